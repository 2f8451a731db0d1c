//! Images with known results: depth 0, increasing depth, furnaces, spheres under a sky.

use super::rig::Rig;
use super::scenes::{DARK, made};
use super::statistics::mean_of;
use crate::given::builtin;
use afterimage_lab::scene::builtin::furnace_of;
use afterimage_lab::scene::{Camera, Environment, Material, Pose, Triangles};
use afterimage_testing::{ALPHA, p_of_z};
use afterimage_trace::settings::{Bsdf, Integrator, TraceSettings};
use glam::{DVec3, Vec3};
use statrs::distribution::{ContinuousCDF, Normal};

fn depth(max_depth: u32) -> TraceSettings {
    TraceSettings { max_depth, seed: 3, ..TraceSettings::default() }
}

#[test]
fn depth_0_is_what_emits_and_nothing_else() {
    let rig = Rig::new(builtin("cornell"), [64, 64]);
    let film = rig.cpu(depth(0), 8);
    assert_eq!(film.rays, 64 * 64 * 8);
    // The lamp is a rectangle of radiance 15 at y = 5.54, placed by similar triangles; pixels on its rim are mixed.
    let scale = 64.0 / (2.0 * 20.0_f64.to_radians().tan());
    let (mut lamp, mut dark) = (0, 0);
    for (i, m) in film.moments.pixels().iter().enumerate() {
        let (x, y) = ((i % 64) as f64 - 31.5, (i / 64) as f64 - 31.5);
        // Where rays reach the lamp's plane: distance along z, and x. The camera's right is -x.
        let at = |(dx, dy): (f64, f64)| {
            let t = (5.54 - 2.78) / (-(y + dy) / scale);
            let (px, pz) = (2.78 - t * (x + dx) / scale, -8.0 + t);
            t > 0.0 && (2.13..3.43).contains(&px) && (2.27..3.32).contains(&pz)
        };
        let corners = [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)].map(at);
        if corners == [true; 4] {
            assert_eq!(m.mean, Vec3::splat(15.0));
            lamp += 1;
        } else if corners == [false; 4] && !at((0.0, 0.0)) {
            assert_eq!(m.mean, Vec3::ZERO, "{i}");
            dark += 1;
        }
    }
    println!("{lamp} pixels of lamp, {dark} dark");
    assert!(lamp > 8 && dark > 3900);
}

#[test]
fn more_depth_is_more_light() {
    for name in ["cornell", "mirror-room", "cubes"] {
        let rig = Rig::new(builtin(name), [32, 24]);
        for integrator in [Integrator::Mis, Integrator::Nee, Integrator::Naive] {
            let at = |max_depth| rig.cpu(TraceSettings { integrator, ..depth(max_depth) }, 8);
            let films: Vec<_> = [0, 1, 2, 3, 8].map(at).into();
            for pair in films.windows(2) {
                // The same paths with a larger depth limit: no pixel gets darker, except by rounding.
                for (less, more) in pair[0].moments.pixels().iter().zip(pair[1].moments.pixels()) {
                    assert!(more.mean.cmpge(less.mean * (1.0 - 1e-5)).all(), "{name}: {} {}", less.mean, more.mean);
                }
                let sum = |i: usize| mean_of(&pair[i], 1, |_| true).0;
                assert!(sum(1) > sum(0), "{name}, {integrator:?}");
            }
        }
    }
}

/// A floor of 18 m sides of the first material, and more, seen by a camera above its middle.
fn over_a_floor(height_m: f64, vfov_deg: f32, materials: Vec<Material>, mut t: Triangles, sky: Environment) -> Rig {
    t.push_quad([[-9., 9.], [9., 9.], [9., -9.], [-9., -9.]].map(|[x, z]| Vec3::new(x, 0.0, z)), 0);
    let camera = Camera::look_at(DVec3::Y * height_m, DVec3::ZERO, vfov_deg);
    Rig::seen_by(made("a floor", materials, t, Pose::default(), sky), &camera, [4, 4])
}

/// Mean over a ball, and its standard error.
fn on_ball(material: Material, settings: TraceSettings, spp: u32) -> (f64, f64) {
    // The ball's angular radius is asin(1/4) = 14.48 degrees, more than the 14.0 degrees from the image centre to its
    // corner.
    let camera = Camera::look_at(DVec3::new(0.0, 0.0, 4.0), DVec3::ZERO, 20.0);
    let rig = Rig::seen_by(furnace_of(vec![material]), &camera, [12, 12]);
    let film = rig.cpu(settings, spp);
    assert_eq!(film.nonfinite, 0);
    mean_of(&film, 0, |_| true)
}

