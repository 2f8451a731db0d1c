//! Rasterizes scenes into the color, depth and motion buffers that an engine hands to the post-process.
//!
//! A frame has three passes. **Sun**: a shadow map of the strongest directional light, if there is one; scenes without
//! any light get a sun and a sky. **Surfaces**: depth and motion at each pixel's centre, one sample per pixel.
//! **Color**: four samples per pixel, resolved by averaging; surfaces are shaded once per pixel with the tracer's
//! scattering functions and tables.
//!
//! | target | format | contents |
//! |---|---|---|
//! | color | `Rgba16Float` | linear, scene-referred; alpha 1 |
//! | depth | `Depth32Float` | reversed, infinite far: [`near`](Raster::near) / distance along the view axis, 0 without a surface |
//! | motion | `Rg32Float` | pixels, y down, previous minus current; 1e6 for points behind the previous camera |
//!
//! These match [`DepthConvention::Reversed`](afterimage::DepthConvention) and the default
//! [`MotionConvention`](afterimage::MotionConvention). Motion contains the motion of the camera and of the vertices
//! (rigid, skinned, morphing). The sky moves by the camera's rotation.
//!
//! A frame is drawn in one of three ways: at full rate; as a planned frame, depth and motion of every pixel first
//! ([`record_surfaces`](Raster::record_surfaces)), then the color of chosen quads
//! ([`record_quads`](Raster::record_quads)) or of one pixel of each quad ([`record_half`](Raster::record_half)); or as
//! quad views ([`record_quad_views`](Raster::record_quad_views)), regions at lower resolutions that a [`Composer`]
//! enlarges. With [`Shading::Deferred`] frames with one sample a pixel draw their triangles once, into a G-buffer, and
//! a compute pass lights the pixels that are shaded. Triangles outside a view are left out in groups, at full rate as
//! well.
//!
//! - **Alpha.** MASK: alpha test against the cutoff; in the color pass, alpha to coverage smooths the edge. BLEND and
//!   transmissive surfaces: drawn after the sky, back to front by material and by triangle within a material, without
//!   writing the color pass' depth. Depth and motion include them where they are more than half opaque, as in
//!   `Surfaces` of `afterimage-trace`; transmissive surfaces count as opaque.
//! - **Light.** Punctual lights and the sun as in the tracer, up to 64; only the sun casts shadows. Emissive triangles
//!   become one disk per material and direction, at most 32, without shadows, in their pose at time 0. The sky is not
//!   occluded: irradiance from six faces, reflections from a mip level by roughness. In scenes without a sky, indirect
//!   light is computed as in an integrating sphere that has the area of the scene's bounding box and the scene's
//!   openness.
//! - **Refraction** is not simulated: glass shows what is straight behind it, dimmed by the base color's luminance.

mod bounce;
mod chosen_quads;
mod compose;
mod deferred;
mod deferred_pipelines;
mod frame;
mod lighting;
mod lights;
mod materials;
mod mipmaps;
mod pipelines;
mod pixels;
mod record;
mod targets;
mod vertices;
mod window;

pub use compose::Composer;
pub use lighting::{DEFAULT_SKY, DEFAULT_SUN, DEFAULT_SUN_DIRECTION};
pub use pipelines::{COLOR_FORMAT, DEPTH_FORMAT, MOTION_FORMAT};
pub use targets::{FoveatedTargets, Targets};
pub(crate) use targets::{read_color, read_distance};
pub use window::AtlasLayout;

use crate::device::{bind_group, empty_buffer};
use crate::error::{Bound, Exceeded, InputError};
use crate::kernel::albedo::AlbedoTables;
use crate::scene::effects::Effects;
use crate::scene::{Environment, Pose, PunctualLight, Scene};
use afterimage::kernel::pack::half_bits;
use bytemuck::Zeroable;
use chosen_quads::ChunkTest;
use deferred_pipelines::{Deferred, DeferredPipelines};
use lighting::Lighting;
use materials::upload_levels;
use pipelines::{ColorPipelines, Layouts, Pipelines};
use std::cell::OnceCell;
use std::sync::LazyLock;
use vertices::{AlphaKind, Blended, Chunks, GroupedTriangles, STRIDE, Vertex};
use wgpu::{BindGroup, Buffer, BufferUsages, Device, Queue, TextureFormat, TextureView};

