//! Pipeline of a clip: foveates each frame for a gaze, runs each method on it, and tracks surfaces for the metrics.

#[cfg(feature = "ablation")]
pub mod ablation;
mod candidate;
mod cpu;
#[cfg(feature = "full")]
mod device;
mod executor;
mod guide;
mod oracle;
mod poison;

#[cfg(feature = "full")]
pub use device::{DeviceFormats, DeviceInputs, DeviceRun};

use crate::clock::{Elapsed, Stopwatch};
use crate::device::Backend;
#[cfg(feature = "full")]
use crate::device::Headless;
use crate::frame::{Content, RenderedFrame};
use crate::lattices::{SampleOrder, SparseGeometry};
use crate::metric::{Tracked, Tracker};
use crate::quad_views::QuadViewLayout;
use crate::source::{FrameRequest, SamplingGuide, Wanted};
use afterimage::simulator::Pyramid;
use afterimage::{
    ContextDesc, CreateError, DebugView, Filter, Foveation, FrameError, FrameStats, Gaze, Image, Lattices, Method,
    Settings, SettingsError, ViewGeometry,
};
use candidate::Candidate;
use cpu::CpuExecutor;
#[cfg(feature = "full")]
use device::DeviceExecutor;
use executor::{Executor, Shot};
use guide::HistoryNoise;
use oracle::Oracle;
#[cfg(feature = "full")]
use std::sync::Arc;

/// Kind of a run: how it processes the foveated frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RunKind {
    /// The post-process with these settings. The pipeline's foveation replaces theirs.
    PostProcess(Settings),
    /// The post-process without a part of its pass, on a device only: measures the part's cost and benefit.
    #[cfg(feature = "ablation")]
    Without(Settings, &'static ablation::Part),
    /// Every pixel at its finest level of detail so far: the upper bound of temporal reuse. Defined for stills only.
    Oracle,
}

/// A run's output for one frame.
#[derive(Clone, Debug)]
pub struct MethodOutput {
    /// Displayed frame, linear.
    pub image: Image<[f32; 3]>,
    /// Wall time of the pass in milliseconds.
    pub wall_ms: f64,
    /// CPU time of the process during the pass in milliseconds; `None` if the system does not measure it.
    pub cpu_ms: Option<f64>,
    /// Time of the pass by timestamp queries, in milliseconds; `None` on software devices and the CPU.
    pub device_ms: Option<f64>,
    /// Counters of the pass; all 0 for the oracle.
    pub stats: FrameStats,
    /// Bytes per pixel that the pass reads and writes; `None` for the oracle.
    pub traffic_bytes_per_pixel: Option<u32>,
    /// Debug views, linear, in the order of the request; empty for the oracle.
    pub debug: Vec<Image<[f32; 3]>>,
}

impl MethodOutput {
    /// Time of the pass.
    pub fn elapsed(&self) -> Elapsed {
        Elapsed { wall_ms: self.wall_ms, cpu_ms: self.cpu_ms, device_ms: self.device_ms }
    }
}

