//! The f32 kernel matches the formulas in f64; reciprocity.

use super::surfaces::*;
use afterimage_lab::kernel::bsdf::{self, Lobes, Surface};
use afterimage_testing::Draws;
use glam::{DVec3, Vec3};
use std::f64::consts::PI;

/// Textbook forms of GGX D, height-correlated visibility G2 / (4 cos cos), and Fresnel reflectance.
fn ggx(wo: DVec3, wi: DVec3, h: DVec3, a: f64) -> [f64; 2] {
    let t = (h.x * h.x + h.y * h.y) / (h.z * h.z);
    let d = 1.0 / (PI * a * a * h.z.powi(4) * (1.0 + t / (a * a)).powi(2));
    let lambda = |w: DVec3| 0.5 * ((1.0 + a * a * (1.0 - w.z * w.z) / (w.z * w.z)).sqrt() - 1.0);
    [d, 1.0 / (1.0 + lambda(wo) + lambda(wi))]
}

fn fresnel(c: f64, eta: f64) -> f64 {
    let s = (1.0 - c * c).sqrt() / eta;
    if s >= 1.0 {
        return 1.0;
    }
    let [i, t] = [c.acos(), s.asin()];
    if i < 1e-6 {
        return ((1.0 - eta) / (1.0 + eta)).powi(2);
    }
    0.5 * (((i - t).sin() / (i + t).sin()).powi(2) + ((i - t).tan() / (i + t).tan()).powi(2))
}

/// Largest relative error of `eval` against `exact`. `exact` uses the layers' strengths, so only the lobe's shape is
/// compared.
fn worst(surface: &Surface, exact: impl Fn(&bsdf::Layers, DVec3, DVec3) -> f64, below: bool) -> f64 {
    let mut d = Draws::new("f64");
    let mut worst = 0.0_f64;
    for _ in 0..20_000 {
        let wo = direction(d.range(0.02, 1.0), d.uniform());
        let layers = bsdf::layers(surface, wo, &TABLES, Lobes::ALL);
        let u = std::array::from_fn(|_| d.uniform());
        let s = bsdf::sample(&layers, wo, u, Lobes::ALL);
        if s.scatter.pdf > 0.0 && (s.wi.z < -0.01) == below && s.wi.z.abs() > 0.01 {
            let e = exact(&layers, wo.as_dvec3().normalize(), s.wi.as_dvec3().normalize());
            worst = worst.max((f64::from(s.scatter.value.x) / e - 1.0).abs());
        }
    }
    worst
}

#[test]
fn the_kernel_is_its_formulas_in_f64() {
    let metal = Surface { metallic: 1.0, roughness: 0.5, base_color: Vec3::splat(0.5), ..WHITE };
    let reflection = |l: &bsdf::Layers, wo: DVec3, wi: DVec3| {
        let h = (wo + wi).normalize();
        let [d, g] = ggx(wo, wi, h, f64::from(l.widths.x));
        let f = f64::from(l.reflect.x) + f64::from(l.reflect_rise.x) * (1.0 - wo.dot(h)).powi(5);
        d * g * f / (4.0 * wo.z)
    };
    let glass = Surface { transmission: 1.0, specular: 1.0, roughness: 0.5, ..WHITE };
    let refraction = |l: &bsdf::Layers, wo: DVec3, wi: DVec3| {
        // Walter et al. 2007, eq. 21, with the indices of both sides.
        let eta = f64::from(l.eta);
        let mut h = (wo + eta * wi).normalize();
        h *= h.z.signum();
        let [d, g] = ggx(wo, wi, h, f64::from(l.widths.x));
        let root = wo.dot(h) + eta * wi.dot(h);
        let t = 1.0 - fresnel(wo.dot(h), eta);
        wo.dot(h) * wi.dot(h).abs() / wo.z * eta * eta * t * g * d / (root * root) * f64::from(l.glass.x)
    };
    // Rounding of the half vector divided by the widths, squared in D; larger where the two directions nearly cancel.
    for (name, error, bound) in [
        ("reflection", worst(&metal, reflection, false), 1e-4),
        ("refraction in", worst(&glass, refraction, true), 1e-3),
        ("refraction out", worst(&Surface { entering: false, ..glass }, refraction, true), 1e-3),
    ] {
        println!("{name}: largest relative error {error:.1e}");
        assert!(error < bound, "{name}: {error}");
    }
    let wrong = worst(&metal, |l, wo, wi| reflection(l, wo, wi) * 1.001, false);
    assert!(wrong > 5e-4, "planted error of 0.1 %: {wrong}");
}

/// Largest f(wo, wi) / f(wi, wo) - 1 over many pairs.
fn asymmetry(surface: &Surface) -> f32 {
    let mut d = Draws::new("reciprocity");
    let f = |o: Vec3, i: Vec3| {
        let layers = bsdf::layers(surface, o, &TABLES, Lobes::ALL);
        bsdf::eval(&layers, o, i, Lobes::ALL).value.x / i.z
    };
    let pairs = (0..2000).map(|_| [0; 2].map(|_| direction(d.range(0.05, 1.0), d.uniform())));
    pairs.map(|[a, b]| (f(a, b) / f(b, a) - 1.0).abs()).fold(0.0, f32::max)
}

#[test]
fn reciprocity_holds_without_compensation_and_not_with_it() {
    // Lambert, and smooth metal, which needs almost no compensation.
    assert!(asymmetry(&WHITE) < 1e-6);
    let smooth = asymmetry(&Surface { metallic: 1.0, roughness: 0.1, ..WHITE });
    println!("smooth metal {smooth:.1e}");
    // Layering and compensation use the albedo seen from `wo`, so these lobes are not reciprocal. That is the price of
    // conserving energy.
    let rough = asymmetry(&Surface { metallic: 1.0, roughness: 1.0, ..WHITE });
    let plastic = asymmetry(&Surface { specular: 1.0, roughness: 0.3, ..WHITE });
    println!("rough metal {rough:.2}, plastic {plastic:.2}");
    assert!(rough > 0.05 && plastic > 0.05);
}
