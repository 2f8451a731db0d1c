//! Several frames in one submission, lost gazes, formats, errors.

use super::rig::*;
use afterimage::internal::{Foveation, FoveationKind, GpuSimulator, SimulatorFrame};
use afterimage::wgpu::{self, TextureFormat, TextureUsages};
use afterimage::{CreateError, FrameError, Gaze, ViewGeometry};
use afterimage_testing::agree;

const SIZE: [u32; 2] = [97, 61];

#[test]
fn frames_of_one_submission_see_their_own_gaze() {
    for filter in [FoveationKind::Mip, FoveationKind::Gauss, FoveationKind::Block] {
        let foveation = foveation(filter, [4, 16]);
        let Some(mut rig) = Rig::new(&desc(SIZE, 1, foveation)) else { return };
        let written = TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC;
        let image = nasty(SIZE, "twice");
        rig.upload(std::slice::from_ref(&image));
        let mut encoder = rig.device.create_command_encoder(&Default::default());
        let scenes = [[10.0, 10.0], [80.0, 50.0]].map(|gaze| Scene::mono(image.clone(), gaze));
        let shown = scenes.each_ref().map(|scene| {
            let output = texture(&rig.device, rig.post.desc(), TextureFormat::Rgba32Float, written);
            rig.post.record(&rig.device, &mut encoder, &SimulatorFrame::new(&rig.full, &output, &scene.views)).unwrap();
            output
        });
        rig.queue.submit([encoder.finish()]);
        for (scene, output) in scenes.iter().zip(&shown) {
            let words = afterimage_testing::gpu::read_texture(&rig.device, &rig.queue, output);
            let got: Vec<[u32; 3]> = words.chunks_exact(4).map(|c| [c[0], c[1], c[2]]).collect();
            assert_eq!(agree::colors(&got, &scene.on_cpu(&foveation).shown), Ok(()), "{filter:?}");
        }
    }
}

#[test]
fn a_lost_gaze_is_held() {
    let foveation = foveation(FoveationKind::Mip, [4, 16]);
    let Some(mut rig) = Rig::new(&desc(SIZE, 1, foveation)) else { return };
    let mut scene = Scene::mono(nasty(SIZE, "lost"), [48.0, 30.0]);
    let middle = scene.on_cpu(&foveation);
    scene.views[0].gaze = Gaze::Lost;
    assert_eq!(rig.on_gpu(&scene).agrees(&middle), Ok(()), "lost from the start: the middle");
    scene.views[0].gaze = Gaze::At { px: [10.0, 50.0] };
    let seen = rig.on_gpu(&scene);
    assert!(seen != middle);
    scene.views[0].gaze = Gaze::At { px: [f32::NAN, 0.0] };
    assert_eq!(rig.on_gpu(&scene).agrees(&seen), Ok(()), "held");
}

#[test]
fn what_does_not_fit_is_refused_and_nothing_recorded() {
    let (device, _queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    let base = desc(SIZE, 1, Foveation::default());
    let bad = GpuSimulator::new(&device, &base, TextureFormat::Bgra8Unorm);
    assert!(matches!(bad, Err(CreateError::OutputFormat { .. })));
    let bad = desc(SIZE, 1, Foveation { rate_far: 3, ..Foveation::default() });
    assert!(matches!(GpuSimulator::new(&device, &bad, FORMAT), Err(CreateError::Settings(_))));
    let bad = desc(SIZE, 5, Foveation::default());
    assert!(GpuSimulator::new(&device, &bad, FORMAT).unwrap_err().to_string().contains("at most 4 views"));

    let mut post = GpuSimulator::new(&device, &base, FORMAT).unwrap();
    let (read, written) = (TextureUsages::TEXTURE_BINDING, TextureUsages::STORAGE_BINDING);
    let context = base;
    let full = texture(&device, &context, TextureFormat::Rgba16Float, read);
    let output = texture(&device, &context, TextureFormat::Rgba32Float, written);
    let half = texture(&device, &context, TextureFormat::Rgba16Float, written | read);
    let lod = texture(&device, &context, TextureFormat::R32Float, written);
    let scalar = texture(&device, &context, TextureFormat::R32Float, read);
    let larger = texture(&device, &desc([98, 61], 1, Foveation::default()), TextureFormat::Rgba16Float, read);
    let views = [looking(ViewGeometry::flat(SIZE, 70.0).unwrap(), [0.0, 0.0])];
    let other = [looking(ViewGeometry::flat([98, 61], 70.0).unwrap(), [0.0, 0.0])];
    let good = SimulatorFrame { lod: Some(&lod), ..SimulatorFrame::new(&full, &output, &views) };
    let mut encoder = device.create_command_encoder(&Default::default());
    let mut refused = |frame: SimulatorFrame<'_>| post.record(&device, &mut encoder, &frame).unwrap_err();
    assert!(matches!(refused(SimulatorFrame { views: &[], ..good }), FrameError::ViewCount { .. }));
    assert!(matches!(refused(SimulatorFrame { views: &other, ..good }), FrameError::Size { .. }));
    assert!(matches!(refused(SimulatorFrame { full: &larger, ..good }), FrameError::Size { .. }));
    for (frame, words) in [
        (SimulatorFrame { full: &scalar, ..good }, "the full-rate frame is a texture of format R32Float"),
        (SimulatorFrame { full: &output, ..good }, "TEXTURE_BINDING"),
        (SimulatorFrame { output: &half, ..good }, "output is a texture of format Rgba16Float, the wrong format"),
        (SimulatorFrame { lod: Some(&scalar), ..good }, "STORAGE_BINDING"),
        (SimulatorFrame { lod: Some(&half), ..good }, "levels of detail is a texture of format Rgba16Float"),
    ] {
        let message = refused(frame).to_string();
        assert!(message.contains(words), "{message}");
    }
    post.record(&device, &mut encoder, &good).unwrap();
}
