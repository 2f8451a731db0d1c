//! The smallest renderer with planned frames: a quarter of its pixels is shaded, and the picture is that of full rate,
//! antialiased. The post-process chooses the pixels, and the depth test rejects the rest before it is shaded. Shaders
//! and draw calls stay as they are.
//!
//! What is added to a prepass of depth and a pass of colors: a jittered projection, `plan`, `close` and `show`.
//!
//! `cargo run --release --example 01_planned` (any adapter; software Vulkan: mesa-vulkan-drivers)

mod headless;

use afterimage::wgpu::util::{BufferInitDescriptor, DeviceExt};
use afterimage::wgpu::{
    self, BufferUsages, CommandEncoder, LoadOp, RenderPipeline, Texture, TextureFormat, TextureUsages,
};
use afterimage::{Afterimage, Camera, Desc, Frame};
use glam::{Mat4, Vec3, camera::rh::proj::directx::perspective_infinite_reverse};
use headless::Headless;

const SIZE: [u32; 2] = [640, 360];
const DEPTH: TextureFormat = TextureFormat::Depth32Float;
const COLOR: TextureFormat = TextureFormat::Rgba32Float;

/// A floor of tiles. Both passes must draw exactly the same depth, hence `@invariant`.
const SHADER: &str = "
@group(0) @binding(0) var<uniform> clip_from_world: mat4x4f;
struct Varying { @invariant @builtin(position) position: vec4f, @location(0) floor: vec2f }

@vertex fn vertex(@builtin(vertex_index) i: u32) -> Varying {
    let world = vec3f(f32(i & 1u) * 120.0 - 60.0, 0.0, -1.0 - 60.0 * f32(i >> 1u));
    return Varying(clip_from_world * vec4f(world, 1.0), world.xz);
}

@fragment fn color(in: Varying) -> @location(0) vec4f {
    let wave = sin(in.floor * 12.0) * (1.0 - smoothstep(vec2f(0.1), vec2f(0.25), fwidth(in.floor)));
    return vec4f(vec3f(0.5, 0.45, 0.4) + 0.3 * wave.x * wave.y, 1.0);
}";

/// A pass of the renderer: of depth alone, or of colors.
fn pipeline(gpu: &Headless, is_color: bool) -> RenderPipeline {
    let source = wgpu::ShaderSource::Wgsl(SHADER.into());
    let module = &gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let targets = [Some(COLOR.into())];
    let fragment =
        wgpu::FragmentState { module, entry_point: None, compilation_options: Default::default(), targets: &targets };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState { module, entry_point: None, compilation_options: Default::default(), buffers: &[] },
        primitive: wgpu::PrimitiveState { topology: wgpu::PrimitiveTopology::TriangleStrip, ..Default::default() },
        // Depth is reversed; what is as near as the prepass says is drawn.
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(!is_color),
            depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: is_color.then_some(fragment),
        multiview_mask: None,
        cache: None,
    })
}

/// Draws the scene into a depth buffer, which is cleared to the far plane without a color.
fn draw(
    gpu: &Headless,
    encoder: &mut CommandEncoder,
    pipeline: &RenderPipeline,
    [color, depth]: [Option<&Texture>; 2],
    clip_from_world: Mat4,
) {
    let columns = clip_from_world.to_cols_array();
    let (contents, usage) = (bytemuck::bytes_of(&columns), BufferUsages::UNIFORM);
    let uniforms = gpu.device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage });
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: uniforms.as_entire_binding() }],
    });
    let [color, depth] = [color, depth].map(|texture| texture.map(|texture| texture.create_view(&Default::default())));
    let sky = wgpu::Color { r: 0.4, g: 0.6, b: 0.9, a: 1.0 };
    let depth_load = if color.is_some() { LoadOp::Load } else { LoadOp::Clear(0.0) };
    let color = color.as_ref().map(|view| wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load: LoadOp::Clear(sky), store: wgpu::StoreOp::Store },
    });
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: if color.is_some() { std::slice::from_ref(&color) } else { &[] },
        depth_stencil_attachment: depth.as_ref().map(|view| wgpu::RenderPassDepthStencilAttachment {
            view,
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
    let [prepass, shading] = [false, true].map(|is_color| pipeline(&gpu, is_color));
    let attachment = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
    let [depth, closed, color, full] =
        [DEPTH, DEPTH, COLOR, COLOR].map(|format| gpu.texture(SIZE, 1, format, attachment | TextureUsages::COPY_DST));
    let output = gpu.texture(SIZE, 1, COLOR, TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC);

    // A quarter of the pixels; where an eye tracker says where the eye looks, a tenth.
    let mut post = Afterimage::new(&gpu.device, &Desc::new(SIZE, COLOR))?;
    let clip_from_view = perspective_infinite_reverse(0.75, 640.0 / 360.0, 0.1);
    for index in 0..48 {
        // Only the camera moves, so that there are no motion vectors.
        let world_from_view = Mat4::from_translation(Vec3::new(0.03 * index as f32, 1.5, 0.0));
        let jittered = Mat4::from_cols_array_2d(&post.jittered(clip_from_view.to_cols_array_2d()));
        let clip_from_world = jittered * world_from_view.inverse();

        let mut encoder = gpu.encoder();
        draw(&gpu, &mut encoder, &prepass, [None, Some(&depth)], clip_from_world);
        let camera = Camera::new(clip_from_view.to_cols_array_2d(), world_from_view.to_cols_array_2d());
        let plan = post.plan(&mut encoder, &Frame::new(&depth, camera))?;
        // The post-process reads depth, too: a copy of it is closed.
        encoder.copy_texture_to_texture(depth.as_image_copy(), closed.as_image_copy(), depth.size());
        post.close(&mut encoder, &plan, &closed.create_view(&Default::default()))?;
        draw(&gpu, &mut encoder, &shading, [Some(&color), Some(&closed)], clip_from_world);
        let list = plan.list().clone();
        post.show(&mut encoder, plan, &color, &output)?;
        gpu.submit(encoder);

        if index == 0 || index % 16 == 15 {
            let mut encoder = gpu.encoder();
            let clip_from_world = clip_from_view * world_from_view.inverse();
            draw(&gpu, &mut encoder, &prepass, [None, Some(&closed)], clip_from_world);
            draw(&gpu, &mut encoder, &shading, [Some(&full), Some(&closed)], clip_from_world);
            gpu.submit(encoder);
            let (shown, expected) = (gpu.read(&output, 0), gpu.read(&full, 0));
            let squares: f32 = shown.iter().zip(&expected).map(|(a, b)| (a[0] - b[0]).powi(2)).sum();
            let psnr_db = -10.0 * (squares / shown.len() as f32).log10();
            let words: Vec<u32> = bytemuck::pod_collect_to_vec(&gpu.read_buffer(&list)[28..32]);
            let share = 400.0 * words[0] as f32 / (SIZE[0] * SIZE[1]) as f32;
            println!(
                "frame {index}: quads with {share:.0} % of the pixels are shaded; PSNR {psnr_db:.1} dB to full rate"
            );
        }
    }
    Ok(())
}
