//! One frame through everything: foveate it for a gaze, give it to each method, keep what metrics need.

#[cfg(feature = "ablation")]
pub mod ablation;
#[cfg(feature = "full")]
mod gpu_lane;
mod guide;

use crate::clock::Stopwatch;
use crate::metric::{Tracked, Tracker};
#[cfg(feature = "ablation")]
use afterimage::SettingsError;
use afterimage::cpu::{CpuAfterimage, CpuFrame, CpuView};
use afterimage::kernel::debug_view::{DebugView, PixelTrace, view_color};
use afterimage::kernel::noise::{Noise, unpack_noise};
use afterimage::simulator::Pyramid;
use afterimage::{
    ContextDesc, CreateError, Filter, Foveation, FrameError, FrameStats, Gaze, Image, Reset, Settings, ViewFrame,
    ViewGeometry,
};

use crate::device::Backend;
use crate::frame::{FoveatedFrame, Guide, SourceFrame};
#[cfg(feature = "full")]
use gpu_lane::{GpuLane, LaneInput};
use guide::Knowledge;

/// What a lane of the pipeline does with the foveated frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LaneKind {
    /// The post-process with these settings; their foveation is replaced by the pipeline's.
    PostProcess(Settings),
    /// The same with a part of the pass left out, on a device only: to see what the part costs and buys.
    #[cfg(feature = "ablation")]
    Without(Settings, &'static crate::pipeline::ablation::Part),
    /// Every pixel at the best level of detail it was ever shown at: the upper bound of temporal reuse. Only right for stills.
    Oracle,
}

/// One method's result for one frame.
#[derive(Clone, Debug)]
pub struct Shown {
    /// What the user sees, linear.
    pub image: Image<[f32; 3]>,
    /// Wall time of the pass in milliseconds.
    pub wall_ms: f64,
    /// CPU time of the process during the pass in milliseconds, where the system tells.
    pub cpu_ms: Option<f64>,
    /// The pass's time on a device that tells it; `None` on software devices and the CPU.
    pub device_ms: Option<f64>,
    /// What the pass counted; empty for the oracle.
    pub stats: FrameStats,
    /// Bytes that the pass reads and writes a pixel; `None` for the oracle.
    pub traffic_bytes_per_pixel: Option<u32>,
    /// Pictures of pixel decisions, linear, in the order in which they were asked for; none for the oracle.
    pub debug: Vec<Image<[f32; 3]>>,
}

impl Shown {
    /// What the pass costs: the device's own time, else CPU time, which other work on the machine disturbs less than wall time.
    pub fn cost_ms(&self) -> f64 {
        self.device_ms.or(self.cpu_ms).unwrap_or(self.wall_ms)
    }
}

/// One frame, foveated, and what each lane made of it.
#[derive(Clone, Debug)]
pub struct Step {
    /// Where the eye was taken to look, in pixels.
    pub gaze_px: [f32; 2],
    /// Eccentricity of every pixel in degrees.
    pub ecc_deg: Image<f32>,
    /// Level of detail of every pixel of the foveated frame.
    pub lods: Image<f32>,
    /// Correspondence and retention.
    pub tracked: Tracked,
    /// Results in the order of the lanes.
    pub shown: Vec<Shown>,
    /// Wall time of the foveation simulator in milliseconds.
    pub foveation_ms: f64,
}

/// A foveated frame.
struct Candidate<'a> {
    color: &'a Image<[f32; 3]>,
    lods: &'a Image<f32>,
    /// Whether the methods are told its levels of detail.
    told: bool,
    noise: Option<&'a Image<[f32; 2]>>,
    /// What it was made of, if by a simulator.
    pyramid: Option<&'a Pyramid>,
}

enum Executor {
    PostProcess(Box<CpuAfterimage>),
    #[cfg(feature = "full")]
    Gpu(Box<GpuLane>),
    Oracle {
        best: Option<Image<f32>>,
    },
}

impl Executor {
    /// Noise of what its history holds, if that is noisy, and its settings.
    fn noise(&self) -> Option<(Image<Noise>, &Settings)> {
        let (words, settings) = match self {
            Self::PostProcess(post) => {
                let words = post.history().noise().to_vec();
                let size_px = post.desc().size_px;
                let image = (!words.is_empty()).then(|| Image::from_pixels(size_px, words).expect("a word a pixel"));
                (image?, post.settings())
            }
            #[cfg(feature = "full")]
            Self::Gpu(lane) => (lane.noise()?, lane.settings()),
            Self::Oracle { .. } => return None,
        };
        Some((words.map(unpack_noise), settings))
    }
}

