//! Foveated rendering of one ordinary view: the post-process chooses the quads of 2x2 pixels that are shaded, and the
//! depth test rejects the rest before it is shaded. Camera, shaders and draw calls stay as they are.
//!
//! What a renderer adds to its prepass of depth and motion and to its color pass: `plan` between the two, a copy of the
//! depth buffer, and `prime`. The first frame, and those after a cut, are drawn at half the width and height instead.
//!
//! `cargo run --release --example 09_quads` (any adapter; software Vulkan: mesa-vulkan-drivers)

mod headless;

use afterimage::gpu::{Afterimage, Frame, Prime};
use afterimage::wgpu::util::{BufferInitDescriptor, DeviceExt};
use afterimage::wgpu::{self, CommandEncoder, LoadOp, RenderPipeline, Texture, TextureFormat, TextureUsages};
use afterimage::{ContextDesc, DepthConvention, Foveation, Gaze, Settings, ViewFrame, ViewGeometry};
use headless::Headless;

const SIZE: [u32; 2] = [640, 360];
const NEAR: f32 = 0.1;
const DEPTH: TextureFormat = TextureFormat::Depth32Float;
const COLOR: TextureFormat = TextureFormat::Rgba32Float;
const MOTION: TextureFormat = TextureFormat::Rg32Float;

/// A floor of tiles, seen by a camera that moves to the right. `fwidth` sees whole quads, as at full rate.
const SHADER: &str = "
struct Camera { scale: vec2f, offset: vec2f, size: vec2f, time: f32, bias: f32 }
@group(0) @binding(0) var<uniform> camera: Camera;
struct Varying { @invariant @builtin(position) position: vec4f, @location(0) floor: vec2f, @location(1) now: vec4f, @location(2) before: vec4f }

fn projected(world: vec3f, time: f32) -> vec4f {
    let p = world - vec3f(0.03 * time, 1.5, 0.0);
    // Distance times the pixel that shows the point: tangents of view angles are `pixel * scale + offset`.
    let px = (p.xy * vec2f(1.0, -1.0) + camera.offset * p.z) / camera.scale;
    let ndc = (px - 0.5 * p.z) * 2.0 / camera.size + p.z;
    return vec4f(ndc.x, -ndc.y, 0.1, -p.z);
}

@vertex fn vertex(@builtin(vertex_index) i: u32) -> Varying {
    let corner = vec2f(f32(i & 1u), f32(i >> 1u));
    let world = vec3f(corner.x * 120.0 - 60.0, 0.0, -1.0 - 60.0 * corner.y);
    let now = projected(world, camera.time);
    return Varying(now, world.xz, now, projected(world, camera.time - 1.0));
}

@fragment fn motion(in: Varying) -> @location(0) vec2f {
    let ndc = in.before.xy / in.before.w - in.now.xy / in.now.w;
    return ndc * vec2f(0.5, -0.5) * camera.size;
}

@fragment fn color(in: Varying) -> @location(0) vec4f {
    // With textures: textureSampleBias(map, map_sampler, uv, camera.bias). Here, tiles fade where they are small.
    let width = fwidth(in.floor) * exp2(camera.bias);
    let wave = sin(in.floor * 12.0) * (1.0 - smoothstep(vec2f(0.1), vec2f(0.25), width));
    return vec4f(vec3f(0.5, 0.45, 0.4) + 0.3 * wave.x * wave.y, 1.0);
}";

