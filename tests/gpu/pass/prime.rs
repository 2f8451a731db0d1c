//! Depth and stencil buffers that are closed where a plan shades nothing, of every format, direction and number of
//! samples: what is then drawn over the whole target appears at chosen quads, and beside the view.

use super::rig::make_layers;
use super::sparse::SIZE;
use super::*;
use crate::images::pixels;
use afterimage::wgpu::CompareFunction;

const ORIGIN_PX: [u32; 2] = [3, 5];
const TARGET: [u32; 2] = [SIZE[0] + 9, SIZE[1] + 6];
const COLOR: TextureFormat = TextureFormat::Rgba8Unorm;
/// Depth of the prepass, and of what is drawn.
const DEPTH: f32 = 0.5;

/// A target: its format, number of samples, depth of the near plane, and stencil.
type Case = (TextureFormat, u32, f32, Option<u8>);

fn cases() -> Vec<Case> {
    use TextureFormat::{Depth16Unorm, Depth24Plus, Depth24PlusStencil8, Depth32Float};
    let depths = [Depth16Unorm, Depth24Plus, Depth24PlusStencil8, Depth32Float];
    let of = |format| [1, 4].into_iter().flat_map(move |n| [0.0, 1.0].map(|near| (format, n, near, None)));
    let stencils = [1, 4].map(|n| (Depth24PlusStencil8, n, 0.0, Some(7)));
    depths.into_iter().flat_map(of).chain(stencils).collect()
}

fn texture(device: &Device, [w, h]: [u32; 2], format: TextureFormat, samples: u32, usage: TextureUsages) -> Texture {
    make_layers(device, [w, h, 1], samples, format, usage)
}

/// A pipeline that draws white over the whole target, at the depth of the prepass.
fn white(device: &Device, (format, samples, near, stencil): Case) -> wgpu::RenderPipeline {
    let source = "@vertex fn v(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
            return vec4f(4.0 * vec2f(f32(i & 1u), f32(i >> 1u)) - 1.0, 0.5, 1.0);
        }
        @fragment fn f() -> @location(0) vec4f { return vec4f(1.0); }";
    let source = wgpu::ShaderSource::Wgsl(source.into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let face = wgpu::StencilFaceState {
        compare: if stencil.is_some() { CompareFunction::Equal } else { CompareFunction::Always },
        ..wgpu::StencilFaceState::IGNORE
    };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format,
            depth_write_enabled: Some(true),
            depth_compare: Some(if near > DEPTH { CompareFunction::GreaterEqual } else { CompareFunction::LessEqual }),
            stencil: wgpu::StencilState { front: face, back: face, read_mask: 0xff, write_mask: 0 },
            bias: Default::default(),
        }),
        multisample: wgpu::MultisampleState { count: samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            targets: &[Some(COLOR.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// A context with one view, its frame's color, and the view.
struct Planned {
    post: Afterimage,
    color: Texture,
    views: [ViewFrame; 1],
}

impl Planned {
    fn new(device: &Device) -> Self {
        let foveation = Foveation { fovea_deg: 12.0, mid_deg: 30.0, ..Foveation::quads() };
        let desc = ContextDesc { settings: Settings { foveation, ..Settings::default() }, ..ContextDesc::new(SIZE) };
        let post = Afterimage::new(device, &desc, TextureFormat::Rgba32Float).unwrap();
        let color = texture(device, SIZE, TextureFormat::Rgba16Float, 1, Afterimage::INPUT_USAGE);
        let geometry = ViewGeometry::flat(SIZE, 70.0).unwrap();
        Self { post, color, views: [ViewFrame::new(geometry, Gaze::At { px: [20.0, 15.0] })] }
    }

    fn plan(&mut self, device: &Device, encoder: &mut wgpu::CommandEncoder) {
        self.post.plan(device, encoder, &Frame::new(&self.color, &self.views, 3)).unwrap();
    }
}

/// What is there at the start of a pass: what was there, or a value.
fn begun<T>(is_kept: bool, value: T) -> wgpu::Operations<T> {
    let load = if is_kept { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(value) };
    wgpu::Operations { load, store: wgpu::StoreOp::Store }
}

/// Which pixels of the target are drawn, and which should be.
fn drawn(device: &Device, queue: &Queue, case: Case, is_half: bool) -> [Vec<bool>; 2] {
    let (format, samples, near_depth, stencil) = case;
    let mut planned = Planned::new(device);
    let attachment = TextureUsages::RENDER_ATTACHMENT;
    let depth = texture(device, TARGET, format, samples, attachment);
    let many = texture(device, TARGET, COLOR, samples, attachment | TextureUsages::COPY_SRC);
    let one = texture(device, TARGET, COLOR, 1, attachment | TextureUsages::COPY_SRC);
    let [depth_view, many_view, one_view] = [&depth, &many, &one].map(|t| t.create_view(&Default::default()));
    let white = white(device, case);
    let mut encoder = device.create_command_encoder(&Default::default());
    planned.plan(device, &mut encoder);
    for is_draw in [false, true] {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: if samples > 1 { &many_view } else { &one_view },
                depth_slice: None,
                resolve_target: (samples > 1).then_some(&one_view),
                ops: begun(false, wgpu::Color::BLACK),
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth_view,
                depth_ops: Some(begun(is_draw, DEPTH)),
                stencil_ops: format.has_stencil_aspect().then(|| begun(is_draw, 0)),
            }),
            ..Default::default()
        });
        if is_draw {
            pass.set_pipeline(&white);
            pass.draw(0..3, 0..1);
        }
        drop(pass);
        if !is_draw {
            let prime = Prime { target: &depth_view, origin_px: ORIGIN_PX, near_depth, stencil, is_half };
            planned.post.prime(device, &mut encoder, 0, &prime).unwrap();
        }
    }
    queue.submit([encoder.finish()]);
    let mask = read_texture(device, queue, planned.post.quad_mask().unwrap());
    let expected = pixels(TARGET).map(|px| {
        // Beyond the view where they wrap.
        let [x, y] = [0, 1].map(|i| px[i].wrapping_sub(ORIGIN_PX[i]));
        let word = |[x, y]: [u32; 2]| mask[((y / 2) * SIZE[0].div_ceil(2) + x / 2) as usize];
        let is_open = |px: [u32; 2]| {
            let pixels = word(px) & 15;
            pixels >> (px[0] % 2 + 2 * (px[1] % 2)) & 1 == 1 && (!is_half || pixels == 15)
        };
        x >= SIZE[0] || y >= SIZE[1] || is_open([x, y])
    });
    let drawn = read_texture(device, queue, &one);
    let shown = drawn.iter().map(|&word| word & 0xff == 0xff);
    [shown.collect(), expected.collect()]
}

