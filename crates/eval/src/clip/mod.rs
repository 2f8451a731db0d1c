//! Runs the pipeline over a clip, frame by frame, and writes frames and scores to disk. Shared by `run`, `demo` and
//! `sweep`.

pub mod pixel;
pub mod run_report;

use crate::clock::Quartiles;
use crate::error::InputError;
use crate::exposure::{Chosen, Exposure};
use crate::frame::RenderedFrame;
use crate::method_report::{MethodAccumulator, MethodReport, Share};
use crate::metric;
use crate::metric::{Flip, Reference, References};
use crate::output::{Output, Table, WriteError};
use crate::picture::to_rgb8;
use crate::pipeline::{Pipeline, Processor, ProcessorInfo, RunKind, Step};
use crate::quad_views::{Geometry, QuadViewLayout};
use crate::report::sheet::{Column, Sheet};
use crate::source::FrameSource;
use crate::times::{RenderTime, Times};
use afterimage::internal::{Foveation, FoveationKind, MethodKind};
use afterimage::{CreateError, DebugView, FrameError, Image, ViewGeometry};
use afterimage_metric::{Display, Viewing};
use pixel::ExplainedPixel;
use rayon::prelude::*;
use thiserror::Error;

/// Files that describe a whole clip. The first one marks the folder. `demo` draws no plot.
pub const REPORTS: [&str; 4] = ["report.json", "psnr.svg", "psnr.png", pixel::FILE];

