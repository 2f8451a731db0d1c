//! Options of the input that `run`, `sweep` and `view` share, and opening it.

use crate::args::channels::ChannelArgs;
use crate::args::paths::PathArgs;
use crate::args::{parse_fps, parse_hfov, parse_samples, parse_size};
use crate::failure::{Failure, warn};
use afterimage::ViewGeometry;
use afterimage_lab::device::{Backend, Headless, NO_ADAPTER};
use afterimage_lab::raster::Shading;
use afterimage_lab::scanpath::HeadPath;
use afterimage_lab::scene::{PunctualKind, Scene};
use afterimage_lab::source;
use afterimage_lab::source::{
    FrameSource, Light, RasterSource, ReadLimits, SceneChoice, SceneOptions, SourceInfo, ViewedScene,
};
use afterimage_trace::sampling::Sampling;
use afterimage_trace::{TracedSamples, TracedSource};
use clap::{Args, ValueEnum};
use std::sync::Arc;

/// Heading of these options in the help.
const HEADING: &str = "Input";

/// Input: frames or a scene.
#[derive(Args, Clone, Debug)]
pub struct InputArgs {
    /// A still (.png, .jpg, .exr), a folder of .exr frames, a scene (.gltf, .glb, builtin:NAME), or analytic:NAME with
    /// NAME one of still, lateral, turn, walk, occluder, light-step, spin, scroll
    #[arg(value_name = "INPUT")]
    pub name: String,
    /// Frames per second, for view an upper limit; default: the input's, else 60
    #[arg(long, value_parser = parse_fps, value_name = "F", help_heading = HEADING)]
    pub fps: Option<f32>,
    /// Horizontal field of view of the flat view, degrees; default: the input's, else 70
    #[arg(long, value_parser = parse_hfov, value_name = "DEG", help_heading = HEADING)]
    pub hfov: Option<f32>,
    /// Size of scenes, pixels; default 640x360
    #[arg(long, value_parser = parse_size, value_name = "WxH", help_heading = HEADING)]
    pub size: Option<[u32; 2]>,
    /// Renderer of a scene; default: raster
    #[arg(long, value_enum, value_name = "NAME", help_heading = HEADING)]
    pub source: Option<SourceName>,
    /// Where surfaces of --source raster are lit: as they are drawn, or, in frames with one sample a pixel (planned
    /// ones, --jitter halton), from a G-buffer; default: forward
    #[arg(long, value_enum, value_name = "NAME", help_heading = HEADING)]
    pub shading: Option<ShadingName>,
    /// Samples per pixel of --source trace: of full-rate frames, or of the fovea with --sampling
    #[arg(long, default_value_t = 32, value_parser = parse_samples, value_name = "N", help_heading = HEADING)]
    pub spp: u32,
    #[command(flatten)]
    pub paths: PathArgs,
    /// Camera of a scene: one of its cameras by name, a camera file (cameras.json, transforms.json, keyframes, COLMAP's
    /// images.txt ...; docs/cameras.md), another scene (.gltf, .glb) for its first camera, or lateral, orbit, walk (the
    /// head of a walking person), framing, head (the poses of the head in --gaze FILE.csv, or somebody who looks around
    /// with head and eye with --gaze synthetic:SEED), head-walk (the same, walking); default: the scene's first camera,
    /// which glides sideways if nothing in the scene moves
    #[arg(long, value_name = "NAME|FILE", help_heading = HEADING)]
    pub camera: Option<String>,
    /// Animation of a scene, by name or number from 0; default: the first. It starts at its first key, and loops
    #[arg(long, visible_alias = "clip", value_name = "NAME|N", help_heading = HEADING)]
    pub animation: Option<String>,
    /// Limit on the size of input images, million pixels
    #[arg(long, default_value_t = 64, value_name = "N", help_heading = HEADING)]
    pub max_megapixels: u32,
    #[command(flatten)]
    pub channels: ChannelArgs,
}

/// Values of `--source`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SourceName {
    /// Rasterization on a GPU, or on a software device if there is none
    Raster,
    /// Path tracing with --spp samples per pixel
    Trace,
}

/// Values of `--shading`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ShadingName {
    /// As they are drawn
    Forward,
    /// From a G-buffer, by a compute pass at the pixels that are shaded
    Deferred,
}

/// Settings of renderers that are not options of the input.
pub struct Rendering {
    pub backend: Backend,
    pub seed: u64,
    /// Sampling pattern of foveated frames; `None`: full-rate frames only.
    pub foveated: Option<FoveatedSampling>,
    /// Head that moves the camera.
    pub head: Option<HeadPath>,
}

/// Samples of foveated frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoveatedSampling {
    /// Their pattern.
    pub pattern: Sampling,
    /// Samples per pixel of their full-rate references.
    pub reference_samples: u32,
}

impl InputArgs {
    /// Whether frames are rendered.
    pub fn is_scene(&self) -> bool {
        source::is_scene(&self.name)
    }

    /// Whether the frames are those of a rasterised scene.
    pub fn is_rasterised(&self) -> bool {
        self.is_scene() && self.source != Some(SourceName::Trace)
    }

    /// Whether the frames are those of an analytic scene.
    pub fn is_analytic(&self) -> bool {
        self.name.starts_with("analytic:")
    }

