//! With the same seed, the device's film equals the CPU's bit for bit.

use super::rig::{Rig, differing};
use super::scenes::{SMALL, shared, under_a_map, under_a_screen, under_lamps};
use crate::given::{builtin, device};
use afterimage_lab::scene::builtin::courtyard_of;
use afterimage_lab::trace::gpu::scene_buffer::Storage;
use afterimage_lab::trace::settings::{Bsdf, Integrator, TraceSettings};

const INTEGRATORS: [Integrator; 3] = [Integrator::Mis, Integrator::Nee, Integrator::Naive];
const SPP: u32 = 2;

fn other(storage: Storage) -> Storage {
    if storage == Storage::Buffer { Storage::Texture } else { Storage::Buffer }
}

/// Every integrator and both scattering models, with alternating storage. Fails if any bit of the film differs.
#[track_caller]
fn check(rig: &Rig) {
    let Some(device) = device() else { return };
    let mut storage = Storage::Buffer;
    let mut failures = vec![];
    for integrator in INTEGRATORS {
        // Alternates, so that each model runs with each storage.
        storage = other(storage);
        for bsdf in [Bsdf::Principled, Bsdf::Phong] {
            storage = other(storage);
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
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn built_in_scenes() {
    for name in ["cornell", "furnace", "cubes", "mirror-room", "bunny-low", "control"] {
        check(&Rig::new(builtin(name), [48, 32]));
    }
    check(&Rig::new(courtyard_of(4000), [48, 32]));
}

#[test]
fn kinds_of_light() {
    for scene in [under_a_map(), under_lamps(), under_a_screen()] {
        check(&Rig::new(scene, [48, 32]));
    }
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
    for scene in SMALL.iter().filter_map(|name| shared(name)) {
        check(&Rig::new(scene, [32, 24]));
    }
}
