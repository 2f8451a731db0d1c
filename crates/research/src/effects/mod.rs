//! `cargo research effects`: cost of each effect in a scene that does not need it.
//!
//! Makes the tables of `docs/effects.md`. The command is there.
//!
//! Kernels with and without the effect take turns on the same rays, frame by frame. The result is the ratio of the
//! times of two frames that are traced within a second of each other.

mod removals;
mod table;

use crate::options::EffectsArgs;
use afterimage_eval::output::write_json;
use afterimage_lab::clock::{Quartiles, Stopwatch};
use afterimage_lab::device::Backend;
use afterimage_lab::pipeline::Processor;
use afterimage_lab::scene::effects::{Effect, Effects};
use afterimage_program::failure::{Failure, warn};
use afterimage_trace::Tracer;
use afterimage_trace::gpu::GpuTracer;
use afterimage_trace::gpu::scene_buffer::Storage;
use afterimage_trace::measure::TracedView;
use afterimage_trace::settings::TraceSettings;
use removals::REMOVALS;
use std::io::IsTerminal;
use table::{EffectsReport, EffectsSceneReport, Price};

/// Untimed frames.
const WARM_UP: u64 = 2;

/// Number of compilations per set of effects.
const COMPILES: usize = 3;

/// Built-in scenes, of which the first is diffuse only and the last needs most lobes.
const SCENES: [&str; 4] = ["builtin:courtyard", "builtin:cornell", "builtin:mirror-room", "builtin:furnace"];

/// A tracer with its kernels and measured times.
struct Variant {
    what: String,
    effects: Effects,
    tracer: Tracer,
    ms: Vec<f64>,
    compile_ms: Vec<f64>,
}

/// Measures the cost of effects at `size` for `frames` frames.
pub fn bench(args: &EffectsArgs, size: [u32; 2], frames: u64) -> Result<(), Failure> {
    let backends = args.traced.backend.open()?;
    let default = SCENES.map(str::to_owned);
    let names = if args.traced.scene.is_empty() { &default[..] } else { &args.traced.scene };
    // Compiled kernels depend only on the effects, not on the rest of the scene.
    let small = TracedView::open("builtin:cornell", [8, 8], None, None)?;
    let mut scenes = vec![];
    for name in names {
        let subject = TracedView::open(name, size, None, None)?;
        warn(subject.warnings());
        let needs = subject.world.needs;
        let mut prices = vec![];
        let mut removals = vec![];
        for backend in &backends {
            let mut variants = variants(&subject, backend)?;
            take_turns(&subject, backend, &mut variants, frames);
            if let Backend::Gpu(_) = backend {
                compile_in_turn(&small, backend, &mut variants)?;
            }
            prices.push(priced(&variants));
            if std::io::stderr().is_terminal() {
                eprintln!("{name}: {} done", backend.info().kind);
            }
            drop(variants);
            if args.removal && matches!(backend, Backend::Gpu(_)) {
                removals.extend(price_removals(&subject, backend, frames)?);
            }
        }
        scenes.push(EffectsSceneReport {
            scene: name.rsplit('/').next().unwrap_or(name).to_owned(),
            triangles: subject.world.geometry.len(),
            needs: needs.iter().map(Effect::name).collect(),
            prices,
            removals,
        });
    }
    let report = EffectsReport {
        tool: "afterimage",
        version: env!("CARGO_PKG_VERSION"),
        size,
        frames,
        max_depth: TraceSettings::default().max_depth,
        machine: machine(),
        compiled_cold: std::env::var("MESA_SHADER_CACHE_DISABLE").is_ok_and(|v| v == "true" || v == "1"),
        backends: backends.iter().map(Processor::info).collect(),
        scenes,
    };
    let text = table::markdown(&report);
    match &args.out {
        Some(path) => table::write(path, &text)?,
        None => say!("{text}"),
    }
    Ok(write_json(args.traced.json.as_deref(), &report)?)
}

/// The scene's effects, twice; all effects; the scene's effects with each other effect.
fn variants(subject: &TracedView, backend: &Backend) -> Result<Vec<Variant>, Failure> {
    let needs = subject.world.needs;
    let mut sets = vec![("auto".to_owned(), needs), ("again".into(), needs), ("all".into(), Effects::all())];
    sets.extend(Effects::all().without(needs).iter().map(|e| (e.name().to_owned(), needs.set(e, true))));
    let variant = |(what, effects): (String, Effects)| {
        Ok(Variant { what, effects, tracer: subject.tracer(backend, with(effects))?, ms: vec![], compile_ms: vec![] })
    };
    sets.into_iter().map(variant).collect()
}

