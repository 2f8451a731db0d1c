//! Time of one planned frame: its surfaces and chosen pixels, and smr.

use afterimage::gpu::{Afterimage, Frame, Target};
use afterimage::internal::{ContextDesc, Foveation, Settings, ViewFrame};
use afterimage::kernel::quads::place_in_quad;
use afterimage::wgpu::{CommandEncoder, Texture, TextureFormat, TextureUsages};
use afterimage::{DepthConvention, FrameError, Gaze, Image};
use afterimage_eval::times::Times;
use afterimage_lab::clock::Elapsed;
use afterimage_lab::device::{Backend, Headless, SpanClock};
use afterimage_lab::frame::OnDevice;
use afterimage_lab::raster::RasterSettings;
use afterimage_lab::scene::builtin::courtyard_of;
use afterimage_lab::source::{FrameRequest, FrameSource, RasterSource, SceneCamera, Wanted};
use afterimage_program::failure::Failure;
use afterimage_trace::Tracer;
use afterimage_trace::film::Film;
use afterimage_trace::settings::TraceSettings;
use afterimage_trace::surfaces::Surfaces;
use afterimage_trace::work::Spans;
use afterimage_trace::world::World;
use clap::ValueEnum;
use glam::{DMat4, DVec3};
use serde::Serialize;
use std::sync::Arc;

/// Values of `--renderer`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Renderer {
    /// The rasterizer
    Raster,
    /// The path tracer, on the CPU unless there is a hardware GPU
    Trace,
}

/// Untimed frames: pipelines compile, histories fill.
const WARM_UP: u64 = 2;
/// Distance of the eyes in metres.
const IPD_M: f64 = 0.063;
/// Paths of a chosen pixel of traced frames.
const TRACED_SAMPLES: u32 = 1;
/// Bytes a pixel of what a frame needs, renderer, textures and history together, rounded up.
const BYTES_PER_PIXEL: u64 = 160;

/// A frame to measure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Config {
    pub renderer: Renderer,
    pub size: [u32; 2],
    /// Triangles that the scene is built for.
    pub triangles: u32,
    pub eyes: u32,
}

/// Times of a frame, medians in milliseconds.
#[derive(Clone, Debug, Serialize)]
pub struct Point {
    #[serde(flatten)]
    pub config: Config,
    /// Triangles of the scene.
    pub scene_triangles: usize,
    /// Samples of a frame.
    pub samples: u64,
    pub render_ms: f64,
    pub post_ms: f64,
    pub total_ms: f64,
}

/// Device, and clocks of both parts.
pub struct Rig {
    pub gpu: Arc<Headless>,
    pub tracer: Backend,
    clock: SpanClock,
    trace_clock: SpanClock,
}

impl Rig {
    /// Paths are traced on a hardware GPU if there is one, else on the CPU.
    pub fn new(gpu: Arc<Headless>) -> Self {
        let tracer = if gpu.is_software() { Backend::Cpu } else { Backend::Gpu(gpu.clone()) };
        let (clock, trace_clock) = (SpanClock::new(&Backend::Gpu(gpu.clone())), SpanClock::new(&tracer));
        Self { gpu, tracer, clock, trace_clock }
    }
}

impl Config {
    pub fn pixels(&self) -> u64 {
        self.size.map(u64::from).iter().product()
    }

    /// Reason why the frame cannot be measured on this machine, if there is one.
    pub fn obstacle(&self, gpu: &Headless) -> Option<String> {
        let most = gpu.device.limits().max_texture_dimension_2d;
        if self.size.iter().any(|&side| side > most) {
            return Some(format!("the device draws at most {most} pixels a side"));
        }
        let needed = self.pixels() * u64::from(self.eyes) * BYTES_PER_PIXEL;
        let free = free_bytes().filter(|&free| gpu.is_software() && needed > free)?;
        Some(format!("needs about {} MiB, and {} are free", needed >> 20, free >> 20))
    }
}

/// Memory that is free, if the system tells.
fn free_bytes() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    Some(line.trim().strip_suffix(" kB")?.parse::<u64>().ok()? * 1024)
}

/// One eye's smr.
struct Eye {
    post: Afterimage,
    output: Texture,
}

impl Eye {
    fn new(gpu: &Headless, size: [u32; 2], settings: Settings, depth: DepthConvention) -> Result<Self, Failure> {
        let desc = ContextDesc { settings, depth, ..ContextDesc::new(size) };
        let format = TextureFormat::Rgba16Float;
        let post = Afterimage::new(&gpu.device, &desc, format)?;
        Ok(Self { post, output: gpu.texture(size, 1, format, TextureUsages::STORAGE_BINDING) })
    }

