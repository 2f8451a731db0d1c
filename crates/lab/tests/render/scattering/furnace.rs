//! Energy conservation: white surfaces reflect everything in a white furnace, colored ones never more.

use super::surfaces::*;
use afterimage_lab::kernel::bsdf;
use afterimage_lab::kernel::bsdf::{Layers, Lobes, Scatter, Surface};
use afterimage_testing::{ALPHA, Draws, holds};
use glam::Vec3;
use statrs::distribution::{ContinuousCDF, Normal};

/// Integral of `eval` over all directions: for each lobe, a grid over its sampler's draws, weighted by the density of
/// the mixture. `value` replaces the value where an error is planted.
fn reflected(layers: &Layers, wo: Vec3, grid: u32, value: impl Fn(Vec3, Scatter) -> f32) -> f64 {
    let mut sum = 0.0;
    let mut before = 0.0;
    for (lobe, &probability) in layers.probabilities.iter().enumerate() {
        if probability > 0.0 {
            let choices = if lobe == 3 { 16 } else { 1 };
            let mut mean = 0.0;
            for i in 0..grid * grid * choices {
                let at = |k: u32, n: u32| (k as f32 + 0.5) / n as f32;
                // Substitution: points are dense where directions approach the horizon.
                let t = at(i / grid % grid, grid);
                let turn = at(i % grid, grid);
                let power = if lobe == 0 { 4 } else { 2 };
                let radial = 1.0 - t.powi(power);
                let [a, b] = if lobe == 0 { [radial, turn] } else { [turn, radial] };
                let u = [before + 0.5 * probability, a, b, at(i / (grid * grid), choices)];
                let s = bsdf::sample(layers, wo, u, Lobes::ALL);
                if s.scatter.pdf > 0.0 {
                    let weight = f64::from(power) * f64::from(t).powi(power - 1);
                    mean += weight * f64::from(value(s.wi, s.scatter) / s.scatter.pdf);
                }
            }
            sum += f64::from(probability) * mean / f64::from(grid * grid * choices);
        }
        before += probability;
    }
    sum
}

fn energy(surface: &Surface, wo: Vec3, grid: u32) -> f64 {
    reflected(&bsdf::layers(surface, wo, &TABLES, Lobes::ALL), wo, grid, |_, s| s.value.x)
}

