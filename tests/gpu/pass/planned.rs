//! The context for planned frames against the CPU executor, and with several views against the full GPU context. These
//! are told what that context knows by itself: jitter, previous cameras, planes, frame index and rates.

use super::rig::{make_texture, noise};
use super::*;
use crate::images::planned;
use afterimage::cpu::CpuAfterimage;
use afterimage::doctor::Fault;
use afterimage::{Camera, Desc, Shading};
use afterimage_testing::gpu::{device, read_buffer, write_layer};
use glam::{Mat4, Quat, Vec3};

const SIZE: [u32; 2] = [48, 34];
const NEAR: f32 = 0.1;

/// Projection and pose in a frame: a walk that turns, and a zoom in frame 9.
fn camera(index: u64) -> [[[f32; 4]; 4]; 2] {
    let time = index as f32;
    let height_rad: f32 = if index < 9 { 0.9 } else { 0.8 };
    let clip_from_view = glam::camera::rh::proj::directx::perspective_infinite_reverse(height_rad, 48.0 / 34.0, NEAR);
    let pose =
        Mat4::from_rotation_translation(Quat::from_rotation_y(0.01 * time), Vec3::new(0.02 * time, 1.6, -0.03 * time));
    [clip_from_view.to_cols_array_2d(), pose.to_cols_array_2d()]
}

fn shading(index: u64) -> Shading {
    match index {
        0..3 => Shading::default(),
        3..7 => Shading::Everywhere { share: 0.05 + 0.1 * index as f32 },
        _ => Shading::Gaze { fovea_deg: 12.0, share: 0.11 },
    }
}

/// The same, as the CPU executor has it.
fn foveation(index: u64) -> Foveation {
    match shading(index) {
        Shading::Everywhere { share } => Foveation::uniform(share),
        Shading::Gaze { fovea_deg, share } => Foveation { fovea_deg, mid_deg: 15.0, ..Foveation::uniform(share) },
    }
}

fn antialiased(foveation: Foveation) -> Settings {
    Settings { method: Method::Smr(Smr { antialias: true, ..Smr::default() }), foveation, ..Settings::default() }
}

/// Depth buffer and colors of a frame.
fn drawn(index: u64) -> (Image<f32>, Image<[f32; 3]>) {
    let depth = Image::from_fn(SIZE, |[x, y]| if (10..25).contains(&x) { 0.04 } else { 0.01 + 1e-4 * y as f32 });
    (depth, noise(SIZE, &format!("planned {}", index / 2)))
}

/// Frames of both, word by word. `wrong`: tells the CPU executor that the camera stands still.
fn differing(wrong: bool) -> Option<usize> {
    let (device, queue) = device()?;
    let motion = MotionConvention { without_camera: true, ..MotionConvention::default() };
    let desc = ContextDesc { motion, settings: antialiased(foveation(0)), ..ContextDesc::new(SIZE) };
    let mut cpu = CpuAfterimage::new(&desc).unwrap();
    let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    let written = TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC;
    let texture = |format, usage| make_texture(&device, &desc, format, usage);
    let [depth, color] = [TextureFormat::R32Float, TextureFormat::Rgba32Float].map(|format| texture(format, read));
    let output = texture(TextureFormat::Rgba32Float, written);
    let mut post = afterimage::Afterimage::new(&device, &Desc::new(SIZE, output.format())).unwrap();
    let mut differing = 0;
    for index in 0..14 {
        let [clip_from_view, pose] = camera(index);
        let [_, previous] = camera(index.saturating_sub(1));
        let is_cut = index == 5;
        let gaze = Gaze::Uv { uv: [0.3, 0.6] };
        let (depths, colors) = drawn(index);

        let view = ViewFrame {
            depth: Some(DepthConvention::Reversed { near: NEAR, far: f32::INFINITY }),
            jitter_px: Foveation::jitter_px(index),
            ..ViewFrame::new(ViewGeometry::from_projection(SIZE, clip_from_view).unwrap(), gaze)
        };
        let views = [view.posed(pose, if wrong { pose } else { previous }).unwrap()];
        cpu.set_settings(antialiased(foveation(index))).unwrap();
        let reset = if is_cut { Reset::All } else { Reset::None };
        let (color_images, depth_images) = ([&colors], [&depths]);
        let frame = afterimage::cpu::Frame {
            depth: Some(&depth_images),
            reset,
            ..afterimage::cpu::Frame::new(&color_images, &views, index)
        };
        let mask = planned(&mut cpu, &frame);
        let mut expected = [Image::filled(SIZE, [f32::NAN; 3])];
        cpu.process(&frame, &mut expected).unwrap();

        post.set_shading(shading(index)).unwrap();
        assert_eq!(post.jitter_px(), views[0].jitter_px);
        write_layer(&queue, &depth, 0, bytemuck::cast_slice(depths.pixels()));
        // What is not planned is never read.
        let given: Vec<[f32; 4]> = (mask[0].pixels().iter().zip(colors.pixels()))
            .map(|(&is_shaded, &[r, g, b])| if is_shaded { [r, g, b, 1.0] } else { [f32::NAN; 4] })
            .collect();
        write_layer(&queue, &color, 0, bytemuck::cast_slice(&given));
        let camera = Camera { gaze, ..Camera::new(clip_from_view, pose) };
        let frame = afterimage::Frame { is_cut, ..afterimage::Frame::new(&depth, camera) };
        if index == 8 {
            // A frame that is planned and given up.
            post.plan(&mut device.create_command_encoder(&Default::default()), &frame).unwrap();
        }
        let mut encoder = device.create_command_encoder(&Default::default());
        let plan = post.plan(&mut encoder, &frame).unwrap();
        post.show(&mut encoder, plan, &color, &output).unwrap();
        queue.submit([encoder.finish()]);
        let shown = read_texture(&device, &queue, &output);
        let shown = shown.chunks_exact(4).map(|texel| [texel[0], texel[1], texel[2]]);
        differing += shown.zip(expected[0].pixels()).filter(|(a, b)| *a != b.map(f32::to_bits)).count();
    }
    Some(differing)
}

