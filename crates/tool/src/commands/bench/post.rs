//! `afterimage bench post`: off-screen cost of the passes, compared with a copy pass that moves as many bytes.

use super::{BenchArgs, write_json};
use crate::args::backend::NO_ADAPTER;
use crate::failure::Failure;
use afterimage::gpu::{Afterimage, Frame, GpuDesc};
use afterimage::kernel::pack::half_bits;
use afterimage::kernel::rng;
use afterimage::simulator::{GpuSimulator, SimulatorFrame};
use afterimage::{CreateError, Filter, FrameError, Gaze, Method, Settings, ViewFrame, ViewGeometry};
use afterimage_lab::clock::{Quartiles, Stopwatch};
use afterimage_lab::device::{Headless, PassClock};
use serde::Serialize;
use wgpu::{Texture, TextureFormat, TextureUsages};

/// Untimed frames: pipelines compile, caches fill.
const WARM_UP: u64 = 8;

#[derive(Serialize)]
struct Report {
    tool: &'static str,
    version: &'static str,
    adapter: String,
    driver: String,
    backend: String,
    size: [u32; 2],
    frames: u64,
    /// Clock: timestamp queries of the device, or the process's CPU time on a software device.
    clock: &'static str,
    /// Time of the post-process and the copy from their creation until their first frame is done: shader and pipeline creation, and
    /// the driver's compilation at the first dispatch.
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

/// Textures of a frame in the formats that engines use.
struct Inputs {
    full: Texture,
    /// The full-rate frame after the foveation simulator, at the frame's gaze.
    color: Texture,
    foveation: GpuSimulator,
    depth: Texture,
    motion: Texture,
    output: Texture,
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
    Post(Method),
    Foveate(Filter),
}

/// The passes, in the order in which each frame times them. The others are compared with the first.
const PASSES: [PassSpec; 8] = [
    PassSpec { name: "copy", bytes_per_pixel: 48, kind: PassKind::Copy },
    PassSpec { name: "none", bytes_per_pixel: 16, kind: PassKind::Post(Method::None) },
    PassSpec { name: "wrs", bytes_per_pixel: 48, kind: PassKind::Post(Method::Wrs) },
    PassSpec { name: "taa", bytes_per_pixel: 40, kind: PassKind::Post(Method::Taa) },
    PassSpec { name: "smr", bytes_per_pixel: 48, kind: PassKind::Post(Method::Smr) },
    PassSpec { name: "mip", bytes_per_pixel: 27, kind: PassKind::Foveate(Filter::Mip) },
    PassSpec { name: "gauss", bytes_per_pixel: 48, kind: PassKind::Foveate(Filter::Gauss) },
    PassSpec { name: "block", bytes_per_pixel: 25, kind: PassKind::Foveate(Filter::Block) },
];

/// A pass, created on the device.
enum CreatedPass {
    Copy(Afterimage),
    Post(Afterimage),
    Foveate(GpuSimulator),
}

impl CreatedPass {
    fn new(gpu: &Headless, size: [u32; 2], kind: PassKind) -> Result<Self, CreateError> {
        let mut desc = GpuDesc::new(size, TextureFormat::Rgba16Float);
        desc.settings = Settings::paper();
        Ok(match kind {
            PassKind::Copy => Self::Copy(Afterimage::new(&gpu.device, &desc)?),
            PassKind::Post(method) => {
                desc.settings.method = method;
                Self::Post(Afterimage::new(&gpu.device, &desc)?)
            }
            PassKind::Foveate(filter) => {
                desc.settings.foveation.filter = filter;
                Self::Foveate(GpuSimulator::new(&gpu.device, &desc)?)
            }
        })
    }
}

/// Times the passes at `size` for `frames` frames.
pub fn bench(args: &BenchArgs, size: [u32; 2], frames: u64) -> Result<(), Failure> {
    let is_known = |name: &&String| PASSES.iter().any(|p| p.name == **name);
    if let Some(name) = args.only.iter().find(|name| !is_known(name)) {
        let names: Vec<_> = PASSES.iter().map(|p| p.name).collect();
        return Err(Failure::Input(format!("--only {name}: expected one or more of {}", names.join(","))));
    }
    let chosen =
        |pass: &&PassSpec| pass.name == "copy" || args.only.is_empty() || args.only.iter().any(|o| o == pass.name);
    let passes: Vec<&PassSpec> = PASSES.iter().filter(chosen).collect();
    let gpu = Headless::find(true).ok_or_else(|| Failure::Input(format!("bench: {NO_ADAPTER}")))?;
    let clock = PassClock::new(&gpu);
    let mut inputs = Inputs::new(&gpu, size)?;
    let first = views(size, 0)?;
    inputs.foveate(&gpu, &first)?;
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
        inputs.foveate(&gpu, &views)?;
        for (pass, times) in created.iter_mut().zip(&mut times) {
            let ms = time(&gpu, &clock, &inputs, pass, &views, index)?;
            if index >= WARM_UP {
                times.push(ms);
            }
        }
    }
    let report = summarise(size, frames, &gpu, &clock, cold_start_ms, &passes, &times);
    print(&report);
    write_json(args, &report)
}

