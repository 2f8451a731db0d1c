//! What is the least that I must write on a GPU? Two frames in, one image out, without a window.
//!
//! `cargo run --features lab --example 06_gpu_headless` (any adapter; software Vulkan: mesa-vulkan-drivers)

use afterimage::display::ViewGeometry;
use afterimage::frame::{Gaze, ViewFrame};
use afterimage::gpu::{Afterimage, Frame, GpuDesc};
use wgpu::{TextureFormat, TextureUsages};

const SIZE: [u32; 2] = [256, 64];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
    println!("on {}", adapter.get_info().name);
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;

    // Yours: the frame that your renderer wrote, and what the user will see.
    let texture = |format, usage| {
        device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    };
    let color = texture(TextureFormat::Rgba32Float, TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST);
    let output = texture(TextureFormat::Rgba32Float, TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC);

    let mut post = Afterimage::new(&device, &GpuDesc::new(SIZE, output.format()))?;
    // Frame 0: the eye looks left and sees sharp stripes there. Frame 1: it looks right, and the left is blurred.
    for (index, (gaze_x, sharp)) in [(50.0, true), (200.0, false)].into_iter().enumerate() {
        let stripe = |i: u32| if sharp { (i % 2) as f32 } else { 0.5 };
        let pixels: Vec<[f32; 4]> = (0..SIZE[0] * SIZE[1]).map(|i| [stripe(i), stripe(i), stripe(i), 1.0]).collect();
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(SIZE[0] * 16), rows_per_image: None };
        queue.write_texture(color.as_image_copy(), bytemuck::cast_slice(&pixels), layout, color.size());

        let views = [ViewFrame {
            geometry: ViewGeometry::flat(SIZE, 70.0)?,
            gaze: Gaze::At { px: [gaze_x, 32.0] },
            previous_from_current: None,
        }];
        let mut encoder = device.create_command_encoder(&Default::default());
        post.record(&device, &mut encoder, &Frame::new(&color, &output, &views, index as u64))?;
        queue.submit([encoder.finish()]);
    }

    let row = read_row(&device, &queue, &output, 32)?;
    let kept = |x: std::ops::Range<usize>| 100 * row[x.clone()].iter().filter(|c| c[0] != 0.5).count() / x.len();
    println!("stripes still seen on the left, where the eye was: {} %", kept(40..60));
    println!("and further out, where it never looked: {} %", kept(110..130));
    Ok(())
}

/// One row of the output, back in memory.
fn read_row(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    texture: &wgpu::Texture,
    y: u32,
) -> Result<Vec<[f32; 4]>, Box<dyn std::error::Error>> {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(SIZE[0]) * 16,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut from = texture.as_image_copy();
    from.origin.y = y;
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(SIZE[0] * 16), rows_per_image: None };
    let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    let mut encoder = device.create_command_encoder(&Default::default());
    encoder.copy_texture_to_buffer(from, to, wgpu::Extent3d { width: SIZE[0], height: 1, depth_or_array_layers: 1 });
    queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |_| ());
    device.poll(wgpu::PollType::wait_indefinitely())?;
    let mapped = buffer.slice(..).get_mapped_range()?;
    Ok(bytemuck::cast_slice(&mapped).to_vec())
}
