//! Path tracer on a GPU: a wavefront tracer (Laine, Karras and Aila, "Megakernels Considered Harmful", HPG 2013). All
//! paths advance together, one kernel at a time: `generate`, then for each bounce `extend`, `shade` and `shadow`. Only
//! the device knows how many paths are still alive.

mod compute;
mod expand;
mod passes;
mod paths;
pub mod ray_lists;
pub mod scene_buffer;

use super::film::{Film, Moments};
use super::scene_buffer::{SceneBuffer, SceneBufferBuilder, SceneBufferError, Section};
use super::settings::{Bsdf, Integrator, TraceSettings};
use super::work::Spans;
use super::world::World;
use afterimage::{FrameError, Image};
use afterimage_lab::device::{DeviceClock, Headless};
use afterimage_lab::scene::effects::{Effect, Effects};
use afterimage_lab::view::View;
pub use expand::BATCH;
use expand::{Expand, batches};
use glam::Vec3;
use passes::Passes;
use paths::{FrameUniforms, Paths, Run};
use scene_buffer::{GpuSceneBuffer, Storage, traversal_constants};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Tracer of one scene on one device. The same seed on the same device gives the same image: appending to path lists is
/// unordered, but no result depends on the order.
#[derive(Debug)]
pub struct GpuTracer {
    device: Arc<Headless>,
    settings: TraceSettings,
    effects: Effects,
    scene_buffer: SceneBuffer,
    on_device: GpuSceneBuffer,
    passes: Passes,
    expand: Expand,
    paths: Paths,
    /// Time spent compiling kernels. It does not contain compilation that the driver defers to the first use.
    pub compile_time: Duration,
}

impl GpuTracer {
    /// Reports a lost device. Call it after tracing: on a lost device the film receives black samples.
    ///
    /// # Errors
    /// [`FrameError::DeviceLost`].
    pub fn check(&self) -> Result<(), FrameError> {
        self.device.check()
    }

    /// Uploads `world` and compiles kernels for it.
    ///
    /// # Errors
    /// If the scene exceeds the device's limits.
    pub fn new(device: Arc<Headless>, world: &World, settings: TraceSettings) -> Result<Self, SceneBufferError> {
        let storage = Storage::of(device.info.device_type);
        Self::with_storage(device, world, settings, storage, |text| text)
    }