fn summarise(
    size: [u32; 2],
    frames: u64,
    gpu: &Headless,
    clock: &PassClock,
    cold_start_ms: f64,
    passes: &[&PassSpec],
    times: &[Vec<f64>],
) -> Report {
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
    Report {
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

fn print(report: &Report) {
    say!("{} ({}, {})", report.adapter, report.driver, report.backend);
    say!("{}x{}, {} frames; times are {}", report.size[0], report.size[1], report.frames, report.clock);
    say!("pass      median      p25      p75 ms   ms/Mpx  B/px  share of the copy's bandwidth");
    for pass in &report.passes {
        let (Some(q), Some(per_mpx), Some(share)) = (pass.ms, pass.ms_per_megapixel, pass.share_of_copy_bandwidth)
        else {
            continue;
        };
        say!(
            "{:6} {:>9.3} {:>8.3} {:>8.3} {:>11.3} {:>5} {:>6.0} %",
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
    inputs: &Inputs,
    pass: &mut CreatedPass,
    views: &[ViewFrame],
    index: u64,
) -> Result<f64, Failure> {
    let color = if matches!(pass, CreatedPass::Foveate(_)) { &inputs.full } else { &inputs.color };
    let frame = Frame {
        depth: Some(&inputs.depth),
        motion: Some(&inputs.motion),
        timestamps: clock.timestamps(),
        ..Frame::new(color, &inputs.output, views, index)
    };
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let watch = Stopwatch::start();
    record(gpu, &mut encoder, pass, &frame)?;
    clock.resolve(&mut encoder);
    gpu.queue.submit([encoder.finish()]);
    gpu.wait();
    Ok(clock.read_ms(gpu, &watch))
}

fn record(
    gpu: &Headless,
    encoder: &mut wgpu::CommandEncoder,
    pass: &mut CreatedPass,
    frame: &Frame<'_>,
) -> Result<(), FrameError> {
    match pass {
        CreatedPass::Copy(post) => post.record_copy(&gpu.device, encoder, frame).map(|_| ()),
        CreatedPass::Post(post) => post.record(&gpu.device, encoder, frame).map(|_| ()),
        CreatedPass::Foveate(foveation) => {
            let foveated = SimulatorFrame {
                timestamps: frame.timestamps,
                ..SimulatorFrame::new(frame.color, frame.output, frame.views)
            };
            foveation.record(&gpu.device, encoder, &foveated)
        }
    }
}

/// A view whose gaze moves on a circle.
fn views(size: [u32; 2], index: u64) -> Result<[ViewFrame; 1], Failure> {
    let turn = index as f32 * 0.1;
    let px = [(0.5 + 0.3 * turn.cos()) * size[0] as f32, (0.5 + 0.3 * turn.sin()) * size[1] as f32];
    let geometry = ViewGeometry::flat(size, 70.0)?;
    Ok([ViewFrame { geometry, gaze: Gaze::At { px }, previous_from_current: None }])
}

impl Inputs {
    /// White noise in stripes of two depths. Every other stripe has motion vectors of a few pixels that the color does not follow, so
    /// that half of the history is valid and half is rejected.
    fn new(gpu: &Headless, size: [u32; 2]) -> Result<Self, Failure> {
        let texture = |format, usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("bench"),
                size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let upload = |texture: &Texture, bytes: &[u8]| {
            let layout = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(bytes.len() as u32 / size[1]),
                rows_per_image: None,
            };
            gpu.queue.write_texture(texture.as_image_copy(), bytes, layout, texture.size());
        };
        let pixels = || (0..size[1]).flat_map(move |y| (0..size[0]).map(move |x| [x, y]));
        let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        let half = |v: f32| half_bits(v) as u16;
        let mut desc = GpuDesc::new(size, TextureFormat::Rgba16Float);
        desc.settings = Settings::paper();
        let inputs = Self {
            full: texture(TextureFormat::Rgba16Float, read),
            color: texture(TextureFormat::Rgba16Float, TextureUsages::TEXTURE_BINDING | TextureUsages::STORAGE_BINDING),
            foveation: GpuSimulator::new(&gpu.device, &desc)?,
            depth: texture(TextureFormat::R32Float, read),
            motion: texture(TextureFormat::Rg16Float, read),
            output: texture(TextureFormat::Rgba16Float, TextureUsages::STORAGE_BINDING),
        };
        let color: Vec<[u16; 4]> =
            pixels().map(|[x, y]| [0, 1, 2, 3].map(|i| half(rng::unit_draw(rng::bits(x, y, i, 1))))).collect();
        upload(&inputs.full, bytemuck::cast_slice(&color));
        let depth: Vec<f32> = pixels().map(|[x, _]| if x / 64 % 2 == 0 { 3.0 } else { 12.0 }).collect();
        upload(&inputs.depth, bytemuck::cast_slice(&depth));
        let motion: Vec<[u16; 2]> =
            pixels().map(|[x, _]| if x / 64 % 2 == 0 { [half(-3.0), half(1.0)] } else { [0, 0] }).collect();
        upload(&inputs.motion, bytemuck::cast_slice(&motion));
        Ok(inputs)
    }

    /// Foveates the frame for these views.
    fn foveate(&mut self, gpu: &Headless, views: &[ViewFrame]) -> Result<(), Failure> {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        self.foveation.record(&gpu.device, &mut encoder, &SimulatorFrame::new(&self.full, &self.color, views))?;
        gpu.queue.submit([encoder.finish()]);
        gpu.wait();
        Ok(())
    }
}