#[test]
fn planned_frames_are_those_of_the_cpu() {
    assert!(differing(false).is_none_or(|pixels| pixels == 0), "{:?} pixels differ", differing(false));
}

#[test]
fn a_wrong_camera_of_the_previous_frame_is_caught() {
    assert!(differing(true).is_none_or(|pixels| pixels > 1000), "{:?} pixels differ", differing(true));
}

/// The two eyes of a frame, and what each shows of its lens.
fn eyes(index: u64) -> [Camera; 2] {
    let [clip_from_view, pose] = camera(index);
    [-1.0, 1.0].map(|side: f32| {
        let pose = Mat4::from_cols_array_2d(&pose) * Mat4::from_translation(Vec3::new(0.1 * side, 0.0, 0.0));
        let gaze = Gaze::Uv { uv: [0.5 - 0.2 * side, 0.6] };
        let visible_px = Some([[2.0, 1.0, 8.0, -30.0], [45.0 + side, 32.0, 70.0, 42.0]]);
        Camera { gaze, visible_px, ..Camera::new(clip_from_view, pose.to_cols_array_2d()) }
    })
}

/// Results of frames: pictures, debug views and counters.
type Shown = Vec<[Vec<u32>; 3]>;

/// Two views through the context for planned frames, and through the full one. `is_traced`: noisy frames of single
/// pixels. `plant` changes what the former is told.
fn stereo(is_traced: bool, view: Option<DebugView>, plant: fn(&mut [Camera; 2])) -> Option<[Shown; 2]> {
    let (device, queue) = if view.is_some() { rig::device_of_five_outputs()? } else { device()? };
    let motion = MotionConvention { without_camera: true, ..MotionConvention::default() };
    let shading = Shading::Gaze { fovea_deg: 12.0, share: 0.11 };
    let (is_noisy, single_pixels) = (is_traced, is_traced);
    let door = Desc { view_count: 2, shading, is_noisy, single_pixels, ..Desc::new(SIZE, TextureFormat::Rgba32Float) };
    let smr = if is_noisy { Smr::traced() } else { Smr::default() };
    let method = Method::Smr(Smr { antialias: true, ..smr });
    let quads = foveation(13);
    // The even pattern has one pixel of a quad.
    let budget = if single_pixels { 0.11 - 0.25 / 32.0 } else { quads.budget };
    let foveation = Foveation { budget, single_pixels, ..quads };
    let settings = Settings { method, foveation, noisy: is_noisy, ..Settings::default() };
    let desc = ContextDesc { view_count: 2, motion, keep_alpha: false, settings, ..ContextDesc::new(SIZE) };
    let mut full = Afterimage::new(&device, &desc, door.output).unwrap();
    let mut post = afterimage::Afterimage::new(&device, &door).unwrap();

    let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    let written = TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC;
    let texture = |format, usage| make_texture(&device, &desc, format, usage);
    let [depth, color, mask, noisiness] =
        [TextureFormat::R32Float, TextureFormat::Rgba32Float, TextureFormat::R32Float, TextureFormat::Rg32Float]
            .map(|format| texture(format, read));
    let [output, debug] =
        [TextureFormat::Rgba32Float, TextureFormat::Rgba16Float].map(|format| texture(format, written));
    let counters = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: afterimage::FrameStats::COUNTERS_BYTES,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let target = Target {
        debug: view.map(|view| DebugTarget { view, output: (&debug).into() }),
        counters: Some(&counters),
        ..Target::new(&output)
    };
    let shown = || {
        let [picture, view] = [&output, &debug].map(|texture| read_texture(&device, &queue, texture));
        [picture, view, read_buffer(&device, &queue, &counters)]
    };
    let noise_input = is_noisy.then_some(&noisiness);
    let mut results = [vec![], vec![]];
    for index in 0..10 {
        for view in 0..2 {
            let (depths, _) = drawn(index);
            let colors = noise(SIZE, &format!("stereo {} {view}", index / 2));
            let colors: Vec<[f32; 4]> = colors.pixels().iter().map(|&[r, g, b]| [r, g, b, 1.0]).collect();
            let chosen: Vec<f32> =
                (0..SIZE[0] * SIZE[1]).map(|i| ((i + i / SIZE[0] + index as u32) % 2) as f32).collect();
            write_layer(&queue, &depth, view, bytemuck::cast_slice(depths.pixels()));
            write_layer(&queue, &color, view, bytemuck::cast_slice(&colors));
            write_layer(&queue, &mask, view, bytemuck::cast_slice(&chosen));
            write_layer(&queue, &noisiness, view, bytemuck::cast_slice(&[[0.1_f32, 4.0]; 48 * 34]));
        }
        let is_cut = index == 5;
        // Two frames whose pixels the renderer chooses itself.
        let own = (3..5).contains(&index);

        let before = eyes(index.saturating_sub(1));
        let [left, right] = [0, 1].map(|i| {
            let (now, [clip_from_view, _]) = (eyes(index)[i], camera(index));
            let view = ViewFrame {
                depth: Some(DepthConvention::Reversed { near: NEAR, far: f32::INFINITY }),
                jitter_px: Foveation::jitter_px(index),
                visible_px: now.visible_px,
                ..ViewFrame::new(ViewGeometry::from_projection(SIZE, clip_from_view).unwrap(), now.gaze)
            };
            view.posed(now.world_from_view, before[i].world_from_view).unwrap()
        });
        let views = [left, right];
        let frame = Frame {
            depth: Some((&depth).into()),
            noise: noise_input.map(Into::into),
            mask: own.then_some((&mask).into()),
            reset: if is_cut { Reset::All } else { Reset::None },
            ..Frame::new(&color, &views, index)
        };
        let mut encoder = device.create_command_encoder(&Default::default());
        if !own {
            full.plan(&device, &mut encoder, &frame).unwrap();
        }
        full.record(&device, &mut encoder, &frame, target).unwrap();
        queue.submit([encoder.finish()]);
        results[0].push(shown());

        let mut cameras = eyes(index);
        plant(&mut cameras);
        let [left, right] = cameras;
        let others = &[right];
        let frame = afterimage::Frame { others, is_cut, noise: noise_input, ..afterimage::Frame::new(&depth, left) };
        let mut encoder = device.create_command_encoder(&Default::default());
        let plan = if own { post.given(&frame, &mask) } else { post.plan(&mut encoder, &frame) }.unwrap();
        assert_eq!(plan.lists().len(), 2);
        post.show(&mut encoder, plan, &color, target).unwrap();
        queue.submit([encoder.finish()]);
        results[1].push(shown());
    }
    Some(results)
}