    /// As [`new`](Self::new), with an explicit choice of `storage` for the scene buffer, and with `edit` applied to
    /// each kernel's WGSL source, to measure the cost of code.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_storage(
        device: Arc<Headless>,
        world: &World,
        settings: TraceSettings,
        storage: Storage,
        edit: impl Fn(String) -> String,
    ) -> Result<Self, SceneBufferError> {
        let effects = settings.effects.unwrap_or(world.needs);
        let scene_buffer = scene_buffer(world, effects, storage.limits(&device.device.limits()))?;
        let on_device = GpuSceneBuffer::new(&device.device, &device.queue, &scene_buffer, storage);
        let started = Instant::now();
        let constants = constants(world, &scene_buffer, &settings, effects, storage);
        let passes = Passes::new(&device.device, &on_device, storage, &constants, edit);
        let expand = Expand::new(&device.device);
        let compile_time = started.elapsed();
        let paths = Paths::new(&device.device, &passes, BATCH);
        Ok(Self { device, settings, effects, scene_buffer, on_device, passes, expand, paths, compile_time })
    }

    /// Effects that are compiled in.
    pub fn effects(&self) -> Effects {
        self.effects
    }

    /// Size of the scene buffer in bytes.
    pub fn scene_bytes(&self) -> u64 {
        self.scene_buffer.bytes()
    }

    /// Uploads moved geometry and lights. Call it after [`World::pose`].
    ///
    /// # Errors
    /// If they exceed the capacity reserved at creation.
    pub fn update(&mut self, world: &World) -> Result<(), SceneBufferError> {
        self.scene_buffer.rewrite_moving(&world.geometry)?;
        self.scene_buffer.rewrite(Section::Picks, &world.picks)?;
        self.scene_buffer.rewrite(Section::Punctual, &world.punctual)?;
        self.on_device.write_moving(&self.device.queue, &self.scene_buffer);
        Ok(())
    }

    /// Adds the samples of `work` to `film`, which must contain all its pixels, as
    /// [`CpuTracer::trace`](super::cpu::CpuTracer::trace) does.
    pub fn trace(&self, world: &World, view: &View, frame: u64, work: &Spans, film: &mut Film) {
        self.trace_batches(world, view, frame, work, film, None);
    }

    /// As [`trace`](Self::trace), and returns the kernels' time by device timestamps, without transfers. `None` if the
    /// device has no timestamps, or for more than 2048 batches.
    pub fn trace_timed(
        &self,
        world: &World,
        view: &View,
        frame: u64,
        work: &Spans,
        film: &mut Film,
    ) -> Option<Duration> {
        let clock = DeviceClock::new(&self.device, batches(work).len() as u32);
        self.trace_batches(world, view, frame, work, film, clock.as_ref());
        let clock = clock?;
        let mut encoder = self.device.device.create_command_encoder(&Default::default());
        clock.resolve(&mut encoder, 0..batches(work).len() as u32);
        self.device.queue.submit([encoder.finish()]);
        let ms: f64 = clock.wait_ms(&self.device).iter().sum();
        Some(Duration::from_secs_f64(ms * 1e-3))
    }

    fn trace_batches(
        &self,
        world: &World,
        view: &View,
        frame: u64,
        work: &Spans,
        film: &mut Film,
        clock: Option<&DeviceClock>,
    ) {
        if work.is_empty() {
            return;
        }
        let size = film.moments.size();
        let before: Vec<[f32; 4]> = film.moments.pixels().iter().flat_map(rows_of).collect();
        let run = self.submit_batches(world, view, frame, work, (size[0], film.base(), &before), clock);
        let (rows, counters) = run.read(&self.device);
        let moments = rows.as_chunks::<2>().0.iter().map(moments_of).collect();
        film.moments = Image::from_pixels(size, moments).expect("as many pixels as before");
        film.rays += counters.rays;
        film.nonfinite += counters.nonfinite;
    }

    /// Device that traces.
    pub fn device(&self) -> &Arc<Headless> {
        &self.device
    }

    /// Traces `work` into a film on the device. The film is given by its width in pixels, its base, and its earlier
    /// contents.
    fn submit_batches(
        &self,
        world: &World,
        view: &View,
        frame: u64,
        work: &Spans,
        (width, film_base, before): (u32, u32, &[[f32; 4]]),
        clock: Option<&DeviceClock>,
    ) -> Run<'_> {
        let rays = view.rays();
        let mut uniforms = FrameUniforms {
            origin: rays.origin.to_array(),
            key: super::cpu::path_key(self.settings.seed, frame),
            corner: rays.corner.to_array(),
            lights: world.picks.len() as u32,
            right: rays.right.to_array(),
            sky_probability: world.sky_probability,
            down: rays.down.to_array(),
            width,
            sky: world.sky.to_array(),
            items: 0,
            map_size: world.map_size,
            capacity: BATCH,
            jitter: rays.jitter,
            film_base,
            unused: [0; 3],
        };
        let device = &self.device.device;
        let expansion = self.expand.expansion(device, work);
        let run = self.paths.run(device, &self.passes, &self.on_device, &expansion.items, before);
        for (batch, index) in batches(work).into_iter().zip(0..) {
            uniforms.items = batch.items;
            let mut encoder = device.create_command_encoder(&Default::default());
            self.expand.record(device, &mut encoder, &expansion, &batch);
            let timestamps = clock.map(|c| c.writes(index));
            run.record(device, &mut encoder, &self.passes, &uniforms, self.settings.max_depth, timestamps);
            self.device.queue.submit([encoder.finish()]);
            // Without waiting, a software device holds the memory of all batches at once.
            self.device.wait();
        }
        run
    }
}

fn rows_of(m: &Moments) -> [[f32; 4]; 2] {
    [m.mean.extend(m.count as f32).to_array(), m.squares.extend(0.0).to_array()]
}

