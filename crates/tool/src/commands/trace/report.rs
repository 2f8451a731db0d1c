//! Report of a trace: on the screen, in `trace.json` and in `cameras.json`.

use super::TraceArgs;
use super::eyes::{Eyes, below};
use super::setup::Setup;
use crate::args::Named;
use crate::args::pattern::SamplingName;
use crate::report::cameras::cameras_json;
use afterimage_lab::clock::Stopwatch;
use afterimage_lab::pipeline::{Processor, ProcessorInfo};
use afterimage_lab::scene::effects::Effects;
use afterimage_lab::view::View;
use glam::DMat4;
use serde::Serialize;

/// Sums over the frames.
pub struct TraceReport {
    /// View of the head in each frame.
    pub heads: Vec<View>,
    eyes: Vec<Counts>,
    seconds: f64,
    cpu_seconds: Option<f64>,
}

/// Counts of samples and rays.
#[derive(Clone, Default)]
pub struct Counts {
    /// Samples of each region.
    pub samples: Vec<u64>,
    /// Samples of the pattern without overlaps for blending and partial blocks at borders, if known.
    pub ideal_samples: Option<f64>,
    pub rays: u64,
    pub nonfinite: u64,
}

#[derive(Serialize)]
struct TraceJson<'a> {
    tool: &'static str,
    version: &'static str,
    scene: &'a str,
    size: [u32; 2],
    frames: u64,
    fps: f32,
    hfov_deg: f32,
    spp: u32,
    sampling: &'static str,
    max_depth: u32,
    integrator: &'static str,
    bsdf: &'static str,
    seed: u64,
    backend: ProcessorInfo,
    triangles: u32,
    load_ms: f64,
    build_ms: f64,
    compile_ms: f64,
    samples: Samples,
    rays: u64,
    seconds: f64,
    cpu_seconds: Option<f64>,
    million_rays_per_second: f64,
    nonfinite_samples: u64,
    effects: Vec<&'static str>,
    stereo: Option<Stereo>,
    warnings: &'a [String],
}

/// Two eyes, each with the pattern around its own gaze.
#[derive(Serialize)]
struct Stereo {
    ipd_m: f64,
    eyes: Vec<Eye>,
}

#[derive(Serialize)]
struct Eye {
    name: &'static str,
    sampling: &'static str,
    /// File of the gaze; null with uniform sampling.
    gaze: Option<String>,
    samples: Samples,
    rays: u64,
}

#[derive(Serialize)]
struct Samples {
    traced: u64,
    uniform: u64,
    regions: Vec<u64>,
    /// Uniform samples divided by traced samples.
    reduction: f64,
    /// The same ratio for the ideal number of samples.
    ideal_reduction: Option<f64>,
    /// Ratio of times; null, since it needs a uniform run to compare with (see `bench trace`).
    achieved_reduction: Option<f64>,
}

impl Counts {
    fn add(&mut self, other: &Self) {
        self.samples.resize(other.samples.len().max(self.samples.len()), 0);
        for (sum, n) in self.samples.iter_mut().zip(&other.samples) {
            *sum += n;
        }
        self.ideal_samples = self.ideal_samples.zip(other.ideal_samples).map(|(a, b)| a + b);
        self.rays += other.rays;
        self.nonfinite += other.nonfinite;
    }

    /// Zero counts.
    fn none() -> Self {
        Self { ideal_samples: Some(0.0), ..Self::default() }
    }

    /// The counts, compared with `uniform` samples.
    fn samples(&self, uniform: u64) -> Samples {
        let traced = self.samples.iter().sum::<u64>();
        Samples {
            traced,
            uniform,
            regions: self.samples.clone(),
            reduction: uniform as f64 / traced.max(1) as f64,
            ideal_reduction: self.ideal_samples.map(|ideal| uniform as f64 / ideal.max(1.0)),
            achieved_reduction: None,
        }
    }
}

impl TraceReport {
    /// An empty report.
    pub fn new(eyes: usize) -> Self {
        Self { heads: vec![], eyes: vec![Counts::none(); eyes], seconds: 0.0, cpu_seconds: Some(0.0) }
    }

    /// Adds the counts and time of a frame of an eye.
    pub fn count(&mut self, eye: usize, counts: &Counts, clock: &Stopwatch) {
        self.eyes[eye].add(counts);
        self.seconds += clock.wall_ms() * 1e-3;
        self.cpu_seconds = self.cpu_seconds.zip(clock.cpu_ms()).map(|(s, ms)| s + ms * 1e-3);
    }