/// A lobe: name; surface of a roughness and an index of refraction; bounds on the root mean square and the largest
/// error.
struct Lobe(&'static str, fn(f32, f32) -> Surface, [f64; 2]);

fn glass(roughness: f32, ior: f32) -> Surface {
    Surface { roughness, specular: 1.0, transmission: 1.0, ior, ..WHITE }
}

/// Bounds are about 1.3 times the measured values: interpolation errors of the tables, and 3e-4 of the quadrature
/// itself, as Lambert's lobe shows.
const LOBES: &[Lobe] = &[
    Lobe("Lambert", |_, _| WHITE, [4e-4, 4e-4]),
    Lobe("retro-reflection", |r, _| Surface { roughness: r, specular: 1e-12, ..WHITE }, [4e-4, 4e-4]),
    Lobe("metal", |r, _| Surface { roughness: r, metallic: 1.0, ..WHITE }, [1e-3, 5e-3]),
    Lobe("dielectric", |r, i| Surface { roughness: r, specular: 1.0, ior: i, ..WHITE }, [1e-3, 5e-3]),
    Lobe("coat", |r, _| Surface { clearcoat_roughness: r, clearcoat: 1.0, ..WHITE }, [1e-3, 5e-3]),
    Lobe("sheen", |r, _| Surface { sheen_roughness: r, sheen_color: Vec3::ONE, ..WHITE }, [3e-3, 1e-2]),
    Lobe("sheet", |r, i| Surface { thin: true, ..glass(r, i) }, [1e-3, 5e-3]),
    Lobe("into glass", glass, [3e-3, 2e-2]),
    Lobe("out of glass", |r, i| Surface { entering: false, ..glass(r, i) }, [1e-2, 7e-2]),
    Lobe("stretched 0.5", |r, _| Surface { roughness: r, metallic: 1.0, anisotropy: 0.5, ..WHITE }, [4e-3, 2e-2]),
    Lobe("stretched 1", |r, _| Surface { roughness: r, metallic: 1.0, anisotropy: 1.0, ..WHITE }, [1e-2, 6e-2]),
];

#[test]
fn every_lobe_returns_what_falls_on_it_h83() {
    let (mut beyond, mut lines) = (vec![], vec![]);
    for Lobe(name, make, [rms_bound, bound]) in LOBES {
        let mut errors = vec![];
        for ior in [1.03, 1.5, 2.4] {
            for r in [0.0, 0.11, 0.23, 0.43, 0.63, 0.8, 1.0] {
                for z in [1e-7, 0.01, 0.06, 0.22, 0.5, 0.8, 1.0] {
                    for turn in [0.03, 0.22] {
                        errors.push(energy(&make(r, ior), direction(z, turn), 40) - 1.0);
                    }
                }
            }
        }
        let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
        let worst = errors.iter().fold(0.0_f64, |m, e| m.max(e.abs()));
        println!("{name}: error of the furnace {rms:.1e} root mean square, {worst:.1e} largest");
        lines.push(format!("{name} {rms:.0e}"));
        if rms > *rms_bound || worst > *bound {
            beyond.push(*name);
        }
    }
    assert!(beyond.is_empty(), "{beyond:?}");
    holds!("H83", Cpu, "root mean square of (energy - 1): {}", lines.join(", "));
}

#[test]
fn a_furnace_sees_planted_errors() {
    let surface = Surface { metallic: 1.0, roughness: 0.6, ..WHITE };
    let wo = direction(0.3, 0.1);
    let layers = bsdf::layers(&surface, wo, &TABLES, Lobes::ALL);
    let right = reflected(&layers, wo, 40, |_, s| s.value.x);
    assert!((right - 1.0).abs() < 5e-3, "{right}");
    let a = layers.widths;
    // Planted errors: no masking and shadowing; no compensation; no half vector Jacobian.
    let bare = |wi: Vec3, s: Scatter| {
        let length = |v| afterimage_lab::kernel::microfacet::ggx_length(v, a);
        s.value.x * (wi.z * length(wo) + wo.z * length(wi)) / (2.0 * wi.z * wo.z)
    };
    let uncompensated = bsdf::Layers { reflect: Vec3::ONE, reflect_rise: Vec3::ZERO, ..layers };
    for (name, e) in [
        ("no masking", reflected(&layers, wo, 40, bare)),
        ("no compensation", reflected(&uncompensated, wo, 40, |_, s| s.value.x)),
        ("no Jacobian", reflected(&layers, wo, 40, |wi, s| s.value.x * 4.0 * wo.dot((wo + wi).normalize()))),
    ] {
        println!("{name}: {e:.4}");
        assert!((e - 1.0).abs() > 2e-2, "{name}: {e}");
    }
}

/// Mean of value / density over random draws in three channels, with its standard error.
fn monte_carlo(surface: &Surface, wo: Vec3, d: &mut Draws, samples: u32) -> ([f64; 3], f64) {
    let layers = bsdf::layers(surface, wo, &TABLES, Lobes::ALL);
    let (mut sum, mut squares) = ([0.0; 3], 0.0);
    for _ in 0..samples {
        let u = std::array::from_fn(|_| d.uniform());
        let s = bsdf::sample(&layers, wo, u, Lobes::ALL).scatter;
        if s.pdf > 0.0 {
            let w = (s.value / s.pdf).as_dvec3().to_array();
            (0..3).for_each(|k| sum[k] += w[k]);
            squares += w[0] * w[0];
        }
    }
    let n = f64::from(samples);
    let mean = sum.map(|s| s / n);
    (mean, ((squares / n - mean[0] * mean[0]).max(0.0) / n).sqrt())
}

/// Bound on the tables' error for random surfaces without anisotropy; see [`LOBES`].
const TABLE_ERROR: f64 = 2e-2;

#[test]
fn random_white_surfaces_reflect_and_transmit_everything_h83() {
    let mut d = Draws::new("white furnace");
    let tests = 200;
    // Two-sided, with the significance shared by all tests.
    let z = Normal::standard().inverse_cdf(1.0 - ALPHA / (2.0 * f64::from(tests)));
    let mut total = 0.0;
    for _ in 0..tests {
        let surface = white(&mut d);
        let wo = direction(d.uniform().max(1e-3), d.uniform());
        let (mean, error) = monte_carlo(&surface, wo, &mut d, 10_000);
        let off = (mean[0] - 1.0).abs();
        assert!(off < z * error + TABLE_ERROR, "{surface:?} from {wo}: {} +- {error}", mean[0]);
        total += mean[0];
    }
    println!("mean of {tests} white surfaces: {:.5}", total / f64::from(tests));
    assert!((total / f64::from(tests) - 1.0).abs() < 2e-3);
}

#[test]
fn no_surface_makes_light() {
    let mut d = Draws::new("passivity");
    let z = Normal::standard().inverse_cdf(1.0 - ALPHA / 600.0);
    for _ in 0..200 {
        let mut color = || Vec3::new(share(&mut d), share(&mut d), share(&mut d));
        let [base_color, specular_color, sheen_color] = [color(), color(), color()];
        let surface = Surface { base_color, specular_color, sheen_color, ..white(&mut d) };
        let wo = direction(d.uniform().max(1e-3), d.uniform());
        let (mean, error) = monte_carlo(&surface, wo, &mut d, 4_000);
        // Uses the first channel's error; the others' are as large.
        assert!(mean.iter().all(|&m| m < 1.0 + TABLE_ERROR + z * error.max(0.02)), "{surface:?}: {mean:?} +- {error}");
    }
}
