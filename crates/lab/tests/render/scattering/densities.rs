//! Samplers against their densities: chi-squared tests over bins of (cosine, azimuth), and integrals of densities.

use super::surfaces::*;
use afterimage_lab::kernel::bsdf::{self, Layers, Lobes, Surface};
use afterimage_lab::kernel::microfacet::{ggx_d, ggx_length, vndf_sample};
use afterimage_lab::kernel::sampling::*;
use afterimage_testing::{Draws, accept, p_of_counts, reject};
use glam::{Vec2, Vec3};
use std::f64::consts::{PI, TAU};

/// Bins along the cosine and the azimuth.
const BINS: [usize; 2] = [16, 12];
/// Midpoint rule points per bin, along each axis.
const POINTS: usize = 48;
/// Samples per test.
const SAMPLES: u64 = 200_000;

fn bin(w: Vec3) -> usize {
    let z = ((f64::from(w.z) + 1.0) * 0.5 * BINS[0] as f64).min(BINS[0] as f64 - 1.0) as usize;
    let turn = f64::from(w.y).atan2(f64::from(w.x)) / TAU;
    let a = ((turn + 0.5) * BINS[1] as f64).min(BINS[1] as f64 - 1.0) as usize;
    z * BINS[1] + a
}

/// Probability of each bin by quadrature of `pdf`.
fn expected(pdf: impl Fn(Vec3) -> f32) -> Vec<f64> {
    let steps = [BINS[0] * POINTS, BINS[1] * POINTS];
    let mut bins = vec![0.0; BINS[0] * BINS[1]];
    for i in 0..steps[0] {
        for j in 0..steps[1] {
            let z = (i as f64 + 0.5) / steps[0] as f64 * 2.0 - 1.0;
            let angle = ((j as f64 + 0.5) / steps[1] as f64 - 0.5) * TAU;
            let r = (1.0 - z * z).sqrt();
            let w = Vec3::new((r * angle.cos()) as f32, (r * angle.sin()) as f32, z as f32);
            bins[(i / POINTS) * BINS[1] + j / POINTS] += f64::from(pdf(w)) * 4.0 * PI / (steps[0] * steps[1]) as f64;
        }
    }
    bins
}

/// p-value of samples against `pdf`. Draws without a direction have a bin of their own. Bins that expect fewer than 5
/// samples are merged; the merged bin is left out if it still expects fewer.
fn p_of(name: &str, sample: impl Fn(&mut Draws) -> Option<Vec3>, pdf: impl Fn(Vec3) -> f32) -> f64 {
    let probabilities = expected(pdf);
    let mut counts = vec![0; probabilities.len()];
    let mut lost = 0;
    let mut d = Draws::new(name);
    for _ in 0..SAMPLES {
        match sample(&mut d) {
            Some(w) => counts[bin(w)] += 1,
            None => lost += 1,
        }
    }
    let total: f64 = probabilities.iter().sum();
    assert!(total < 1.001, "{name}: the density integrates to {total}");
    let all = counts.into_iter().zip(probabilities.iter().map(|p| p * SAMPLES as f64));
    let (mut kept, few): (Vec<(u64, f64)>, Vec<_>) = all.partition(|&(_, e)| e >= 5.0);
    let n: u64 = lost + few.iter().map(|bin| bin.0).sum::<u64>();
    let e = (1.0 - total).max(0.0) * SAMPLES as f64 + few.iter().map(|bin| bin.1).sum::<f64>();
    if e >= 5.0 {
        kept.push((n, e));
    } else {
        // Poisson counts with 5 expected exceed 30 with probability 2e-14.
        assert!(n <= 30, "{name}: {n} samples where {e} are expected");
    }
    let (counts, expected): (Vec<_>, Vec<_>) = kept.into_iter().unzip();
    p_of_counts(&counts, &expected)
}

fn two(d: &mut Draws) -> Vec2 {
    Vec2::new(d.uniform(), d.uniform())
}