    /// Sum over the eyes.
    fn total(&self) -> Counts {
        self.eyes.iter().fold(Counts::none(), |mut sum, eye| {
            sum.add(eye);
            sum
        })
    }

    /// Prints the effects that are compiled in, why, and those that are left out.
    pub fn print_effects(&self, setup: &Setup) {
        let (compiled, needed) = (setup.tracer.effects(&setup.world), setup.world.needs);
        say!("compiled in:");
        for effect in compiled.iter() {
            let why = if needed.has(effect) { effect.reason() } else { "requested; nothing in the scene needs it" };
            say!("  {:<24} {why}", effect.name());
        }
        if compiled == Effects::NONE {
            say!("  none: Lambertian scattering only");
        }
        let left_out = Effects::all().without(compiled);
        let missing: Vec<_> = left_out.iter().filter(|&e| needed.has(e)).map(|e| e.name()).collect();
        if !missing.is_empty() {
            say!("left out though the scene has it: {}", missing.join(", "));
        }
        let unused: Vec<_> = left_out.iter().filter(|&e| !needed.has(e)).map(|e| e.name()).collect();
        say!("left out, as nothing needs it: {}", unused.join(", "));
    }

    pub fn json(&self, args: &TraceArgs, setup: &Setup, eyes: &Eyes) -> String {
        let total = self.total();
        let of_an_eye = args.frames
            * u64::from(args.size[0])
            * u64::from(args.size[1])
            * u64::from(args.pattern.of.most_samples(args.spp));
        let eye = |(counts, &name): (&Counts, &&'static str)| Eye {
            name,
            sampling: args.pattern.of.sampling.name(),
            gaze: (args.pattern.of.sampling != SamplingName::Uniform).then(|| below(name, "gaze.csv")),
            samples: counts.samples(of_an_eye),
            rays: counts.rays,
        };
        let both = || self.eyes.iter().zip(eyes.names()).map(eye).collect();
        let report = TraceJson {
            tool: "afterimage",
            version: env!("CARGO_PKG_VERSION"),
            scene: &args.scene,
            size: args.size,
            frames: args.frames,
            fps: setup.of.fps,
            hfov_deg: self.hfov_deg(),
            spp: args.spp,
            sampling: args.pattern.of.sampling.name(),
            max_depth: args.paths.max_depth,
            integrator: args.paths.integrator.name(),
            bsdf: args.paths.bsdf.name(),
            seed: args.seed,
            backend: setup.backend.info(),
            triangles: setup.world.geometry.len(),
            load_ms: setup.load_ms,
            build_ms: setup.build_ms,
            compile_ms: setup.tracer.compile_time().as_secs_f64() * 1e3,
            samples: total.samples(of_an_eye * self.eyes.len() as u64),
            rays: total.rays,
            seconds: self.seconds,
            cpu_seconds: self.cpu_seconds,
            million_rays_per_second: total.rays as f64 / self.seconds * 1e-6,
            nonfinite_samples: total.nonfinite,
            effects: setup.tracer.effects(&setup.world).iter().map(|e| e.name()).collect(),
            stereo: eyes.ipd_m.map(|ipd_m| Stereo { ipd_m, eyes: both() }),
            warnings: &setup.of.scene.warnings,
        };
        serde_json::to_string_pretty(&report).expect("the report has no map with keys other than strings") + "\n"
    }

    /// Camera poses as a cameras.json (z up), which `run` reads with the frames and `--camera` accepts. `view_of` maps
    /// the head's view to the camera.
    pub fn cameras_json(&self, args: &TraceArgs, setup: &Setup, view_of: impl Fn(&View) -> View) -> String {
        let to_file = DMat4::from_translation(setup.of.scene.origin);
        let poses = self.heads.iter().map(|head| to_file * view_of(head).world_from_camera());
        cameras_json(args.size, setup.of.fps, self.hfov_deg(), poses)
    }

    pub fn print_summary(&self, args: &TraceArgs, setup: &Setup, eyes: &Eyes) {
        say!(
            "{}: {} triangles, {} frames {}of {}x{} at {} spp in {:.2} s, {:.2} million rays/s, on {}",
            args.scene,
            setup.world.geometry.len(),
            args.frames,
            if eyes.ipd_m.is_some() { "for each of two eyes " } else { "" },
            args.size[0],
            args.size[1],
            args.spp,
            self.seconds,
            self.total().rays as f64 / self.seconds * 1e-6,
            setup.backend.info().name,
        );
        say!("wrote {}", args.out.display());
    }

    fn hfov_deg(&self) -> f32 {
        self.heads.first().map_or(0.0, |view| view.geometry().hfov_deg())
    }
}