#[test]
fn two_views_are_those_of_the_full_context() {
    for is_traced in [false, true] {
        let Some([expected, found]) = stereo(is_traced, None, |_| {}) else { return };
        assert!(expected.iter().zip(&found).all(|(a, b)| a == b), "traced: {is_traced}");
        // Pictures and counters are not always the same.
        assert!([0, 2].iter().all(|&part| expected.windows(2).any(|pair| pair[0][part] != pair[1][part])));
    }
}

#[test]
fn views_beside_two_views_are_those_of_the_full_context() {
    let Some([expected, found]) = stereo(true, Some(DebugView::Rejection), |_| {}) else { return };
    assert!(expected.iter().zip(&found).all(|(a, b)| a == b));
    // No part of a result is always the same.
    assert!((0..3).all(|part| expected.windows(2).any(|pair| pair[0][part] != pair[1][part])));
}

#[test]
fn swapped_eyes_one_gaze_for_both_and_one_lens_for_both_are_caught() {
    let plants: [fn(&mut [Camera; 2]); 3] = [
        |cameras| cameras.swap(0, 1),
        |cameras| cameras[1].gaze = cameras[0].gaze,
        |cameras| cameras[1].visible_px = cameras[0].visible_px,
    ];
    for plant in plants {
        let Some([expected, found]) = stereo(false, None, plant) else { return };
        assert!(expected.iter().zip(&found).any(|(a, b)| a[0] != b[0]));
    }
}

