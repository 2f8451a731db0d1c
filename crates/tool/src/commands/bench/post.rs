//! `afterimage bench post`: off-screen cost of the passes, compared with a copy pass that moves as many bytes.

use super::BenchArgs;
use crate::failure::Failure;
use crate::output::write_json;
use afterimage::internal::{
    ContextDesc, Foveation, FoveationKind, GpuSimulator, MethodKind, Reset, Settings, SimulatorFrame, ViewFrame,
};
use afterimage::kernel::rng;
use afterimage::module;
use afterimage::shader::{Composer, Module};
use afterimage::wgpu::{Texture, TextureUsages};
use afterimage::{CreateError, Gaze, Image, ViewGeometry};
use afterimage_lab::clock::{Quartiles, Stopwatch};
use afterimage_lab::device::{Headless, NO_ADAPTER, PassClock};
use afterimage_lab::frame::{RenderedFrame, SourceFrame};
use afterimage_lab::pipeline::{DeviceFormats, DeviceInputs, DeviceRun};
use serde::Serialize;
use std::sync::Arc;

static MODULES: &[Module] = &[module!("bench", "copy_pass")];

/// Shaders of the benches, which may use the drop-in's modules.
static SHADERS: Composer = Composer::new(&[afterimage::shader::MODULES, MODULES]);

/// Untimed frames: pipelines compile, caches fill.
const WARM_UP: u64 = 8;

#[derive(Serialize)]
struct PostBenchReport {
    tool: &'static str,
    version: &'static str,
    adapter: String,
    driver: String,
    backend: String,
    size: [u32; 2],
    frames: u64,
    /// Clock: timestamp queries of the device, or the process's CPU time on a software device.
    clock: &'static str,
    /// Time of the post-process and the copy from their creation until their first frame is done: shader and pipeline
    /// creation, and the driver's compilation at the first dispatch.
    cold_start_ms: f64,
    passes: Vec<PassReport>,
}

#[derive(Serialize)]
struct PassReport {
    name: &'static str,
    ms: Option<Quartiles>,
    ms_per_megapixel: Option<f64>,
    bytes_per_pixel: u32,
    /// Time of a copy that moves as many bytes, divided by the pass's time.
    share_of_copy_bandwidth: Option<f64>,
}

/// A pass that can be timed.
struct PassSpec {
    name: &'static str,
    /// Bytes read and written, as counted in the pass's documentation.
    bytes_per_pixel: u32,
    kind: PassKind,
}

/// Kind of a pass.
#[derive(Clone, Copy)]
enum PassKind {
    Copy,
    Post(Settings),
    /// A method on planned frames, with their plan.
    Planned(Settings),
    Foveate(FoveationKind),
}

impl PassSpec {
    fn new(name: &'static str, settings: Settings) -> Self {
        let bytes_per_pixel = settings.traffic_bytes_per_pixel([true, true, false]);
        Self { name, bytes_per_pixel, kind: PassKind::Post(settings) }
    }

    fn planned(name: &'static str, settings: Settings) -> Self {
        Self { kind: PassKind::Planned(settings), ..Self::new(name, settings) }
    }
}

/// The passes, in the order in which each frame times them. The others are compared with the first.
fn all_passes() -> Vec<PassSpec> {
    let mut passes = vec![PassSpec { name: "copy", bytes_per_pixel: 48, kind: PassKind::Copy }];
    let plain = |kind: MethodKind| Settings { method: kind.into(), ..Settings::default() };
    passes.extend(MethodKind::ALL.map(|kind| PassSpec::new(kind.name(), plain(kind))));
    passes.push(PassSpec::new("wrs-weighted", Settings::weighted()));
    let screen = Settings::screen();
    passes.push(PassSpec::planned("smr-screen", screen));
    let everywhere = Settings { foveation: Foveation::uniform(0.25), ..screen };
    passes.push(PassSpec::planned("smr-everywhere", everywhere));
    passes.extend(FoveationKind::ALL.into_iter().filter_map(|filter| {
        let bytes_per_pixel = simulator_traffic(filter)?;
        Some(PassSpec { name: filter.name(), bytes_per_pixel, kind: PassKind::Foveate(filter) })
    }));
    passes
}

/// Bytes of memory traffic a pixel of a filter's passes, to outputs of halves and without levels of detail. `None`:
/// full-rate frames are copied.
fn simulator_traffic(filter: FoveationKind) -> Option<u32> {
    match filter {
        FoveationKind::Mip => Some(27),
        FoveationKind::Gauss => Some(48),
        FoveationKind::Block => Some(25),
        _ => None,
    }
}

