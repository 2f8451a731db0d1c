//! H83: the ends of every parameter range. Nothing is NaN, infinite or negative, and weights sum to 1.

use super::surfaces::*;
use afterimage_lab::kernel::bsdf::{self, Lobes, Surface};
use afterimage_lab::kernel::direction::{basis, to_local, to_world, unit};
use afterimage_lab::kernel::octahedral::{decode_direction, encode_direction};
use afterimage_lab::kernel::phong::{PhongSurface, phong_eval, phong_sample};
use afterimage_lab::kernel::sampling::*;
use afterimage_testing::{Draws, accept, holds, p_of_z, reject};
use glam::{Vec2, Vec3};

const DRAWS: [f32; 5] = [0.0, 1.0 / 16_777_216.0, 0.5, 0.999, 16_777_215.0 / 16_777_216.0];
const COSINES: [f32; 5] = [1e-7, 1e-4, 0.1, 0.999_999, 1.0];

#[test]
fn h83_scattering_is_finite_at_the_ends_of_every_range() {
    let mut d = Draws::new("hard scattering");
    let mut sampled = 0;
    for _ in 0..400 {
        let surface = Surface { anisotropy: share(&mut d), base_color: Vec3::splat(share(&mut d)), ..white(&mut d) };
        for z in COSINES {
            let wo = direction(z, d.uniform());
            let layers = bsdf::layers(&surface, wo, &TABLES, Lobes::ALL);
            let probabilities: f32 = layers.probabilities.iter().sum();
            assert!((probabilities - 1.0).abs() < 1e-6 || probabilities == 0.0, "{surface:?} {wo}: {probabilities}");
            for _ in 0..40 {
                let u = std::array::from_fn(|_| DRAWS[d.bits() as usize % 5]);
                let s = bsdf::sample(&layers, wo, u, Lobes::ALL);
                assert!((s.wi.length() - 1.0).abs() < 1e-5, "{surface:?} {wo} {u:?}: {s:?}");
                let others = [1.0, -1.0].map(|side| side * direction(z, d.uniform()));
                let [above, below] = others.map(|wi| bsdf::eval(&layers, wo, wi, Lobes::ALL));
                for s in [s.scatter, above, below] {
                    let good = |x: f32| x.is_finite() && x >= 0.0;
                    assert!(s.value.to_array().into_iter().all(good) && good(s.pdf), "{surface:?} {wo} {u:?}: {s:?}");
                    // Directions with light have a density, except in the sheen's tail, which is clamped to e^-60
                    // instead of 0.
                    assert!(s.pdf > 0.0 || s.value.max_element() < 1e-20, "{surface:?} {wo} {u:?}: {s:?}");
                    if s.pdf > 0.0 {
                        sampled += 1;
                        let other = [0.0, 1e-30, 1.0, 1e10][d.bits() as usize % 4];
                        let sum = power_heuristic(s.pdf, other) + power_heuristic(other, s.pdf);
                        assert!((sum - 1.0).abs() < 2e-7, "{} {other}: {sum}", s.pdf);
                    }
                }
            }
        }
    }
    assert!(sampled > 50_000);
    let weights = "weights of the power heuristic sum to 1 within 2e-7";
    holds!("H83", Cpu, "{sampled} densities at the ends of all ranges finite; {weights}");
}

#[test]
fn h83_no_light_from_below_and_none_sampled() {
    let surface = Surface { transmission: 0.5, specular: 1.0, ..WHITE };
    for z in [0.0, -1e-7, -1.0] {
        let wo = direction(z, 0.3);
        let layers = bsdf::layers(&surface, wo, &TABLES, Lobes::ALL);
        assert_eq!(bsdf::eval(&layers, wo, Vec3::Z, Lobes::ALL), bsdf::Scatter::NONE);
        assert_eq!(bsdf::sample(&layers, wo, [0.5; 4], Lobes::ALL).scatter, bsdf::Scatter::NONE);
    }
}

