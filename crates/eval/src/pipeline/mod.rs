//! Pipeline of a clip: foveates each frame for a gaze, runs each method on it, and tracks surfaces for the metrics.

mod candidate;
mod cpu;
mod executor;
mod foveator;
mod oracle;
mod processor;
mod run;

pub use candidate::{Candidate, InMemory, needs_lod};
pub use executor::{Executor, RunInputs, Shade};
pub use processor::{Cpu, Processor, ProcessorInfo};
pub use run::{Chosen, MethodOutput, RunKind, chooses, unshaded};

use crate::clock::Stopwatch;
use crate::frame::{RenderedFrame, Shaded, ShadingRequest};
use crate::metric::{Tracked, Tracker};
use crate::quad_views::{Geometry, QuadViewLayout};
use crate::source::{FrameRequest, Wanted};
use afterimage::internal::{ContextDesc, Foveation, FoveationKind, Method, Settings};
use afterimage::{CreateError, DebugView, FrameError, FrameValue, Gaze, Image, SettingsError, ViewGeometry};
use foveator::Foveator;
use oracle::Oracle;

/// Result of one frame: the foveation, and the output of each run.
#[derive(Clone, Debug)]
pub struct Step {
    /// True gaze in pixels. It differs from the foveation's gaze if the tracker has latency.
    pub gaze_px: [f32; 2],
    /// Eccentricity of every pixel from the true gaze, in degrees.
    pub ecc_deg: Image<f32>,
    /// Level of detail of every pixel of the foveated frame.
    pub lods: Image<f32>,
    /// Correspondence with the previous frame, and retained pixels.
    pub tracked: Tracked,
    /// Outputs in the order of the runs.
    pub outputs: Vec<MethodOutput>,
    /// Wall time of the foveation simulator in milliseconds.
    pub foveation_ms: f64,
}

/// A run of a pipeline.
enum Run {
    /// The executor's method of this number.
    Method(usize),
    Oracle(Oracle),
}

/// Pipeline of a clip: state of the foveation and of all runs.
pub struct Pipeline {
    foveator: Foveator,
    runs: Vec<Run>,
    executor: Box<dyn Executor>,
    tracker: Tracker,
    last_gaze_px: Option<[f32; 2]>,
    /// True gaze, if the gaze of the requests is late.
    true_gaze: Option<[f32; 2]>,
    debug: Vec<DebugView>,
    use_trust: bool,
    pixel: Option<[u32; 2]>,
    quad_views: Option<QuadViewLayout>,
    is_jittered: bool,
    has_albedo: bool,
    reference_samples: Option<u32>,
}

impl Pipeline {
    /// Creates a pipeline for frames of `geometry`'s size. `is_still`: all frames are equal, so that the mip chain is
    /// built once. `debug`: debug views to draw.
    ///
    /// # Errors
    /// [`CreateError`] if a setting is out of range or the device does not support it.
    pub fn new(
        geometry: ViewGeometry,
        foveation: Foveation,
        runs: &[RunKind],
        is_still: bool,
        debug: &[DebugView],
        processor: &dyn Processor,
    ) -> Result<Self, CreateError> {
        foveation.validate()?;
        // Simulators read only the foveation of the settings.
        let settings = Settings { method: Method::None, foveation, ..Settings::default() };
        let desc = ContextDesc { settings, keep_alpha: false, ..ContextDesc::new(geometry.size_px()) };
        let mut executor = processor.executor(&desc, is_still)?;
        let mut methods = 0..;
        let mut run = |kind: &RunKind| {
            let Some(settings) = kind.settings() else {
                return check_oracle(&foveation).map(|()| Run::Oracle(Oracle::default()));
            };
            let settings = Settings { foveation, ..*settings };
            executor.add(kind, &ContextDesc { settings, has_albedo: kind.has_albedo(), ..desc })?;
            Ok::<_, CreateError>(Run::Method(methods.next().unwrap_or_default()))
        };
        Ok(Self {
            runs: runs.iter().map(&mut run).collect::<Result<_, _>>()?,
            executor,
            foveator: Foveator::new(geometry, foveation, is_still),
            tracker: Tracker::default(),
            last_gaze_px: None,
            true_gaze: None,
            debug: debug.to_vec(),
            use_trust: false,
            pixel: None,
            quad_views: None,
            is_jittered: false,
            has_albedo: runs.iter().any(RunKind::has_albedo),
            reference_samples: None,
        })
    }

