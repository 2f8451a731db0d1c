//! Every filter, size, rate and gaze, over frames with NaN, infinity and extreme values.

use super::rig::*;
use afterimage::internal::FoveationKind;

const RATES: [[u32; 2]; 2] = [[1, 2], [16, 64]];

/// Inside, at the border, in the corner, off screen, far away.
fn gazes([w, h]: [u32; 2]) -> [[f32; 2]; 5] {
    let [w, h] = [w as f32, h as f32];
    [[0.3 * w, 0.6 * h], [w - 1.0, 0.5 * h], [-0.5, -0.5], [-0.7 * w, 1.5 * h], [1e6, -1e6]]
}

fn agree(filter: FoveationKind, size: [u32; 2], rates: &[[u32; 2]]) {
    let mut levels = std::collections::BTreeSet::new();
    for &rates in rates {
        let foveation = foveation(filter, rates);
        let Some(mut rig) = Rig::new(&desc(size, 1, foveation)) else { return };
        for gaze in gazes(size) {
            let scene = Scene::mono(nasty(size, "frame"), gaze);
            let cpu = scene.on_cpu(&foveation);
            levels.extend(cpu.lods.iter().map(|l| f32::from_bits(*l) as u32));
            let what = format!("{filter:?}, {size:?}, rates {rates:?}, gaze {gaze:?}");
            assert_eq!(rig.on_gpu(&scene).agrees(&cpu), Ok(()), "{what}");
        }
    }
    println!("{filter:?}, {size:?}: levels {levels:?}");
}

fn agree_at_odd_sizes(filter: FoveationKind) {
    for size in [[1, 1], [17, 1], [1, 33], [97, 61]] {
        agree(filter, size, &RATES);
    }
    agree(filter, [256, 160], &[[4, 64]]);
}

#[test]
fn mip_is_bit_equal_h69() {
    agree_at_odd_sizes(FoveationKind::Mip);
    agree(FoveationKind::Mip, [300, 200], &[[16, 256]]);
}

#[test]
fn gauss_is_bit_equal() {
    agree_at_odd_sizes(FoveationKind::Gauss);
}

#[test]
fn block_is_bit_equal() {
    agree_at_odd_sizes(FoveationKind::Block);
    agree(FoveationKind::Block, [300, 200], &[[16, 256]]);
}

#[test]
fn off_copies_every_bit() {
    agree(FoveationKind::Off, [97, 61], &[[8, 16]]);
}

#[test]
fn two_eyes_have_their_own_frame_geometry_and_gaze_h62() {
    let size = [97, 61];
    for filter in [FoveationKind::Mip, FoveationKind::Gauss, FoveationKind::Block] {
        let foveation = foveation(filter, [4, 16]);
        let Some(mut rig) = Rig::new(&desc(size, 2, foveation)) else { return };
        for gazes in [[[20.0, 30.0], [70.0, 10.0]], [[-5.0, 0.0], [96.0, 60.0]]] {
            let scene = Scene::stereo(size, gazes);
            assert_eq!(rig.on_gpu(&scene).agrees(&scene.on_cpu(&foveation)), Ok(()), "{filter:?}, {gazes:?}");
        }
    }
}