#[test]
fn h83_shapes_are_finite_at_both_ends_of_the_draws() {
    for a in DRAWS.into_iter().chain([1.0]) {
        for b in DRAWS.into_iter().chain([1.0]) {
            let u = Vec2::new(a, b);
            for w in [cosine_hemisphere(u), uniform_hemisphere(u)] {
                assert!((w.length() - 1.0).abs() < 1e-6, "{u}: {w}");
            }
            let b = barycentrics(u);
            assert!((b.x + b.y + b.z - 1.0).abs() < 1e-6 && b.min_element() >= 0.0, "{u}: {b}");
            assert!(disk(u).length() <= 1.0 + 1e-6);
        }
    }
    assert_eq!(power_heuristic(0.0, 0.0), 0.0);
    assert_eq!(power_heuristic(1e18, 0.0), 1.0);
    assert_eq!(area_pdf(0.0, 1.0, 1.0), 0.0);
    assert_eq!(area_pdf(1.0, 1.0, 0.0), 0.0);
}

#[test]
fn frames_are_orthonormal_and_stored_directions_are_close() {
    let mut d = Draws::new("frames");
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    let mut either =
        || uniform_hemisphere(Vec2::new(d.uniform(), d.uniform())) * if d.uniform() < 0.5 { -1.0 } else { 1.0 };
    let random = (0..20_000).map(|_| either()).collect::<Vec<_>>();
    let mut worst = 0.0_f32;
    for n in random.into_iter().chain(axes).chain(axes.map(|v| -v)) {
        let n = unit(n);
        let [x, y] = basis(n);
        for (dot, expected) in [(x.dot(y), 0.0), (x.dot(n), 0.0), (y.dot(n), 0.0), (x.dot(x), 1.0), (y.dot(y), 1.0)] {
            assert!((dot - expected).abs() < 1e-6, "{n}: {dot}");
        }
        assert!((x.cross(y) - n).length() < 1e-6, "{n}: left-handed");
        let v = Vec3::new(0.3, -0.5, 0.81);
        assert!((to_local(to_world(v, x, y, n), x, y, n) - v).length() < 1e-6);
        worst = worst.max((decode_direction(encode_direction(n)) - n).length());
    }
    println!("octahedral: largest error {worst:.2e} rad");
    assert!(worst < 7e-5);
    for v in axes.into_iter().chain(axes.map(|v| -v)) {
        assert_eq!(decode_direction(encode_direction(v)), v);
    }
    assert_eq!(unit(Vec3::ZERO), Vec3::Z);
    assert!((unit(Vec3::new(3e-20, 4e-20, 0.0)) - Vec3::new(0.6, 0.8, 0.0)).length() < 1e-6);
}

#[test]
fn phong_is_passive_and_its_samples_have_its_mean() {
    let surface =
        PhongSurface { diffuse: Vec3::new(0.6, 0.3, 0.2), specular: Vec3::new(0.3, 0.4, 0.1), exponent: 20.0 };
    let mut d = Draws::new("phong");
    for z in [0.2, 0.9] {
        let wo = direction(z, 0.3);
        let [mut exact, mut mean, mut squares] = [0.0, 0.0, 0.0];
        let n = 200_000;
        for _ in 0..n {
            let u = [d.uniform(), d.uniform(), d.uniform()];
            let s = phong_sample(&surface, wo, u);
            let w = f64::from(s.scatter.value.x / s.scatter.pdf);
            mean += w / f64::from(n);
            squares += w * w / f64::from(n);
        }
        // Midpoint rule with steps much finer than the lobe.
        let steps = 400;
        for i in 0..steps * steps {
            let at = |k: u32| (k as f32 + 0.5) / steps as f32;
            let wi = uniform_hemisphere(Vec2::new(at(i % steps), at(i / steps)));
            let s = phong_eval(&surface, wo, wi);
            exact += f64::from(s.value.x / s.pdf) / f64::from(steps * steps);
        }
        let error = ((squares - mean * mean) / f64::from(n)).sqrt();
        println!("phong from {z}: {mean:.4} +- {error:.4}, exact {exact:.4}");
        accept("phong", p_of_z((mean - exact) / error));
        assert!(exact <= 0.9);
        reject("phong", p_of_z((mean - 0.9 * exact) / error));
    }
    for wi in [direction(1e-7, 0.1), direction(1.0, 0.0), -Vec3::Z] {
        let s = phong_eval(&PhongSurface { exponent: 1e6, ..surface }, direction(1e-7, 0.6), wi);
        assert!(s.value.is_finite() && s.pdf.is_finite());
    }
}
