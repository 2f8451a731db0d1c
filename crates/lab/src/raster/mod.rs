//! Scenes by render passes: what an engine would hand to the post-process.
//!
//! A frame is three passes. **Sun**: a shadow map of 2048² from the one light that is infinitely far, if there is one; scenes
//! without any light get a sun and a sky. **Surfaces**: depth and motion of what is behind each pixel's centre, one sample a pixel.
//! **Color**: four samples a pixel, which are averaged; surfaces are shaded once a pixel, by the tracer's own scattering
//! functions and tables.
//!
//! | target | format | what |
//! |---|---|---|
//! | color | `Rgba16Float` | linear, scene-referred; alpha 1 |
//! | depth | `Depth32Float` | reversed, infinite far: [`near`](Raster::near) / distance along the view axis, 0 where there is nothing |
//! | motion | `Rg32Float` | pixels, y down, previous minus current; 1e6 for what was behind the previous camera |
//!
//! Those are [`DepthConvention::Reversed`](afterimage::DepthConvention) and the default
//! [`MotionConvention`](afterimage::MotionConvention). Motion is of both the camera and the vertices (rigid, skinned,
//! morphing); that of the sky is the camera's rotation.
//!
//! - **Alpha.** MASK: with holes by the cutoff; in the color an edge covers samples as far as opacity says. BLEND and what light
//!   passes through: after the sky, from back to front by material and within it by triangle, without writing the color pass'
//!   depth. Depth and motion are theirs where they are more than half opaque, as [`Surfaces`](crate::trace::surfaces::Surfaces) has it;
//!   surfaces that light passes through count as there.
//! - **Light.** Punctual lights and the sun as the tracer has them, up to 64, only the sun with shadows. Emissive triangles as
//!   one disk a material and direction, at most 32, without shadows, where they are at time 0. The sky without occlusion: its
//!   irradiance on six faces, its mirror image by roughness. Light from other surfaces is that of an integrating sphere with
//!   the walls of the scene's box and as open as the scene is, in scenes without a sky.
//! - **Refraction** is not there: through glass one sees straight on, dimmed by the base color's luminance.

mod bounce;
mod corners;
mod frame;
mod lighting;
mod materials;
mod mipmaps;
mod pipelines;
mod record;
mod targets;

pub use lighting::{DEFAULT_SKY, DEFAULT_SUN, DEFAULT_SUN_DIRECTION};
pub use pipelines::{COLOR_FORMAT, DEPTH_FORMAT, MOTION_FORMAT};
pub use targets::Targets;

use crate::error::{Bound, Exceeded, InputError};
use crate::kernel::albedo::AlbedoTables;
use crate::scene::{Environment, Pose, PunctualLight, Scene};
use crate::trace::effects::Effects;
use afterimage::kernel::pack::half_bits;
use bytemuck::Zeroable;
use corners::{Blended, Corner, Grouped, STRIDE};
use lighting::Lighting;
use materials::upload_levels;
use pipelines::{Layouts, Pipelines};
use std::sync::LazyLock;
use wgpu::{BindGroup, Buffer, BufferUsages, Device, Queue, TextureFormat, TextureView};

/// What a rasteriser is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RasterSettings {
    /// Most texels that are averaged along the longer side of a pixel's footprint, 1 to 16; more is sharper at grazing angles and
    /// costs reads. Devices without it take 1. Default 16.
    pub anisotropy: u16,
    /// Side of the sun's shadow map in texels, 1 to 8192. Default 2048.
    pub shadow_side: u32,
}

impl Default for RasterSettings {
    fn default() -> Self {
        Self { anisotropy: 16, shadow_side: 2048 }
    }
}

/// A scene on a device, and the targets that it is drawn to. Same device, same frames, same bytes.
#[derive(Debug)]
pub struct Raster {
    layouts: Layouts,
    pipelines: Pipelines,
    materials: Vec<BindGroup>,
    /// Between surfaces; without the shadow map's texture this could not be bound while that is drawn.
    scenery: BindGroup,
    shadow: TextureView,
    lighting: Lighting,
    last_level: f32,
    shadow_side: u32,
    still: Set,
    moving: Set,
    /// Where what moves was a frame ago.
    previous: Buffer,
    /// What moves, to be uploaded with the next frame, now and a frame ago.
    pending: Option<[Vec<Corner>; 2]>,
    lights: Vec<PunctualLight>,
    has_sun: bool,
    /// Whether the shadow map is of an earlier pose.
    is_shadow_old: bool,
    near: f32,
    targets: Targets,
}

/// Triangles in one buffer.
#[derive(Debug)]
struct Set {
    grouped: Grouped,
    buffer: Buffer,
    blended: Vec<Blended>,
}

/// The albedos' tables; the same for all scenes.
static TABLES: LazyLock<AlbedoTables> = LazyLock::new(AlbedoTables::compute);

/// Cells of the tables in a row of their texture.
const TABLE_ROW: u32 = 256;

