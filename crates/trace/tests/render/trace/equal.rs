//! With the same seed, the device's film equals the CPU's bit for bit.

use super::rig::{Rig, differing};
use super::scenes::{SMALL, shared, under_a_map, under_a_screen, under_lamps};
use crate::given::{builtin, device};
use afterimage_lab::scene::Scene;
use afterimage_lab::scene::builtin::courtyard_of;
use afterimage_trace::gpu::scene_buffer::Storage;
use afterimage_trace::settings::{Bsdf, Integrator, TraceSettings};

const SPP: u32 = 2;

/// Ways of tracing. Each compiles a kernel of its own for every set of effects, which takes most of the time: scenes
/// take turns.
const WAYS: [(Integrator, Bsdf, Storage); 6] = [
    (Integrator::Mis, Bsdf::Principled, Storage::Buffer),
    (Integrator::Nee, Bsdf::Phong, Storage::Buffer),
    (Integrator::Naive, Bsdf::Principled, Storage::Texture),
    (Integrator::Mis, Bsdf::Phong, Storage::Texture),
    (Integrator::Nee, Bsdf::Principled, Storage::Texture),
    (Integrator::Naive, Bsdf::Phong, Storage::Buffer),
];

/// Fails if any bit of the film differs.
#[track_caller]
fn check(rig: &Rig, ways: &[(Integrator, Bsdf, Storage)]) {
    let Some(device) = device() else { return };
    let mut failures = vec![];
    for &(integrator, bsdf, storage) in ways {
        let settings = TraceSettings { integrator, bsdf, max_depth: 4, seed: 7, effects: None };
        let cpu = rig.cpu(settings, SPP);
        let gpu = rig.gpu(&device, settings, storage, SPP);
        let count = differing(&cpu, &gpu);
        let what = format!("{}, {integrator:?}, {bsdf:?}, {storage:?}: {count} pixels differ", rig.name);
        println!("{what}");
        if count > 0 || (cpu.rays, cpu.nonfinite) != (gpu.rays, gpu.nonfinite) {
            failures.push(format!("{what}; rays {} and {}", cpu.rays, gpu.rays));
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// A way for each scene, in turn.
#[track_caller]
fn check_in_turn(scenes: impl IntoIterator<Item = Scene>, size: [u32; 2]) {
    for (scene, ways) in scenes.into_iter().zip(WAYS.chunks_exact(1).cycle()) {
        check(&Rig::new(scene, size), ways);
    }
}

#[test]
fn built_in_scenes_and_kinds_of_light() {
    check(&Rig::new(builtin("cornell"), [48, 32]), &WAYS);
    let names = ["furnace", "cubes", "mirror-room", "bunny-low", "control"];
    check_in_turn(names.map(builtin).into_iter().chain([courtyard_of(4000)]), [48, 32]);
    check_in_turn([under_a_map(), under_lamps(), under_a_screen()], [48, 32]);
}

#[test]
fn one_wrong_last_bit_is_caught() {
    let Some(device) = device() else { return };
    let mut rig = Rig::new(builtin("cornell"), [48, 32]);
    let gpu = rig.gpu(&device, TraceSettings::default(), Storage::Texture, SPP);
    assert_eq!(differing(&rig.cpu(TraceSettings::default(), SPP), &gpu), 0);
    let red = &mut rig.world.materials[1].base_color[0];
    *red = red.next_up();
    assert_ne!(differing(&rig.cpu(TraceSettings::default(), SPP), &gpu), 0);
}

#[test]
fn scenes_that_others_made() {
    check_in_turn(SMALL.iter().filter_map(|name| shared(name)), [32, 24]);
}
