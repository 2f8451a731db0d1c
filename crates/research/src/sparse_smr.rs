//! Sparse frames with smr beside frames that are filled between the same number of samples: quality and time. Makes the
//! last columns of `cargo research papers`.

use afterimage::{Filter, Foveation, Image, Settings};
use afterimage_lab::clock::Quartiles;
use afterimage_lab::device::Backend;
use afterimage_lab::frame::Content;
use afterimage_lab::lattices::{Geometry, SampleOrder};
use afterimage_lab::measure::{Foveated, FrameTime, Pattern, TracedView};
use afterimage_lab::metric::{Flip, encode, psnr_db};
use afterimage_lab::pipeline::{Pipeline, RunKind};
use afterimage_lab::trace::Tracer;
use afterimage_lab::trace::sampling::Sampling;
use afterimage_program::failure::Failure;
use serde::Serialize;
use std::collections::BTreeMap;

/// Frames of the clip that smr sees; the last one is scored. A lattice of step 4 has then sampled all pixels.
pub const CLIP_FRAMES: u64 = 16;
/// The last frames of the clip, which are timed.
pub const TIMED_FRAMES: u64 = 3;

/// A frame of each kind.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Samples per pixel of the full-rate frame that both are compared with: as many as where the pattern is densest.
    reference_samples_per_pixel: u32,
    pub filled: Shown,
    pub sparse_smr: Shown,
}

/// Quality and time of frames as they are displayed.
#[derive(Clone, Debug, Serialize)]
pub struct Shown {
    /// Of sRGB-encoded values; `None` without errors.
    pub psnr_db: Option<f64>,
    pub flip: f64,
    /// Samples of the last frame.
    samples: u64,
    /// Time of tracing, with interpolation where frames are filled, and with depth and motion at the samples where they
    /// are sparse and on a device. On the CPU, depth and motion are given.
    pub render_ms: f64,
    /// Time of smr; 0 for filled frames.
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

    /// Compares the frames of `filled` with sparse frames of `lattices`, a pattern whose samples can lie on lattices,
    /// after smr.
    ///
    /// # Errors
    /// If they cannot, or the device fails.
    pub fn compare(&mut self, filled: &Pattern, lattices: Sampling) -> Result<Comparison, Failure> {
        let subject = self.subject;
        let reference = self
            .references
            .entry(filled.samples)
            .or_insert_with(|| encode(&subject.full_rate(self.tracer, filled.samples, CLIP_FRAMES - 1), 0.0));
        let reference = reference.clone();
        let sparse = Pattern { sampling: lattices, sparse: Some(Geometry::Samples), ..filled.clone() };
        Ok(Comparison {
            reference_samples_per_pixel: filled.samples,
            filled: self.filled(filled, &reference)?,
            sparse_smr: self.sparse(&sparse, &reference)?,
        })
    }

    fn filled(&self, pattern: &Pattern, reference: &Image<[f32; 3]>) -> Result<Shown, Failure> {
        let (mut render_ms, mut last) = (vec![], None);
        for index in CLIP_FRAMES - TIMED_FRAMES..CLIP_FRAMES {
            let frame = self.subject.foveated(self.tracer, pattern, index)?;
            render_ms.push(self.ms(&frame.took));
            last = Some(frame);
        }
        let Some(Foveated { content: Content::Foveated(frame), samples, .. }) = last else {
            unreachable!("filled frames are in memory")
        };
        Ok(self.shown(&frame.color, reference, samples, &render_ms, &[0.0]))
    }

    fn sparse(&self, pattern: &Pattern, reference: &Image<[f32; 3]>) -> Result<Shown, Failure> {
        let geometry = *self.subject.geometry();
        let foveation = Foveation { filter: Filter::Sparse, ..pattern.sampling.foveation() };
        let smr = [RunKind::PostProcess(Settings::traced())];
        let mut pipeline = Pipeline::new(geometry, foveation, &smr, false, &[], self.backend)?
            .with_sparse(Geometry::Samples, SampleOrder::default());
        let (mut render_ms, mut post_ms, mut last) = (vec![], vec![], None);
        for index in 0..CLIP_FRAMES {
            let (frame, took) = self.subject.rendered(self.tracer, pattern, index)?;
            let step = pipeline.step(&frame)?;
            if index + TIMED_FRAMES >= CLIP_FRAMES {
                render_ms.push(self.ms(&took));
                post_ms.extend(step.outputs.iter().map(|output| output.elapsed.cost_ms()));
            }
            last = step.outputs.into_iter().next().map(|output| (output.image, frame.samples));
        }
        let (image, samples) = last.expect("a clip has frames");
        Ok(self.shown(&image, reference, samples.unwrap_or(0), &render_ms, &post_ms))
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