#[test]
fn shapes_are_sampled_by_their_densities() {
    accept("cosine", p_of("cosine", |d| Some(cosine_hemisphere(two(d))), |w| cosine_hemisphere_pdf(w.z)));
    accept("hemisphere", p_of("hemisphere", |d| Some(uniform_hemisphere(two(d))), |w| uniform_hemisphere_pdf(w.z)));
    reject("cosine as uniform", p_of("wrong", |d| Some(uniform_hemisphere(two(d))), |w| cosine_hemisphere_pdf(w.z)));
    // Triangle and disk, in bins of equal area.
    let mut counts = [vec![0; 16], vec![0; 16]];
    let mut d = Draws::new("triangle and disk");
    for _ in 0..SAMPLES {
        let b = barycentrics(two(&mut d));
        // (1 - b0)^2 is uniform, and so is b2 / (1 - b0).
        let first = ((1.0 - b.x) * (1.0 - b.x) * 4.0).min(3.0) as usize;
        counts[0][first * 4 + (b.z / (1.0 - b.x).max(1e-9) * 4.0).clamp(0.0, 3.0) as usize] += 1;
        let p = disk(two(&mut d));
        let turn = p.y.atan2(p.x) / std::f32::consts::TAU + 0.5;
        counts[1][(p.length_squared() * 4.0).min(3.0) as usize * 4 + (turn * 4.0).min(3.0) as usize] += 1;
    }
    for (name, counts) in ["triangle", "disk"].into_iter().zip(&counts) {
        accept(name, p_of_counts(counts, &[SAMPLES as f64 / 16.0; 16]));
    }
}

#[test]
fn visible_normals_are_sampled_by_their_density() {
    for (z, a) in [(0.9, [0.5, 0.5]), (0.3, [0.8, 0.2]), (0.05, [0.3, 0.6])] {
        let v = direction(z, 0.15);
        let a = Vec2::from(a);
        let name = format!("visible normals from {z}, widths {a}");
        let sample = |d: &mut Draws| Some(vndf_sample(v, a, two(d)));
        // D G1 (v.h) / v.z (Heitz 2018, eq. 3).
        let pdf = |h: Vec3| 2.0 * ggx_d(h, a) * v.dot(h).max(0.0) / (v.z + ggx_length(v, a));
        accept(&name, p_of(&name, sample, |h| if h.z > 0.0 { pdf(h) } else { 0.0 }));
    }
}

fn surfaces() -> Vec<(&'static str, Surface)> {
    let rough = Surface { roughness: 0.75, specular: 1.0, base_color: Vec3::new(0.8, 0.5, 0.2), ..WHITE };
    let glass = Surface { transmission: 1.0, base_color: Vec3::ONE, ..rough };
    let coated = Surface { clearcoat: 1.0, clearcoat_roughness: 0.7, ..rough };
    let sheen_color = Vec3::new(0.3, 0.5, 0.1);
    vec![
        ("plastic", rough),
        ("metal", Surface { metallic: 1.0, anisotropy: 0.6, ..rough }),
        ("coat and sheen", Surface { sheen_color: Vec3::splat(0.5), ..coated }),
        ("glass from outside", glass),
        ("glass from inside", Surface { entering: false, ..glass }),
        ("sheet", Surface { thin: true, ..glass }),
        ("all", Surface { metallic: 0.3, anisotropy: 0.5, clearcoat: 0.7, sheen_color, transmission: 0.5, ..coated }),
    ]
}

fn sampled(layers: &Layers, wo: Vec3, d: &mut Draws) -> Option<Vec3> {
    let u = std::array::from_fn(|_| d.uniform());
    let s = bsdf::sample(layers, wo, u, Lobes::ALL);
    (s.scatter.pdf > 0.0).then_some(s.wi)
}

#[test]
fn every_lobe_is_sampled_by_its_density() {
    for (name, surface) in surfaces() {
        for z in [0.95, 0.4] {
            let wo = direction(z, 0.1);
            let layers = bsdf::layers(&surface, wo, &TABLES, Lobes::ALL);
            let name = format!("{name} from {z}");
            let pdf = |w: Vec3| bsdf::eval(&layers, wo, w, Lobes::ALL).pdf;
            accept(&name, p_of(&name, |d| sampled(&layers, wo, d), pdf));
            // Planted error: a density 5 % too small on one side of the plane of incidence.
            if name.starts_with("all") {
                let wrong = |w: Vec3| pdf(w) * if w.y * wo.x > w.x * wo.y { 0.95 } else { 1.0 };
                reject(&name, p_of(&name, |d| sampled(&layers, wo, d), wrong));
            }
        }
    }
}
