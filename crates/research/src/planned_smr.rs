//! Frames whose pixels and numbers of paths smr chooses beside frames that are filled between as many samples: quality
//! and time. Makes the last columns of `cargo research papers`.

use afterimage::Image;
use afterimage::internal::{Foveation, Settings};
use afterimage_lab::clock::Elapsed;
use afterimage_lab::clock::Quartiles;
use afterimage_lab::device::Backend;
use afterimage_lab::frame::{Shaded, ShadedColor, ShadingRequest};
use afterimage_lab::metric::{Flip, encode, psnr_db};
use afterimage_lab::pipeline::{Pipeline, RunKind};
use afterimage_program::failure::Failure;
use afterimage_trace::Tracer;
use afterimage_trace::measure::{Foveated, FrameTime, Pattern, TracedView};
use serde::Serialize;
use std::collections::BTreeMap;

/// Frames of the clip that smr sees; the last one is scored.
pub const CLIP_FRAMES: u64 = 16;
/// The last frames of the clip, which are timed.
pub const TIMED_FRAMES: u64 = 3;

/// A frame of each kind.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Samples per pixel of the full-rate frame that both are compared with: as many as where the pattern is densest.
    reference_samples_per_pixel: u32,
    pub filled: Shown,
    pub planned_smr: Shown,
}

/// Quality and time of frames as they are displayed.
#[derive(Clone, Debug, Serialize)]
pub struct Shown {
    /// Of sRGB-encoded values; `None` without errors.
    pub psnr_db: Option<f64>,
    pub flip: f64,
    /// Samples of the last frame.
    samples: u64,
    /// Time of tracing, with interpolation where frames are filled. Depth and motion are given.
    pub render_ms: f64,
    /// Time of smr with its plan; 0 for filled frames.
    pub post_ms: f64,
    pub total_ms: f64,
}

/// Compares the patterns of a scene, on the device that traces them.
pub struct Comparer<'a> {
    subject: &'a TracedView,
    tracer: &'a Tracer,
    backend: &'a Backend,
    /// Times are wall times instead of CPU times.
    by_wall: bool,
    /// Encoded full-rate frames, by samples per pixel.
    references: BTreeMap<u32, Image<[f32; 3]>>,
}

impl<'a> Comparer<'a> {
    pub fn new(subject: &'a TracedView, tracer: &'a Tracer, backend: &'a Backend, by_wall: bool) -> Self {
        Self { subject, tracer, backend, by_wall, references: BTreeMap::new() }
    }

    /// Compares the frames of `filled` with frames of as many paths that smr plans.
    ///
    /// # Errors
    /// If the device fails.
    pub fn compare(&mut self, filled: &Pattern) -> Result<Comparison, Failure> {
        let subject = self.subject;
        let reference = self
            .references
            .entry(filled.samples)
            .or_insert_with(|| encode(&subject.full_rate(self.tracer, filled.samples, CLIP_FRAMES - 1), 0.0));
        let reference = reference.clone();
        let shown = self.filled(filled, &reference);
        Ok(Comparison {
            reference_samples_per_pixel: filled.samples,
            planned_smr: self.planned(filled, shown.samples, &reference)?,
            filled: shown,
        })
    }

    fn filled(&self, pattern: &Pattern, reference: &Image<[f32; 3]>) -> Shown {
        let frames = (CLIP_FRAMES - TIMED_FRAMES..CLIP_FRAMES).map(|i| self.subject.foveated(self.tracer, pattern, i));
        let frames: Vec<Foveated> = frames.collect();
        let render_ms: Vec<_> = frames.iter().map(|frame| self.ms(&frame.took)).collect();
        let last = &frames[frames.len() - 1];
        self.shown(&last.frame.color, reference, last.samples, &render_ms, &[0.0])
    }

    /// `paths`: number of paths of a frame.
    fn planned(&self, pattern: &Pattern, paths: u64, reference: &Image<[f32; 3]>) -> Result<Shown, Failure> {
        let geometry = *self.subject.geometry();
        let fovea_deg = pattern.sampling.foveation().fovea_deg;
        let foveation = Foveation { fovea_deg, mid_deg: fovea_deg, single_pixels: true, ..Foveation::quads() };
        // What the fovea and the even pattern leave, one pixel in two blocks.
        let e_deg = geometry.eccentricity_map(pattern.gaze_px);
        let all = e_deg.pixels().len() as f64;
        let in_fovea = e_deg.pixels().iter().filter(|&&e| e < 0.5 * fovea_deg).count() as f64;
        let even = in_fovea + (all - in_fovea) / f64::from(2 * foveation.rate_far * foveation.rate_far);
        let budget = ((paths as f64 - even) / all).clamp(0.0, 1.0) as f32;
        let smr = [RunKind::PostProcess(Settings::traced())];
        let foveation = Foveation { budget, ..foveation };
        let mut pipeline = Pipeline::new(geometry, foveation, &smr, false, &[], self.backend)?;
        let (mut render_ms, mut post_ms, mut last) = (vec![], vec![], None);
        for index in 0..CLIP_FRAMES {
            let frame = self.subject.surfaces(self.tracer, pattern.gaze_px, index);
            let (mut traced, mut samples) = (0.0, 0);
            let mut shade = |request: &ShadingRequest| -> Result<_, Failure> {
                let (film, took) = self.subject.shade(self.tracer, request, 1, index);
                traced = self.ms(&took);
                samples = film.moments.pixels().iter().map(|moments| u64::from(moments.count)).sum();
                let (color, noise) = (ShadedColor::InMemory(film.color()), Some(film.noise()));
                let took = Elapsed { wall_ms: took.wall_ms, cpu_ms: Some(took.cpu_ms), device_ms: took.device_ms };
                Ok(Some(Shaded { color, half: None, noise, took }))
            };
            let step = pipeline.step_with(&frame, &mut shade)?;
            if index + TIMED_FRAMES >= CLIP_FRAMES {
                render_ms.push(traced);
                post_ms.extend(step.outputs.iter().map(|output| output.elapsed.cost_ms()));
            }
            last = step.outputs.into_iter().next().map(|output| (output.image, samples));
        }
        let (image, samples) = last.expect("a clip has frames");
        Ok(self.shown(&image, reference, samples, &render_ms, &post_ms))
    }

    fn ms(&self, took: &FrameTime) -> f64 {
        if self.by_wall { took.wall_ms } else { took.cpu_ms }
    }

    fn shown(
        &self,
        color: &Image<[f32; 3]>,
        reference: &Image<[f32; 3]>,
        samples: u64,
        render_ms: &[f64],
        post_ms: &[f64],
    ) -> Shown {
        let shown = encode(color, 0.0);
        let values =
            |image: &Image<[f32; 3]>| image.pixels().iter().flatten().map(|&v| f64::from(v)).collect::<Vec<_>>();
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let squares: Vec<f64> = values(&shown)
            .iter()
            .zip(values(reference))
            .map(|(shown, reference)| (shown - reference).powi(2))
            .collect();
        let flip = Flip::for_view(self.subject.geometry()).map(reference, &shown);
        let median = |ms: &[f64]| Quartiles::of(ms).map_or(f64::NAN, |q| q.median);
        let (render_ms, post_ms) = (median(render_ms), median(post_ms));
        Shown {
            psnr_db: psnr_db(mean(&squares)),
            flip: mean(&flip.pixels().iter().map(|&v| f64::from(v)).collect::<Vec<_>>()),
            samples,
            render_ms,
            post_ms,
            total_ms: render_ms + post_ms,
        }
    }
}
