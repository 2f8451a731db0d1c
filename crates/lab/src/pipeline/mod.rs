//! Pipeline of a clip: foveates each frame for a gaze, runs each method on it, and tracks surfaces for the metrics.

#[cfg(feature = "ablation")]
pub mod ablation;
#[cfg(feature = "full")]
mod composed;
#[cfg(feature = "full")]
mod device;
mod guide;
#[cfg(feature = "full")]
mod sparse;

use crate::lattices::{SampleOrder, SparseGeometry, levels};
#[cfg(feature = "full")]
pub use device::{DeviceFormats, DeviceInputs, DeviceRun};

use crate::clock::{Elapsed, Stopwatch};
use crate::device::Backend;
#[cfg(feature = "full")]
use crate::device::{Headless, PassClock};
#[cfg(feature = "full")]
use crate::frame::DeviceFrame;
use crate::frame::{FoveatedFrame, Guide, SourceFrame};
use crate::metric::{Tracked, Tracker};
use crate::quad_views::{QuadViewLayout, QuadViews};
use afterimage::cpu::{CpuAfterimage, Frame, PixelTrace};
use afterimage::kernel::debug_view::view_color;
use afterimage::kernel::noise::{Noise, unpack_noise};
use afterimage::simulator::Pyramid;
use afterimage::{
    ContextDesc, CreateError, DebugView, Filter, Foveation, FrameError, FrameStats, Gaze, Image, Lattices, Method,
    Reset, Settings, SettingsError, Smr, ViewFrame, ViewGeometry,
};
use guide::HistoryNoise;
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

/// A foveated frame in memory.
struct Candidate<'a> {
    color: &'a Image<[f32; 3]>,
    /// Levels of detail as an input of the methods, if any.
    lod_given: Option<&'a Image<f32>>,
    noise: Option<&'a Image<[f32; 2]>>,
    /// Depth and motion of the samples, where they replace those of the full-rate frame.
    geometry: Option<(&'a Image<f32>, &'a Image<[f32; 2]>)>,
}

/// State of a run.
enum Run {
    Cpu(Box<CpuAfterimage>),
    #[cfg(feature = "full")]
    Device(Box<DeviceRun>),
    Oracle {
        best: Option<Image<f32>>,
    },
}

/// Device side of a pipeline.
#[cfg(feature = "full")]
struct Device {
    gpu: Arc<Headless>,
    inputs: DeviceInputs,
    clock: PassClock,
    /// Whether the frame of a still is already on the device.
    has_still: bool,
}

