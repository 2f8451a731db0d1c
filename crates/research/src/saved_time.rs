//! `cargo research foveated`: what of the samples that foveated path tracing saves becomes saved time.
//!
//! Makes the table of `docs/performance.md`, "Saved samples as saved time"; the commands are there. Half a minute on
//! the CPU.

use crate::options::TracedArgs;
use afterimage_eval::output::write_json;
use afterimage_lab::pipeline::{Processor, ProcessorInfo};
use afterimage_program::failure::{Failure, warn};
use afterimage_trace::measure::{PatternReport, TracedView, measure, one_path, regions};
use afterimage_trace::settings::TraceSettings;
use serde::Serialize;

#[derive(Serialize)]
struct SavedTimeReport {
    tool: &'static str,
    version: &'static str,
    size: [u32; 2],
    frames: u64,
    max_depth: u32,
    scenes: Vec<SavedTimeSceneReport>,
}

#[derive(Serialize)]
struct SavedTimeSceneReport {
    scene: String,
    triangles: u32,
    tracers: Vec<SavedTimeTracerReport>,
}

#[derive(Serialize)]
struct SavedTimeTracerReport {
    backend: ProcessorInfo,
    patterns: Vec<PatternReport>,
}

/// Times the patterns for `size` in each scene on each device, `frames` times.
pub fn bench(args: &TracedArgs, size: [u32; 2], frames: u64) -> Result<(), Failure> {
    let settings = TraceSettings::default();
    let backends = args.backend.open()?;
    let default = ["builtin:courtyard".to_owned()];
    let names = if args.scene.is_empty() { &default[..] } else { &args.scene };
    let mut scenes = vec![];
    for name in names {
        let subject = TracedView::open(name, size, args.camera.as_deref(), None)?;
        warn(subject.warnings());
        let middle = subject.middle_px();
        let regions = |samples| regions(samples, false, 1.0, middle);
        let patterns = [one_path(middle), regions([8, 4, 2]), regions([32, 16, 8])];
        let mut tracers = vec![];
        for backend in &backends {
            let tracer = subject.tracer(backend, settings)?;
            let patterns = measure(&subject, &tracer, &patterns, frames, backend.is_real_gpu());
            tracers.push(SavedTimeTracerReport { backend: backend.info(), patterns });
        }
        scenes.push(SavedTimeSceneReport { scene: name.clone(), triangles: subject.world.geometry.len(), tracers });
    }
    let report = SavedTimeReport {
        tool: "afterimage",
        version: env!("CARGO_PKG_VERSION"),
        size,
        frames,
        max_depth: settings.max_depth,
        scenes,
    };
    print(&report);
    Ok(write_json(args.json.as_deref(), &report)?)
}

/// Markdown.
fn print(report: &SavedTimeReport) {
    let [w, h] = report.size;
    say!(
        "{w}x{h}, depth {}, {} frames, medians. Uniform frames have the fovea's samples.\n",
        report.max_depth,
        report.frames
    );
    say!(
        "| scene | device | pattern | ms, uniform to foveated | of samples | of time | share of saved | share of reduction |"
    );
    say!("|---|---|---|---|---|---|---|---|");
    for scene in &report.scenes {
        let name = scene.scene.rsplit('/').next().unwrap_or(&scene.scene);
        for tracer in &scene.tracers {
            for p in &tracer.patterns {
                let percent = |share: Option<f64>| share.map_or("-".into(), |s| format!("{:.1} %", s * 100.0));
                say!(
                    "| {name} | {} | {} | {} | {:.1}x | {} | {} | {} |",
                    tracer.backend.kind,
                    p.pattern,
                    p.times().map_or("-".into(), |(u, f)| format!("{:.0} to {:.1} {}", u.median, f.median, p.clock)),
                    p.sample_reduction,
                    p.time_reduction.map_or("-".into(), |t| format!("{t:.1}x")),
                    percent(p.share_of_saved),
                    percent(p.share_of_reduction),
                );
            }
        }
    }
}