/// Depths of both eyes after `close`, of which one texture of two layers is given.
#[test]
fn close_leaves_open_what_each_eye_shades() {
    let Some((device, queue)) = device() else { return };
    let desc = ContextDesc { view_count: 2, ..ContextDesc::new(SIZE) };
    let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    let depth = make_texture(&device, &desc, TextureFormat::R32Float, read);
    let attachment = TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC;
    let closed = make_texture(&device, &desc, TextureFormat::Depth32Float, attachment);
    let door = Desc { view_count: 2, shading: shading(13), ..Desc::new(SIZE, TextureFormat::Rgba32Float) };
    let mut post = afterimage::Afterimage::new(&device, &door).unwrap();
    let [left, right] = eyes(0);
    let frame = afterimage::Frame { others: &[right], ..afterimage::Frame::new(&depth, left) };
    let mut encoder = device.create_command_encoder(&Default::default());
    let plan = post.plan(&mut encoder, &frame).unwrap();
    post.close(&mut encoder, &plan, &closed).unwrap();
    queue.submit([encoder.finish()]);
    let (masks, depths) = (read_texture(&device, &queue, plan.mask()), read_texture(&device, &queue, &closed));
    let [width, height] = SIZE.map(|side| side as usize);
    let mut differing = [0; 2];
    for (i, depth) in depths.iter().enumerate() {
        let (view, x, y) = (i / (width * height), i % width, i / width % height);
        let quads = &masks[view * masks.len() / 2..];
        let is_shaded = quads[y / 2 * (width / 2) + x / 2] >> (y % 2 * 2 + x % 2) & 1 == 1;
        // wgpu clears the buffer to 0, far away; the near plane is at 1.
        assert_eq!(f32::from_bits(*depth), if is_shaded { 0.0 } else { 1.0 }, "view {view}, ({x}, {y})");
        differing[usize::from(is_shaded)] += 1;
    }
    assert!(differing[0] > 100 && differing[1] > 100, "{differing:?}");
    assert!(masks[..masks.len() / 2] != masks[masks.len() / 2..]);
}

/// Quarter frames come where nothing is known: at first, and after a change of size that keeps nothing.
#[test]
fn both_eyes_have_quarters_until_history_is_there() {
    let Some((device, queue)) = device() else { return };
    let door = Desc { view_count: 2, draws_quarters: true, ..Desc::new(SIZE, TextureFormat::Rgba32Float) };
    let mut post = afterimage::Afterimage::new(&device, &door).unwrap();
    for (size_px, keeps, begins) in
        [(SIZE, false, true), (SIZE, true, false), ([61, 40], true, false), (SIZE, false, true)]
    {
        let mut encoder = device.create_command_encoder(&Default::default());
        match keeps {
            true => post.resize_keeping_history(&mut encoder, size_px).unwrap(),
            false => post.resize(size_px).unwrap(),
        }
        assert_eq!(post.desc().size_px, size_px);
        let whole = ContextDesc { view_count: 2, ..ContextDesc::new(size_px) };
        let small = ContextDesc { size_px: size_px.map(|side| side.div_ceil(2)), ..whole };
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::STORAGE_BINDING;
        let color = |desc| make_texture(&device, desc, TextureFormat::Rgba32Float, usage);
        let depth = make_texture(&device, &whole, TextureFormat::R32Float, usage);
        let [left, right] = eyes(0).map(|eye| Camera { visible_px: None, ..eye });
        // The right eye's projection is off its axis.
        let mut clip_from_view = right.clip_from_view;
        clip_from_view[2][0] = 0.2;
        let right = Camera { clip_from_view, ..right };
        let frame = afterimage::Frame { others: &[right], ..afterimage::Frame::new(&depth, left) };
        let plan = post.plan(&mut encoder, &frame).unwrap();
        let quarters = plan.quarters().to_vec();
        assert_eq!(quarters.len(), if begins { 2 } else { 0 }, "{size_px:?}, keeps: {keeps}");
        if let [left, right] = quarters[..] {
            assert_eq!([left.size_px, right.size_px], [small.size_px; 2]);
            let moved = right.clip_from_view[2][0] - left.clip_from_view[2][0];
            let scale = right.clip_from_view[0][0] / clip_from_view[0][0] as f32;
            assert!((moved - 0.2 * scale).abs() < 1e-5, "{moved}");
            post.show_quarter(&mut encoder, plan, [&color(&whole), &color(&small)], &color(&whole)).unwrap();
        } else {
            post.show(&mut encoder, plan, &color(&whole), &color(&whole)).unwrap();
        }
        queue.submit([encoder.finish()]);
    }
}

