//! The words of both executors, bit for bit, on clips that are damaged here and there; planted errors in the shader.

use super::clips::{Clip, Delivered, Delivery, eye, foveations};
use super::planted::jitter;
use afterimage::internal::{ContextDesc, Reset, Sources, ViewFrame};
use afterimage::shader::SHADERS;
use afterimage::wgpu::{self, BufferUsages, TextureFormat, TextureUsages};
use afterimage::{Exposure, Image, cpu, gpu};
use afterimage_lab::device::Headless;
use afterimage_testing::Draws;

/// A foveated clip of an odd size, with broken pixels, and the levels of detail of each frame.
fn damaged() -> (Delivery, Vec<Image<f32>>) {
    let clip = Clip::open("analytic:occluder", Some([203, 117]), 1, 3);
    let foveation = foveations()[0];
    let mut delivery = Delivery::right(&clip, foveation);
    let mut draws = Draws::new("a damaged clip");
    for frame in &mut delivery.frames {
        for _ in 0..200 {
            let i = (draws.uniform() * frame.color.pixels().len() as f32) as usize;
            let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -3.0, 1e-41][draws.bits() as usize % 6];
            match draws.bits() % 3 {
                0 => frame.color.pixels_mut()[i][1] = bad,
                1 => frame.motion.as_mut().unwrap().pixels_mut()[i][(draws.bits() % 2) as usize] = bad,
                _ => frame.depth.as_mut().unwrap().pixels_mut()[i] = bad,
            }
        }
    }
    let gaze = |i| eye(clip.size(), i, clip.frames.len());
    let lods = (0..clip.frames.len()).map(|i| foveation.lod_map(&clip.geometry, gaze(i))).collect();
    (delivery, lods)
}

/// Optional inputs that a frame has, and the unit of its light, of which its exposure is the inverse.
#[derive(Clone, Copy)]
struct Given {
    depth: bool,
    motion: bool,
    /// Whether vectors are said to lack the camera's motion.
    without_camera: bool,
    lod: bool,
    unit: f32,
}

const ALL: Given = Given { depth: true, motion: true, without_camera: false, lod: true, unit: 1.0 };

impl Given {
    fn lit(&self, color: &Image<[f32; 3]>) -> Image<[f32; 3]> {
        color.map(|c| c.map(|v| v * self.unit))
    }

    /// A jittered view, where the camera's motion is looked for.
    fn seen(&self, view: ViewFrame, index: usize) -> ViewFrame {
        if self.without_camera { ViewFrame { jitter_px: jitter(index), ..view } } else { view }
    }

    fn described(&self, delivery: &Delivery) -> ContextDesc {
        let mut desc = delivery.desc;
        desc.motion.without_camera = self.without_camera;
        desc
    }

    fn exposure(&self) -> Exposure {
        Exposure::Scene { exposure: 1.0 / self.unit }
    }
}

fn on_cpu((delivery, lods): &(Delivery, Vec<Image<f32>>), given: Given) -> Vec<Vec<u32>> {
    let mut doctor = cpu::Doctor::new(&given.described(delivery), 0).unwrap();
    for (i, (f, lod)) in delivery.frames.iter().zip(lods).enumerate() {
        let lit = given.lit(&f.color);
        let (color, views, lod) = ([&lit], [given.seen(f.view, i)], [lod]);
        let (depth, motion) = ([f.depth.as_ref().unwrap()], [f.motion.as_ref().unwrap()]);
        let frame = cpu::Frame {
            depth: given.depth.then_some(&depth[..]),
            motion: given.motion.then_some(&motion[..]),
            lod: given.lod.then_some(&lod[..]),
            reset: if i == 0 { Reset::All } else { Reset::None },
            exposure: given.exposure(),
            ..cpu::Frame::new(&color, &views, i as u64)
        };
        doctor.observe(&frame).unwrap();
    }
    doctor.words().into_iter().map(<[u32]>::to_vec).collect()
}

