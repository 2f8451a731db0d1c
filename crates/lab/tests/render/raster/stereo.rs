//! Two eyes with a gaze each: their lattices in an atlas an eye, both views in one context.

use super::foveated::{Rig, noise};
use crate::given::device;
use afterimage::gpu::{Afterimage, Frame, Region, Textures};
use afterimage::wgpu::{TextureFormat, TextureUsages};
use afterimage::{
    ContextDesc, DepthConvention, Filter, Foveation, Gaze, Image, MethodKind, Settings, ViewFrame, ViewGeometry,
};
use afterimage_lab::raster::{AtlasLayout, FoveatedTargets, PixelSamples};
use afterimage_lab::trace::view::View;
use glam::{DMat4, DVec3};

const SIZE: [u32; 2] = [160, 120];
const FRAMES: u64 = 5;

/// The eye's view in frame `index`: 64 mm apart, with a wider field of view on the outer side.
fn eye(eye: usize, index: u64) -> View {
    let tan_x = [[-1.2, 0.9], [-0.9, 1.2]][eye];
    let at = DVec3::new([-0.032, 0.032][eye] + 0.05 * index as f64, 1.6, 5.0);
    let world_from_camera = DMat4::from_translation(at) * DMat4::from_rotation_y(0.01 * index as f64);
    View::new(ViewGeometry::off_axis(SIZE, tan_x, [-0.8, 0.8]).unwrap(), world_from_camera)
}

/// Frames of these eyes, as `method` shows them in one context with a view an eye. `gaze_of`: the eye whose gaze each
/// eye has.
fn shown(rig: &mut Rig, eyes: &[usize], method: MethodKind, gaze_of: [usize; 2]) -> Vec<Image<[f32; 3]>> {
    let gpu = rig.device.clone();
    let foveation = Foveation { filter: Filter::Sparse, rate_mid: 2, rate_far: 4, ..Foveation::default() };
    let desc = ContextDesc {
        view_count: eyes.len() as u32,
        settings: Settings { method: method.into(), foveation, ..Settings::default() },
        depth: DepthConvention::Reversed { near: rig.raster.near(), far: f32::INFINITY },
        ..ContextDesc::new(SIZE)
    };
    let usage = TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC;
    let output = gpu.texture(SIZE, eyes.len() as u32, TextureFormat::Rgba32Float, usage);
    let mut post = Afterimage::new(&gpu.device, &desc, output.format()).unwrap();
    for index in 0..FRAMES {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut drawn = vec![];
        for &i in eyes {
            let (now, before) = (eye(i, index), eye(i, index.saturating_sub(1)));
            let gaze_px = [[60.0 + 8.0 * index as f32, 50.0], [90.0, 70.0 - 5.0 * index as f32]][gaze_of[i]];
            let lattices = foveation.lattices(now.geometry(), gaze_px, index);
            let (lattices, size) = AtlasLayout::Compact.place(&lattices, SIZE);
            let targets = FoveatedTargets::new(&gpu.device, size);
            rig.raster.record_foveated(
                &gpu.device,
                &mut encoder,
                [&now, &before],
                (&lattices, PixelSamples::Four),
                &targets,
            );
            let view = ViewFrame {
                lattices: Some(lattices.with_geometry_at_samples()),
                previous_from_current: Some(now.previous_from_current(&before)),
                ..ViewFrame::new(*now.geometry(), Gaze::At { px: gaze_px })
            };
            drawn.push((targets, view));
        }
        // One region an eye: the eye's own atlas.
        let colors: Vec<_> = drawn.iter().map(|(targets, _)| Region::new(&targets.atlas.color, [0, 0])).collect();
        let depths: Vec<_> = drawn.iter().map(|(targets, _)| Region::new(&targets.atlas.depth, [0, 0])).collect();
        let motions: Vec<_> = drawn.iter().map(|(targets, _)| Region::new(&targets.atlas.motion, [0, 0])).collect();
        let views: Vec<_> = drawn.iter().map(|(_, view)| *view).collect();
        let frame = Frame {
            depth: Some(Textures::Regions(&depths)),
            motion: Some(Textures::Regions(&motions)),
            ..Frame::new(Textures::Regions(&colors), &views, index)
        };
        post.record(&gpu.device, &mut encoder, &frame, &output).unwrap();
        gpu.queue.submit([encoder.finish()]);
    }
    (0..eyes.len() as u32).map(|layer| gpu.read_rgb(&output, layer)).collect()
}

#[test]
fn each_eye_of_a_stereo_pair_is_that_of_a_run_of_its_own() {
    let Some(device) = device() else { return };
    let mut rig = Rig::new(&device, &noise(), SIZE);
    for method in [MethodKind::None, MethodKind::Taa, MethodKind::Taau, MethodKind::Wrs, MethodKind::Smr] {
        let both = shown(&mut rig, &[0, 1], method, [0, 1]);
        // wrs draws other random numbers in the second view than in the first.
        let second: &[usize] = if method == MethodKind::Wrs { &[1, 1] } else { &[1] };
        let runs = [&[0], second];
        let alone = runs.map(|eyes| shown(&mut rig, eyes, method, [0, 1]).pop().unwrap());
        assert!(alone[0] != alone[1], "the eyes see different pictures");
        for (eye, alone) in alone.iter().enumerate() {
            assert!(&both[eye] == alone, "{}, eye {eye}", method.name());
        }
        // Planted: one gaze for both eyes.
        assert!(shown(&mut rig, &[0, 1], method, [0, 0])[1] != alone[1], "{}", method.name());
    }
}