/// The pipeline of a clip: state of all lanes, and of the foveation.
pub struct Pipeline {
    geometry: ViewGeometry,
    foveation: Foveation,
    lanes: Vec<Executor>,
    tracker: Tracker,
    held_gaze: Option<[f32; 2]>,
    still: Option<Pyramid>,
    is_still: bool,
    debug: Vec<DebugView>,
    use_trust: bool,
    /// For guided sampling, if that is done.
    knowledge: Option<Knowledge>,
    is_guided: bool,
    #[cfg(feature = "ablation")]
    poison: f32,
}

impl Pipeline {
    /// A pipeline for frames of `geometry`'s size. `is_still`: all frames are the same picture, whose mip levels are then
    /// built once. `debug`: pixel decisions to draw.
    ///
    /// # Errors
    /// If a setting is out of range, or the device cannot do it.
    pub fn new(
        geometry: ViewGeometry,
        foveation: Foveation,
        lanes: &[LaneKind],
        is_still: bool,
        debug: &[DebugView],
        backend: &Backend,
    ) -> Result<Self, CreateError> {
        foveation.validate()?;
        let lanes = lanes
            .iter()
            .map(|lane| match lane {
                LaneKind::Oracle => Ok(Executor::Oracle { best: None }),
                LaneKind::PostProcess(settings) => {
                    let settings = Settings { foveation, ..*settings };
                    let desc = ContextDesc::new(geometry.size_px());
                    match backend {
                        Backend::Cpu => Ok(Executor::PostProcess(Box::new(CpuAfterimage::new(desc, settings)?))),
                        #[cfg(feature = "full")]
                        Backend::Gpu(gpu) => Ok(Executor::Gpu(Box::new(GpuLane::new(gpu, desc, settings)?))),
                    }
                }
                #[cfg(feature = "ablation")]
                LaneKind::Without(settings, part) => {
                    let Backend::Gpu(gpu) = backend else {
                        let expected = "a device: parts are left out of shaders".into();
                        Err(SettingsError { setting: "backend", found: "the CPU".into(), expected })?
                    };
                    let settings = Settings { foveation, ..*settings };
                    let shader = part.shader_without(settings.method);
                    let desc = ContextDesc::new(geometry.size_px());
                    Ok(Executor::Gpu(Box::new(GpuLane::from_shader(gpu, desc, settings, &shader)?)))
                }
            })
            .collect::<Result<_, CreateError>>()?;
        Ok(Self {
            geometry,
            foveation,
            lanes,
            tracker: Tracker::default(),
            held_gaze: None,
            still: None,
            is_still,
            debug: debug.to_vec(),
            use_trust: false,
            knowledge: None,
            is_guided: false,
            #[cfg(feature = "ablation")]
            poison: 0.0,
        })
    }

    /// Gives the methods the trust masks of sources that have them.
    #[must_use]
    pub fn with_trust(self) -> Self {
        Self { use_trust: true, ..self }
    }

    /// Spoils a share of the foveated pixels of every frame as renderers do: NaN, infinite, huge, negative.
    #[cfg(feature = "ablation")]
    #[must_use]
    pub fn with_poison(self, share: f32) -> Self {
        Self { poison: share, ..self }
    }

    /// Remembers after each frame what the history of the first noisy lane of smr knows.
    #[must_use]
    pub fn with_guidance(self) -> Self {
        Self { is_guided: true, ..self }
    }

    /// What is known of a frame that is about to be foveated, for sampling that is guided by it. `None` before the first frame, after a
    /// cut, and without [`with_guidance`](Self::with_guidance) or a lane that knows.
    pub fn guide(&self, frame: &SourceFrame) -> Option<Guide> {
        self.knowledge.as_ref().filter(|_| !frame.cut).map(|k| k.guide(frame, &self.geometry))
    }