/// Share of the pixels that the tenth frame shades.
fn share_of(single_pixels: bool, share: f32) -> Option<f32> {
    let (device, queue) = device()?;
    let desc = ContextDesc::new(SIZE);
    let texture = |format, usage| make_texture(&device, &desc, format, usage);
    let depth = texture(TextureFormat::R32Float, TextureUsages::TEXTURE_BINDING);
    let color = texture(TextureFormat::Rgba32Float, TextureUsages::TEXTURE_BINDING);
    let output = texture(TextureFormat::Rgba32Float, TextureUsages::STORAGE_BINDING);
    let door = Desc { shading: Shading::Everywhere { share }, single_pixels, ..Desc::new(SIZE, output.format()) };
    let mut post = afterimage::Afterimage::new(&device, &door).unwrap();
    let [clip_from_view, pose] = camera(0);
    let frame = afterimage::Frame::new(&depth, Camera::new(clip_from_view, pose));
    let mut mask = vec![];
    for _ in 0..10 {
        let mut encoder = device.create_command_encoder(&Default::default());
        let plan = post.plan(&mut encoder, &frame).unwrap();
        let texture = plan.mask().clone();
        post.show(&mut encoder, plan, &color, &output).unwrap();
        queue.submit([encoder.finish()]);
        mask = read_texture(&device, &queue, &texture);
    }
    let shaded: u32 = mask.iter().map(|quad| (quad & 15).count_ones()).sum();
    assert!(!single_pixels || mask.iter().all(|quad| (quad & 15).count_ones() <= 1));
    Some(shaded as f32 / (SIZE[0] * SIZE[1]) as f32)
}

#[test]
fn quads_and_single_pixels_have_the_same_share() {
    for (single_pixels, share) in [(false, 0.25), (true, 0.25), (false, 0.1), (true, 0.1)] {
        let Some(found) = share_of(single_pixels, share) else { return };
        assert!((found - share).abs() < 0.02, "{found} of {share}, single pixels: {single_pixels}");
    }
}

