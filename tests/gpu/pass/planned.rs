//! The context for planned frames against the CPU executor, which is told what that context knows by itself: jitter,
//! previous camera, planes, frame index and rates.

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
        let camera = Camera::new(clip_from_view, pose);
        let frame = afterimage::Frame { gaze, is_cut, ..afterimage::Frame::new(&depth, camera) };
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
