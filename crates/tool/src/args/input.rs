//! What is looked at: the options that `run`, `sweep` and `view` share, and how it is opened.

use crate::args::backend::{BackendName, NO_ADAPTER};
use crate::args::paths::PathArgs;
use crate::args::{parse_fps, parse_hfov, parse_samples, parse_size};
use crate::failure::Failure;
use afterimage::ViewGeometry;
use afterimage_lab::device::Headless;
use afterimage_lab::source;
use afterimage_lab::source::{
    FrameSource, RasterSource, ReadLimits, SceneOptions, SourceInfo, TracedSamples, TracedSource,
};
use afterimage_lab::trace::sampling::Sampling;
use clap::{Args, ValueEnum};

/// What is looked at.
#[derive(Args, Clone, Debug)]
pub struct InputArgs {
    /// A still (.png, .jpg, .exr), a folder of .exr frames, a scene (.gltf, .glb, builtin:NAME), or analytic:NAME with NAME one
    /// of still, lateral, turn, occluder, light-step, scroll
    #[arg(value_name = "INPUT")]
    pub name: String,
    /// Frames per second, of view at most so many; default: the input's, else 60
    #[arg(long, value_parser = parse_fps, value_name = "F")]
    pub fps: Option<f32>,
    /// Horizontal field of view of the flat view, degrees; default: the input's, else 70
    #[arg(long, value_parser = parse_hfov, value_name = "DEG")]
    pub hfov: Option<f32>,
    /// Size of scenes, pixels; default 640x360
    #[arg(long, value_parser = parse_size, value_name = "WxH")]
    pub size: Option<[u32; 2]>,
    /// What renders a scene; default: raster
    #[arg(long, value_enum, value_name = "NAME")]
    pub source: Option<SourceName>,
    /// Samples a pixel of --source trace: of full-rate frames, or of the fovea with --sampling
    #[arg(long, default_value_t = 32, value_parser = parse_samples, value_name = "N")]
    pub spp: u32,
    #[command(flatten)]
    pub paths: PathArgs,
    /// Where a scene is seen from: one of its cameras, a .json file (a cameras.json, or a path of keyframes), or lateral, orbit,
    /// framing; default: the scene's first camera, gliding sideways if nothing moves
    #[arg(long, value_name = "NAME|FILE.json")]
    pub camera: Option<String>,
    /// Largest image that is read, million pixels
    #[arg(long, default_value_t = 64, value_name = "N")]
    pub max_megapixels: u32,
}

/// Names of what renders scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SourceName {
    /// Render passes on a device, a software one if there is no other
    Raster,
    /// Path tracing with --spp samples a pixel
    Trace,
}

/// What of `--source trace` is no property of the input.
pub struct Tracing {
    pub backend: BackendName,
    pub seed: u64,
    /// How foveated frames are sampled, and with how many samples a pixel the full-rate ones; `None`: there are full-rate ones alone.
    pub foveated: Option<(Sampling, u32)>,
}

impl InputArgs {
    /// Opens files as they are, scenes with a renderer.
    pub fn open(&self, tracing: &Tracing) -> Result<Box<dyn FrameSource + Send>, Failure> {
        let refuse = |option: &str| {
            Err(Failure::Input(format!(
                "{option}: {} brings its own frames; expected a scene (.gltf, .glb, builtin:NAME), or leave it out",
                self.name
            )))
        };
        match (source::is_scene(&self.name), self.source, &self.camera) {
            (true, Some(SourceName::Trace), _) => self.traced(tracing),
            (true, ..) => self.rasterised(),
            (false, Some(_), _) => refuse("--source"),
            (false, _, Some(_)) => refuse("--camera"),
            (false, None, None) => self.read(),
        }
    }

    /// Opens what brings its own frames.
    pub fn read(&self) -> Result<Box<dyn FrameSource + Send>, Failure> {
        Ok(source::open(&self.name, &self.limits(), &self.scene_options())?)
    }

    /// By render passes. They need a device even where the methods run on the CPU.
    fn rasterised(&self) -> Result<Box<dyn FrameSource + Send>, Failure> {
        let device =
            Headless::find_roomy(true).ok_or_else(|| Failure::Input(format!("--source raster: {NO_ADAPTER}")))?;
        let (limits, options) = (self.limits(), self.scene_options());
        let source = RasterSource::open(&self.name, &limits, &options, self.camera.as_deref(), device)?;
        warn(source.warnings());
        Ok(Box::new(source))
    }

    /// By path tracing.
    fn traced(&self, tracing: &Tracing) -> Result<Box<dyn FrameSource + Send>, Failure> {
        let (foveated, full_rate_samples) = tracing.foveated.map_or((None, self.spp), |(s, n)| (Some(s), n));
        let samples = TracedSamples { foveated, samples: self.spp, full_rate_samples };
        let backend = tracing.backend.open_for_scenes()?;
        let settings = self.paths.settings(tracing.seed)?;
        let (limits, options, camera) = (self.limits(), self.scene_options(), self.camera.as_deref());
        let source = TracedSource::open(&self.name, &limits, &options, camera, &backend, settings, samples)?;
        warn(source.warnings());
        Ok(Box::new(source))
    }

    fn limits(&self) -> ReadLimits {
        ReadLimits::from_megapixels(self.max_megapixels)
    }

    fn scene_options(&self) -> SceneOptions {
        SceneOptions { size: self.size, hfov_deg: self.hfov, fps: self.fps }
    }

    /// Frames per second, of an input with these facts.
    pub fn fps(&self, info: &SourceInfo) -> f32 {
        self.fps.or(info.fps).unwrap_or(60.0)
    }

    /// Pixels and angles of an input with these facts.
    pub fn geometry(&self, info: &SourceInfo) -> Result<ViewGeometry, Failure> {
        Ok(ViewGeometry::flat(info.size, self.hfov.or(info.hfov_deg).unwrap_or(70.0))?)
    }
}

/// Frames of a run; `None`: stills and endless scenes last as long as the eye looks.
pub fn frames(asked: Option<u64>, info: &SourceInfo) -> Option<u64> {
    asked.or(if info.still { None } else { info.frames })
}

fn warn(warnings: &[String]) {
    for warning in warnings {
        eprintln!("afterimage: warning: {warning}");
    }
}
