//! Foveated rendering with wgpu: each lattice of a sparse frame is drawn as a small view of its own, all of them in one
//! atlas, and the post-process takes the atlas as it is.
//!
//! What a renderer adds to its own passes: a viewport and a scissor per lattice ([`draw`]), a crop of clip space and a
//! bias of textures' level of detail ([`crop`]).
//!
//! `cargo run --release --example 08_foveated_raster` (any adapter; software Vulkan: mesa-vulkan-drivers)

mod headless;

use afterimage::gpu::{Afterimage, Frame};
use afterimage::wgpu::util::{BufferInitDescriptor, DeviceExt};
use afterimage::wgpu::{self, Texture, TextureFormat, TextureUsages};
use afterimage::{
    ContextDesc, DepthConvention, Filter, Foveation, Gaze, Lattice, Lattices, Settings, ViewFrame, ViewGeometry,
};
use headless::Headless;

const SIZE: [u32; 2] = [640, 360];
const NEAR: f32 = 0.1;

/// A floor of tiles, seen by a camera that moves to the right.
const SHADER: &str = "
struct Crop { scale: vec2f, offset: vec2f, bias: f32, time: f32, tan: vec2f, size: vec2f }
@group(0) @binding(0) var<uniform> crop: Crop;
struct Varying { @builtin(position) position: vec4f, @location(0) floor: vec2f, @location(1) now: vec4f, @location(2) before: vec4f }
struct Targets { @location(0) color: vec4f, @location(1) motion: vec2f }

fn projected(world: vec3f, time: f32) -> vec4f {
    let p = world - vec3f(0.03 * time, 1.5, 0.0);
    return vec4f(p.xy / crop.tan, 0.1, -p.z);
}

@vertex fn vertex(@builtin(vertex_index) i: u32) -> Varying {
    let corner = vec2f(f32(i & 1u), f32(i >> 1u));
    let world = vec3f(corner.x * 120.0 - 60.0, 0.0, -1.0 - 60.0 * corner.y);
    let now = projected(world, crop.time);
    // The renderer's own projection, then the crop.
    let cropped = vec4f(now.xy * crop.scale + crop.offset * now.w, now.zw);
    return Varying(cropped, world.xz, now, projected(world, crop.time - 1.0));
}

@fragment fn fragment(in: Varying) -> Targets {
    // With textures: textureSampleBias(map, map_sampler, uv, crop.bias). Here, tiles fade where they are small.
    let width = fwidth(in.floor) * exp2(crop.bias);
    let wave = sin(in.floor * 12.0) * (1.0 - smoothstep(vec2f(0.1), vec2f(0.25), width));
    let ndc = in.before.xy / in.before.w - in.now.xy / in.now.w;
    let motion = ndc * vec2f(0.5, -0.5) * crop.size; // Pixels of the full-rate frame.
    return Targets(vec4f(vec3f(0.5, 0.45, 0.4) + 0.3 * wave.x * wave.y, 1.0), motion);
}";

/// Scale and offset of clip space's x and y: pixel (i, j) of the small view shows the full-rate frame's pixel
/// `first_px + step * (i, j)`. Then the bias of textures' level of detail.
fn crop(lattice: &Lattice) -> [f32; 5] {
    let step = lattice.step as f32;
    let covered = lattice.points.map(|n| n as f32 * step);
    let scale = [0, 1].map(|i| SIZE[i] as f32 / covered[i]);
    let offset = [0, 1].map(|i| (SIZE[i] as f32 - 1.0 - 2.0 * lattice.first_px[i] as f32 + step) / covered[i] - 1.0);
    [scale[0], scale[1], offset[0], -offset[1], -step.log2()]
}

/// Color, depth and motion.
struct Atlas([Texture; 3]);

impl Atlas {
    fn new(gpu: &Headless, size: [u32; 2]) -> Self {
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC;
        let formats = [TextureFormat::Rgba32Float, TextureFormat::Depth32Float, TextureFormat::Rg32Float];
        Self(formats.map(|format| gpu.texture(size, 1, format, usage)))
    }
}

