//! A renderer that chooses its pixels itself: it shades everything around the gaze and a checkerboard beyond, and says
//! which pixels these are. There is no call of `plan`.
//!
//! What a renderer adds to depth and motion of every pixel: a mask. Any pattern does that visits every pixel in some
//! frame. Of quads of 2x2 with one pixel, color may have half the width and height (`half`).
//!
//! `cargo run --release --example 08_own_mask` (any adapter; software Vulkan: mesa-vulkan-drivers)

mod headless;

use afterimage::gpu::{Afterimage, Frame};
use afterimage::wgpu::util::{BufferInitDescriptor, DeviceExt};
use afterimage::wgpu::{self, BindGroupEntry, BindingResource, ComputePipeline, Texture, TextureFormat, TextureUsages};
use afterimage::{ContextDesc, DepthConvention, Foveation, Gaze, Settings, ViewFrame, ViewGeometry};
use headless::Headless;

const SIZE: [u32; 2] = [640, 360];
const NEAR: f32 = 0.1;
/// Color, depth, motion and mask.
const FORMATS: [TextureFormat; 4] =
    [TextureFormat::Rgba32Float, TextureFormat::R32Float, TextureFormat::Rg32Float, TextureFormat::R32Float];

/// A floor of tiles, seen by a camera that moves to the right.
const SHADER: &str = "
struct Camera { gaze: vec2f, radius: f32, time: u32 }
@group(0) @binding(0) var color_out: texture_storage_2d<rgba32float, write>;
@group(0) @binding(1) var depth_out: texture_storage_2d<r32float, write>;
@group(0) @binding(2) var motion_out: texture_storage_2d<rg32float, write>;
@group(0) @binding(3) var mask_out: texture_storage_2d<r32float, write>;
@group(0) @binding(4) var<uniform> camera: Camera;

fn shade(at: vec2f, width: vec2f) -> vec4f {
    let wave = sin(at * 12.0) * (1.0 - smoothstep(vec2f(0.1), vec2f(0.25), width));
    return vec4f(vec3f(0.5, 0.45, 0.4) + 0.3 * wave.x * wave.y, 1.0);
}

@compute @workgroup_size(8, 8) fn render(@builtin(global_invocation_id) id: vec3u) {
    let size = vec2f(textureDimensions(color_out));
    let px_tan = 1.4 / size.x;
    let ray = px_tan * (vec2f(id.xy) + 0.5 - 0.5 * size);
    let is_floor = ray.y > 0.0;
    // Depth and motion are given at every pixel.
    let z = 1.5 / ray.y;
    textureStore(depth_out, id.xy, vec4f(select(0.0, 0.1 / z, is_floor)));
    textureStore(motion_out, id.xy, vec4f(select(0.0, 0.03 / (z * px_tan), is_floor), vec3f(0.0)));
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
    images: &[Texture; 4],
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

    // Beside the filter, of use here is only `rate_far`: about how far apart the shaded pixels are.
    let foveation = Foveation::quarter();
    let desc = ContextDesc {
        settings: Settings { foveation, ..Settings::default() },
        depth: DepthConvention::Reversed { near: NEAR, far: f32::INFINITY },
        ..ContextDesc::new(SIZE)
    };
    let output = gpu.texture(SIZE, 1, FORMATS[0], usage);
    let mut post = Afterimage::new(&gpu.device, &desc, output.format())?;
    let geometry = ViewGeometry::flat(SIZE, 2.0 * 0.7_f32.atan().to_degrees())?;
    for index in 0..48 {
        let gaze_px = [150.0 + 7.0 * index as f32, 250.0];
        render(&gpu, &pipeline, &given, (gaze_px, 40.0), index);
        let [color, depth, motion, mask] = &given;
        let views = [ViewFrame::new(geometry, Gaze::At { px: gaze_px })];
        let frame = Frame {
            depth: Some(depth.into()),
            motion: Some(motion.into()),
            mask: Some(mask.into()),
            ..Frame::new(color, &views, index)
        };
        let mut encoder = gpu.encoder();
        post.record(&gpu.device, &mut encoder, &frame, &output)?;
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
