//! The device, and textures that come back from it.

use crate::Result;
use std::sync::{Arc, Mutex};
use wasm_bindgen::{JsError, JsValue};
use wasm_bindgen_futures::JsFuture;
use wgpu::{
    Adapter, BindGroupDescriptor, BindGroupEntry, BindingResource, Buffer, BufferDescriptor, BufferUsages,
    CommandEncoder, ComputePipeline, ComputePipelineDescriptor, Device, Extent3d, Queue, ShaderModule, Surface,
    Texture, TextureAspect, TextureDescriptor, TextureDimension, TextureFormat, TextureUsages,
};

/// Device and queue.
pub struct Gpu {
    pub device: Device,
    pub queue: Queue,
    pub adapter: String,
    /// First error of the device that was not asked about.
    pub fault: Arc<Mutex<Option<String>>>,
    /// Mapped after the frames before it are done.
    fence: [Buffer; 2],
}

/// Size of a dispatch.
pub enum Dispatch<'a> {
    /// An invocation for each pixel, in workgroups of 8x8.
    Pixels([u32; 2]),
    /// One for each quad of a list of the post-process (`Afterimage::quad_list`), in workgroups of 64.
    Quads(&'a Buffer),
}

/// Place of the arguments of a dispatch in such a list.
const QUAD_GROUPS: u64 = 16;

fn failed(error: impl std::fmt::Display) -> JsError {
    JsError::new(&error.to_string())
}

impl Gpu {
    /// The browser's preferred device, and the surface of a canvas.
    pub async fn open(canvas: &web_sys::HtmlCanvasElement) -> Result<(Self, Surface<'static>, Adapter)> {
        let mut desc = wgpu::InstanceDescriptor::new_without_display_handle();
        desc.backends = wgpu::Backends::BROWSER_WEBGPU;
        let instance = wgpu::Instance::new(desc);
        let surface = instance.create_surface(wgpu::SurfaceTarget::Canvas(canvas.clone())).map_err(failed)?;
        let options = wgpu::RequestAdapterOptions { compatible_surface: Some(&surface), ..Default::default() };
        let adapter = instance.request_adapter(&options).await.map_err(failed)?;
        let (device, queue) = adapter.request_device(&wgpu::DeviceDescriptor::default()).await.map_err(failed)?;
        let fault = Arc::new(Mutex::new(None));
        let note = |fault: &Arc<Mutex<Option<String>>>, message: String| {
            if let Ok(mut fault) = fault.lock() {
                fault.get_or_insert(message);
            }
        };
        let lost = fault.clone();
        device.set_device_lost_callback(move |reason, message| {
            note(&lost, format!("The device is lost ({reason:?}). {message}"));
        });
        let uncaptured = fault.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| note(&uncaptured, error.to_string())));
        let buffer = |usage| {
            device.create_buffer(&BufferDescriptor { label: Some("fence"), size: 4, usage, mapped_at_creation: false })
        };
        let fence = [buffer(BufferUsages::COPY_SRC), buffer(BufferUsages::COPY_DST | BufferUsages::MAP_READ)];
        let info = adapter.get_info();
        let name = if info.name.is_empty() { info.driver } else { info.name };
        Ok((Self { device, queue, adapter: name, fault, fence }, surface, adapter))
    }

    /// A texture of one level.
    pub fn texture(&self, [width, height]: [u32; 2], format: TextureFormat, usage: TextureUsages) -> Texture {
        self.device.create_texture(&TextureDescriptor {
            label: None,
            size: Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    }

    /// A texture that compute shaders write and read.
    pub fn image(&self, size: [u32; 2], format: TextureFormat) -> Texture {
        let usage = TextureUsages::TEXTURE_BINDING
            | TextureUsages::STORAGE_BINDING
            | TextureUsages::COPY_DST
            | TextureUsages::COPY_SRC;
        self.texture(size, format, usage)
    }

    /// The pipeline of a shader's entry point.
    pub fn pipeline(&self, module: &ShaderModule, entry: &str) -> ComputePipeline {
        self.device.create_compute_pipeline(&ComputePipelineDescriptor {
            label: Some(entry),
            layout: None,
            module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            cache: None,
        })
    }

    /// Records a dispatch with resources by number.
    pub fn dispatch(
        &self,
        encoder: &mut CommandEncoder,
        pipeline: &ComputePipeline,
        bound: &[(u32, BindingResource<'_>)],
        size: Dispatch<'_>,
    ) {
        let entries: Vec<_> = bound
            .iter()
            .map(|(binding, resource)| BindGroupEntry { binding: *binding, resource: resource.clone() })
            .collect();
        let layout = &pipeline.get_bind_group_layout(0);
        let group = self.device.create_bind_group(&BindGroupDescriptor { label: None, layout, entries: &entries });
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        match size {
            Dispatch::Pixels([width, height]) => pass.dispatch_workgroups(width.div_ceil(8), height.div_ceil(8), 1),
            Dispatch::Quads(list) => pass.dispatch_workgroups_indirect(list, QUAD_GROUPS),
        }
    }

    /// Resolves when everything that was submitted is done.
    pub async fn finished(&self) -> Result<()> {
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(&self.fence[0], 0, &self.fence[1], 0, 4);
        self.queue.submit([encoder.finish()]);
        mapped(&self.fence[1]).await?;
        self.fence[1].unmap();
        Ok(())
    }

    /// Texels of a texture whose channels are floats, row after row.
    pub async fn read(&self, texture: &Texture) -> Result<Vec<f32>> {
        self.read_rows(texture, 1).await
    }

    /// Texels of every `step`-th row. Depth can only be read as a whole.
    pub async fn read_rows(&self, texture: &Texture, step: u32) -> Result<Vec<f32>> {
        let texel = texture.format().block_copy_size(Some(TextureAspect::All)).unwrap_or(4);
        let row = texture.width() * texel;
        let rows = texture.height();
        let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.device.create_buffer(&BufferDescriptor {
            label: Some("readback"),
            size: u64::from(padded * rows.div_ceil(step)),
            usage: BufferUsages::COPY_DST | BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let height = if step == 1 { rows } else { 1 };
        for (i, y) in (0..rows).step_by(if step == 1 { rows } else { step } as usize).enumerate() {
            let layout = wgpu::TexelCopyBufferLayout {
                offset: i as u64 * u64::from(padded),
                bytes_per_row: Some(padded),
                rows_per_image: Some(height),
            };
            let from =
                wgpu::TexelCopyTextureInfo { origin: wgpu::Origin3d { x: 0, y, z: 0 }, ..texture.as_image_copy() };
            let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
            encoder.copy_texture_to_buffer(from, to, Extent3d { height, ..texture.size() });
        }
        self.queue.submit([encoder.finish()]);
        mapped(&buffer).await?;
        let bytes = buffer.get_mapped_range(..).map_err(failed)?;
        let texels = bytes.chunks(padded as usize).map(|r| &r[..row as usize]);
        Ok(texels.flat_map(bytemuck::pod_collect_to_vec::<u8, f32>).collect())
    }
}

/// Resolves when a buffer can be read.
async fn mapped(buffer: &Buffer) -> Result<()> {
    let promise = js_sys::Promise::new(&mut |resolve, reject| {
        buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            // The call fails if nobody waits for the promise any more.
            let _ = match result {
                Ok(()) => resolve.call0(&JsValue::NULL),
                Err(error) => reject.call1(&JsValue::NULL, &error.to_string().into()),
            };
        });
    });
    JsFuture::from(promise).await.map_err(|_| JsError::new("what the device computed cannot be read"))?;
    Ok(())
}