/// `None`, after a message, without an adapter.
fn on_gpu((delivery, lods): &(Delivery, Vec<Image<f32>>), given: Given, source: &str) -> Option<Vec<Vec<u32>>> {
    let device = Headless::on(afterimage_testing::gpu::adapter()?, wgpu::Limits::default()).unwrap();
    let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    let [color, depth, motion, lod_in] =
        [TextureFormat::Rgba32Float, TextureFormat::R32Float, TextureFormat::Rg32Float, TextureFormat::R32Float]
            .map(|format| device.texture(delivery.desc.size_px, 1, format, usage));
    let mut doctor = afterimage_testing::gpu::validated(&device.device, "new", || {
        let sources = Sources::default().with("doctor_pass", source);
        gpu::Doctor::with_sources(&device.device, &given.described(delivery), 0, &sources).unwrap()
    });
    let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
    let size = doctor.words_bytes();
    let words =
        device.device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false });
    for (i, (Delivered { color: c, depth: d, motion: m, view, .. }, lod)) in
        delivery.frames.iter().zip(lods).enumerate()
    {
        device.write_rgb(&color, 0, &given.lit(c));
        device.write(&depth, 0, d.as_ref().unwrap());
        device.write(&motion, 0, m.as_ref().unwrap());
        device.write(&lod_in, 0, lod);
        let views = [given.seen(*view, i)];
        let frame = gpu::Frame {
            depth: given.depth.then_some((&depth).into()),
            motion: given.motion.then_some((&motion).into()),
            lod: given.lod.then_some((&lod_in).into()),
            reset: if i == 0 { Reset::All } else { Reset::None },
            exposure: given.exposure(),
            ..gpu::Frame::new(&color, &views, i as u64)
        };
        afterimage_testing::gpu::validated(&device.device, "record", || {
            let mut encoder = device.device.create_command_encoder(&Default::default());
            doctor.record(&device.device, &mut encoder, &frame, &words).unwrap();
            device.queue.submit([encoder.finish()]);
        });
        assert!(doctor.read(&afterimage_testing::gpu::read_buffer::<u8>(&device.device, &device.queue, &words)));
    }
    Some(doctor.words().into_iter().map(<[u32]>::to_vec).collect())
}

/// Words that differ, and all.
fn differences(a: &[Vec<u32>], b: &[Vec<u32>]) -> (usize, usize) {
    let pairs = || a.iter().flatten().zip(b.iter().flatten());
    assert_eq!(a.iter().map(Vec::len).collect::<Vec<_>>(), b.iter().map(Vec::len).collect::<Vec<_>>());
    (pairs().filter(|(a, b)| a != b).count(), pairs().count())
}

#[test]
fn words_are_equal_bit_for_bit() {
    let clip = damaged();
    let source = SHADERS.compose("doctor_pass").source;
    let none = Given { depth: false, motion: false, lod: false, unit: 2.0_f32.powi(-10), ..ALL };
    let objects = Given { without_camera: true, ..ALL };
    let camera_alone = Given { motion: false, ..objects };
    for given in
        [ALL, Given { depth: false, ..ALL }, Given { motion: false, unit: 3.0, ..ALL }, none, objects, camera_alone]
    {
        let cpu = on_cpu(&clip, given);
        let Some(gpu) = on_gpu(&clip, given, &source) else { return };
        let (different, all) = differences(&cpu, &gpu);
        assert_eq!(different, 0, "of {all} words");
    }
}

#[test]
fn errors_planted_in_the_shader_are_caught() {
    let clip = damaged();
    let complete = Given { unit: 3.0, ..ALL };
    let of_vectors = [
        ("at.x + moved.x * map.x", "at.x - moved.x * map.x"),
        ("kept_depth(px + vec2u(0u, DEPTH_STEP_PX))", "kept_depth(px)"),
        ("signal(green * frame.exposure)", "signal(green)"),
    ];
    let objects = Given { without_camera: true, ..ALL };
    let of_distances = [
        ("stored * disparity_factor(i)", "stored * disparity_factor(DISTANCES - 1u - i)"),
        ("frame.camera) + frame.jitter_px", "frame.camera)"),
        ("stored <= frame.camera.sky", "stored < 0.0"),
        ("at.y + moved.y * 0.5", "at.y + moved.y"),
    ];
    for (given, planted) in [(complete, &of_vectors[..]), (objects, &of_distances)] {
        let cpu = on_cpu(&clip, given);
        let source = SHADERS.compose("doctor_pass").source;
        afterimage_testing::planted::all_caught_once(source, planted, |source| {
            Some(differences(&cpu, &on_gpu(&clip, given, source)?).0 > 0)
        });
    }
}

#[test]
fn radiance_with_its_exposure_has_the_words_of_exposed_colors() {
    let clip = damaged();
    let words = on_cpu(&clip, ALL);
    // The last one is the planted error: an exposure that rounds.
    for (unit, is_same) in [(2.0_f32.powi(-10), true), (2.0_f32.powi(6), true), (3.0, false)] {
        assert_eq!(on_cpu(&clip, Given { unit, ..ALL }) == words, is_same, "{unit}");
    }
}
