//! Setup of a trace: scene, light, camera, tracer.

use super::TraceArgs;
use crate::args::head::head_path;
use crate::failure::{Failure, warn};
use afterimage_lab::clock::Stopwatch;
use afterimage_lab::device::Backend;
use afterimage_lab::scene::Environment;
use afterimage_lab::source::{FrameSource, Light, ReadLimits, SceneChoice, SceneOptions, StillSource, ViewedScene};
use afterimage_lab::view::View;
use afterimage_trace::Tracer;
use afterimage_trace::settings::TraceSettings;
use afterimage_trace::world::World;
use std::path::Path;

/// A scene ready to be traced.
pub struct Setup {
    pub of: ViewedScene,
    pub world: World,
    pub tracer: Tracer,
    pub settings: TraceSettings,
    pub backend: Backend,
    /// Time to read the scene.
    pub load_ms: f64,
    /// Time to build its bounding volume hierarchy.
    pub build_ms: f64,
    moves: bool,
}

/// Largest side of an image in pixels: coordinates have 16 bits.
const MAX_SIDE: u32 = 65_536;

impl Setup {
    pub fn new(args: &TraceArgs) -> Result<Self, Failure> {
        check(args)?;
        let settings = args.paths.settings(args.seed)?;
        let light = light(args)?;
        let clock = Stopwatch::start();
        let of = ViewedScene::open(&SceneChoice {
            clip: args.animation.as_deref(),
            camera: Some(args.camera.as_deref().unwrap_or("still")),
            head: head_path(args.camera.as_deref(), &args.pattern.gaze, &args.scene, args.fps, Some(args.frames))?,
            light,
            options: SceneOptions { size: Some(args.size), hfov_deg: args.hfov, fps: args.fps },
            ..SceneChoice::new(&args.scene)
        })?;
        let load_ms = clock.wall_ms();
        warn(of.warnings());
        if args.frames > 1 && args.camera.is_none() && of.info().still {
            let n = args.frames;
            say!("warning: nothing moves in these {n} frames; --camera lateral moves the camera, as run does");
        }
        let backend = args.backend.open_for_scenes()?;
        let clock = Stopwatch::start();
        let world = World::new(&of.scene);
        let build_ms = clock.wall_ms();
        let tracer = Tracer::new(&backend, &world, settings)
            .map_err(|e| Failure::Input(format!("{}: {e}; use --backend cpu", args.scene)))?;
        let moves = of.scene.duration_s() > 0.0;
        Ok(Self { world, tracer, settings, backend, load_ms, build_ms, moves, of })
    }

    /// Updates the animated scene to `time_s`; returns the view of the head.
    pub fn pose(&mut self, frame: u64, time_s: f64) -> Result<View, Failure> {
        if self.moves {
            let before = (time_s - 1.0 / f64::from(self.of.fps)).max(0.0);
            self.world.pose(&self.of.scene, time_s, before);
            self.tracer.update(&self.world).map_err(|e| Failure::Work(e.to_string()))?;
        }
        Ok(self.of.camera.view(&self.of.scene, frame, time_s))
    }
}

fn check(args: &TraceArgs) -> Result<(), Failure> {
    let refuse = |text: String| Err(Failure::Input(text));
    let [w, h] = args.size;
    if w > MAX_SIDE || h > MAX_SIDE || u64::from(w) * u64::from(h) > ReadLimits::default().max_pixels {
        return refuse(format!("--size {w}x{h}: too large; expected at most 64 million pixels, {MAX_SIDE} a side"));
    }
    if args.aov.contains(&super::AovName::Variance)
        && args.pattern.of.sampling != crate::args::pattern::SamplingName::Uniform
    {
        return refuse("--aov variance: interpolated pixels have none; use --sampling uniform".into());
    }
    Ok(())
}

/// Light by `--sky`; by default, a sky for a scene without light.
fn light(args: &TraceArgs) -> Result<Light, Failure> {
    let expected = "expected none, a radiance R,G,B of numbers from 0, or an .exr file";
    Ok(match args.sky.as_deref() {
        None if args.scene.starts_with("builtin:") => Light::Own,
        None => Light::IfDark,
        Some("none") => Light::Environment(Environment::Constant([0.0; 3])),
        Some(file) if file.to_lowercase().ends_with(".exr") => {
            let mut source = StillSource::open(Path::new(file), &ReadLimits::default())?;
            Light::Environment(Environment::Map(source.frame(0)?.color.map(|c| c.map(|v| v.max(0.0)))))
        }
        Some(text) => {
            let values: Vec<f32> = text.split(',').filter_map(|v| v.trim().parse().ok()).collect();
            let is_valid =
                values.len() == 3 && text.split(',').count() == 3 && values.iter().all(|v| (0.0..1e9).contains(v));
            if !is_valid {
                return Err(Failure::Input(format!("--sky {text}: {expected}")));
            }
            Light::Environment(Environment::Constant([values[0], values[1], values[2]]))
        }
    })
}