#[test]
fn what_is_drawn_appears_at_chosen_quads_alone() {
    let Some((device, queue)) = afterimage_testing::gpu::device() else { return };
    // The plan is that of a first frame.
    for (case, is_half) in cases().into_iter().flat_map(|case| [false, true].map(|is_half| (case, is_half))) {
        let [shown, expected] = drawn(&device, &queue, case, is_half);
        let count = expected.iter().filter(|&&is| is).count();
        println!("{case:?}, half {is_half}: {count} of {} pixels", expected.len());
        assert!(count > 600 && count < expected.len() - 700, "{count}");
        assert!(shown == expected, "{case:?}, half {is_half}");
    }
}

#[test]
fn targets_that_do_not_fit_are_refused() {
    let Some((device, _queue)) = afterimage_testing::gpu::device() else { return };
    let mut planned = Planned::new(&device);
    let mut encoder = device.create_command_encoder(&Default::default());
    let attachment = TextureUsages::RENDER_ATTACHMENT;
    let view = |size, format, usage| texture(&device, size, format, 1, usage).create_view(&Default::default());
    let target = view(TARGET, TextureFormat::Depth32Float, attachment);
    let right = Prime { target: &target, origin_px: ORIGIN_PX, near_depth: 0.0, stencil: None, is_half: false };
    let mut message = |planned: &mut Planned, view, prime: &Prime<'_>| {
        let error: FrameError = planned.post.prime(&device, &mut encoder, view, prime).unwrap_err();
        error.to_string()
    };
    let missing = "plan of view 0 is missing: expected a plan of the same frame before prime";
    assert_eq!(message(&mut planned, 0, &right), missing);
    let mut planning = device.create_command_encoder(&Default::default());
    planned.plan(&device, &mut planning);
    assert!(message(&mut planned, 1, &right).starts_with("plan of view 1 is missing"));
    assert_eq!(
        message(&mut planned, 0, &Prime { stencil: Some(1), ..right }),
        "target of prime is a texture of format Depth32Float, usage TextureUsages(RENDER_ATTACHMENT): \
         expected a format with a stencil"
    );
    let color = view(TARGET, COLOR, attachment);
    assert!(planned.post.prewarm_prime(&device, &Prime { target: &color, ..right }).is_err());
    assert!(message(&mut planned, 0, &Prime { target: &color, ..right }).ends_with("expected a depth format"));
    let read = view(TARGET, TextureFormat::Depth32Float, TextureUsages::TEXTURE_BINDING);
    assert!(message(&mut planned, 0, &Prime { target: &read, ..right }).ends_with("the usage RENDER_ATTACHMENT"));
    for near_depth in [-0.5, 2.0, f32::NAN] {
        let found = message(&mut planned, 0, &Prime { near_depth, ..right });
        assert!(found.ends_with("expected near_depth from 0 to 1"), "{found}");
    }
    for origin_px in [[10, 5], [u32::MAX, 0]] {
        let found = message(&mut planned, 0, &Prime { origin_px, ..right });
        assert!(found.ends_with("expected a target that contains the view"), "{found}");
    }
}