    /// Passes the source's trust masks, if any, to the methods.
    #[must_use]
    pub fn with_trust(self) -> Self {
        Self { use_trust: true, ..self }
    }

    /// Frames are composed of quad views, which their source renders, with this depth and motion.
    #[must_use]
    pub fn with_quad_views(mut self, layout: Option<QuadViewLayout>, geometry: Geometry) -> Self {
        self.foveator.view_geometry = geometry;
        Self { quad_views: layout, ..self }
    }

    /// Sources that can jitter the projection do so, by [`Foveation::jitter_px`] of the frame's number.
    #[must_use]
    pub fn with_jitter(self) -> Self {
        Self { is_jittered: true, ..self }
    }

    /// Samples a pixel of references: [`FrameRequest::reference_samples`].
    #[must_use]
    pub fn with_reference_samples(self, samples: Option<u32>) -> Self {
        Self { reference_samples: samples, ..self }
    }

    /// The request of frame `index` for a gaze in pixels. A lost gaze holds the last position; before the first, it is
    /// the center of the view.
    pub fn request(&mut self, index: u64, gaze: Option<[f32; 2]>) -> FrameRequest {
        let gaze = gaze.map_or(Gaze::Lost, |px| Gaze::At { px });
        let gaze_px = gaze.resolve(self.last_gaze_px, &self.foveator.geometry);
        self.last_gaze_px = Some(gaze_px);
        let Foveator { foveation, geometry, .. } = &self.foveator;
        let wanted = match self.quad_views {
            Some(layout) => Wanted::QuadViews(layout.views(foveation, geometry, gaze_px)),
            // A fovea of the whole view is a full-rate frame.
            None if foveation.kind == FoveationKind::Quads && foveation.fovea_deg < 180.0 => Wanted::Surfaces,
            None => Wanted::FullRate,
        };
        FrameRequest {
            gaze_px,
            wanted,
            // The sequence starts with a corner of the pixel.
            jitter_px: self.is_jittered.then(|| Foveation::jitter_px(index + 1)),
            reference_samples: self.reference_samples,
            geometry: self.foveator.view_geometry,
            albedo: self.has_albedo,
            device: self.executor.device().filter(|_| !self.foveates_in_memory()),
            ..FrameRequest::full_rate(index)
        }
    }

    /// True gaze of the next steps, for scores, if the gaze of the requests is late. `None`: the requests' gaze is the
    /// true one.
    pub fn look_at(&mut self, true_gaze: Option<[f32; 2]>) {
        self.true_gaze = true_gaze;
    }

    /// Takes notes about a pixel in the next steps: [`MethodOutput::notes`]. Methods must run on the CPU.
    pub fn explain(&mut self, pixel: Option<[u32; 2]>) {
        self.pixel = pixel;
    }

    /// Foveates a frame, unless its source did, and runs all methods on it. The runs' settings must be
    /// [`noisy`](Settings::noisy) for frames of a path tracer that foveates; the oracle supports simulated frames only.
    ///
    /// # Errors
    /// [`FrameError::Size`] if the frame's size is not the pipeline's, [`FrameError::Value`] if it is not composed of
    /// quad views and should be.
    pub fn step(&mut self, frame: &RenderedFrame) -> Result<Step, FrameError> {
        self.step_with(frame, &mut |_| Ok(None))
    }