/// A pass, created on the device.
enum CreatedPass {
    Post(Box<DeviceRun>),
    Foveate { simulator: Box<GpuSimulator>, output: Texture },
}

impl CreatedPass {
    fn new(gpu: &Arc<Headless>, size: [u32; 2], kind: PassKind) -> Result<Self, CreateError> {
        let mut desc = ContextDesc { settings: Settings::paper(), keep_alpha: false, ..ContextDesc::new(size) };
        Ok(match kind {
            PassKind::Copy => {
                let source = SHADERS.compose("copy_pass").source;
                Self::Post(Box::new(DeviceRun::with_shader(gpu, &desc, DeviceFormats::ENGINE, &source)?))
            }
            PassKind::Post(settings) | PassKind::Planned(settings) => {
                desc.settings = settings;
                Self::Post(Box::new(DeviceRun::new(gpu, &desc, DeviceFormats::ENGINE)?))
            }
            PassKind::Foveate(filter) => {
                desc.settings.foveation.kind = filter;
                let format = DeviceFormats::ENGINE.color;
                Self::Foveate {
                    simulator: Box::new(GpuSimulator::new(&gpu.device, &desc, format)?),
                    output: gpu.texture(size, 1, format, TextureUsages::STORAGE_BINDING),
                }
            }
        })
    }
}

/// Times the passes at `size` for `frames` frames.
pub fn bench(args: &BenchArgs, size: [u32; 2], frames: u64) -> Result<(), Failure> {
    let all = all_passes();
    let is_known = |name: &&String| all.iter().any(|p| p.name == **name);
    if let Some(name) = args.only.iter().find(|name| !is_known(name)) {
        let names: Vec<_> = all.iter().map(|p| p.name).collect();
        return Err(Failure::Input(format!("--only {name}: expected one or more of {}", names.join(","))));
    }
    let chosen =
        |pass: &&PassSpec| pass.name == "copy" || args.only.is_empty() || args.only.iter().any(|o| o == pass.name);
    let passes: Vec<&PassSpec> = all.iter().filter(chosen).collect();
    let gpu = Headless::find(true).ok_or_else(|| Failure::Input(format!("bench: {NO_ADAPTER}")))?;
    let clock = PassClock::new(&gpu);
    let mut inputs = inputs(&gpu, size)?;
    let first = views(size, 0)?;
    foveate(&gpu, &mut inputs, &first)?;
    let mut created = vec![];
    let mut cold_start_ms = 0.0;
    for spec in &passes {
        let watch = Stopwatch::start();
        let mut pass = CreatedPass::new(&gpu, size, spec.kind)?;
        time(&gpu, &clock, &inputs, &mut pass, &first, 0)?;
        if !matches!(spec.kind, PassKind::Foveate(_)) {
            cold_start_ms += watch.wall_ms();
        }
        created.push(pass);
    }
    let mut times: Vec<Vec<f64>> = vec![vec![]; passes.len()];
    for index in 1..WARM_UP + frames {
        let views = views(size, index)?;
        foveate(&gpu, &mut inputs, &views)?;
        for (pass, times) in created.iter_mut().zip(&mut times) {
            let ms = time(&gpu, &clock, &inputs, pass, &views, index)?;
            if index >= WARM_UP {
                times.push(ms);
            }
        }
    }
    let report = summarise(size, frames, &gpu, &clock, cold_start_ms, &passes, &times);
    print(&report);
    Ok(write_json(args.json.as_deref(), &report)?)
}

fn summarise(
    size: [u32; 2],
    frames: u64,
    gpu: &Headless,
    clock: &PassClock,
    cold_start_ms: f64,
    passes: &[&PassSpec],
    times: &[Vec<f64>],
) -> PostBenchReport {
    let megapixels = f64::from(size[0]) * f64::from(size[1]) / 1e6;
    let median = |i: usize| Quartiles::of(&times[i]).map(|q| q.median);
    let reports = passes.iter().enumerate().map(|(i, pass)| PassReport {
        name: pass.name,
        ms: Quartiles::of(&times[i]),
        ms_per_megapixel: median(i).map(|ms| ms / megapixels),
        bytes_per_pixel: pass.bytes_per_pixel,
        share_of_copy_bandwidth: (|| {
            let copy_ms = median(0)? * f64::from(pass.bytes_per_pixel) / f64::from(passes[0].bytes_per_pixel);
            Some(copy_ms / median(i)?)
        })(),
    });
    PostBenchReport {
        tool: "afterimage",
        version: env!("CARGO_PKG_VERSION"),
        adapter: gpu.info.name.clone(),
        driver: format!("{} {}", gpu.info.driver, gpu.info.driver_info),
        backend: format!("{:?}", gpu.info.backend),
        size,
        frames,
        clock: clock.name(),
        cold_start_ms,
        passes: reports.collect(),
    }
}

