//! Textures and render passes of planned frames.

use super::*;
use afterimage::wgpu::{Color, CompareFunction, RenderPass, RenderPipeline};
use afterimage::{Afterimage, Camera, Desc, Targets};
use afterimage_testing::gpu::device;

const SIZE: [u32; 2] = [48, 34];
const COLOR: TextureFormat = TextureFormat::Rgba32Float;
const POSE: [[f32; 4]; 4] = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// A triangle over the whole view, at one depth between the planes of both directions, white.
const SHADER: &str = "
@vertex fn vertex(@builtin(vertex_index) i: u32) -> @invariant @builtin(position) vec4f {
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}
@fragment fn fragment() -> @location(0) vec4f { return vec4f(1.0); }";

/// The projection of a depth buffer, reversed or not, with a far plane at infinity.
fn camera(is_reversed: bool) -> Camera {
    let (scale, offset) = if is_reversed { (0.0, 0.1) } else { (-1.0, -0.1) };
    let clip_from_view = [[1.4, 0.0, 0.0, 0.0], [0.0, 2.0, 0.0, 0.0], [0.0, 0.0, scale, -1.0], [0.0, 0.0, offset, 0.0]];
    Camera::new(clip_from_view, POSE)
}

fn pipeline(device: &Device, target: Option<TextureFormat>, is_reversed: bool, writes_depth: bool) -> RenderPipeline {
    let source = wgpu::ShaderSource::Wgsl(SHADER.into());
    let module = &device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let targets = [target.map(Into::into)];
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState { module, entry_point: None, compilation_options: Default::default(), buffers: &[] },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: Targets::DEPTH,
            depth_write_enabled: Some(writes_depth),
            depth_compare: Some(match is_reversed {
                true => CompareFunction::GreaterEqual,
                false => CompareFunction::LessEqual,
            }),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: target.map(|_| wgpu::FragmentState {
            module,
            entry_point: None,
            compilation_options: Default::default(),
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}

fn draw(mut pass: RenderPass<'_>, pipeline: &RenderPipeline) {
    pass.set_pipeline(pipeline);
    pass.draw(0..3, 0..1);
}

/// Whether each pixel of both views is as bright as the triangle.
fn white(texels: &[u32]) -> Vec<bool> {
    texels.chunks_exact(4).map(|texel| f32::from_bits(texel[0]) == 1.0).collect()
}

/// Whether each pixel of both views is planned.
fn planned_pixels(mask: &[u32]) -> Vec<bool> {
    let [width, height] = SIZE.map(|side| side as usize);
    let is_planned = |view: usize, x: usize, y: usize| {
        let quad = (view * height / 2 + y / 2) * (width / 2) + x / 2;
        mask[quad] >> (y % 2 * 2 + x % 2) & 1 == 1
    };
    (0..2 * width * height).map(|i| is_planned(i / (width * height), i % width, i / width % height)).collect()
}

#[test]
fn planned_pixels_alone_are_drawn_in_both_directions_of_depth() {
    let Some((device, queue)) = device() else { return };
    for is_reversed in [true, false] {
        for motion in [None, Some(MotionConvention::BEVY)] {
            let desc = Desc { view_count: 2, motion, ..Desc::new(SIZE, COLOR) };
            let mut post = Afterimage::new(&device, &desc).unwrap();
            let targets = Targets::new(&device, &desc, COLOR);
            let vectors = motion.map(|_| Targets::MOTION);
            let [prepass, colors] = [(vectors, true), (Some(COLOR), false)]
                .map(|(target, writes_depth)| pipeline(&device, target, is_reversed, writes_depth));
            let camera = camera(is_reversed);
            for index in 0..3 {
                let mut encoder = device.create_command_encoder(&Default::default());
                for view in 0..2 {
                    draw(targets.prepass(&mut encoder, view, &camera), &prepass);
                }
                let frame = afterimage::Frame { others: &[camera], ..targets.frame(camera) };
                let plan = post.plan(&mut encoder, &frame).unwrap();
                targets.close(&mut encoder, &mut post, &plan).unwrap();
                for view in 0..2 {
                    draw(targets.color_pass(&mut encoder, view, Color::TRANSPARENT), &colors);
                }
                let mask = plan.mask().clone();
                post.show(&mut encoder, plan, &targets.color, &targets.output).unwrap();
                queue.submit([encoder.finish()]);
                let found = white(&read_texture(&device, &queue, &targets.color));
                let expected = planned_pixels(&read_texture(&device, &queue, &mask));
                assert!(found == expected, "frame {index}, reversed: {is_reversed}, {motion:?}");
                let share = found.iter().filter(|is_white| **is_white).count() as f32 / found.len() as f32;
                assert!(index == 0 || share < 0.3, "{share}");
            }
        }
    }
}

#[test]
fn depth_is_cleared_to_the_far_plane_and_open_depth_and_the_output_take_every_pixel() {
    let Some((device, queue)) = device() else { return };
    for is_reversed in [true, false] {
        let desc = Desc { view_count: 2, ..Desc::new(SIZE, COLOR) };
        let targets = Targets::new(&device, &desc, COLOR);
        let colors = pipeline(&device, Some(COLOR), is_reversed, false);
        let mut encoder = device.create_command_encoder(&Default::default());
        for view in 0..2 {
            drop(targets.prepass(&mut encoder, view, &camera(is_reversed)));
        }
        targets.open(&mut encoder);
        // The second view alone: the first one keeps what it has.
        draw(targets.color_pass(&mut encoder, 1, Color::TRANSPARENT), &colors);
        draw(targets.output_pass(&mut encoder, 1), &colors);
        queue.submit([encoder.finish()]);
        let far = if is_reversed { 0.0_f32 } else { 1.0 };
        assert!(read_texture(&device, &queue, &targets.depth).iter().all(|depth| *depth == far.to_bits()));
        for texture in [&targets.color, &targets.output] {
            let found = white(&read_texture(&device, &queue, texture));
            let (first, second) = found.split_at(found.len() / 2);
            assert!(!first.contains(&true) && !second.contains(&false), "reversed: {is_reversed}");
        }
    }
}

#[test]
fn formats_that_cannot_be_drawn_to_make_targets_too() {
    let (device, _queue) = Device::noop(&wgpu::DeviceDescriptor::default());
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let targets = Targets::new(&device, &Desc::new(SIZE, TextureFormat::Rgba8Snorm), COLOR);
    assert!(pollster::block_on(scope.pop()).is_none());
    assert!(targets.motion.is_none() && targets.output.format() == TextureFormat::Rgba8Snorm);
}