/// Result of one frame: the foveation, and the output of each run.
#[derive(Clone, Debug)]
pub struct Step {
    /// Gaze that the foveation used, in pixels.
    pub gaze_px: [f32; 2],
    /// Eccentricity of every pixel in degrees.
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
    geometry: ViewGeometry,
    foveation: Foveation,
    runs: Vec<Run>,
    executor: Box<dyn Executor>,
    #[cfg(feature = "full")]
    device: Option<Arc<Headless>>,
    tracker: Tracker,
    held_gaze: Option<[f32; 2]>,
    still: Option<Pyramid>,
    is_still: bool,
    debug: Vec<DebugView>,
    use_trust: bool,
    sparse_geometry: SparseGeometry,
    sample_order: SampleOrder,
    quad_views: Option<QuadViewLayout>,
    /// For guided sampling.
    history_noise: Option<HistoryNoise>,
    is_guided: bool,
    poison: f32,
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
        backend: &Backend,
    ) -> Result<Self, CreateError> {
        foveation.validate()?;
        // Simulators read the foveation alone.
        let settings = Settings { method: Method::None, foveation, ..Settings::default() };
        let desc = ContextDesc { settings, ..ContextDesc::new(geometry.size_px()) };
        let mut executor: Box<dyn Executor> = match backend {
            Backend::Cpu => Box::new(CpuExecutor::default()),
            #[cfg(feature = "full")]
            Backend::Gpu(gpu) => Box::new(DeviceExecutor::new(gpu, &desc, is_still)?),
        };
        let mut methods = 0..;
        let mut run = |kind: &RunKind| {
            let Some(settings) = kind.settings() else {
                return check_oracle(&foveation).map(|()| Run::Oracle(Oracle::default()));
            };
            executor.add(kind, &ContextDesc { settings: Settings { foveation, ..*settings }, ..desc })?;
            Ok::<_, CreateError>(Run::Method(methods.next().unwrap_or_default()))
        };
        Ok(Self {
            runs: runs.iter().map(&mut run).collect::<Result<_, _>>()?,
            executor,
            #[cfg(feature = "full")]
            device: backend.device().cloned(),
            geometry,
            foveation,
            tracker: Tracker::default(),
            held_gaze: None,
            still: None,
            is_still,
            debug: debug.to_vec(),
            use_trust: false,
            sparse_geometry: SparseGeometry::default(),
            sample_order: SampleOrder::default(),
            quad_views: None,
            history_noise: None,
            is_guided: false,
            poison: 0.0,
        })
    }

    /// Passes the source's trust masks, if any, to the methods.
    #[must_use]
    pub fn with_trust(self) -> Self {
        Self { use_trust: true, ..self }
    }

    /// Depth and motion of sparse frames, and the order in which their samples move.
    #[must_use]
    pub fn with_sparse(self, geometry: SparseGeometry, order: SampleOrder) -> Self {
        Self { sparse_geometry: geometry, sample_order: order, ..self }
    }

    /// Frames are composed of quad views, which their source renders.
    #[must_use]
    pub fn with_quad_views(self, layout: Option<QuadViewLayout>) -> Self {
        Self { quad_views: layout, ..self }
    }

    /// Replaces a share of the foveated pixels of every frame by invalid colors: NaN, infinite, huge, negative.
    #[must_use]
    pub fn with_poison(self, share: f32) -> Self {
        Self { poison: share, ..self }
    }

    /// Guides the source's samples by the noise of the first noisy smr run's history.
    #[must_use]
    pub fn with_guidance(self) -> Self {
        Self { is_guided: true, ..self }
    }

    /// The request of frame `index` for a gaze in pixels. A lost gaze holds the last position; before the first, it is
    /// the center of the view.
    pub fn request(&mut self, index: u64, gaze: Option<[f32; 2]>) -> FrameRequest<'_> {
        let gaze = gaze.map_or(Gaze::Lost, |px| Gaze::At { px });
        let gaze_px = gaze.resolve(self.held_gaze, &self.geometry);
        self.held_gaze = Some(gaze_px);
        let wanted = match (self.quad_views, self.lattices(gaze_px, index)) {
            (_, Some(lattices)) => Wanted::Lattices(lattices),
            (Some(layout), None) => Wanted::QuadViews(layout.views(&self.foveation, &self.geometry, gaze_px)),
            (None, None) => Wanted::FullRate,
        };
        FrameRequest {
            index,
            gaze_px,
            wanted,
            geometry: self.sparse_geometry,
            reference: true,
            guide: self.history_noise.as_ref().map(|noise| noise as &dyn SamplingGuide),
            #[cfg(feature = "full")]
            device: self.device.clone().filter(|_| !self.foveates_in_memory()),
        }
    }

    /// Foveates a frame, unless its source did, and runs all methods on it. The runs' settings must be
    /// [`noisy`](Settings::noisy) for frames of a path tracer that foveates; the oracle supports simulated frames only.
    ///
    /// # Errors
    /// [`FrameError::Size`] if the frame's size is not the pipeline's, [`FrameError::Value`] if it is not composed of
    /// quad views and should be.
    pub fn step(&mut self, frame: &RenderedFrame) -> Result<Step, FrameError> {
        let has_reference = self.check(frame)?;
        let watch = Stopwatch::start();
        let gaze_px = frame.gaze_px;
        let ecc_deg = self.geometry.eccentricity_map(gaze_px);
        let candidate = self.candidate(frame, &ecc_deg);
        self.executor.set(frame, &candidate)?;
        // Nothing is foveated here if a path tracer did it.
        let foveation_ms = if frame.content.is_traced() { 0.0 } else { watch.wall_ms() };
        let tracked = match has_reference {
            true => self.tracker.advance(&frame.reference, &self.geometry, &ecc_deg, &candidate.lods),
            false => Tracked::unknown(self.geometry.size_px()),
        };
        let outputs = self.run(frame, &candidate)?;
        self.note_noise(frame, &outputs);
        let Candidate { lods, pyramid, .. } = candidate;
        self.still = pyramid.filter(|_| self.is_still);
        Ok(Step { gaze_px, ecc_deg, lods, tracked, outputs, foveation_ms })
    }

    /// Whether a frame, which must fit the pipeline, has a reference.
    fn check(&self, frame: &RenderedFrame) -> Result<bool, FrameError> {
        let (found, expected) = (frame.reference.color.size(), self.geometry.size_px());
        let is_full_rate = matches!(frame.content, Content::FullRate);
        if found != expected && (is_full_rate || found != [0; 2]) {
            return Err(FrameError::Size { input: "color", view: 0, found, expected });
        }
        if is_full_rate && self.quad_views.is_some() {
            let (found, expected) = ("a full-rate frame".into(), "one that is composed of quad views");
            return Err(FrameError::Value { what: "frame", view: 0, found, expected });
        }
        Ok(found == expected)
    }

    /// Runs all methods on the foveated frame.
    fn run(&mut self, frame: &RenderedFrame, candidate: &Candidate<'_>) -> Result<Vec<MethodOutput>, FrameError> {
        let shot = Shot { frame, candidate, debug: &self.debug, use_trust: self.use_trust };
        let mut outputs: Vec<Option<MethodOutput>> = vec![None; self.runs.len()];
        // Rotate the order of runs each frame: the first run finds caches as the foveation left them.
        let first = frame.index as usize % self.runs.len().max(1);
        for i in (first..self.runs.len()).chain(0..first) {
            outputs[i] = Some(match &mut self.runs[i] {
                Run::Method(run) => self.executor.run(*run, &shot)?,
                Run::Oracle(oracle) => oracle.run(candidate.pyramid.as_ref(), &candidate.lods, &self.foveation)?,
            });
        }
        Ok(outputs.into_iter().flatten().collect())
    }

    /// Stores the noise of the first history that knows it, for the next request.
    fn note_noise(&mut self, frame: &RenderedFrame, outputs: &[MethodOutput]) {
        if !self.is_guided {
            return;
        }
        let noise = self.runs.iter().zip(outputs).find_map(|(run, output)| match run {
            Run::Method(run) => Some((self.executor.history_noise(*run)?, &output.image)),
            Run::Oracle(_) => None,
        });
        self.history_noise = noise.map(|((noise, settings), image)| {
            HistoryNoise::new(noise, 1.0 - settings.smr.accumulate, image.clone(), &frame.reference, self.geometry)
        });
    }

    /// Bytes of history that run `index` keeps between frames.
    pub fn memory_bytes(&self, index: usize) -> usize {
        match &self.runs[index] {
            Run::Method(run) => self.executor.memory_bytes(*run),
            Run::Oracle(oracle) => oracle.memory_bytes(),
        }
    }

    /// Lattices of frame `index`, if frames are sparse.
    fn lattices(&self, gaze_px: [f32; 2], index: u64) -> Option<Lattices> {
        let is_sparse = self.foveation.filter == Filter::Sparse;
        is_sparse.then(|| {
            let lattices = self.sample_order.lattices(&self.foveation, &self.geometry, gaze_px, index);
            self.sparse_geometry.of(lattices)
        })
    }

    /// Whether frames are foveated in memory: for runs on the CPU, for the oracle, and for poisoned pixels.
    fn foveates_in_memory(&self) -> bool {
        let has_oracle = self.runs.iter().any(|run| matches!(run, Run::Oracle(_)));
        self.executor.reads_memory() || has_oracle || self.poison > 0.0
    }
}