impl Raster {
    /// Uploads `scene` at time 0 for frames of `size` pixels.
    ///
    /// # Errors
    /// If the frame or the scene's triangles are more than the device takes.
    pub fn new(
        device: &Device,
        queue: &Queue,
        scene: &Scene,
        size: [u32; 2],
        settings: RasterSettings,
    ) -> Result<Self, InputError> {
        let limits = device.limits();
        let pose = scene.pose(0.0);
        check(scene, &pose, size, &limits)?;
        let effects = Effects::needed(scene);
        let lighting = Lighting::new(scene);
        let has_sun = lighting.sun(&pose.lights).is_some();
        let layouts = Layouts::new(device);
        let pipelines = Pipelines::new(device, &layouts, effects, has_sun);
        let materials = materials::bind_groups(device, queue, &layouts, scene, settings.anisotropy.clamp(1, 16));
        let shadow_side = if has_sun { settings.shadow_side.clamp(1, 8192) } else { 1 };
        let shadow = targets::attachment(device, [shadow_side; 2], DEPTH_FORMAT, 1).create_view(&Default::default());
        let (sky, last_level) = sky(device, queue, &lighting.environment);
        let scenery = scenery(device, queue, &layouts, &shadow, &sky);
        let grouped = Grouped::new(scene.still(), &scene.materials);
        let corners = grouped.corners(scene.still());
        let buffer = vertex_buffer(device, corners.len());
        queue.write_buffer(&buffer, 0, bytemuck::cast_slice(&corners));
        let still = Set { blended: grouped.blended(&corners), grouped, buffer };
        let grouped = Grouped::new(&pose.moving, &scene.materials);
        let count = 3 * pose.moving.len();
        let moving = Set { grouped, buffer: vertex_buffer(device, count), blended: vec![] };
        // Far below what is looked at, and not so small that 1/near leaves the floats.
        let near = (lighting.radius * 1e-4).clamp(1e-6, 1e-2);
        let mut raster = Self {
            layouts,
            pipelines,
            materials,
            scenery,
            shadow,
            last_level,
            shadow_side,
            still,
            moving,
            previous: vertex_buffer(device, count),
            pending: None,
            lights: vec![],
            has_sun,
            is_shadow_old: true,
            near,
            lighting,
            targets: Targets::new(device, size),
        };
        raster.place(pose.clone(), pose);
        Ok(raster)
    }

    /// Moves what moves to its place at `time_s`; `previous_s` is when motion is told from.
    pub fn pose(&mut self, scene: &Scene, time_s: f64, previous_s: f64) {
        if scene.duration_s() > 0.0 {
            self.place(scene.pose(time_s), scene.pose(previous_s));
        }
    }

    fn place(&mut self, pose: Pose, previous: Pose) {
        if !pose.moving.is_empty() {
            let now = self.moving.grouped.corners(&pose.moving);
            self.moving.blended = self.moving.grouped.blended(&now);
            self.pending = Some([now, self.moving.grouped.corners(&previous.moving)]);
        }
        self.lights = pose.lights;
        self.is_shadow_old = true;
    }

    /// Distance of the near plane, metres: a ten-thousandth of the scene's radius, at most a centimetre.
    pub fn near(&self) -> f32 {
        self.near
    }

    /// Where frames are drawn to.
    pub fn targets(&self) -> &Targets {
        &self.targets
    }
}

fn check(scene: &Scene, pose: &Pose, size: [u32; 2], limits: &wgpu::Limits) -> Result<(), InputError> {
    let side = limits.max_texture_dimension_2d;
    if size.iter().any(|s| !(1..=side).contains(s)) {
        return Err(InputError::request(
            &scene.name,
            format!("the size is {}x{}", size[0], size[1]),
            format!("expected 1 to {side} pixels a side, which is what this device draws"),
        ));
    }
    let count = scene.still().len().max(pose.moving.len()) as u64;
    let most = (limits.max_buffer_size / (3 * STRIDE)).min(u64::from(u32::MAX / 3));
    if count > most {
        return Err(InputError::limit(
            Exceeded { bound: Bound::Device, needed: Some(count), allowed: most },
            &scene.name,
            format!("has {count} triangles"),
            format!("expected at most {most}, which is what this device holds"),
        ));
    }
    Ok(())
}

/// A buffer for corners, at least one.
fn vertex_buffer(device: &Device, corners: usize) -> Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("corners"),
        size: STRIDE * corners.max(1) as u64,
        usage: BufferUsages::VERTEX | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

/// The sky with its blurred copies, and the number of the last of these.
fn sky(device: &Device, queue: &Queue, environment: &Environment) -> (TextureView, f32) {
    let levels = match environment {
        Environment::Constant(radiance) => vec![afterimage::Image::filled([1, 1], *radiance)],
        Environment::Map(map) => mipmaps::sky_levels(map, device.limits().max_texture_dimension_2d),
    };
    let halves: Vec<_> =
        levels.iter().map(|l| l.map(|[r, g, b]| [r, g, b, 1.0].map(|v: f32| half_bits(v.max(0.0)) as u16))).collect();
    (upload_levels(device, queue, "sky", &halves, TextureFormat::Rgba16Float), (levels.len() - 1) as f32)
}

fn scenery(device: &Device, queue: &Queue, layouts: &Layouts, shadow: &TextureView, sky: &TextureView) -> BindGroup {
    let mut words: Vec<[u32; 4]> = TABLES.words().collect();
    words.resize(words.len().next_multiple_of(TABLE_ROW as usize), Zeroable::zeroed());
    let size = [TABLE_ROW, words.len() as u32 / TABLE_ROW];
    let table = afterimage::Image::from_pixels(size, words).expect("whole rows");
    let tables = upload_levels(device, queue, "albedos", &[table], TextureFormat::Rgba32Uint);
    let around = device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("sky"),
        address_mode_u: wgpu::AddressMode::Repeat,
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..Default::default()
    });
    let compare = device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("shadow"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        compare: Some(wgpu::CompareFunction::GreaterEqual),
        ..Default::default()
    });
    let resources = [
        wgpu::BindingResource::TextureView(shadow),
        wgpu::BindingResource::Sampler(&compare),
        wgpu::BindingResource::TextureView(sky),
        wgpu::BindingResource::Sampler(&around),
        wgpu::BindingResource::TextureView(&tables),
    ];
    let entries: Vec<_> =
        resources.into_iter().zip(0..).map(|(resource, binding)| wgpu::BindGroupEntry { binding, resource }).collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("scenery"),
        layout: &layouts.scenery,
        entries: &entries,
    })
}
