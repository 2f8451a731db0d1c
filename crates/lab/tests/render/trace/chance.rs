//! With different seeds, the CPU's and the device's images differ only by noise.

use super::rig::Rig;
use super::scenes::{SMALL, shared};
use super::statistics::{p_of_means, p_of_pixels};
use crate::given::{builtin, device};
use afterimage_lab::trace::gpu::scene_buffer::Storage;
use afterimage_lab::trace::settings::TraceSettings;
use afterimage_testing::{accept, reject};

fn settings(seed: u64, max_depth: u32) -> TraceSettings {
    TraceSettings { seed, max_depth, ..TraceSettings::default() }
}

#[track_caller]
fn check(rig: &Rig, spp: u32, max_depth: u32) {
    let Some(device) = device() else { return };
    let cpu = rig.cpu(settings(1, max_depth), spp);
    let gpu = rig.gpu(&device, settings(2, max_depth), Storage::Texture, spp);
    accept(&format!("{}: pixels", rig.name), p_of_pixels(&cpu, &gpu));
    accept(&format!("{}: mean", rig.name), p_of_means(&cpu, &gpu, |_| true));
    assert_eq!(cpu.nonfinite + gpu.nonfinite, 0, "{}", rig.name);
}

#[test]
fn cornell_box() {
    check(&Rig::new(builtin("cornell"), [48, 48]), 64, 3);
}

#[test]
fn scenes_that_others_made() {
    for scene in SMALL.iter().filter_map(|name| shared(name)) {
        check(&Rig::new(scene, [32, 24]), 32, 3);
    }
}

#[test]
fn sponza() {
    let Some(scene) = shared("sponza/sponza.gltf") else { return };
    check(&Rig::new(scene, [160, 90]), 16, 2);
}

#[test]
fn a_lamp_one_percent_brighter_is_caught() {
    let mut rig = Rig::new(builtin("cornell"), [24, 24]);
    let film = rig.cpu(settings(1, 1), 768);
    accept("the same lamp", p_of_means(&film, &rig.cpu(settings(2, 1), 768), |_| true));
    for m in &mut rig.world.materials {
        m.emissive = m.emissive.map(|e| 1.01 * e);
    }
    // Below the lamp, whose rim is noisy.
    let lit = |i: usize| i / 24 > 5;
    reject("a lamp of 1.01", p_of_means(&film, &rig.cpu(settings(2, 1), 768), lit));
}

#[test]
fn a_pixel_of_another_color_is_caught() {
    let rig = Rig::new(builtin("cornell"), [24, 24]);
    let a = rig.cpu(settings(1, 1), 64);
    let mut b = rig.cpu(settings(2, 1), 64);
    accept("as it is", p_of_pixels(&a, &b));
    b.moments.pixels_mut()[300].mean *= 2.0;
    reject("one pixel twice as bright", p_of_pixels(&a, &b));
}