fn with(effects: Effects) -> TraceSettings {
    TraceSettings { effects: Some(effects), ..TraceSettings::default() }
}

/// Times every variant on every frame. Each frame starts with another variant.
fn take_turns(subject: &TracedView, backend: &Backend, variants: &mut [Variant], frames: u64) {
    let count = variants.len();
    for index in 0..WARM_UP + frames {
        for i in 0..count {
            let variant = &mut variants[(i + index as usize) % count];
            let took = subject.frame(&variant.tracer, index);
            if index >= WARM_UP {
                variant.ms.push(took.device_ms.filter(|_| backend.is_real_gpu()).unwrap_or(took.cpu_ms));
            }
        }
    }
}

/// Measures compile times: CPU time of creating the tracer and tracing a first small frame, minus that of a second one.
/// Drivers compile at the first dispatch.
fn compile_in_turn(small: &TracedView, backend: &Backend, variants: &mut [Variant]) -> Result<(), Failure> {
    for _ in 0..COMPILES {
        for variant in &mut *variants {
            let watch = Stopwatch::start();
            let tracer = small.tracer(backend, with(variant.effects))?;
            small.few(&tracer);
            let ms = watch.cpu_ms().unwrap_or_else(|| watch.wall_ms());
            variant.compile_ms.push(ms - small.few(&tracer).cpu_ms);
        }
    }
    Ok(())
}

/// Compares the kernels of `auto`, with the effect switched off, with kernels whose source lacks the effect.
fn price_removals(subject: &TracedView, backend: &Backend, frames: u64) -> Result<Vec<Price>, Failure> {
    let Backend::Gpu(gpu) = backend else { return Ok(vec![]) };
    let needs = subject.world.needs;
    let variant = |what: &str, edit: &dyn Fn(String) -> String| {
        let storage = Storage::of(gpu.info.device_type);
        let tracer = GpuTracer::with_storage(gpu.clone(), &subject.world, with(needs), storage, edit)
            .map_err(|e| Failure::Input(format!("{}: {e}", subject.name)))?;
        let tracer = Tracer::Gpu(Box::new(tracer));
        Ok::<_, Failure>(Variant { what: what.into(), effects: needs, tracer, ms: vec![], compile_ms: vec![] })
    };
    let unneeded: Vec<_> = REMOVALS.iter().filter(|r| !needs.has(r.effect)).collect();
    let mut variants = vec![variant("off", &|text| text)?, variant("again", &|text| text)?];
    for removal in &unneeded {
        variants.push(variant(removal.effect.name(), &|text| removal.cut(&text))?);
    }
    variants.push(variant("all of them", &|text| unneeded.iter().fold(text, |text, removal| removal.cut(&text)))?);
    take_turns(subject, backend, &mut variants, frames);
    // The ratio is relative to the kernels without the source, not to `auto`.
    let off = variants[0].ms.clone();
    Ok(variants.iter().skip(1).map(|variant| price(variant, &off, &variant.ms)).collect())
}

fn priced(variants: &[Variant]) -> Vec<Price> {
    variants.iter().map(|variant| price(variant, &variant.ms, &variants[0].ms)).collect()
}

/// The cost of a variant, with the ratio of `above` to `below` frame by frame.
fn price(variant: &Variant, above: &[f64], below: &[f64]) -> Price {
    let mut ratios: Vec<f64> = above.iter().zip(below).map(|(a, b)| a / b).collect();
    let ratio = Quartiles::of(&ratios);
    ratios.sort_by(f64::total_cmp);
    // Order statistics: the number of frames below the median is binomial, approximated by a normal distribution with
    // standard deviation sqrt(n) / 2; 99.9 % are within 3.29 standard deviations.
    let n = ratios.len() as f64;
    let rank = (0.5 * n - 3.29 * 0.5 * n.sqrt()).floor().max(0.0) as usize;
    let interval = (!ratios.is_empty()).then(|| [ratios[rank], ratios[ratios.len() - 1 - rank]]);
    let (ms, compile_ms) = (Quartiles::of(&variant.ms), Quartiles::of(&variant.compile_ms));
    Price { what: variant.what.clone(), ms, ratio, interval, compile_ms }
}

/// Name of the processor, if known.
fn machine() -> String {
    let cpuinfo = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = cpuinfo.lines().find_map(|l| l.strip_prefix("model name")?.split_once(": "));
    let model = model.map_or("a processor of unknown name", |(_, name)| name.trim());
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{cores} cores of {model}")
}