fn moments_of(rows: &[[f32; 4]; 2]) -> Moments {
    let [[x, y, z, count], [a, b, c, _]] = *rows;
    Moments { mean: Vec3::new(x, y, z), squares: Vec3::new(a, b, c), count: count as u32 }
}

/// Builds the scene buffer.
fn scene_buffer(
    world: &World,
    effects: Effects,
    limits: super::scene_buffer::SceneBufferLimits,
) -> Result<SceneBuffer, SceneBufferError> {
    let tables: Vec<[u32; 4]> = world.tables.words().collect();
    // Reserves room for one triangle even if no triangle moves. A zeroed node has no children.
    let max_moving = if effects.has(Effect::MovingObjects) { world.max_moving.max(1) } else { 0 };
    let mut builder = SceneBufferBuilder::default();
    builder
        .geometry(&world.geometry, max_moving)
        .fill(Section::Materials, &world.materials)
        .fill(Section::Textures, &world.textures)
        .fill(Section::Texels, &world.texels)
        .fill(Section::Map, &world.map)
        .fill(Section::Albedos, &tables)
        .reserve(Section::Picks, &world.picks, world.max_lights)
        .fill(Section::Punctual, &world.punctual);
    builder.finish(limits)
}

/// Values of all override constants.
fn constants(
    world: &World,
    scene_buffer: &SceneBuffer,
    settings: &TraceSettings,
    effects: Effects,
    storage: Storage,
) -> Vec<(&'static str, f64)> {
    let mut constants = traversal_constants(scene_buffer, &world.geometry, effects.has(Effect::Alpha), storage);
    for (name, section) in [
        ("MATERIALS", Section::Materials),
        ("TEXTURES", Section::Textures),
        ("TEXELS", Section::Texels),
        ("MAP", Section::Map),
        ("ALBEDOS", Section::Albedos),
        ("PICKS", Section::Picks),
        ("PUNCTUAL", Section::Punctual),
        ("ATTRIBUTES", Section::Attributes),
        ("MOVING_ATTRIBUTES", Section::MovingAttributes),
        ("SECOND_UVS", Section::SecondUvs),
        ("MOVING_SECOND_UVS", Section::MovingSecondUvs),
    ] {
        constants.push((name, f64::from(scene_buffer.base(section))));
    }
    for (name, effect) in [
        ("EFFECT_ANISOTROPY", Effect::Anisotropy),
        ("EFFECT_CLEARCOAT", Effect::Clearcoat),
        ("EFFECT_SHEEN", Effect::Sheen),
        ("EFFECT_DIELECTRIC", Effect::Dielectric),
        ("EFFECT_TRANSMISSION", Effect::Transmission),
        ("EFFECT_BASE_COLOR", Effect::BaseColor),
        ("EFFECT_SURFACE_TEXTURE", Effect::SurfaceTexture),
        ("EFFECT_NORMAL_MAP", Effect::NormalMap),
        ("EFFECT_EMISSIVE_TEXTURE", Effect::EmissiveTexture),
        ("EFFECT_TEXTURE_COORDINATES", Effect::TextureCoordinates),
        ("EFFECT_EMISSIVE_TRIANGLES", Effect::EmissiveTriangles),
        ("EFFECT_PUNCTUAL_LIGHTS", Effect::PunctualLights),
        ("EFFECT_ENVIRONMENT", Effect::Environment),
        ("EFFECT_ENVIRONMENT_MAP", Effect::EnvironmentMap),
    ] {
        constants.push((name, f64::from(u8::from(effects.has(effect)))));
    }
    constants.extend(effects.lobe_constants());
    let integrator = match settings.integrator {
        Integrator::Mis => 0.0,
        Integrator::Nee => 1.0,
        Integrator::Naive => 2.0,
    };
    constants.push(("INTEGRATOR", integrator));
    constants.push(("PHONG", f64::from(u8::from(settings.bsdf == Bsdf::Phong))));
    constants.push(("MAX_DEPTH", f64::from(settings.max_depth)));
    constants
}