/// A pipeline of the renderer: `entry` is its fragment shader.
fn pipeline(gpu: &Headless, entry: &str, format: TextureFormat) -> RenderPipeline {
    let source = wgpu::ShaderSource::Wgsl(SHADER.into());
    let module = &gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState { module, entry_point: None, compilation_options: Default::default(), buffers: &[] },
        primitive: wgpu::PrimitiveState { topology: wgpu::PrimitiveTopology::TriangleStrip, ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Draws the scene as a view into `target`, on the depth buffer as it is or on a cleared one.
fn draw(
    gpu: &Headless,
    encoder: &mut CommandEncoder,
    pipeline: &RenderPipeline,
    [target, depth]: [&Texture; 2],
    depth_load: LoadOp<f32>,
    (view, time): (&ViewGeometry, u64),
) {
    let ([sx, sy], [ox, oy]) = view.scale_offset();
    let [width, height] = view.size_px().map(|side| side as f32);
    // Samples of a view at half size stand for pixels of full size.
    let bias = (width / SIZE[0] as f32).log2().round();
    let words = [sx, sy, ox, oy, width, height, time as f32, bias];
    let (contents, usage) = (bytemuck::bytes_of(&words), wgpu::BufferUsages::UNIFORM);
    let uniforms = gpu.device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage });
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: uniforms.as_entire_binding() }],
    });
    let [target, depth] = [target, depth].map(|texture| texture.create_view(&Default::default()));
    let ops = wgpu::Operations { load: LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store };
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &target,
            depth_slice: None,
            resolve_target: None,
            ops,
        })],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &depth,
            depth_ops: Some(wgpu::Operations { load: depth_load, store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..4, 0..1);
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Headless::new()?;
    let prepass = pipeline(&gpu, "motion", MOTION);
    let shading = pipeline(&gpu, "color", COLOR);

    // `Foveation::uniform(0.25)`, without an eye tracker: a temporal upscaler.
    let foveation = Foveation::quads();
    let desc = ContextDesc {
        settings: Settings { foveation, ..Settings::default() },
        depth: DepthConvention::Reversed { near: NEAR, far: f32::INFINITY },
        ..ContextDesc::new(SIZE)
    };
    let attachment = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
    let texture = |format| gpu.texture(SIZE, 1, format, attachment);
    let [color, motion, depth, full] = [COLOR, MOTION, DEPTH, COLOR].map(texture);
    let [half_color, half_depth] =
        [COLOR, DEPTH].map(|format| gpu.texture(SIZE.map(|side| side.div_ceil(2)), 1, format, attachment));
    let primed = gpu.texture(SIZE, 1, DEPTH, TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_DST);
    let primed_view = primed.create_view(&Default::default());
    let output = gpu.texture(SIZE, 1, COLOR, TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC);
    let mut post = Afterimage::new(&gpu.device, &desc, COLOR)?;
    let geometry = ViewGeometry::flat(SIZE, 2.0 * 0.7_f32.atan().to_degrees())?;
    for index in 0..48 {
        let gaze_px = [150.0 + 7.0 * index as f32, 200.0];
        let views = [ViewFrame::new(geometry, Gaze::At { px: gaze_px })];
        let mut frame =
            Frame { depth: Some((&depth).into()), motion: Some((&motion).into()), ..Frame::new(&color, &views, index) };
        let mut encoder = gpu.encoder();
        // The renderer's prepass; 0 is the far plane.
        draw(&gpu, &mut encoder, &prepass, [&motion, &depth], LoadOp::Clear(0.0), (&geometry, index));
        post.plan(&gpu.device, &mut encoder, &frame)?;
        // The renderer's color pass.
        // Both the methods and the color pass read depth; prime closes a copy of it.
        encoder.copy_texture_to_texture(depth.as_image_copy(), primed.as_image_copy(), depth.size());
        let is_half = post.is_quarter();
        let prime = Prime { target: &primed_view, origin_px: [0, 0], near_depth: 1.0, stencil: None, is_half };
        post.prime(&gpu.device, &mut encoder, 0, &prime)?;
        draw(&gpu, &mut encoder, &shading, [&color, &primed], LoadOp::Load, (&geometry, index));
        if is_half {
            // Nothing is known: outside the fovea one pixel of each quad, as a small view. With jitter, half of it.
            let half = geometry.half(Foveation::quarter_place_px(index));
            draw(&gpu, &mut encoder, &shading, [&half_color, &half_depth], LoadOp::Clear(0.0), (&half, index));
            frame.half = Some((&half_color).into());
        }
        let pixels = if is_half { 1 } else { 4 };
        post.record(&gpu.device, &mut encoder, &frame, &output)?;
        gpu.submit(encoder);
        if index == 0 || index % 16 == 15 {
            let mut encoder = gpu.encoder();
            draw(&gpu, &mut encoder, &shading, [&full, &depth], LoadOp::Load, (&geometry, index));
            gpu.submit(encoder);
            let (shown, expected) = (gpu.read(&output, 0), gpu.read(&full, 0));
            let squares: f32 = shown.iter().zip(&expected).map(|(a, b)| (a[0] - b[0]).powi(2)).sum();
            let list = gpu.read_buffer(post.quad_list(0).expect("the filter is Quads"));
            let quads = u32::from_le_bytes([list[28], list[29], list[30], list[31]]);
            println!(
                "frame {index}: {:.1} % of the pixels are shaded, PSNR {:.1} dB",
                (100 * pixels * quads) as f32 / (SIZE[0] * SIZE[1]) as f32,
                -10.0 * (squares / shown.len() as f32).log10()
            );
        }
    }
    Ok(())
}