    /// Opens files directly, and scenes with a renderer.
    pub fn open(&self, rendering: &Rendering) -> Result<Box<dyn FrameSource + Send>, Failure> {
        let refuse = |option: &str| {
            Err(Failure::Input(format!(
                "{option}: {} has frames already; give a scene (.gltf, .glb, builtin:NAME), or leave the option out",
                self.name
            )))
        };
        if self.is_scene() || self.is_analytic() {
            self.channels.refuse_for(&self.name)?;
        }
        match (source::is_scene(&self.name), self.source, &self.camera) {
            (true, Some(SourceName::Trace), _) if self.shading.is_some() => {
                Err(Failure::Input("--shading: it is for rasterised scenes; leave it or --source trace out".into()))
            }
            (true, Some(SourceName::Trace), _) => self.traced(rendering),
            (true, ..) => self.rasterised(rendering),
            (false, Some(_), _) => refuse("--source"),
            (false, _, Some(_)) => refuse("--camera"),
            (false, None, None) if self.shading.is_some() => refuse("--shading"),
            (false, None, None) if self.animation.is_some() => refuse("--animation"),
            (false, None, None) => self.read(),
        }
    }

    /// Opens an input that needs no renderer.
    pub fn read(&self) -> Result<Box<dyn FrameSource + Send>, Failure> {
        let source = source::open_named(&self.name, &self.limits(), &self.scene_options(), &self.channels.names())?;
        warn(source.warnings());
        Ok(source)
    }

    /// Opens a scene for rasterization: on the methods' device, or, since it needs one, on any if they run on the CPU.
    fn rasterised(&self, rendering: &Rendering) -> Result<Box<dyn FrameSource + Send>, Failure> {
        let device = match &rendering.backend {
            Backend::Gpu(device) => Some(device.clone()),
            Backend::Cpu => Headless::find_roomy(true),
        };
        let device = device.ok_or_else(|| Failure::Input(format!("--source raster: {NO_ADAPTER}")))?;
        Ok(Box::new(self.on(&self.scene(rendering.head.clone())?, device)?))
    }

    /// Uploads a scene to a device that rasterises it.
    pub fn on(&self, scene: &ViewedScene, device: Arc<Headless>) -> Result<RasterSource, Failure> {
        let is_deferred = self.shading == Some(ShadingName::Deferred);
        let source = scene.shaded_on(device, if is_deferred { Shading::Deferred } else { Shading::Forward })?;
        if is_deferred && !source.is_deferred() {
            warn(&["--shading deferred: the scene has materials that are drawn forward, and so is all of it".into()]);
        }
        Ok(source)
    }

    /// Opens a scene for rasterization on any device.
    pub fn scene(&self, head: Option<HeadPath>) -> Result<ViewedScene, Failure> {
        let scene = self.viewed(head, Light::Own)?;
        warn(&without_shadows(&scene.scene).into_iter().collect::<Vec<_>>());
        Ok(scene)
    }

    fn viewed(&self, head: Option<HeadPath>, light: Light) -> Result<ViewedScene, Failure> {
        let (clip, camera) = (self.animation.as_deref(), self.camera.as_deref());
        let (options, limits) = (self.scene_options(), self.limits());
        let choice = SceneChoice { clip, camera, head, light, options, limits, ..SceneChoice::new(&self.name) };
        let scene = ViewedScene::open(&choice)?;
        warn(scene.warnings());
        Ok(scene)
    }

    /// Opens a scene for path tracing.
    fn traced(&self, rendering: &Rendering) -> Result<Box<dyn FrameSource + Send>, Failure> {
        let foveated = rendering.foveated;
        let samples = TracedSamples {
            foveated: foveated.map(|f| f.pattern),
            samples: self.spp,
            full_rate_samples: foveated.map_or(self.spp, |f| f.reference_samples),
        };
        let settings = self.paths.settings(rendering.seed)?;
        let scene = self.viewed(rendering.head.clone(), Light::IfDark)?;
        Ok(Box::new(TracedSource::new(scene, &rendering.backend, settings, samples)?))
    }

    fn limits(&self) -> ReadLimits {
        ReadLimits::from_megapixels(self.max_megapixels)
    }

    fn scene_options(&self) -> SceneOptions {
        SceneOptions { size: self.size, hfov_deg: self.hfov, fps: self.fps }
    }

    /// Frames per second of the input.
    pub fn fps(&self, info: &SourceInfo) -> f32 {
        self.fps.or(info.fps).unwrap_or(60.0)
    }

    /// View geometry of the input.
    pub fn geometry(&self, info: &SourceInfo) -> Result<ViewGeometry, Failure> {
        Ok(ViewGeometry::flat(info.size, self.hfov.or(info.hfov_deg).unwrap_or(70.0))?)
    }
}

/// What to say of lights that cast no shadows when they are rasterized.
fn without_shadows(scene: &Scene) -> Option<String> {
    let lights = scene.pose(0.0).lights;
    let count = lights.iter().filter(|light| light.kind != PunctualKind::Directional).count();
    (count > 0).then(|| {
        format!(
            "{count} point or spot lights cast no shadows when rasterized, only the strongest directional light does; \
             --source trace has all shadows"
        )
    })
}

/// Number of frames of a run; `None` for stills and endless scenes, which last as long as the gaze.
pub fn frames(requested: Option<u64>, info: &SourceInfo) -> Option<u64> {
    requested.or(if info.still { None } else { info.frames })
}
