//! `afterimage bench trace`: rays per second of the tracers.

use super::BenchArgs;
use crate::failure::{Failure, warn};
use crate::output::write_json;
use afterimage_lab::clock::Quartiles;
use afterimage_lab::pipeline::{Processor, ProcessorInfo};
use afterimage_trace::measure::{FrameTime, PatternReport, ROUNDS, TracedView, measure, patterns};
use afterimage_trace::settings::TraceSettings;
use serde::Serialize;

/// Untimed frames.
const WARM_UP: u64 = 2;

#[derive(Serialize)]
struct TraceBenchReport {
    tool: &'static str,
    version: &'static str,
    size: [u32; 2],
    frames: u64,
    samples_per_pixel: u32,
    max_depth: u32,
    scenes: Vec<TraceBenchSceneReport>,
}

#[derive(Serialize)]
struct TraceBenchSceneReport {
    scene: String,
    triangles: u32,
    tracers: Vec<TracerReport>,
}

#[derive(Serialize)]
struct TracerReport {
    backend: ProcessorInfo,
    rays_per_frame: u64,
    /// CPU time of the process per frame, including the transfer of work list and film.
    cpu_ms: Option<Quartiles>,
    wall_ms: Option<Quartiles>,
    /// Time of the kernels alone, by timestamp queries; `null` on the CPU and on software devices.
    device_ms: Option<Quartiles>,
    /// Million rays per second of CPU time (one core).
    mrays_per_core_second: Option<f64>,
    /// Million rays per second of device time if it is known, else of wall time.
    mrays_per_second: Option<f64>,
    scene_bytes_per_triangle: Option<f64>,
    /// Results of `--foveated`.
    foveated: Vec<PatternReport>,
}

/// Times the tracers for `size` and `frames`.
pub fn bench(args: &BenchArgs, size: [u32; 2], frames: u64) -> Result<(), Failure> {
    let settings = TraceSettings::default();
    let backends = args.backend.open()?;
    let default = ["builtin:courtyard".to_owned()];
    let names = if args.scene.is_empty() { &default[..] } else { &args.scene };
    let mut scenes = vec![];
    for name in names {
        let subject = TracedView::open(name, size, args.camera.as_deref(), None)?;
        warn(subject.warnings());
        let tracers = backends.iter().map(|b| subject.tracer(b, settings)).collect::<Result<Vec<_>, _>>()?;
        let mut took: Vec<Vec<FrameTime>> = vec![vec![]; tracers.len()];
        for index in 0..WARM_UP + frames {
            for (tracer, took) in tracers.iter().zip(&mut took) {
                let frame = subject.frame(tracer, index);
                if index >= WARM_UP {
                    took.push(frame);
                }
            }
        }
        let triangles = subject.world.geometry.len();
        let reports = backends.iter().zip(&tracers).zip(&took).map(|((backend, tracer), took)| {
            let of = |value: &dyn Fn(&FrameTime) -> f64| Quartiles::of(&took.iter().map(value).collect::<Vec<_>>());
            let device = backend.is_real_gpu() && took.iter().all(|t| t.device_ms.is_some());
            let device_ms = if device { of(&|t| t.device_ms.unwrap_or(f64::NAN)) } else { None };
            let rate = |ms: &dyn Fn(&FrameTime) -> f64| of(&|t| t.rays as f64 / ms(t) * 1e-3).map(|q| q.median);
            Ok::<_, Failure>(TracerReport {
                backend: backend.info(),
                rays_per_frame: took.first().map_or(0, |t| t.rays),
                cpu_ms: of(&|t| t.cpu_ms),
                wall_ms: of(&|t| t.wall_ms),
                device_ms,
                mrays_per_core_second: rate(&|t| t.cpu_ms),
                mrays_per_second: rate(&|t| t.device_ms.filter(|_| device).unwrap_or(t.wall_ms)),
                foveated: if args.foveated {
                    measure(&subject, tracer, &patterns(&subject), ROUNDS, backend.is_real_gpu())
                } else {
                    vec![]
                },
                scene_bytes_per_triangle: tracer.scene_bytes().map(|b| b as f64 / f64::from(triangles.max(1))),
            })
        });
        scenes.push(TraceBenchSceneReport {
            scene: name.clone(),
            triangles,
            tracers: reports.collect::<Result<_, _>>()?,
        });
    }
    let report = TraceBenchReport {
        tool: "afterimage",
        version: env!("CARGO_PKG_VERSION"),
        size,
        frames,
        samples_per_pixel: 1,
        max_depth: settings.max_depth,
        scenes,
    };
    print(&report);
    Ok(write_json(args.json.as_deref(), &report)?)
}

fn print(report: &TraceBenchReport) {
    let [w, h] = report.size;
    say!("{w}x{h}, 1 sample a pixel, depth {}, {} frames; medians and quartiles", report.max_depth, report.frames);
    say!("ms are CPU time of the process, including the transfer of work list and film");
    say!("Mrays/s are per second of wall time, or of device time on a GPU with timestamps");
    for scene in &report.scenes {
        say!("{}, {} triangles", scene.scene, scene.triangles);
        say!("    median      p25      p75 ms  rays/frame  Mrays/core-second  Mrays/s  bytes/triangle  tracer");
        for t in &scene.tracers {
            let (Some(q), Some(core), Some(rate)) = (t.cpu_ms, t.mrays_per_core_second, t.mrays_per_second) else {
                continue;
            };
            say!(
                "{:>10.1} {:>8.1} {:>8.1} {:>14} {:>18.3} {:>8.3} {:>15}  {} ({})",
                q.median,
                q.p25,
                q.p75,
                t.rays_per_frame,
                core,
                rate,
                t.scene_bytes_per_triangle.map_or("-".into(), |b| format!("{b:.0}")),
                t.backend.name,
                t.backend.kind,
            );
        }
        for t in scene.tracers.iter().filter(|t| !t.foveated.is_empty()) {
            let clock = t.foveated.first().map_or("", |p| p.clock);
            say!("  foveated and uniform, {clock} time, {} ({})", t.backend.name, t.backend.kind);
            print_patterns(&t.foveated);
        }
    }
}

/// Prints a table.
fn print_patterns(patterns: &[PatternReport]) {
    say!("    foveated ms  uniform ms  ideal  samples  time  share of ideal  pattern");
    for p in patterns {
        let (Some((uniform, ms)), Some(time)) = (p.times(), p.time_reduction) else { continue };
        let or_dash =
            |v: Option<f64>, factor: f64, unit: &str| v.map_or("-".into(), |v| format!("{:.1}{unit}", v * factor));
        say!(
            "{:>15.0} {:>11.0} {:>6} {:>7.1}x {:>4.1}x {:>15}  {}",
            ms.median,
            uniform.median,
            or_dash(p.ideal_reduction, 1.0, "x"),
            p.sample_reduction,
            time,
            or_dash(p.share_of_ideal, 100.0, " %"),
            p.pattern,
        );
    }
}