#[test]
fn wrong_calls_are_refused_in_one_line() {
    let Some((device, _queue)) = device() else { return };
    let desc = ContextDesc::new(SIZE);
    let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::STORAGE_BINDING;
    let texture = |format| make_texture(&device, &desc, format, usage);
    let [depth, color, output] =
        [TextureFormat::R32Float, TextureFormat::Rgba32Float, TextureFormat::Rgba32Float].map(texture);
    let mut post = afterimage::Afterimage::new(&device, &Desc::new(SIZE, output.format())).unwrap();
    let mut encoder = device.create_command_encoder(&Default::default());
    let [clip_from_view, pose] = camera(0);
    let frame = afterimage::Frame::new(&depth, Camera::new(clip_from_view, pose));
    let refused = |result: Result<String, FrameError>, words: &str| {
        let error = result.expect_err("refused").to_string();
        assert!(error.contains(words) && !error.contains('\n'), "{error}");
    };
    let given = afterimage::Frame { motion: Some(&color), ..frame };
    refused(post.plan(&mut encoder, &given).map(|_| String::new()), "Desc::motion");
    let transposed = Mat4::from_cols_array_2d(&clip_from_view).transpose().to_cols_array_2d();
    let turned = afterimage::Frame { camera: Camera::new(transposed, pose), ..frame };
    refused(post.plan(&mut encoder, &turned).map(|_| String::new()), "transpose");
    let both = afterimage::Frame { others: &[frame.camera], ..frame };
    refused(post.plan(&mut encoder, &both).map(|_| String::new()), "2 views given: expected 1");
    refused(post.given(&both, &depth).map(|_| String::new()), "2 views given: expected 1");
    let mut stereo =
        afterimage::Afterimage::new(&device, &Desc { view_count: 2, ..Desc::new(SIZE, output.format()) }).unwrap();
    refused(stereo.plan(&mut encoder, &frame).map(|_| String::new()), "1 views given: expected 2");
    refused(stereo.plan(&mut encoder, &both).map(|_| String::new()), "one array layer for each view");
    let many = Desc { view_count: 5, ..Desc::new(SIZE, output.format()) };
    let error = afterimage::Afterimage::new(&device, &many).unwrap_err().to_string();
    assert!(error.contains("at most 4 views"), "{error}");
    let noisy = afterimage::Frame { noise: Some(&color), ..frame };
    let plan = post.plan(&mut encoder, &noisy).unwrap();
    refused(post.show(&mut encoder, plan, &color, &output).map(|_| String::new()), "noise");
    let plan = post.plan(&mut encoder, &frame).unwrap();
    refused(post.close(&mut encoder, &plan, &depth).map(|()| String::new()), "a depth format");
    let [first, second] = [(); 2].map(|()| post.plan(&mut encoder, &frame).unwrap());
    post.show(&mut encoder, second, &color, &output).unwrap();
    refused(post.show(&mut encoder, first, &color, &output).map(|_| String::new()), "the last plan");
    let plan = post.plan(&mut encoder, &frame).unwrap();
    refused(post.show_quarter(&mut encoder, plan, [&color; 2], &output).map(|_| String::new()), "no quarter");
    let error = post.set_shading(Shading::Everywhere { share: f32::NAN }).unwrap_err().to_string();
    assert!(error.contains("share is NaN"), "{error}");
    assert_eq!(post.desc().shading, Shading::default());
}

#[test]
fn the_doctor_finds_vectors_without_the_camera_and_names_the_line_of_planned_frames() {
    let Some((device, queue)) = device() else { return };
    const WIDE: [u32; 2] = [160, 96];
    let context = ContextDesc::new(WIDE);
    let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::STORAGE_BINDING | TextureUsages::COPY_DST;
    let texture = |format| make_texture(&device, &context, format, usage);
    let [depth, color, motion] =
        [TextureFormat::R32Float, TextureFormat::Rgba32Float, TextureFormat::Rg32Float].map(texture);
    write_layer(&queue, &depth, 0, bytemuck::cast_slice(&[0.02_f32; 160 * 96]));
    write_layer(&queue, &motion, 0, bytemuck::cast_slice(&[[0.0_f32; 2]; 160 * 96]));
    let found = |without_camera: bool| {
        let convention = MotionConvention { without_camera, ..MotionConvention::BEVY };
        let desc = Desc { motion: Some(convention), ..Desc::new(WIDE, TextureFormat::Rgba32Float) };
        let mut post = afterimage::Afterimage::new(&device, &desc).unwrap();
        let mut doctor = post.doctor().unwrap();
        let words = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: doctor.words_bytes(),
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        for index in 0..4 {
            let [clip_from_view, _] = camera(0);
            let pose = Mat4::from_translation(Vec3::new(0.2 * index as f32, 0.0, 0.0)).to_cols_array_2d();
            let frame = afterimage::Frame {
                motion: Some(&motion),
                ..afterimage::Frame::new(&depth, Camera::new(clip_from_view, pose))
            };
            let mut encoder = device.create_command_encoder(&Default::default());
            let plan = post.plan(&mut encoder, &frame).unwrap();
            post.examine(&mut encoder, &mut doctor, &plan, &color, &words).unwrap();
            let output = texture(TextureFormat::Rgba32Float);
            post.show(&mut encoder, plan, &color, &output).unwrap();
            queue.submit([encoder.finish()]);
            assert!(doctor.read(&read_buffer::<u8>(&device, &queue, &words)));
        }
        doctor.findings().remove(0)
    };
    let finding = found(false);
    assert_eq!(finding.fault(), Some(Fault::MotionCamera), "{finding}");
    assert!(finding.mend.unwrap().starts_with("desc.motion = Some(MotionConvention { without_camera: true, .."));
    let right = found(true);
    assert_eq!(right.fault(), None, "{right}");
}