    /// Takes frame `index`. A lost gaze holds the last position; before the first, the middle of the view.
    ///
    /// # Errors
    /// If the frame's size is not the pipeline's.
    pub fn step(&mut self, index: u64, frame: &SourceFrame, gaze: Option<[f32; 2]>) -> Result<Step, FrameError> {
        let size = self.geometry.size_px();
        if frame.color.size() != size {
            return Err(FrameError::Size { input: "color", view: 0, found: frame.color.size(), expected: size });
        }
        let gaze_px = self.look(gaze);
        let watch = Stopwatch::start();
        let ecc_deg = self.geometry.eccentricity_map(gaze_px);
        let lods = self.foveation.lod_map(&self.geometry, gaze_px, &ecc_deg);
        let pyramid = match self.still.take() {
            Some(pyramid) => pyramid,
            None => Pyramid::new(frame.color.clone(), self.foveation.max_level()),
        };
        let color = self.foveation.render(&pyramid, &lods);
        let foveation_ms = watch.wall_ms();
        // Blocks are decided by their centres, which the post-process does not know.
        let told = self.foveation.filter == Filter::Block;
        let candidate = Candidate { color: &color, lods: &lods, told, noise: None, pyramid: Some(&pyramid) };
        let (tracked, shown) = self.show(index, frame, gaze_px, &ecc_deg, &candidate)?;
        if self.is_still {
            self.still = Some(pyramid);
        }
        Ok(Step { gaze_px, ecc_deg, lods, tracked, shown, foveation_ms })
    }

    /// The same of a frame that its source foveated for the gaze that [`look`](Self::look) gave. Lanes' settings are taken to be
    /// [`noisy`](Settings::noisy); there is no oracle of such frames.
    ///
    /// # Errors
    /// If a frame's size is not the pipeline's.
    pub fn step_foveated(
        &mut self,
        index: u64,
        frame: &SourceFrame,
        gaze_px: [f32; 2],
        foveated: FoveatedFrame,
    ) -> Result<Step, FrameError> {
        let FoveatedFrame { color, lod, noise, .. } = foveated;
        let ecc_deg = self.geometry.eccentricity_map(gaze_px);
        let candidate = Candidate { color: &color, lods: &lod, told: true, noise: Some(&noise), pyramid: None };
        let (tracked, shown) = self.show(index, frame, gaze_px, &ecc_deg, &candidate)?;
        if self.is_guided {
            let noise = self.lanes.iter().zip(&shown).find_map(|(lane, shown)| Some((lane.noise()?, &shown.image)));
            self.knowledge = noise.map(|((noise, settings), image)| {
                Knowledge::new(noise, 1.0 - settings.smr.accumulate, image.clone(), frame)
            });
        }
        Ok(Step { gaze_px, ecc_deg, lods: lod, tracked, shown, foveation_ms: 0.0 })
    }

    /// Where the eye is taken to look: a lost gaze holds the last position; before the first, the middle of the view.
    pub fn look(&mut self, gaze: Option<[f32; 2]>) -> [f32; 2] {
        let gaze = gaze.map_or(Gaze::Lost, |px| Gaze::At { px });
        let gaze_px = gaze.resolve(self.held_gaze, self.geometry.size_px());
        self.held_gaze = Some(gaze_px);
        gaze_px
    }

    /// Gives a candidate to all lanes.
    fn show(
        &mut self,
        index: u64,
        frame: &SourceFrame,
        gaze_px: [f32; 2],
        ecc_deg: &Image<f32>,
        candidate: &Candidate<'_>,
    ) -> Result<(Tracked, Vec<Shown>), FrameError> {
        let tracked = self.tracker.advance(frame, &self.geometry, ecc_deg, candidate.lods);
        #[cfg(feature = "ablation")]
        let spoiled = poisoned(candidate.color, self.poison, index as u32);
        #[cfg(feature = "ablation")]
        let candidate = &Candidate { color: &spoiled, ..*candidate };
        let facts = ViewFrame {
            geometry: self.geometry,
            gaze: Gaze::At { px: gaze_px },
            previous_from_current: frame.previous_from_current,
        };
        let view = CpuView {
            depth: frame.depth.as_ref(),
            motion: frame.motion.as_ref(),
            trust: frame.trust.as_ref().filter(|_| self.use_trust),
            lod: candidate.told.then_some(candidate.lods),
            noise: candidate.noise,
            ..CpuView::new(facts, candidate.color)
        };
        let reset = if frame.cut { Reset::All } else { Reset::None };
        let cpu_frame = CpuFrame { reset, ..CpuFrame::new(std::slice::from_ref(&view), index) };
        let mut shown: Vec<Option<Shown>> = vec![None; self.lanes.len()];
        // Another lane first in every frame: whoever is first finds the caches as the foveation left them.
        let first = index as usize % self.lanes.len().max(1);
        for i in (first..self.lanes.len()).chain(0..first) {
            shown[i] = Some(match &mut self.lanes[i] {
                Executor::PostProcess(post) => post_process(post, &cpu_frame, &self.debug)?,
                #[cfg(feature = "full")]
                Executor::Gpu(lane) => post_process_on_gpu(lane, &LaneInput { view, index, reset }, &self.debug)?,
                Executor::Oracle { best } => {
                    let pyramid = candidate.pyramid.ok_or_else(|| FrameError::Value {
                        what: "oracle",
                        view: 0,
                        found: "a frame that its source foveated".into(),
                        expected: "a simulator's",
                    })?;
                    oracle(best, candidate.lods, &self.foveation, pyramid)
                }
            });
        }
        Ok((tracked, shown.into_iter().flatten().collect()))
    }