impl RunKind {
    /// Settings of a method; `None` for the oracle.
    fn settings(&self) -> Option<&Settings> {
        match self {
            Self::PostProcess(settings) => Some(settings),
            #[cfg(feature = "ablation")]
            Self::Without(settings, _) => Some(settings),
            Self::Oracle => None,
        }
    }

    /// Parts are removed from shaders.
    fn check_on_cpu(&self) -> Result<(), SettingsError> {
        match self {
            #[cfg(feature = "ablation")]
            Self::Without(..) => {
                let expected = "a device: parts are removed from shaders".into();
                Err(SettingsError { setting: "backend", found: "the CPU".into(), expected })
            }
            _ => Ok(()),
        }
    }
}

fn check_oracle(foveation: &Foveation) -> Result<(), CreateError> {
    if foveation.filter == Filter::Sparse {
        let expected = "another one: the oracle's best level of detail is not defined for moving samples".into();
        Err(SettingsError { setting: "foveation filter", found: "sparse".into(), expected })?;
    }
    Ok(())
}

/// Whether methods need the levels of detail of a simulated frame as an input. `Filter::Block` evaluates the level at
/// the center of a block, which a method cannot derive from the gaze.
fn needs_lod(filter: Filter) -> bool {
    filter == Filter::Block
}