fn draw(gpu: &Headless, pipeline: &wgpu::RenderPipeline, atlas: &Atlas, lattices: &Lattices, time: u64) {
    let tan = [0.7, 0.7 * SIZE[1] as f32 / SIZE[0] as f32];
    let views = atlas.0.each_ref().map(|texture| texture.create_view(&Default::default()));
    let target = |view| {
        let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store };
        Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
    };
    let mut encoder = gpu.encoder();
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[target(&views[0]), target(&views[2])],
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &views[1],
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    pass.set_pipeline(pipeline);
    for lattice in lattices.as_slice() {
        let [a, b, c, d, bias] = crop(lattice);
        let words = [a, b, c, d, bias, time as f32, tan[0], tan[1], SIZE[0] as f32, SIZE[1] as f32, 0.0, 0.0];
        let contents = bytemuck::bytes_of(&words);
        let usage = wgpu::BufferUsages::UNIFORM;
        let uniforms = gpu.device.create_buffer_init(&BufferInitDescriptor { label: None, contents, usage });
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: uniforms.as_entire_binding() }],
        });
        let ([x, y], [w, h]) = (lattice.atlas_texel.unwrap_or_default(), lattice.points);
        pass.set_viewport(x as f32, y as f32, w as f32, h as f32, 0.0, 1.0);
        pass.set_scissor_rect(x, y, w, h);
        pass.set_bind_group(0, &group, &[]);
        // An engine draws only what this small view sees: its frustum is the crop's.
        pass.draw(0..4, 0..1);
    }
    drop(pass);
    gpu.submit(encoder);
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Headless::new()?;
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(SHADER.into()),
    });
    let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState { topology: wgpu::PrimitiveTopology::TriangleStrip, ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: TextureFormat::Depth32Float,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            targets: &[Some(TextureFormat::Rgba32Float.into()), Some(TextureFormat::Rg32Float.into())],
        }),
        multiview_mask: None,
        cache: None,
    });

    let foveation = Foveation { filter: Filter::Sparse, rate_mid: 2, rate_far: 4, ..Foveation::default() };
    let desc = ContextDesc {
        settings: Settings { foveation, ..Settings::default() },
        depth: DepthConvention::Reversed { near: NEAR, far: f32::INFINITY },
        ..ContextDesc::new(SIZE)
    };
    let output =
        gpu.texture(SIZE, 1, TextureFormat::Rgba32Float, TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC);
    let mut post = Afterimage::new(&gpu.device, &desc, output.format())?;
    let geometry = ViewGeometry::flat(SIZE, 2.0 * 0.7_f32.atan().to_degrees())?;
    // For the comparison at the end: the same function draws all pixels as one lattice.
    let whole = Lattices::new(&[Lattice::covering(1, [0, 0], SIZE, [0, 0])])?.in_atlas().0;
    let full = Atlas::new(&gpu, SIZE);
    for index in 0..48 {
        let gaze_px = [150.0 + 7.0 * index as f32, 200.0];
        let (lattices, size) = foveation.lattices(&geometry, gaze_px, index).in_atlas();
        // An engine keeps one atlas that is large enough.
        let atlas = Atlas::new(&gpu, size);
        draw(&gpu, &pipeline, &atlas, &lattices, index);
        let [color, depth, motion] = &atlas.0;
        let lattices = Some(lattices.with_geometry_at_samples());
        let views = [ViewFrame { lattices, ..ViewFrame::new(geometry, Gaze::At { px: gaze_px }) }];
        let frame =
            Frame { depth: Some(depth.into()), motion: Some(motion.into()), ..Frame::new(color, &views, index) };
        let mut encoder = gpu.encoder();
        post.record(&gpu.device, &mut encoder, &frame, &output)?;
        gpu.submit(encoder);
        if index % 16 == 15 {
            draw(&gpu, &pipeline, &full, &whole, index);
            let (shown, expected) = (gpu.read(&output, 0), gpu.read(&full.0[0], 0));
            let squares: f32 = shown.iter().zip(&expected).map(|(a, b)| (a[0] - b[0]).powi(2)).sum();
            let share = 100 * size[0] * size[1] / (SIZE[0] * SIZE[1]);
            println!(
                "frame {index}: an atlas of {share} % of the pixels, PSNR {:.1} dB",
                -10.0 * (squares / shown.len() as f32).log10()
            );
        }
    }
    Ok(())
}