/// A clip that could not be evaluated.
#[derive(Debug, Error)]
pub enum ClipError {
    /// Its source cannot be used.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The settings of a method cannot be used.
    #[error(transparent)]
    Create(#[from] CreateError),
    /// A method did not take a frame.
    #[error(transparent)]
    Frame(#[from] FrameError),
    /// A file could not be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// Settings of a clip: foveation, methods, gaze, and files to write.
pub struct Clip {
    /// First line of the contact sheet.
    pub title: String,
    /// The view of every frame.
    pub geometry: ViewGeometry,
    /// Regions of the foveation, and their coarseness.
    pub foveation: Foveation,
    /// Quad views that the source renders; `None`: a simulator foveates, or methods choose pixels.
    pub quad_views: Option<QuadViewLayout>,
    /// Depth and motion of quad views.
    pub view_geometry: Geometry,
    /// Whether sources that can jitter the projection do so.
    pub jitter: bool,
    /// Samples a pixel of the reference; `None`: as many as the input has.
    pub reference_samples: Option<u32>,
    /// Name of each method, which is also the name of its folder, and its pipeline stage.
    pub methods: Vec<(&'static str, RunKind)>,
    /// Gaze position per frame, in frame pixels; `None`: tracking lost.
    pub gaze: Vec<Option<[f32; 2]>>,
    /// Gaze that the renderer and the methods get in each frame: delayed by a tracker's latency, or fixed. Scores use
    /// the true gaze. `None`: the true gaze.
    pub late_gaze: Option<Vec<Option<[f32; 2]>>>,
    /// First frame that counts in scores.
    pub score_from: usize,
    /// Exposure before sRGB encoding.
    pub exposure: Exposure,
    /// Writes a frame in the format of the run.
    pub write_frame: WriteFrame,
    /// Whether the full-rate frames are written, too.
    pub write_reference: bool,
    /// Debug views to write, each with the name of its folder.
    pub debug: Vec<(&'static str, DebugView)>,
    /// Pixel to explain; methods must run on the CPU.
    pub pixel: Option<ExplainedPixel>,
    /// Whether the methods get the source's trust mask (history confidence).
    pub trust: bool,
    /// Whether FLIP is measured.
    pub flip: bool,
    /// Whether JOD is measured.
    pub jod: bool,
    /// Display on which JOD shows the frames.
    pub display: Display,
    /// Frames per second.
    pub fps: f32,
    /// Processor that runs the methods.
    pub processor: Box<dyn Processor>,
    /// Reason for the fallback to the CPU, as a suffix for messages; empty without a fallback.
    pub backend_note: &'static str,
}

/// Writes frame `index` of a folder. The frame is given as linear and as encoded colors.
pub type WriteFrame = fn(&Output, &str, usize, &Image<[f32; 3]>, &Image<[f32; 3]>) -> Result<(), WriteError>;

/// As 8-bit PNG.
pub fn write_png(
    out: &Output,
    folder: &str,
    index: usize,
    _: &Image<[f32; 3]>,
    encoded: &Image<[f32; 3]>,
) -> Result<(), WriteError> {
    out.picture(folder, index, &to_rgb8(encoded))
}

/// A clip whose first frame is rendered: its input can be read.
pub struct Playback<'a> {
    clip: &'a Clip,
    source: &'a mut dyn FrameSource,
    pipeline: Pipeline,
    first: RenderedFrame,
    exposure: Chosen,
}

/// One frame of a clip, and the outputs of all methods for it.
pub struct FrameResult<'a> {
    /// Number of the frame in the clip.
    pub index: usize,
    /// The frame from its source.
    pub frame: &'a RenderedFrame,
    /// Reference with which metrics compare outputs.
    pub reference: &'a Reference<'a>,
    /// The foveated frame and the outputs.
    pub step: &'a Step,
    /// Exposure before sRGB encoding, stops.
    pub exposure_ev: f32,
}

/// Results of a clip.
#[derive(Default)]
pub struct ClipReport {
    /// Name and results of each method.
    pub methods: Vec<(&'static str, MethodReport)>,
    /// Wall time of the foveation simulator.
    pub foveation_ms: Option<Quartiles>,
    /// Time of rendering the full-rate frames, if they were rendered.
    pub full_rate: Option<RenderTime>,
    /// Camera samples of all frames; 0 unless the source renders foveated frames.
    pub samples: u64,
    /// Device that ran the methods, for messages.
    pub backend: String,
    /// Exposure before sRGB encoding, stops.
    pub exposure_ev: f32,
    /// Gaze position used for each frame, in frame pixels.
    pub gaze_px: Vec<[f32; 2]>,
    /// Mean squared error of each method's frames.
    pub frame_mse: Vec<Vec<f64>>,
}

/// Title of a contact sheet: input, size and foveation.
pub fn title(name: &str, size: [u32; 2], frames: usize, fps: f32, foveation: &str) -> String {
    format!("{name}   {}x{}, {frames} frames at {fps} fps, {foveation}", size[0], size[1])
}

/// Regions of a foveation in words.
pub fn foveation_words(foveation: &Foveation, simulator: &str) -> String {
    let Foveation { kind: filter, fovea_deg, rate_mid, rate_far, budget, .. } = foveation;
    let budget = match filter {
        FoveationKind::Quads => format!(" and {} % by need", 100.0 * budget),
        _ => String::new(),
    };
    format!("fovea {fovea_deg} deg, blocks {rate_mid} and {rate_far} px, {simulator}{budget}")
}

impl Playback<'_> {
    /// The exposure, which may follow from the first frame.
    pub fn exposure(&self) -> &Chosen {
        &self.exposure
    }

    /// Runs the clip and writes everything but `report.json`. Calls `after_frame` when a frame is written.
    pub fn write(
        self,
        out: &Output,
        after_frame: &mut dyn FnMut(&FrameResult<'_>) -> Result<(), ClipError>,
    ) -> Result<ClipReport, ClipError> {
        let clip = self.clip;
        let mut accumulators: Vec<MethodAccumulator> =
            clip.methods.iter().map(|_| MethodAccumulator::default()).collect();
        let exposure_ev = self.exposure.ev;
        let mut report = ClipReport { backend: clip.backend_name(), exposure_ev, ..ClipReport::default() };
        let mut foveation_ms = vec![];
        let mut full_rate = Times::default();
        let mut table = out.table(
            "frames.csv",
            "frame,method,psnr_db,retained_psnr_db,ms,fovea_psnr_db,mid_psnr_db,periphery_psnr_db,\
             cpu_ms,render_ms,render_cpu_ms,total_ms,total_cpu_ms,jod,shaded_share",
        )?;
        let mut pixel_table = clip.pixel.as_ref().map(|_| out.table(pixel::FILE, pixel::HEADER)).transpose()?;
        let pipeline = self.play(&mut |result| {
            if result.index == clip.score_from {
                accumulators.iter_mut().for_each(MethodAccumulator::restart);
            }
            let encoded = clip.score_and_write(result, &mut accumulators, out)?;
            for ((name, _), accumulator) in clip.methods.iter().zip(&accumulators) {
                table.row(&accumulator.row(result.index, name))?;
            }
            if let (Some(pixel), Some(table)) = (&clip.pixel, &mut pixel_table) {
                for ((name, _), output) in clip.methods.iter().zip(&result.step.outputs) {
                    pixel.write(result.index, name, &output.notes, table)?;
                }
            }
            report.samples += result.frame.samples.unwrap_or(0);
            result.frame.full_rate.into_iter().for_each(|elapsed| full_rate.push(elapsed));
            foveation_ms.push(result.step.foveation_ms);
            report.gaze_px.push(result.step.gaze_px);
            if result.index + 1 == clip.gaze.len() {
                clip.write_sheet(result.reference.encoded(), &encoded, &accumulators, &report.gaze_px, out)?;
            }
            after_frame(result)
        })?;
        table.finish()?;
        pixel_table.map_or(Ok(()), Table::finish)?;
        out.gaze("gaze.csv", &report.gaze_px)?;
        let pixels = clip.geometry.size_px().iter().map(|&s| f64::from(s)).product::<f64>();
        let of = |(i, accumulator): (usize, &MethodAccumulator)| {
            let bytes_per_pixel = pipeline.memory_bytes(i) as f64 / pixels;
            (clip.methods[i].0, accumulator.report(bytes_per_pixel))
        };
        report.methods = accumulators.iter().enumerate().map(of).collect();
        compare_with_oracle(&mut report.methods);
        report.frame_mse = accumulators.into_iter().map(MethodAccumulator::into_frame_mse).collect();
        report.full_rate = full_rate.last().map(|_| RenderTime::of(&full_rate));
        report.foveation_ms = Quartiles::of(&foveation_ms);
        Ok(report)
    }

    /// Runs all methods over the clip and calls `each` after every frame. Returns the pipeline in its state after the
    /// last frame.
    pub fn play(self, each: &mut dyn FnMut(&FrameResult<'_>) -> Result<(), ClipError>) -> Result<Pipeline, ClipError> {
        let Self { clip, source, mut pipeline, first, exposure } = self;
        let mut first = Some(first);
        let mut references = clip.references();
        for index in 0..clip.gaze.len() {
            let frame = match first.take() {
                Some(first) => first,
                None => source.render(&pipeline.request(index as u64, clip.known_gaze(index)))?,
            };
            let full = metric::encode(&frame.reference.color, exposure.ev);
            pipeline.look_at(clip.gaze[index].filter(|_| clip.late_gaze.is_some()));
            pipeline.explain(clip.pixel.as_ref().and_then(|pixel| pixel.in_frame(index)));
            let step = pipeline.step_with(&frame, &mut |request| Ok::<_, ClipError>(source.shade(&frame, request)?))?;
            let reference = references.next(&full, &step.tracked, &step.ecc_deg);
            let exposure_ev = exposure.ev;
            each(&FrameResult { index, frame: &frame, reference: &reference, step: &step, exposure_ev })?;
        }
        Ok(pipeline)
    }
}

impl Clip {
    /// Makes the pipeline and renders the first frame. Nothing is written yet.
    pub fn start<'a>(&'a self, source: &'a mut dyn FrameSource) -> Result<Playback<'a>, ClipError> {
        let kinds: Vec<RunKind> = self.methods.iter().map(|l| l.1.clone()).collect();
        let is_still = source.info().still;
        let debug: Vec<_> = self.debug.iter().map(|d| d.1).collect();
        let processor = self.processor.as_ref();
        let mut pipeline = Pipeline::new(self.geometry, self.foveation, &kinds, is_still, &debug, processor)?
            .with_quad_views(self.quad_views, self.view_geometry)
            .with_reference_samples(self.reference_samples);
        if self.jitter {
            pipeline = pipeline.with_jitter();
        }
        if self.trust {
            pipeline = pipeline.with_trust();
        }
        let first = source.render(&pipeline.request(0, self.known_gaze(0)))?;
        let exposure = self.exposure.choose(&first.reference.color, 1.0);
        Ok(Playback { clip: self, source, pipeline, first, exposure })
    }

    /// Gaze that the renderer and the methods get in a frame.
    fn known_gaze(&self, index: usize) -> Option<[f32; 2]> {
        self.late_gaze.as_ref().unwrap_or(&self.gaze).get(index).copied().flatten()
    }

    /// Device that runs the methods, for messages.
    fn backend_name(&self) -> String {
        let ProcessorInfo { kind, name, driver } = self.processor.info();
        match kind {
            "cpu" => format!("CPU ({name}{})", self.backend_note),
            _ => format!("GPU {name} ({driver})"),
        }
    }

    /// FLIP at the pixels per degree of the view, if it is measured.
    pub fn flip(&self) -> Option<Flip> {
        self.flip.then(|| Flip::for_view(&self.geometry))
    }

    /// How the clip is seen, for JOD, if it is measured.
    pub fn viewing(&self) -> Option<Viewing> {
        self.jod.then_some(Viewing { geometry: self.geometry, display: self.display, fps: self.fps })
    }

    /// References for the metrics that are measured.
    fn references(&self) -> References {
        let references = self.flip().map_or_else(References::default, References::with_flip);
        match self.viewing() {
            Some(viewing) => references.with_jod(viewing),
            None => references,
        }
    }

    /// Scores and writes the outputs of all methods for a frame, in parallel; returns their encoded images.
    fn score_and_write(
        &self,
        result: &FrameResult<'_>,
        accumulators: &mut [MethodAccumulator],
        out: &Output,
    ) -> Result<Vec<Image<[f32; 3]>>, WriteError> {
        let &FrameResult { index, frame, reference, step, exposure_ev } = result;
        if self.write_reference {
            (self.write_frame)(out, "reference", index, &frame.reference.color, reference.encoded())?;
        }
        let encoded: Vec<_> = step.outputs.par_iter().map(|shown| metric::encode(&shown.image, exposure_ev)).collect();
        let foveated = self.methods.iter().position(|m| m.0 == MethodKind::None.name()).map(|i| &encoded[i]);
        accumulators.par_iter_mut().zip(&self.methods).zip(step.outputs.par_iter().zip(&encoded)).try_for_each(
            |((accumulator, (name, _)), (shown, encoded))| {
                accumulator.push(frame, reference, encoded, foveated, shown, step);
                (self.write_frame)(out, name, index, &shown.image, encoded)?;
                for ((view, _), picture) in self.debug.iter().zip(&shown.debug) {
                    let folder = format!("debug/{name}/{view}");
                    out.picture(&folder, index, &to_rgb8(&metric::encode(picture, 0.0)))?;
                }
                Ok::<(), WriteError>(())
            },
        )?;
        Ok(encoded)
    }

    fn write_sheet(
        &self,
        reference: &Image<[f32; 3]>,
        encoded: &[Image<[f32; 3]>],
        accumulators: &[MethodAccumulator],
        gaze_px: &[[f32; 2]],
        out: &Output,
    ) -> Result<(), WriteError> {
        let mut columns = vec![Column { name: "reference", shown: reference, scores: None, visible_jod: None }];
        for (((name, _), shown), accumulator) in self.methods.iter().zip(encoded).zip(accumulators) {
            let name = if *name == "none" { "none (foveated only)" } else { name };
            let (scores, visible_jod) = (Some(accumulator.scores()), accumulator.visible_jod());
            columns.push(Column { name, shown, scores, visible_jod });
        }
        let sheet = Sheet {
            title: self.title.clone(),
            columns: &columns,
            geometry: self.geometry,
            gaze_px,
            fovea_deg: self.foveation.fovea_deg,
        };
        out.root_picture("sheet.png", &sheet.draw())
    }
}

/// Fills in `share_of_oracle` if both `none` and `oracle` were run.
fn compare_with_oracle(methods: &mut [(&'static str, MethodReport)]) {
    let find = |name: &str| methods.iter().find(|m| m.0 == name).map(|m| m.1.scores.whole);
    let (Some(none), Some(oracle)) = (find("none"), find("oracle")) else {
        return;
    };
    let share = |value: Option<f64>, from: Option<f64>, to: Option<f64>| {
        let (value, from, to) = (value?, from?, to?);
        (to > from).then(|| (value - from) / (to - from))
    };
    for (_, method) in methods {
        let whole = method.scores.whole;
        method.share_of_oracle = Some(Share {
            psnr: share(whole.psnr_db, none.psnr_db, oracle.psnr_db),
            ssim: share(whole.ssim, none.ssim, oracle.ssim),
        });
    }
}