/// Pipeline of a clip: state of the foveation and of all runs.
pub struct Pipeline {
    geometry: ViewGeometry,
    foveation: Foveation,
    runs: Vec<Run>,
    #[cfg(feature = "full")]
    device: Option<Device>,
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
    #[cfg(feature = "ablation")]
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
        Ok(Self {
            runs: runs.iter().map(|kind| Run::new(kind, &desc, backend)).collect::<Result<_, _>>()?,
            #[cfg(feature = "full")]
            device: match backend {
                Backend::Cpu => None,
                Backend::Gpu(gpu) => Some(Device {
                    inputs: DeviceInputs::new(gpu, &desc, DeviceFormats::EXACT)?,
                    clock: PassClock::new(gpu),
                    has_still: false,
                    gpu: gpu.clone(),
                }),
            },
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
            #[cfg(feature = "ablation")]
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
    #[cfg(feature = "ablation")]
    #[must_use]
    pub fn with_poison(self, share: f32) -> Self {
        Self { poison: share, ..self }
    }

    /// Stores the noise of the first noisy smr run's history after each frame, for [`guide`](Self::guide).
    #[must_use]
    pub fn with_guidance(self) -> Self {
        Self { is_guided: true, ..self }
    }

    /// Sampling guide for the next frame. `None` before the first frame, after a cut, without
    /// [`with_guidance`](Self::with_guidance), and without a noisy smr run.
    pub fn guide(&self, frame: &SourceFrame) -> Option<Guide> {
        self.history_noise.as_ref().filter(|_| !frame.cut).map(|k| k.guide(frame, &self.geometry))
    }

    /// Foveates frame `index` and runs all methods on it. [`look`](Self::look) says where a lost gaze is.
    ///
    /// # Errors
    /// [`FrameError::Size`] if the frame's size is not the pipeline's.
    pub fn step(&mut self, index: u64, frame: &SourceFrame, gaze: Option<[f32; 2]>) -> Result<Step, FrameError> {
        self.step_frame(
            index,
            frame,
            gaze,
            #[cfg(feature = "full")]
            None,
        )
    }

    /// As [`step`](Self::step), for a frame that is also on a device. If that is the pipeline's device, the frame is
    /// not uploaded again.
    ///
    /// # Errors
    /// As for `step`.
    #[cfg(feature = "full")]
    pub fn step_on_device(
        &mut self,
        index: u64,
        frame: &SourceFrame,
        gaze: Option<[f32; 2]>,
        rendered: &DeviceFrame,
    ) -> Result<Step, FrameError> {
        self.step_frame(index, frame, gaze, Some(rendered))
    }

    fn step_frame(
        &mut self,
        index: u64,
        frame: &SourceFrame,
        gaze: Option<[f32; 2]>,
        #[cfg(feature = "full")] rendered: Option<&DeviceFrame>,
    ) -> Result<Step, FrameError> {
        let size = self.geometry.size_px();
        if frame.color.size() != size {
            return Err(FrameError::Size { input: "color", view: 0, found: frame.color.size(), expected: size });
        }
        let gaze_px = self.look(gaze);
        let watch = Stopwatch::start();
        let ecc_deg = self.geometry.eccentricity_map(gaze_px);
        let lattices = self.lattices(gaze_px, index);
        let lods = match &lattices {
            Some(lattices) => levels(lattices, size),
            None => self.foveation.lod_map(&self.geometry, gaze_px, &ecc_deg),
        };
        let view = ViewFrame { lattices, ..self.view(frame, gaze_px) };
        // Runs on a device use the GPU simulator, which equals this one bit for bit on software devices.
        let pyramid = self.foveates_in_memory().then(|| match self.still.take() {
            Some(pyramid) => pyramid,
            // Of sparse frames, only samples are read.
            None => Pyramid::new(frame.color.clone(), if lattices.is_some() { 0 } else { self.foveation.max_level() }),
        });
        let color = pyramid.as_ref().map(|pyramid| self.foveation.render(pyramid, &lods));
        #[cfg(feature = "ablation")]
        let color = color.map(|color| poisoned(color, self.poison, index as u32));
        let candidate = color.as_ref().map(|color| Candidate {
            color,
            lod_given: needs_lod(self.foveation.filter).then_some(&lods),
            noise: None,
            geometry: None,
        });
        #[cfg(feature = "full")]
        self.foveate_on_device(frame, rendered, candidate.as_ref(), &view)?;
        let foveation_ms = watch.wall_ms();
        let tracked = self.tracker.advance(frame, &self.geometry, &ecc_deg, &lods);
        let outputs = self.run(index, frame, &view, candidate.as_ref(), pyramid.as_ref().map(|p| (p, &lods)))?;
        self.still = pyramid.filter(|_| self.is_still);
        Ok(Step { gaze_px, ecc_deg, lods, tracked, outputs, foveation_ms })
    }

    /// As [`step`](Self::step), for a frame that its source foveated for the gaze of [`look`](Self::look). The runs'
    /// settings must be [`noisy`](Settings::noisy). The oracle does not support such frames.
    ///
    /// # Errors
    /// As for `step`.
    pub fn step_foveated(
        &mut self,
        index: u64,
        frame: &SourceFrame,
        gaze_px: [f32; 2],
        foveated: FoveatedFrame,
    ) -> Result<Step, FrameError> {
        let FoveatedFrame { color, lod, noise, lattices, .. } = foveated;
        let ecc_deg = self.geometry.eccentricity_map(gaze_px);
        let tracked = self.tracker.advance(frame, &self.geometry, &ecc_deg, &lod);
        #[cfg(feature = "ablation")]
        let color = poisoned(color, self.poison, index as u32);
        // Lattices say how coarse a sparse frame is.
        let lod_given = lattices.is_none().then_some(&lod);
        let candidate = Candidate { color: &color, lod_given, noise: Some(&noise), geometry: None };
        let lattices = lattices.map(|lattices| self.sparse_geometry.of(lattices));
        let view = ViewFrame { lattices, ..self.view(frame, gaze_px) };
        #[cfg(feature = "full")]
        if let Some(device) = &mut self.device {
            device.inputs.upload_foveated(frame, candidate.color, candidate.lod_given, candidate.noise);
        }
        let outputs = self.run(index, frame, &view, Some(&candidate), None)?;
        if self.is_guided {
            let noise =
                self.runs.iter().zip(&outputs).find_map(|(run, output)| Some((self.noise(run)?, &output.image)));
            self.history_noise =
                noise.map(|((noise, smr), image)| HistoryNoise::new(noise, 1.0 - smr.accumulate, image.clone(), frame));
        }
        Ok(Step { gaze_px, ecc_deg, lods: lod, tracked, outputs, foveation_ms: 0.0 })
    }

    /// Gaze of the frame in pixels. A lost gaze holds the last position; before the first, it is the center of the
    /// view.
    pub fn look(&mut self, gaze: Option<[f32; 2]>) -> [f32; 2] {
        let gaze = gaze.map_or(Gaze::Lost, |px| Gaze::At { px });
        let gaze_px = gaze.resolve(self.held_gaze, &self.geometry);
        self.held_gaze = Some(gaze_px);
        gaze_px
    }

    /// Bytes of history that run `index` keeps between frames.
    pub fn memory_bytes(&self, index: usize) -> usize {
        match &self.runs[index] {
            Run::Cpu(post) => post.memory_bytes(),
            #[cfg(feature = "full")]
            Run::Device(run) => run.post().memory_bytes() as usize,
            Run::Oracle { best } => best.as_ref().map_or(0, |b| size_of_val(b.pixels())),
        }
    }

    /// Lattices of frame `index` for the gaze of [`look`](Self::look), if frames are sparse.
    pub fn lattices(&self, gaze_px: [f32; 2], index: u64) -> Option<Lattices> {
        let is_sparse = self.foveation.filter == Filter::Sparse;
        is_sparse.then(|| {
            let lattices = self.sample_order.lattices(&self.foveation, &self.geometry, gaze_px, index);
            self.sparse_geometry.of(lattices)
        })
    }

    /// Quad views of a frame for the gaze of [`look`](Self::look), if frames are composed of them.
    pub fn quad_views(&self, gaze_px: [f32; 2]) -> Option<QuadViews> {
        Some(self.quad_views?.views(&self.foveation, &self.geometry, gaze_px))
    }

    fn view(&self, frame: &SourceFrame, gaze_px: [f32; 2]) -> ViewFrame {
        let view = ViewFrame::new(self.geometry, Gaze::At { px: gaze_px });
        ViewFrame { previous_from_current: frame.previous_from_current, ..view }
    }

    /// Whether frames are foveated in memory: for runs on the CPU, for the oracle, and for poisoned pixels.
    fn foveates_in_memory(&self) -> bool {
        #[cfg(feature = "ablation")]
        if self.poison > 0.0 {
            return true;
        }
        #[cfg(feature = "full")]
        if self.device.is_some() {
            return self.runs.iter().any(|run| !matches!(run, Run::Device(_)));
        }
        true
    }

    #[cfg(feature = "full")]
    fn foveate_on_device(
        &mut self,
        frame: &SourceFrame,
        rendered: Option<&DeviceFrame>,
        candidate: Option<&Candidate<'_>>,
        view: &ViewFrame,
    ) -> Result<(), FrameError> {
        let Some(Device { gpu, inputs, has_still, .. }) = &mut self.device else { return Ok(()) };
        #[cfg(feature = "ablation")]
        if let Some(candidate) = candidate.filter(|_| self.poison > 0.0) {
            inputs.upload_foveated(frame, candidate.color, candidate.lod_given, None);
            return Ok(());
        }
        #[cfg(not(feature = "ablation"))]
        let _ = candidate;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        match rendered.filter(|rendered| Arc::ptr_eq(&rendered.device, gpu)) {
            Some(rendered) => inputs.import(&mut encoder, rendered),
            None if *has_still => {}
            None => inputs.upload(frame),
        }
        *has_still = self.is_still;
        inputs.foveate(&mut encoder, std::slice::from_ref(view), None)?;
        gpu.queue.submit([encoder.finish()]);
        gpu.wait();
        gpu.check()
    }

    /// Runs all methods on the foveated frame. `still`: mip chain and levels of detail of the frame, for the oracle.
    fn run(
        &mut self,
        index: u64,
        frame: &SourceFrame,
        view: &ViewFrame,
        candidate: Option<&Candidate<'_>>,
        still: Option<(&Pyramid, &Image<f32>)>,
    ) -> Result<Vec<MethodOutput>, FrameError> {
        let reset = if frame.cut { Reset::All } else { Reset::None };
        let mut outputs: Vec<Option<MethodOutput>> = vec![None; self.runs.len()];
        // Rotate the order of runs each frame: the first run finds caches as the foveation left them.
        let first = index as usize % self.runs.len().max(1);
        for i in (first..self.runs.len()).chain(0..first) {
            outputs[i] = Some(match &mut self.runs[i] {
                Run::Cpu(post) => {
                    let candidate = candidate.expect("frames are foveated in memory for runs on the CPU");
                    let trust = frame.trust.as_ref().filter(|_| self.use_trust);
                    on_cpu(post, frame, trust, candidate, view, index, reset, &self.debug)?
                }
                #[cfg(feature = "full")]
                Run::Device(run) => {
                    let device = self.device.as_ref().expect("a pipeline with device runs has a device");
                    let views = std::slice::from_ref(view);
                    let frame = device.inputs.frame(views, index, reset, self.use_trust);
                    on_device(device, run, &frame, &self.debug)?
                }
                Run::Oracle { best } => {
                    let (pyramid, lods) = still.ok_or_else(|| FrameError::Value {
                        what: "oracle",
                        view: 0,
                        found: "a frame that its source foveated".into(),
                        expected: "a simulator's",
                    })?;
                    oracle(best, lods, &self.foveation, pyramid)
                }
            });
        }
        Ok(outputs.into_iter().flatten().collect())
    }

    /// Noise of a run's history, and smr's settings; `None` unless the run is a noisy smr run.
    fn noise(&self, run: &Run) -> Option<(Image<Noise>, Smr)> {
        let settings = match run {
            Run::Cpu(post) => post.desc().settings,
            #[cfg(feature = "full")]
            Run::Device(run) => run.post().desc().settings,
            Run::Oracle { .. } => return None,
        };
        let Method::Smr(smr) = settings.method else { return None };
        let words = match run {
            Run::Cpu(post) => {
                let words = post.history().noise().to_vec();
                (!words.is_empty())
                    .then(|| Image::from_pixels(post.desc().size_px, words).expect("one noise word for each pixel"))?
            }
            #[cfg(feature = "full")]
            Run::Device(run) => {
                let texture = run.post().history_textures().get(2).filter(|_| settings.noisy)?;
                self.device.as_ref()?.gpu.read::<u32>(texture, 0)
            }
            Run::Oracle { .. } => return None,
        };
        Some((words.map(unpack_noise), smr))
    }
}

/// Whether methods need the levels of detail of a simulated frame as an input. `Filter::Block` evaluates the level at
/// the center of a block, which a method cannot derive from the gaze.
pub fn needs_lod(filter: Filter) -> bool {
    filter == Filter::Block
}

impl Run {
    fn new(kind: &RunKind, desc: &ContextDesc, backend: &Backend) -> Result<Self, CreateError> {
        let of = |settings: &Settings| ContextDesc {
            settings: Settings { foveation: desc.settings.foveation, ..*settings },
            ..*desc
        };
        match kind {
            RunKind::Oracle if desc.settings.foveation.filter == Filter::Sparse => {
                let expected =
                    "another one: the oracle's best level of detail is not defined for moving samples".into();
                Err(SettingsError { setting: "foveation filter", found: "sparse".into(), expected })?
            }
            RunKind::Oracle => Ok(Self::Oracle { best: None }),
            RunKind::PostProcess(settings) => match backend {
                Backend::Cpu => Ok(Self::Cpu(Box::new(CpuAfterimage::new(&of(settings))?))),
                #[cfg(feature = "full")]
                Backend::Gpu(gpu) => {
                    Ok(Self::Device(Box::new(DeviceRun::new(gpu, &of(settings), DeviceFormats::EXACT)?)))
                }
            },
            #[cfg(feature = "ablation")]
            RunKind::Without(settings, part) => {
                let Backend::Gpu(gpu) = backend else {
                    let expected = "a device: parts are removed from shaders".into();
                    Err(SettingsError { setting: "backend", found: "the CPU".into(), expected })?
                };
                let shader = part.shader_without(settings.method.kind());
                let run = DeviceRun::with_shader(gpu, &of(settings), DeviceFormats::EXACT, &shader)?;
                Ok(Self::Device(Box::new(run)))
            }
        }
    }
}

/// `color` with a random share of its pixels replaced by invalid colors.
#[cfg(feature = "ablation")]
fn poisoned(mut color: Image<[f32; 3]>, share: f32, index: u32) -> Image<[f32; 3]> {
    use afterimage::kernel::rng;
    const POISONS: [f32; 5] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -5.0];
    /// Purpose of these random numbers, distinct from those of the methods.
    const PURPOSE: u32 = 0x706f_6973;
    if share == 0.0 {
        return color;
    }
    let width = color.width();
    for (i, pixel) in color.pixels_mut().iter_mut().enumerate() {
        let bits = rng::bits((i % width) as u32, (i / width) as u32, index, PURPOSE);
        if rng::unit_draw(bits) < share {
            *pixel = [POISONS[bits as usize % POISONS.len()]; 3];
        }
    }
    color
}

#[allow(clippy::too_many_arguments, reason = "a private helper with unrelated arguments")]
fn on_cpu(
    post: &mut CpuAfterimage,
    source: &SourceFrame,
    trust: Option<&Image<f32>>,
    candidate: &Candidate<'_>,
    view: &ViewFrame,
    index: u64,
    reset: Reset,
    debug: &[DebugView],
) -> Result<MethodOutput, FrameError> {
    use std::slice::from_ref;
    let size = post.desc().size_px;
    let mut output = [Image::filled(size, [0.0; 3])];
    let mut traces = (!debug.is_empty()).then(|| [Image::filled(size, PixelTrace::default())]);
    let (depth, motion) = match candidate.geometry {
        Some((depth, motion)) => (Some(depth), Some(motion)),
        None => (source.depth.as_ref(), source.motion.as_ref()),
    };
    let frame = Frame {
        depth: depth.as_ref().map(from_ref),
        motion: motion.as_ref().map(from_ref),
        trust: trust.as_ref().map(from_ref),
        lod: candidate.lod_given.as_ref().map(from_ref),
        noise: candidate.noise.as_ref().map(from_ref),
        reset,
        ..Frame::new(from_ref(&candidate.color), from_ref(view), index)
    };
    let watch = Stopwatch::start();
    let stats = match &mut traces {
        Some(traces) => post.process_traced(&frame, &mut output, traces)?,
        None => post.process(&frame, &mut output)?,
    };
    let (wall_ms, cpu_ms) = (watch.wall_ms(), watch.cpu_ms());
    let given = [depth.is_some(), motion.is_some(), trust.is_some()];
    let [image] = output;
    Ok(MethodOutput {
        image,
        wall_ms,
        cpu_ms,
        device_ms: None,
        stats,
        traffic_bytes_per_pixel: Some(post.desc().settings.traffic_bytes_per_pixel(given)),
        debug: traces.map_or_else(Vec::new, |[trace]| {
            debug.iter().map(|&view| trace.map(|t| view_color(view, &t).to_array())).collect()
        }),
    })
}

#[cfg(feature = "full")]
fn on_device(
    device: &Device,
    run: &mut DeviceRun,
    frame: &afterimage::gpu::Frame<'_>,
    debug: &[DebugView],
) -> Result<MethodOutput, FrameError> {
    let gpu = &device.gpu;
    let encoder = || gpu.device.create_command_encoder(&Default::default());
    let mut debug_views = vec![];
    // Counters come from a debug view. If no view is requested, one is drawn for the counters and not read back.
    for &view in if debug.is_empty() { &[DebugView::Rejection] } else { debug } {
        let mut encoder = encoder();
        run.record_view(&mut encoder, frame, view)?;
        gpu.queue.submit([encoder.finish()]);
        debug_views.extend(run.debug().filter(|_| !debug.is_empty()).map(|texture| gpu.read_rgb(texture, 0)));
    }
    // The device is idle when the watch starts.
    gpu.wait();
    let watch = Stopwatch::start();
    let mut encoder = encoder();
    run.record(&mut encoder, frame, device.clock.timestamps())?;
    device.clock.resolve(&mut encoder);
    gpu.queue.submit([encoder.finish()]);
    gpu.wait();
    let (wall_ms, cpu_ms) = (watch.wall_ms(), watch.cpu_ms());
    let device_ms = device.clock.is_device().then(|| device.clock.read_ms(gpu, &watch));
    let given = [frame.depth.is_some(), frame.motion.is_some(), frame.trust.is_some()];
    let output = MethodOutput {
        image: gpu.read_rgb(run.output(), 0),
        wall_ms,
        cpu_ms,
        device_ms,
        stats: run.stats(),
        traffic_bytes_per_pixel: Some(run.post().desc().settings.traffic_bytes_per_pixel(given)),
        debug: debug_views,
    };
    gpu.check().map(|()| output)
}

fn oracle(best: &mut Option<Image<f32>>, lods: &Image<f32>, foveation: &Foveation, pyramid: &Pyramid) -> MethodOutput {
    let watch = Stopwatch::start();
    let best = best.get_or_insert_with(|| lods.clone());
    for (b, &l) in best.pixels_mut().iter_mut().zip(lods.pixels()) {
        *b = b.min(l);
    }
    let image = foveation.render(pyramid, best);
    MethodOutput {
        image,
        wall_ms: watch.wall_ms(),
        cpu_ms: watch.cpu_ms(),
        device_ms: None,
        stats: FrameStats::default(),
        traffic_bytes_per_pixel: None,
        debug: vec![],
    }
}