    /// As [`step`](Self::step), for methods that choose pixels: `shade` shades these, for frames that no simulator
    /// foveates. `None`: the source cannot shade them; the step then fails.
    ///
    /// # Errors
    /// As for `step`, and those of `shade`.
    pub fn step_with<E: From<FrameError>>(
        &mut self,
        frame: &RenderedFrame,
        shade: &mut dyn FnMut(&ShadingRequest) -> Result<Option<Shaded>, E>,
    ) -> Result<Step, E> {
        let has_reference = self.check(frame)?;
        let watch = Stopwatch::start();
        let candidate = self.foveator.candidate(frame, self.foveates_in_memory());
        self.executor.set(frame, &candidate)?;
        // Frames that a path tracer foveated are not foveated again.
        let foveation_ms = if frame.content.is_traced() { 0.0 } else { watch.wall_ms() };
        let gaze_px = self.true_gaze.unwrap_or(frame.gaze_px);
        let ecc_deg = self.foveator.geometry.eccentricity_map(gaze_px);
        let tracked = match has_reference {
            true => self.tracker.advance(&frame.reference, &self.foveator.geometry, &ecc_deg, &candidate.lods),
            false => Tracked::unknown(self.foveator.geometry.size_px()),
        };
        let mut failed = None;
        let mut shade =
            |request: &ShadingRequest| shade(request).unwrap_or_else(|error| (failed = Some(error), None).1);
        let outputs = self.run(frame, &candidate, &mut shade);
        failed.map_or(Ok(()), Err)?;
        let outputs = outputs?;
        let Candidate { lods, pyramid, .. } = candidate;
        self.foveator.keep(pyramid);
        Ok(Step { gaze_px, ecc_deg, lods, tracked, outputs, foveation_ms })
    }

    /// Whether a frame, which must fit the pipeline, has a reference.
    fn check(&self, frame: &RenderedFrame) -> Result<bool, FrameError> {
        let expected = self.foveator.geometry.size_px();
        let sizes = [&frame.reference, frame.given()].map(|of| of.color.size());
        let is_full_rate = frame.is_simulated();
        let is_wrong = |found: &[u32; 2]| *found != expected && (is_full_rate || *found != [0; 2]);
        if let Some(found) = sizes.into_iter().find(is_wrong) {
            return Err(FrameError::Size { input: "color", view: 0, found, expected });
        }
        if is_full_rate && self.quad_views.is_some() {
            let (found, expected) = ("a full-rate frame".into(), "one that is composed of quad views");
            return Err(FrameError::Value { value: FrameValue::Color, view: 0, found, expected });
        }
        Ok(sizes[0] == expected)
    }

    /// Runs all methods on the foveated frame.
    fn run(
        &mut self,
        frame: &RenderedFrame,
        candidate: &Candidate<'_>,
        shade: Shade<'_>,
    ) -> Result<Vec<MethodOutput>, FrameError> {
        let inputs = RunInputs { frame, candidate, debug: &self.debug, use_trust: self.use_trust, pixel: self.pixel };
        let mut outputs: Vec<Option<MethodOutput>> = vec![None; self.runs.len()];
        // Rotate the order of runs each frame, because the foveation's data in the caches favor or slow down the first
        // run.
        let first = frame.index as usize % self.runs.len().max(1);
        for i in (first..self.runs.len()).chain(0..first) {
            outputs[i] = Some(match &mut self.runs[i] {
                Run::Method(run) => self.executor.run(*run, &inputs, shade)?,
                Run::Oracle(oracle) => {
                    oracle.run(candidate.pyramid.as_ref(), &candidate.lods, &self.foveator.foveation)?
                }
            });
        }
        Ok(outputs.into_iter().flatten().collect())
    }

    /// Bytes of history that run `index` keeps between frames.
    pub fn memory_bytes(&self, index: usize) -> usize {
        match &self.runs[index] {
            Run::Method(run) => self.executor.memory_bytes(*run),
            Run::Oracle(oracle) => oracle.memory_bytes(),
        }
    }

    /// Whether frames are foveated in memory: for runs on the CPU, and for the oracle.
    fn foveates_in_memory(&self) -> bool {
        let has_oracle = self.runs.iter().any(|run| matches!(run, Run::Oracle(_)));
        self.executor.device().is_none() || has_oracle
    }
}

fn check_oracle(foveation: &Foveation) -> Result<(), CreateError> {
    if foveation.kind == FoveationKind::Quads {
        let expected = "another one: the oracle's best level of detail is not defined for moving samples".into();
        Err(SettingsError { setting: "foveation filter", found: foveation.kind.name().into(), expected })?;
    }
    Ok(())
}