    /// Records a step of smr, and submits it.
    fn step(
        &mut self,
        Rig { gpu, clock, .. }: &Rig,
        record: impl FnOnce(&mut Self, &mut CommandEncoder) -> Result<(), FrameError>,
    ) -> Result<Elapsed, Failure> {
        let (recorded, took) = clock.time(|| {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let recorded = record(self, &mut encoder);
            gpu.queue.submit([encoder.finish()]);
            recorded
        });
        recorded?;
        gpu.check()?;
        Ok(took)
    }

    /// Chooses the pixels of a frame.
    fn plan(&mut self, rig: &Rig, frame: &Frame<'_>) -> Result<Elapsed, Failure> {
        self.step(rig, |eye, encoder| eye.post.plan(&rig.gpu.device, encoder, frame))
    }

    /// Processes a frame.
    fn process(&mut self, rig: &Rig, frame: &Frame<'_>) -> Result<Elapsed, Failure> {
        self.step(rig, |eye, encoder| {
            eye.post.record(&rig.gpu.device, encoder, frame, Target::new(&eye.output)).map(|_| ())
        })
    }

    /// Pixels that were chosen.
    fn chosen(&self, gpu: &Headless) -> Vec<[u32; 2]> {
        let masks = gpu.read::<u32>(self.post.quad_mask().expect("the frame is planned"), 0);
        let [width, height] = self.post.desc().size_px;
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
        let is_chosen = |px: &[u32; 2]| masks.at(px[0] as usize / 2, px[1] as usize / 2) >> place_in_quad(*px) & 1 == 1;
        pixels.filter(is_chosen).collect()
    }
}

/// Times of the renderer and of smr, each of all eyes together.
#[derive(Default)]
struct Sums {
    render: Times,
    post: Times,
    samples: u64,
}

impl Sums {
    fn push(&mut self, index: u64, eyes: &[(Elapsed, Elapsed)]) {
        if index < WARM_UP {
            return;
        }
        let sum = |of: &dyn Fn(&(Elapsed, Elapsed)) -> Elapsed| {
            let add = |a: Elapsed, b: Elapsed| Elapsed {
                wall_ms: a.wall_ms + b.wall_ms,
                cpu_ms: a.cpu_ms.zip(b.cpu_ms).map(|(a, b)| a + b),
                device_ms: a.device_ms.zip(b.device_ms).map(|(a, b)| a + b),
            };
            eyes.iter().map(of).reduce(add)
        };
        sum(&|eye| eye.0).into_iter().for_each(|elapsed| self.render.push(elapsed));
        sum(&|eye| eye.1).into_iter().for_each(|elapsed| self.post.push(elapsed));
    }

    fn point(&self, config: Config, scene_triangles: usize) -> Point {
        let median = |times: &Times| times.median_cost_ms().unwrap_or(f64::NAN);
        let (render_ms, post_ms) = (median(&self.render), median(&self.post));
        let samples = self.samples;
        Point { config, scene_triangles, samples, render_ms, post_ms, total_ms: render_ms + post_ms }
    }
}

/// Measures `frames` frames of a configuration.
pub fn measure(rig: &Rig, config: Config, frames: u64) -> Result<Point, Failure> {
    match config.renderer {
        Renderer::Raster => rasterised(rig, config, frames),
        Renderer::Trace => traced(rig, config, frames),
    }
}

/// Center of a frame.
fn gaze_px(size: [u32; 2]) -> [f32; 2] {
    size.map(|s| 0.5 * (s as f32 - 1.0))
}

/// Shifts of the eyes against the head, in metres.
fn shifts_m(eyes: u32) -> &'static [f64] {
    if eyes == 2 { &[-0.5 * IPD_M, 0.5 * IPD_M] } else { &[0.0] }
}