fn print(report: &PostBenchReport) {
    say!("{} ({}, {})", report.adapter, report.driver, report.backend);
    say!("{}x{}, {} frames; times are {}", report.size[0], report.size[1], report.frames, report.clock);
    say!("pass                median      p25      p75 ms   ms/Mpx  B/px  share of the copy's bandwidth");
    for pass in &report.passes {
        let (Some(q), Some(per_mpx), Some(share)) = (pass.ms, pass.ms_per_megapixel, pass.share_of_copy_bandwidth)
        else {
            continue;
        };
        say!(
            "{:18} {:>7.3} {:>8.3} {:>8.3} {:>11.3} {:>5} {:>6.0} %",
            pass.name,
            q.median,
            q.p25,
            q.p75,
            per_mpx,
            pass.bytes_per_pixel,
            100.0 * share
        );
    }
    say!("cold start of the post-process: {:.0} ms", report.cold_start_ms);
}

/// Runs one pass on one frame; returns its time in milliseconds.
fn time(
    gpu: &Headless,
    clock: &PassClock,
    inputs: &DeviceInputs,
    pass: &mut CreatedPass,
    views: &[ViewFrame],
    index: u64,
) -> Result<f64, Failure> {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let watch = Stopwatch::start();
    match pass {
        CreatedPass::Post(run) => {
            let frame = inputs.frame(views, index, Reset::None, false);
            clock.begin(&mut encoder);
            if run.post().desc().settings.foveation.kind == FoveationKind::Quads {
                // Its pixels are those of a frame that is there already.
                run.post_mut().plan(&gpu.device, &mut encoder, &frame)?;
            }
            run.record(&mut encoder, &frame, None)?;
            clock.end(&mut encoder);
        }
        CreatedPass::Foveate { simulator, output } => {
            let frame =
                SimulatorFrame { timestamps: clock.timestamps(), ..SimulatorFrame::new(inputs.full(), output, views) };
            simulator.record(&gpu.device, &mut encoder, &frame)?;
            clock.resolve(&mut encoder);
        }
    }
    gpu.queue.submit([encoder.finish()]);
    gpu.wait();
    Ok(clock.read_ms(gpu, &watch))
}

/// A view whose gaze moves on a circle.
fn views(size: [u32; 2], index: u64) -> Result<[ViewFrame; 1], Failure> {
    let turn = index as f32 * 0.1;
    let px = [(0.5 + 0.3 * turn.cos()) * size[0] as f32, (0.5 + 0.3 * turn.sin()) * size[1] as f32];
    Ok([ViewFrame::new(ViewGeometry::flat(size, 70.0)?, Gaze::At { px })])
}

/// White noise in stripes of two depths. Every other stripe has motion vectors of a few pixels that the color does not
/// follow, so that half of the history is valid and half is rejected.
fn inputs(gpu: &Arc<Headless>, size: [u32; 2]) -> Result<DeviceInputs, Failure> {
    let desc = ContextDesc { settings: Settings::paper(), keep_alpha: false, ..ContextDesc::new(size) };
    let mut inputs = DeviceInputs::new(gpu, &desc, DeviceFormats::ENGINE)?;
    let is_odd = |x: u32| x / 64 % 2 == 1;
    let frame = SourceFrame {
        color: Image::from_fn(size, |[x, y]| [0, 1, 2].map(|i| rng::unit_draw(rng::bits(x, y, i, 1)))),
        depth: Some(Image::from_fn(size, |[x, _]| if is_odd(x) { 12.0 } else { 3.0 })),
        motion: Some(Image::from_fn(size, |[x, _]| if is_odd(x) { [0.0; 2] } else { [-3.0, 1.0] })),
        ..SourceFrame::without_images(None, true)
    };
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    inputs.set(&mut encoder, &RenderedFrame::full_rate(0, [0.0; 2], frame));
    gpu.queue.submit([encoder.finish()]);
    Ok(inputs)
}

/// Foveates the frame for these views.
fn foveate(gpu: &Headless, inputs: &mut DeviceInputs, views: &[ViewFrame]) -> Result<(), Failure> {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    inputs.foveate(&mut encoder, views, None)?;
    gpu.queue.submit([encoder.finish()]);
    gpu.wait();
    Ok(())
}