/// Settings of the rasterizer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RasterSettings {
    /// Maximum anisotropy of texture filtering, 1 to 16. More is sharper at grazing angles and costs texture reads.
    /// Devices without anisotropic filtering use 1. Default 16.
    pub anisotropy: u16,
    /// Side of the sun's shadow map in texels, 1 to 8192. Default 2048.
    pub shadow_side: u32,
    /// Where surfaces are lit. Default [`Shading::Forward`].
    pub shading: Shading,
}

/// Where surfaces are lit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// As they are drawn: a planned frame draws its triangles twice, for depth and motion and for color, and once more
    /// for albedo.
    #[default]
    Forward,
    /// Frames with one sample a pixel draw all that lighting needs into a G-buffer, once, and a compute pass lights the
    /// pixels that are shaded. Scenes with anisotropic highlights or textures of specular strength or color, clear coat
    /// or sheen are drawn forward; in all scenes, blended surfaces are.
    Deferred,
}

impl Default for RasterSettings {
    fn default() -> Self {
        Self { anisotropy: 16, shadow_side: 2048, shading: Shading::Forward }
    }
}

/// A scene on a device, with the targets it is drawn to. The same frames on the same device give the same bytes.
#[derive(Debug)]
pub struct Raster {
    layouts: Layouts,
    pipelines: Pipelines,
    /// Pipelines with one sample per pixel; none before the first planned frame.
    point_pipelines: OnceCell<ColorPipelines>,
    /// Pipelines of albedo; none before the first frame that asks for it.
    albedo_pipelines: OnceCell<ColorPipelines>,
    /// `None` if frames are drawn forward.
    deferred: Option<Deferred>,
    /// `None` before the first frame that draws to chosen quads.
    chunk_test: OnceCell<ChunkTest>,
    effects: Effects,
    materials: Vec<BindGroup>,
    /// Bind group of the color pass. It includes the shadow map, so it is not bound while the shadow map is drawn.
    lighting_maps: BindGroup,
    shadow: TextureView,
    lighting: Lighting,
    last_level: f32,
    shadow_side: u32,
    still: VertexSet,
    moving: VertexSet,
    /// Vertices of the moving triangles in the previous frame.
    previous: Buffer,
    /// Moving vertices of this and the previous frame, to be uploaded with the next frame.
    pending: Option<[Vec<Vertex>; 2]>,
    lights: Vec<PunctualLight>,
    has_sun: bool,
    /// Whether some surfaces are blended.
    has_blended: bool,
    /// Whether the shadow map shows an earlier pose.
    is_shadow_stale: bool,
    near: f32,
    targets: Targets,
}

/// Triangles that share a vertex buffer.
#[derive(Debug)]
struct VertexSet {
    grouped: GroupedTriangles,
    buffer: Buffer,
    chunks: Chunks,
    blended: Vec<Blended>,
}

/// Tables of the lobes' directional albedos, for all scenes.
static TABLES: LazyLock<AlbedoTables> = LazyLock::new(AlbedoTables::compute);

/// Width in cells of the texture that holds the tables.
const TABLE_ROW: u32 = 256;