fn rasterised(rig: &Rig, config: Config, frames: u64) -> Result<Point, Failure> {
    let scene = courtyard_of(config.triangles);
    let triangles = scene.still().len();
    let camera = SceneCamera::choose(&scene, Some("still"), config.size, None)?;
    let (geometry, gaze_px) = (*camera.geometry(), gaze_px(config.size));
    let mut source = RasterSource::new(rig.gpu.clone(), scene, camera, None, RasterSettings::default())?;
    let head = source.camera_pose(0).map_or(DMat4::IDENTITY, |pose| pose.world_from_camera);
    let near = source.near();
    let depth = DepthConvention::Reversed { near, far: f32::INFINITY };
    let settings = Settings { foveation: Foveation::quads(), ..Settings::steady() };
    let shifts_m = shifts_m(config.eyes);
    let mut eyes =
        shifts_m.iter().map(|_| Eye::new(&rig.gpu, config.size, settings, depth)).collect::<Result<Vec<_>, _>>()?;
    let views = [ViewFrame::new(geometry, Gaze::At { px: gaze_px })];
    let mut sums = Sums::default();
    for index in 0..WARM_UP + frames {
        let mut took = vec![];
        sums.samples = 0;
        for (eye, &shift_m) in eyes.iter_mut().zip(shifts_m) {
            let pose = head * DMat4::from_translation(DVec3::X * shift_m);
            source.steer(index, Some([pose, pose]));
            let request = FrameRequest { wanted: Wanted::Surfaces, reference: false, ..FrameRequest::full_rate(index) };
            let (content, surfaces) =
                rig.clock.time(|| submitted(&rig.gpu, |encoder| source.record(encoder, &request)));
            let Some(OnDevice::Surfaces(drawn)) = OnDevice::of(&content.content) else {
                return Err(Failure::Input("surfaces are on the device".into()));
            };
            let (depth, motion) = (Some((&drawn.depth).into()), Some((&drawn.motion).into()));
            let frame = Frame { depth, motion, ..Frame::new(&drawn.color, &views, index) };
            let planned = eye.plan(rig, &frame)?;
            sums.samples += eye.chosen(&rig.gpu).len() as u64;
            let list = eye.post.quad_list(0).expect("the frame is planned");
            let (color, shaded) =
                rig.clock.time(|| submitted(&rig.gpu, |encoder| source.record_quads(encoder, index, [0.0; 2], list)));
            let processed = eye.process(rig, &Frame { color: (&color).into(), ..frame })?;
            took.push((surfaces.and(shaded), planned.and(processed)));
        }
        sums.push(index, &took);
    }
    Ok(sums.point(config, triangles))
}

/// Records and submits work.
fn submitted<T>(gpu: &Headless, record: impl FnOnce(&mut CommandEncoder) -> T) -> T {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let recorded = record(&mut encoder);
    gpu.queue.submit([encoder.finish()]);
    recorded
}

fn traced(rig: &Rig, config: Config, frames: u64) -> Result<Point, Failure> {
    let scene = courtyard_of(config.triangles);
    let triangles = scene.still().len();
    let camera = SceneCamera::choose(&scene, Some("still"), config.size, None)?;
    let (geometry, gaze_px) = (*camera.geometry(), gaze_px(config.size));
    let world = World::new(&scene);
    let tracer =
        Tracer::new(&rig.tracer, &world, TraceSettings::default()).map_err(|e| Failure::Input(e.to_string()))?;
    let head = camera.view(&scene, 0, 0.0);
    let eyes_of = if config.eyes == 2 { head.stereo(IPD_M).to_vec() } else { vec![head] };
    let foveation = Foveation { single_pixels: true, ..Foveation::quads() };
    let settings = Settings { foveation, ..Settings::traced() };
    let mut eyes = vec![];
    for view in &eyes_of {
        let eye = Eye::new(&rig.gpu, config.size, settings, DepthConvention::Linear)?;
        // Nothing moves, so that depth and motion are those of all frames.
        let seen = Surfaces::trace(&world, view, view, tracer.effects(&world));
        eyes.push((view, eye, TracedImages::new(&rig.gpu, &seen)));
    }
    let views = [ViewFrame::new(geometry, Gaze::At { px: gaze_px })];
    let mut sums = Sums::default();
    for index in 0..WARM_UP + frames {
        let mut took = vec![];
        sums.samples = 0;
        for (view, eye, images) in &mut eyes {
            let frame = Frame {
                depth: Some((&images.depth).into()),
                motion: Some((&images.motion).into()),
                noise: Some((&images.noise).into()),
                ..Frame::new(&images.color, &views, index)
            };
            let planned = eye.plan(rig, &frame)?;
            let chosen = eye.chosen(&rig.gpu);
            sums.samples += chosen.len() as u64 * u64::from(TRACED_SAMPLES);
            let mut film = Film::new(config.size);
            let ((), render) = rig.trace_clock.time(|| {
                tracer.trace(&world, view, index, &Spans::new(chosen.iter().copied(), 0..TRACED_SAMPLES), &mut film);
            });
            rig.gpu.write_rgb(&images.color, 0, &film.color());
            rig.gpu.write(&images.noise, 0, &Image::from_fn(config.size, |px| film.noise_at(px)));
            took.push((render, planned.and(eye.process(rig, &frame)?)));
        }
        sums.push(index, &took);
    }
    Ok(sums.point(config, triangles))
}

/// Inputs of a traced frame on the device.
struct TracedImages {
    color: Texture,
    noise: Texture,
    depth: Texture,
    motion: Texture,
}

impl TracedImages {
    fn new(gpu: &Headless, seen: &Surfaces) -> Self {
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        let texture = |format| gpu.texture(seen.depth.size(), 1, format, usage);
        let [color, noise] = [TextureFormat::Rgba32Float, TextureFormat::Rg32Float].map(texture);
        let [depth, motion] = [TextureFormat::R32Float, TextureFormat::Rg32Float].map(texture);
        gpu.write(&depth, 0, &seen.depth);
        gpu.write(&motion, 0, &seen.motion);
        Self { color, noise, depth, motion }
    }
}