    /// Bytes that lane `index` keeps between frames.
    pub fn memory_bytes(&self, index: usize) -> usize {
        match &self.lanes[index] {
            Executor::PostProcess(post) => post.memory_bytes(),
            #[cfg(feature = "full")]
            Executor::Gpu(lane) => lane.memory_bytes(),
            Executor::Oracle { best } => best.as_ref().map_or(0, |b| size_of_val(b.pixels())),
        }
    }
}

/// A share of the pixels replaced by what renderers' mistakes leave.
#[cfg(feature = "ablation")]
fn poisoned(color: &Image<[f32; 3]>, share: f32, index: u32) -> Image<[f32; 3]> {
    use afterimage::kernel::rng;
    const POISONS: [f32; 5] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -5.0];
    /// No purpose of the methods' draws.
    const PURPOSE: u32 = 0x706f_6973;
    let mut spoiled = color.clone();
    let width = color.width();
    for (i, pixel) in spoiled.pixels_mut().iter_mut().enumerate() {
        let bits = rng::bits((i % width) as u32, (i / width) as u32, index, PURPOSE);
        if rng::unit_draw(bits) < share {
            *pixel = [POISONS[bits as usize % POISONS.len()]; 3];
        }
    }
    spoiled
}

fn post_process(post: &mut CpuAfterimage, frame: &CpuFrame<'_>, debug: &[DebugView]) -> Result<Shown, FrameError> {
    let size = post.desc().size_px;
    let mut output = [Image::filled(size, [0.0; 3])];
    let mut traces = (!debug.is_empty()).then(|| [Image::filled(size, PixelTrace::default())]);
    let watch = Stopwatch::start();
    let stats = post.process(frame, &mut output, traces.as_mut().map(|t| &mut t[..]))?;
    let (wall_ms, cpu_ms) = (watch.wall_ms(), watch.cpu_ms());
    let [image] = output;
    Ok(Shown {
        image,
        wall_ms,
        cpu_ms,
        device_ms: None,
        stats,
        traffic_bytes_per_pixel: Some(post.traffic_bytes_per_pixel(&frame.views[0])),
        debug: traces.map_or_else(Vec::new, |[trace]| {
            debug.iter().map(|&view| trace.map(|t| view_color(view, &t).to_array())).collect()
        }),
    })
}

#[cfg(feature = "full")]
fn post_process_on_gpu(lane: &mut GpuLane, input: &LaneInput<'_>, debug: &[DebugView]) -> Result<Shown, FrameError> {
    let made = lane.process(input, debug)?;
    Ok(Shown {
        image: made.image,
        wall_ms: made.wall_ms,
        cpu_ms: made.cpu_ms,
        device_ms: made.device_ms,
        stats: made.stats,
        traffic_bytes_per_pixel: Some(made.traffic_bytes_per_pixel),
        debug: made.debug,
    })
}

fn oracle(best: &mut Option<Image<f32>>, lods: &Image<f32>, foveation: &Foveation, pyramid: &Pyramid) -> Shown {
    let watch = Stopwatch::start();
    let best = best.get_or_insert_with(|| lods.clone());
    for (b, &l) in best.pixels_mut().iter_mut().zip(lods.pixels()) {
        *b = b.min(l);
    }
    let image = foveation.render(pyramid, best);
    Shown {
        image,
        wall_ms: watch.wall_ms(),
        cpu_ms: watch.cpu_ms(),
        device_ms: None,
        stats: FrameStats::default(),
        traffic_bytes_per_pixel: None,
        debug: vec![],
    }
}