impl Raster {
    /// Uploads `scene` at time 0 for frames of `size` pixels.
    ///
    /// # Errors
    /// If the frame or the scene's triangles exceed the device's limits.
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
        let deferred = deferred(device, queue, scene, settings.shading).map(|materials| Deferred {
            pipelines: DeferredPipelines::new(device, &layouts, effects, has_sun),
            materials,
        });
        let (sky, last_level) = sky(device, queue, &lighting.environment);
        let lighting_maps = lighting_maps(device, queue, &layouts, &shadow, &sky);
        let grouped = GroupedTriangles::new(scene.still(), &scene.materials);
        let vertices = grouped.vertices(scene.still());
        let buffer = vertex_buffer(device, vertices.len());
        queue.write_buffer(&buffer, 0, bytemuck::cast_slice(&vertices));
        let chunks = Chunks::new(&grouped.parts, &vertices);
        let still = VertexSet { blended: grouped.blended(&vertices), grouped, buffer, chunks };
        let grouped = GroupedTriangles::new(&pose.moving, &scene.materials);
        let count = 3 * pose.moving.len();
        let moving =
            VertexSet { grouped, buffer: vertex_buffer(device, count), chunks: Chunks::default(), blended: vec![] };
        let parts = still.grouped.parts.iter().chain(&moving.grouped.parts);
        let has_blended = parts.into_iter().any(|part| part.kind == AlphaKind::Blend);
        // The near plane is much nearer than anything of interest, but not so near that 1/near overflows.
        let near = (lighting.radius * 1e-4).clamp(1e-6, 1e-2);
        let mut raster = Self {
            layouts,
            pipelines,
            point_pipelines: OnceCell::new(),
            albedo_pipelines: OnceCell::new(),
            deferred,
            chunk_test: OnceCell::new(),
            effects,
            materials,
            lighting_maps,
            shadow,
            last_level,
            shadow_side,
            still,
            moving,
            previous: vertex_buffer(device, count),
            pending: None,
            lights: vec![],
            has_sun,
            has_blended,
            is_shadow_stale: true,
            near,
            lighting,
            targets: Targets::new(device, size),
        };
        raster.place(pose.clone(), pose);
        Ok(raster)
    }

    /// Poses the scene at `time_s` (seconds). Motion vectors refer to the pose at `previous_s`.
    pub fn pose(&mut self, scene: &Scene, time_s: f64, previous_s: f64) {
        if scene.duration_s() > 0.0 {
            self.place(scene.pose(time_s), scene.pose(previous_s));
        }
    }

    fn place(&mut self, pose: Pose, previous: Pose) {
        if !pose.moving.is_empty() {
            let now = self.moving.grouped.vertices(&pose.moving);
            self.moving.blended = self.moving.grouped.blended(&now);
            self.moving.chunks = Chunks::new(&self.moving.grouped.parts, &now);
            self.pending = Some([now, self.moving.grouped.vertices(&previous.moving)]);
        }
        self.lights = pose.lights;
        self.is_shadow_stale = true;
    }

    /// Distance of the near plane in metres: 1e-4 of the scene's radius, between 1e-6 and 1e-2.
    pub fn near(&self) -> f32 {
        self.near
    }

    /// Targets that frames are drawn to.
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

/// What lighting needs of the materials, if the scene is to be lit from a G-buffer and that has all the rest.
fn deferred(device: &Device, queue: &Queue, scene: &Scene, shading: Shading) -> Option<TextureView> {
    let is_deferred = shading == Shading::Deferred && materials::are_deferrable(&scene.materials, device);
    is_deferred.then(|| materials::texels(device, queue, &scene.materials))
}

/// A buffer with room for `vertices`; at least one.
fn vertex_buffer(device: &Device, vertices: usize) -> Buffer {
    let usage = BufferUsages::VERTEX | BufferUsages::COPY_DST;
    empty_buffer(device, "vertices", STRIDE * vertices.max(1) as u64, usage)
}

/// The sky texture with its mip levels, and the number of the last level.
fn sky(device: &Device, queue: &Queue, environment: &Environment) -> (TextureView, f32) {
    let levels = match environment {
        Environment::Constant(radiance) => vec![afterimage::Image::filled([1, 1], *radiance)],
        Environment::Map(map) => mipmaps::sky_levels(map, device.limits().max_texture_dimension_2d),
    };
    let halves: Vec<_> =
        levels.iter().map(|l| l.map(|[r, g, b]| [r, g, b, 1.0].map(|v: f32| half_bits(v.max(0.0)) as u16))).collect();
    (upload_levels(device, queue, "sky", &halves, TextureFormat::Rgba16Float), (levels.len() - 1) as f32)
}

fn lighting_maps(
    device: &Device,
    queue: &Queue,
    layouts: &Layouts,
    shadow: &TextureView,
    sky: &TextureView,
) -> BindGroup {
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
    bind_group(device, "lighting_maps", &layouts.lighting_maps, resources)
}
