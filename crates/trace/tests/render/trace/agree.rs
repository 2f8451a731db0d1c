//! The three integrators converge to the same image.

use super::rig::Rig;
use super::scenes::{under_a_map, under_a_screen, under_lamps};
use super::statistics::{p_of_means, p_of_regions};
use crate::given::builtin;
use afterimage_lab::scene::builtin::furnace_of;
use afterimage_lab::scene::{Material, Scene};
use afterimage_testing::{accept, reject};
use afterimage_trace::film::Film;
use afterimage_trace::settings::{Bsdf, Integrator, TraceSettings};

fn film(rig: &Rig, integrator: Integrator, bsdf: Bsdf, spp: u32) -> Film {
    // A seed for each: with shared draws the films would be correlated.
    let settings = TraceSettings { integrator, bsdf, max_depth: 3, seed: 10 + integrator as u64, effects: None };
    rig.cpu(settings, spp)
}

#[track_caller]
fn check(scene: Scene, integrators: &[(Integrator, u32)]) {
    let rig = Rig::new(scene, [32, 32]);
    for bsdf in [Bsdf::Principled, Bsdf::Phong] {
        let films: Vec<Film> = integrators.iter().map(|&(i, spp)| film(&rig, i, bsdf, spp)).collect();
        for (k, other) in films.iter().enumerate().skip(1) {
            let what = format!("{}, {bsdf:?}, {:?} and {:?}", rig.name, integrators[0].0, integrators[k].0);
            accept(&format!("{what}: regions"), p_of_regions(&films[0], other));
            accept(&format!("{what}: mean"), p_of_means(&films[0], other, |_| true));
        }
    }
}

const ALL: [(Integrator, u32); 3] = [(Integrator::Mis, 64), (Integrator::Nee, 64), (Integrator::Naive, 256)];

#[test]
fn in_the_cornell_box_under_a_sky_with_a_bright_spot_and_under_a_screen_that_shows_an_image() {
    for scene in [builtin("cornell"), under_a_map(), under_a_screen()] {
        check(scene, &ALL);
    }
}

#[test]
fn in_the_furnace() {
    check(builtin("furnace"), &[ALL[0], ALL[2]]);
    // Light sampling alone nearly always misses narrow highlights, so its sample statistics would be meaningless.
    let rough = Material { roughness: 0.7, ..Material::default() };
    let metal = Material { metallic: 1.0, ..rough.clone() };
    check(furnace_of(vec![rough, metal]), &ALL);
}

#[test]
fn under_punctual_lights() {
    check(under_lamps(), &ALL[..2]);
    // Punctual lights have no size, so scattered rays never hit them.
    let rig = Rig::new(under_lamps(), [16, 16]);
    let dark = film(&rig, Integrator::Naive, Bsdf::Principled, 4);
    assert!(dark.moments.pixels().iter().all(|m| m.mean == glam::Vec3::ZERO));
}

#[test]
fn a_light_or_a_texel_picked_with_a_wrong_probability_is_caught() {
    for (what, scene) in [("lights", under_a_screen()), ("texels", under_a_map())] {
        let mut rig = Rig::new(scene, [32, 32]);
        let right = film(&rig, Integrator::Naive, Bsdf::Principled, 256);
        match what {
            "lights" => rig.world.picks.iter_mut().for_each(|pick| pick.probability *= 1.1),
            _ => rig.world.map.iter_mut().for_each(|texel| texel.probability *= 1.1),
        }
        let wrong = film(&rig, Integrator::Nee, Bsdf::Principled, 64);
        reject(&format!("{what} 1.1 times as often"), p_of_means(&right, &wrong, |_| true));
    }
}
