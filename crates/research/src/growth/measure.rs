//! Time of one foveated frame: its samples rendered alone, and smr.

use afterimage::gpu::{Afterimage, Frame, Target};
use afterimage::wgpu::{Texture, TextureFormat, TextureUsages};
use afterimage::{
    ContextDesc, DepthConvention, Filter, Foveation, Gaze, Lattice, Lattices, Settings, ViewFrame, ViewGeometry,
};
use afterimage_eval::times::Times;
use afterimage_lab::clock::Elapsed;
use afterimage_lab::device::{Backend, Headless, SpanClock};
use afterimage_lab::raster::{AtlasLayout, RasterSettings};
use afterimage_lab::scene::builtin::courtyard_of;
use afterimage_lab::source::{FrameSource, RasterSource, SceneCamera};
use afterimage_lab::trace::Tracer;
use afterimage_lab::trace::sampling::SparsePlan;
use afterimage_lab::trace::settings::TraceSettings;
use afterimage_lab::trace::surfaces::Surfaces;
use afterimage_lab::trace::world::World;
use afterimage_program::failure::Failure;
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
/// Samples a point of traced frames, from the finest lattice on.
const TRACED_SAMPLES: u32 = 1;
/// Diameter of the fovea in degrees; each lattice of twice the step reaches as much further.
const FOVEA_DEG: f32 = 5.0;
/// Bytes a pixel of what a frame needs, renderer, textures and history together, rounded up.
const BYTES_PER_PIXEL: u64 = 160;

/// A frame to measure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Config {
    pub renderer: Renderer,
    pub size: [u32; 2],
    /// Triangles that the scene is built for.
    pub triangles: u32,
    pub lattices: u32,
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

    /// Lattices of frame `index`, finest first: full rate, then the coarsest steps below that of the periphery.
    fn lattices(&self, geometry: &ViewGeometry, gaze_px: [f32; 2], index: u64) -> Result<Lattices, Failure> {
        let coarsest = Lattices::MAX as u32 - 1;
        let steps = [0].into_iter().chain(coarsest + 2 - self.lattices..=coarsest);
        let of_step = |log2: u32| -> Option<Lattice> {
            let far = Foveation { fovea_deg: FOVEA_DEG, mid_deg: FOVEA_DEG, rate_far: 1 << coarsest, ..foveation() };
            let region = if log2 == 0 || log2 == coarsest {
                Foveation { rate_mid: 1 << coarsest, ..far }
            } else {
                Foveation { mid_deg: FOVEA_DEG * (1 + log2) as f32, rate_mid: 1 << log2, ..far }
            };
            let stack = region.lattices(geometry, gaze_px, index);
            stack.as_slice().iter().find(|lattice| lattice.step == 1 << log2).copied()
        };
        let stack: Vec<Lattice> = steps.filter_map(of_step).collect();
        Ok(Lattices::new(&stack)?.with_geometry_at_samples())
    }
}

fn foveation() -> Foveation {
    Foveation { filter: Filter::Sparse, rate_mid: 4, rate_far: 8, ..Foveation::default() }
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

    fn process(&mut self, rig: &Rig, frame: &Frame<'_>) -> Result<Elapsed, Failure> {
        let Rig { gpu, clock, .. } = rig;
        let (recorded, took) = clock.time(|| {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let recorded = self.post.record(&gpu.device, &mut encoder, frame, Target::new(&self.output)).map(|_| ());
            gpu.queue.submit([encoder.finish()]);
            recorded
        });
        recorded?;
        gpu.check()?;
        Ok(took)
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
    let settings = Settings { foveation: foveation(), ..Settings::steady() };
    let shifts_m = shifts_m(config.eyes);
    let mut eyes =
        shifts_m.iter().map(|_| Eye::new(&rig.gpu, config.size, settings, depth)).collect::<Result<Vec<_>, _>>()?;
    let mut sums = Sums::default();
    for index in 0..WARM_UP + frames {
        let lattices = config.lattices(&geometry, gaze_px, index)?;
        sums.samples = eyes.len() as u64 * samples(&lattices);
        let mut took = vec![];
        for (eye, &shift_m) in eyes.iter_mut().zip(shifts_m) {
            let pose = head * DMat4::from_translation(DVec3::X * shift_m);
            source.steer(index, Some([pose, pose]));
            let (source, lattices) = (&mut source, &lattices);
            let ((targets, placed), render) =
                rig.clock.time(move || source.draw_foveated(index, lattices, AtlasLayout::Compact));
            let lattices = Some(placed.with_geometry_at_samples());
            let views = [ViewFrame { lattices, ..ViewFrame::new(geometry, Gaze::At { px: gaze_px }) }];
            let atlas = &targets.atlas;
            let (depth, motion) = (Some((&atlas.depth).into()), Some((&atlas.motion).into()));
            let frame = Frame { depth, motion, ..Frame::new(&atlas.color, &views, index) };
            took.push((render, eye.process(rig, &frame)?));
        }
        sums.push(index, &took);
    }
    Ok(sums.point(config, triangles))
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
    let views = if config.eyes == 2 { head.stereo(IPD_M).to_vec() } else { vec![head] };
    let settings = Settings { foveation: foveation(), ..Settings::traced() };
    let mut eyes = vec![];
    for view in &views {
        let eye = Eye::new(&rig.gpu, config.size, settings, DepthConvention::Linear)?;
        // Nothing moves, so that depth and motion are those of all frames.
        let seen = Surfaces::trace(&world, view, view, tracer.effects(&world));
        eyes.push((view, eye, TracedImages::new(&rig.gpu, &seen)));
    }
    let mut sums = Sums::default();
    for index in 0..WARM_UP + frames {
        let lattices = config.lattices(&geometry, gaze_px, index)?;
        let mut took = vec![];
        sums.samples = 0;
        for (view, eye, images) in &mut eyes {
            let (frame, render) = rig.trace_clock.time(|| {
                let samples = vec![TRACED_SAMPLES; lattices.as_slice().len()];
                SparsePlan::new(lattices, samples, config.size).trace(&tracer, &world, view, index)
            });
            sums.samples += frame.samples.iter().sum::<u64>();
            rig.gpu.write_rgb(&images.color, 0, &frame.color);
            rig.gpu.write(&images.noise, 0, frame.noise.as_ref().expect("traced frames are noisy"));
            let lattices = Some(lattices);
            let views = [ViewFrame { lattices, ..ViewFrame::new(geometry, Gaze::At { px: gaze_px }) }];
            let frame = Frame {
                depth: Some((&images.depth).into()),
                motion: Some((&images.motion).into()),
                noise: Some((&images.noise).into()),
                ..Frame::new(&images.color, &views, index)
            };
            took.push((render, eye.process(rig, &frame)?));
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

fn samples(lattices: &Lattices) -> u64 {
    lattices.as_slice().iter().map(|l| l.points.map(u64::from).iter().product::<u64>()).sum()
}