#[test]
fn white_balls_cannot_be_seen_in_a_furnace_h83() {
    let white = Material { specular: 0.0, ..Material::default() };
    let metal = Material { metallic: 1.0, ..Material::default() };
    let glass = Material { transmission: 1.0, roughness: 0.2, ..Material::default() };
    let body = |roughness| Material { volume: true, roughness, ..glass.clone() };
    // Bounds of the systematic error of the albedo tables, averaged over a ball; see
    // `lab/tests/render/scattering/furnace.rs`.
    let balls: Vec<(&str, Material, u32, f64)> = vec![
        ("Lambert", white.clone(), 1, 4e-4),
        ("retro-reflection", Material { specular: 1e-9, ..white.clone() }, 1, 4e-4),
        ("rough dielectric", Material::default(), 1, 1e-3),
        ("dielectric", Material { roughness: 0.3, ..Material::default() }, 1, 1e-3),
        ("smooth dielectric", Material { roughness: 0.0, ..Material::default() }, 1, 1e-3),
        ("rough metal", metal.clone(), 1, 1e-3),
        ("metal", Material { roughness: 0.4, ..metal.clone() }, 1, 1e-3),
        ("mirror", Material { roughness: 0.0, ..metal.clone() }, 1, 1e-3),
        ("brushed metal", Material { roughness: 0.5, anisotropy: 0.8, ..metal.clone() }, 1, 4e-3),
        ("coat", Material { clearcoat: 1.0, clearcoat_roughness: 0.2, ..metal }, 1, 1e-3),
        ("sheen", Material { sheen_color: [1.0; 3], sheen_roughness: 0.5, ..white }, 1, 3e-3),
        ("thin glass", glass.clone(), 64, 1e-3),
        ("glass", body(0.0), 64, 3e-3),
        ("rough glass", body(0.5), 64, 1e-2),
    ];
    let z = Normal::standard().inverse_cdf(1.0 - ALPHA / (4.0 * balls.len() as f64));
    let mut failures = vec![];
    for (name, material, max_depth, bound) in balls {
        for integrator in [Integrator::Mis, Integrator::Naive] {
            let (mean, se) = on_ball(material.clone(), TraceSettings { integrator, ..depth(max_depth) }, 2048);
            println!("{name}, {integrator:?}: {mean:.5} +- {se:.5}");
            if !((mean - 1.0).abs() < bound + z * se && se < 3e-3) {
                failures.push(format!("{name}, {integrator:?}: {mean:.5} +- {se:.5}"));
            }
        }
    }
    assert!(failures.is_empty(), "{failures:?}");
}

#[test]
fn grey_balls_are_as_grey_as_they_are() {
    let grey = Material { base_color: [0.18; 3], specular: 0.0, ..Material::default() };
    for integrator in [Integrator::Mis, Integrator::Nee, Integrator::Naive] {
        for bsdf in [Bsdf::Principled, Bsdf::Phong] {
            let (mean, se) = on_ball(grey.clone(), TraceSettings { integrator, bsdf, ..depth(1) }, 256);
            let p = p_of_z((mean - 0.18) / se.max(1e-6));
            println!("{integrator:?}, {bsdf:?}: {mean:.6} +- {se:.6}, p = {p:.3}");
            // Bonferroni correction for six tests.
            assert!(p > ALPHA / 6.0);
        }
    }
    let (mean, se) = on_ball(grey, TraceSettings { integrator: Integrator::Nee, ..depth(1) }, 256);
    let planted = p_of_z((mean - 0.18 * 1.01) / se.max(1e-6));
    assert!(planted < ALPHA, "1 % is not caught: p = {planted}");
}

#[test]
fn a_floor_under_a_lamp_has_its_form_factor() {
    // Square lamp with 2 m sides, 1 m above a floor and parallel to it. Returns the radiance of the floor point below
    // its centre.
    let mut t = Triangles::default();
    t.push_quad([[-1., -1.], [1., -1.], [1., 1.], [-1., 1.]].map(|[x, z]| Vec3::new(x, 1.0, z)), 1);
    let floor = Material { base_color: [0.5; 3], specular: 0.0, ..Material::default() };
    let lamp = Material { base_color: [0.0; 3], emissive: [2.0; 3], double_sided: false, ..floor.clone() };
    let rig = over_a_floor(0.5, 0.2, vec![floor, lamp], t, DARK);
    // Siegel and Howell, configuration factors: parallel rectangle with a corner above the point, four times.
    let (a, b) = (1.0f64, 1.0f64);
    let (p, q) = ((1.0 + a * a).sqrt(), (1.0 + b * b).sqrt());
    let corner = (a / p * (b / p).atan() + b / q * (a / q).atan()) / (2.0 * std::f64::consts::PI);
    let exact = 0.5 * 2.0 * 4.0 * corner;
    for integrator in [Integrator::Mis, Integrator::Nee, Integrator::Naive] {
        let (mean, se) = mean_of(&rig.cpu(TraceSettings { integrator, ..depth(1) }, 8192), 0, |_| true);
        let p = p_of_z((mean - exact) / se);
        println!("{integrator:?}: {mean:.5} +- {se:.5}, exact {exact:.5}, p = {p:.3}");
        assert!(p > ALPHA / 3.0);
    }
}

#[test]
fn a_plane_under_a_sky_shows_its_albedo() {
    let floor = Material { base_color: [0.2, 0.5, 0.8], specular: 0.0, ..Material::default() };
    let sky = Environment::Constant([1.0, 2.0, 0.5]);
    let rig = over_a_floor(2.0, 40.0, vec![floor], Triangles::default(), sky);
    // Lambertian scattering samples exactly the sky's cosine density, so there is no noise.
    let film = rig.cpu(TraceSettings { integrator: Integrator::Naive, ..depth(5) }, 16);
    for m in film.moments.pixels() {
        assert!((m.mean - Vec3::new(0.2, 1.0, 0.4)).abs().max_element() < 1e-6, "{}", m.mean);
    }
}
