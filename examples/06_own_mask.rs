//! A renderer that chooses its pixels itself: it shades everything around the gaze and a checkerboard beyond, and says
//! which pixels these are: `given` in place of `plan`.
//!
//! What a renderer adds to depth of every pixel: a mask. Any pattern does that visits every pixel in some frame. Of
//! quads of 2x2 with one pixel, color may have half the width and height (`show_quarter`).
//!
//! `cargo run --release --example 06_own_mask` (any adapter; software Vulkan: mesa-vulkan-drivers)

mod headless;

use afterimage::wgpu::util::{BufferInitDescriptor, DeviceExt};
use afterimage::wgpu::{self, BindGroupEntry, BindingResource, ComputePipeline, Texture, TextureFormat, TextureUsages};
use afterimage::{Afterimage, Camera, Desc, Frame, Shading};
use glam::{Mat4, Vec3, camera::rh::proj::directx::perspective_infinite_reverse};
use headless::Headless;

const SIZE: [u32; 2] = [640, 360];
const NEAR: f32 = 0.1;
/// Color, depth and mask.
const FORMATS: [TextureFormat; 3] = [TextureFormat::Rgba32Float, TextureFormat::R32Float, TextureFormat::R32Float];

/// A floor of tiles, seen by a camera that moves to the right.
const SHADER: &str = "
struct Camera { gaze: vec2f, radius: f32, time: u32 }
@group(0) @binding(0) var color_out: texture_storage_2d<rgba32float, write>;
@group(0) @binding(1) var depth_out: texture_storage_2d<r32float, write>;
@group(0) @binding(2) var mask_out: texture_storage_2d<r32float, write>;
@group(0) @binding(3) var<uniform> camera: Camera;

fn shade(at: vec2f, width: vec2f) -> vec4f {
    let wave = sin(at * 12.0) * (1.0 - smoothstep(vec2f(0.1), vec2f(0.25), width));
    return vec4f(vec3f(0.5, 0.45, 0.4) + 0.3 * wave.x * wave.y, 1.0);
}

@compute @workgroup_size(8, 8) fn render(@builtin(global_invocation_id) id: vec3u) {
    let size = vec2f(textureDimensions(color_out));
    let px_tan = 1.4 / size.x;
    let ray = px_tan * (vec2f(id.xy) + 0.5 - 0.5 * size);
    let is_floor = ray.y > 0.0;
    // Depth is given at every pixel.
    let z = 1.5 / ray.y;
    textureStore(depth_out, id.xy, vec4f(select(0.0, 0.1 / z, is_floor)));
    // Color, which costs most, only where this renderer wants it.
    let in_checkerboard = ((id.x + id.y + camera.time) & 1u) == 0u;
    let is_shaded = in_checkerboard || distance(vec2f(id.xy), camera.gaze) < camera.radius;
    textureStore(mask_out, id.xy, vec4f(f32(is_shaded)));
    if is_shaded {
        let at = vec2f(ray.x * z + 0.03 * f32(camera.time), z);
        let tiles = shade(at, px_tan * z * vec2f(1.0, z / 1.5));
        textureStore(color_out, id.xy, select(vec4f(0.3, 0.4, 0.6, 1.0), tiles, is_floor));
    }
}";

/// Renders a frame: every pixel within `radius_px` of the gaze, half of the others.
fn render(
    gpu: &Headless,
    pipeline: &ComputePipeline,
    images: &[Texture; 3],
    (gaze_px, radius_px): ([f32; 2], f32),
    index: u64,
) {
    let words = [gaze_px[0].to_bits(), gaze_px[1].to_bits(), radius_px.to_bits(), index as u32];
    let (contents, usage) = (bytemuck::bytes_of(&words), wgpu::BufferUsages::UNIFORM);
    let camera = gpu.device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage });
    let views = images.each_ref().map(|image| image.create_view(&Default::default()));
    let resources = views.iter().map(BindingResource::TextureView).chain([camera.as_entire_binding()]);
    let entries: Vec<_> =
        (0..).zip(resources).map(|(binding, resource)| BindGroupEntry { binding, resource }).collect();
    let layout = &pipeline.get_bind_group_layout(0);
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries });
    let mut encoder = gpu.encoder();
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups(SIZE[0].div_ceil(8), SIZE[1].div_ceil(8), 1);
    drop(pass);
    gpu.submit(encoder);
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Headless::new()?;
    let source = wgpu::ShaderSource::Wgsl(SHADER.into());
    let module = &gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module,
        entry_point: None,
        compilation_options: Default::default(),
        cache: None,
    });
    let usage = TextureUsages::STORAGE_BINDING | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
    let images = || FORMATS.map(|format| gpu.texture(SIZE, 1, format, usage));
    let (given, full) = (images(), images());

    let output = gpu.texture(SIZE, 1, FORMATS[0], usage);
    // Half of the pixels and more, not jittered; motion vectors are not needed where only the camera moves.
    let desc =
        Desc { shading: Shading::Everywhere { share: 0.5 }, antialias: false, ..Desc::new(SIZE, output.format()) };
    let mut post = Afterimage::new(&gpu.device, &desc)?;
    let aspect = SIZE[0] as f32 / SIZE[1] as f32;
    let clip_from_view = perspective_infinite_reverse(2.0 * (0.7 / aspect).atan(), aspect, NEAR).to_cols_array_2d();
    for index in 0..48 {
        let gaze_px = [150.0 + 7.0 * index as f32, 250.0];
        render(&gpu, &pipeline, &given, (gaze_px, 40.0), index);
        let [color, depth, mask] = &given;
        let world_from_view = Mat4::from_translation(Vec3::new(0.03 * index as f32, 0.0, 0.0)).to_cols_array_2d();
        let plan = post.given(&Frame::new(depth, Camera::new(clip_from_view, world_from_view)), mask)?;
        let mut encoder = gpu.encoder();
        post.show(&mut encoder, plan, color, &output)?;
        gpu.submit(encoder);
        if index % 16 == 15 {
            render(&gpu, &pipeline, &full, (gaze_px, f32::INFINITY), index);
            let (shown, expected) = (gpu.read(&output, 0), gpu.read(&full[0], 0));
            let squares: f32 = shown.iter().zip(&expected).map(|(a, b)| (a[0] - b[0]).powi(2)).sum();
            println!("frame {index}: PSNR {:.1} dB", -10.0 * (squares / shown.len() as f32).log10());
        }
    }
    Ok(())
}
