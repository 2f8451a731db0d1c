//! The scene buffer on a device.

use crate::scene_buffer::{ELEMENT_BYTES, SceneBuffer, SceneBufferLimits, Section};
use afterimage_lab::device::{empty_buffer, texture_desc};
use afterimage_lab::rays::Geometry;

/// Kind of GPU resource that holds the scene buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Storage {
    /// An rgba32uint texture. On software Vulkan, reads are five times as fast as from a buffer.
    Texture,
    /// A storage buffer.
    Buffer,
}

impl Storage {
    /// Faster storage for a kind of device.
    pub fn of(device: wgpu::DeviceType) -> Self {
        if device == wgpu::DeviceType::Cpu { Self::Texture } else { Self::Buffer }
    }

    /// Shader module that defines `load` for this storage.
    pub fn module(self) -> &'static str {
        match self {
            Self::Texture => "scene_texture",
            Self::Buffer => "scene_storage",
        }
    }

    /// Largest scene buffer on a device with these limits.
    pub fn limits(self, device: &wgpu::Limits) -> SceneBufferLimits {
        match self {
            Self::Texture => {
                let rows = device.max_texture_dimension_2d;
                SceneBufferLimits { rows, elements: u64::from(rows) * u64::from(rows) }
            }
            Self::Buffer => {
                let bytes = device.max_storage_buffer_binding_size.min(device.max_buffer_size);
                SceneBufferLimits { rows: 1 << 31, elements: bytes / ELEMENT_BYTES as u64 }
            }
        }
    }
}

/// Texture or buffer with the scene buffer's contents.
#[derive(Debug)]
pub struct GpuSceneBuffer {
    resource: Resource,
}

#[derive(Debug)]
enum Resource {
    Texture(wgpu::Texture, wgpu::TextureView),
    Buffer(wgpu::Buffer),
}

impl GpuSceneBuffer {
    /// Uploads all of `scene_buffer`, which must have been built within the limits of `storage` on this device.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, scene_buffer: &SceneBuffer, storage: Storage) -> Self {
        let resource = match storage {
            Storage::Texture => {
                let size = [1 << scene_buffer.width_log2(), scene_buffer.rows()];
                let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
                let desc = texture_desc("scene_buffer", size, wgpu::TextureFormat::Rgba32Uint, usage);
                let texture = device.create_texture(&desc);
                let view = texture.create_view(&Default::default());
                Resource::Texture(texture, view)
            }
            Storage::Buffer => {
                let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
                Resource::Buffer(empty_buffer(device, "scene_buffer", scene_buffer.bytes(), usage))
            }
        };
        let this = Self { resource };
        this.write_rows(queue, scene_buffer, 0..scene_buffer.rows());
        this
    }

    /// Uploads the sections that are rewritten each frame. Takes effect with the next submission to the queue.
    pub fn write_moving(&self, queue: &wgpu::Queue, scene_buffer: &SceneBuffer) {
        let rows = scene_buffer.moving_rows();
        if !rows.is_empty() {
            self.write_rows(queue, scene_buffer, rows);
        }
    }

    /// Bind group layout entry for compute passes.
    pub fn layout_entry(&self, binding: u32) -> wgpu::BindGroupLayoutEntry {
        let ty = match &self.resource {
            Resource::Texture(..) => wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Uint,
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: false,
            },
            Resource::Buffer(_) => wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only: true },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
        };
        wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::COMPUTE, ty, count: None }
    }

    /// Resource to bind.
    pub fn binding(&self) -> wgpu::BindingResource<'_> {
        match &self.resource {
            Resource::Texture(_, view) => wgpu::BindingResource::TextureView(view),
            Resource::Buffer(buffer) => buffer.as_entire_binding(),
        }
    }

    fn write_rows(&self, queue: &wgpu::Queue, scene_buffer: &SceneBuffer, rows: std::ops::Range<u32>) {
        let first = (rows.start as usize) << scene_buffer.width_log2();
        let last = (rows.end as usize) << scene_buffer.width_log2();
        let bytes: &[u8] = bytemuck::cast_slice(&scene_buffer.elements()[first..last]);
        match &self.resource {
            Resource::Texture(texture, _) => {
                let mut to = texture.as_image_copy();
                to.origin.y = rows.start;
                let layout = wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some((ELEMENT_BYTES as u32) << scene_buffer.width_log2()),
                    rows_per_image: None,
                };
                let height = rows.end - rows.start;
                let size = wgpu::Extent3d { width: 1 << scene_buffer.width_log2(), height, depth_or_array_layers: 1 };
                queue.write_texture(to, bytes, layout, size);
            }
            Resource::Buffer(buffer) => queue.write_buffer(buffer, (first * ELEMENT_BYTES) as u64, bytes),
        }
    }
}

/// Override values of `traverse.wgsl` and of the module that defines `load`.
pub fn traversal_constants(
    scene_buffer: &SceneBuffer,
    geometry: &Geometry,
    alpha: bool,
    storage: Storage,
) -> Vec<(&'static str, f64)> {
    let mut constants = vec![
        ("NODES", f64::from(scene_buffer.base(Section::Nodes))),
        ("TRIANGLES", f64::from(scene_buffer.base(Section::Triangles))),
        ("MOVING_NODES", f64::from(scene_buffer.base(Section::MovingNodes))),
        ("MOVING_TRIANGLES", f64::from(scene_buffer.base(Section::MovingTriangles))),
        ("FIRST_MOVING", f64::from(geometry.first_moving())),
        ("MOVES", f64::from(u8::from(scene_buffer.capacity(Section::MovingNodes) > 0))),
        ("ALPHA", f64::from(u8::from(alpha))),
    ];
    if storage == Storage::Texture {
        constants.push(("SCENE_WIDTH_LOG2", f64::from(scene_buffer.width_log2())));
    }
    constants
}
