//! Computes the tables of [`albedo`](super::albedo) by quadrature in f64. No shader twin: the tables are uploaded.
//!
//! GGX is integrated over the random numbers of its sampler of visible normals; the integrand is then a ratio of
//! masking terms between 0 and 1. Sheen is integrated over directions. The cosine uses Gauss-Legendre quadrature. The
//! azimuth uses equal steps, which converge as fast for periodic functions.

use super::albedo::{
    ANISOTROPIC, AlbedoTables, CELLS, COSINES, GLASS_COSINES, GLASS_IORS, GLASS_ROUGHNESSES, MIN_ASPECT, ROUGHNESSES,
};
use super::microfacet::{MIN_SHEEN_COSINE, MIN_SHEEN_ROUGHNESS, MIN_WIDTH};
const MIN_C: f64 = MIN_SHEEN_COSINE as f64;
const IOR_ROOT: f64 = super::albedo::IOR_ROOT as f64;
const SHEEN_ROOT: f64 = super::albedo::SHEEN_ROOT as f64;
use glam::{DVec2, DVec3, Vec4};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Quadrature points along the cosine and over half a turn of azimuth; the other half is its mirror image.
const POINTS: [usize; 2] = [24, 12];
/// Quadrature points for refraction. There are more than for reflection, because total internal reflection has an edge.
const GLASS_POINTS: [usize; 2] = [32, 16];
/// Quadrature points for anisotropic GGX. Its table holds small differences, so fewer suffice.
const ANISOTROPIC_POINTS: [usize; 2] = [16, 10];

/// Nodes and weights of Gauss-Legendre quadrature on \[0, 1\], by Newton's method.
fn gauss(count: usize) -> Vec<[f64; 2]> {
    let n = count as f64;
    (0..count)
        .map(|i| {
            let mut x = (PI * (i as f64 + 0.75) / (n + 0.5)).cos();
            let mut slope = 1.0;
            // The first guess is good to 1 / n^2 and convergence is quadratic, so six steps reach f64 precision.
            for _ in 0..6 {
                let [mut p0, mut p1] = [1.0, x];
                for k in 2..=count {
                    let k = k as f64;
                    [p0, p1] = [p1, ((2.0 * k - 1.0) * x * p1 - (k - 1.0) * p0) / k];
                }
                slope = n * (x * p1 - p0) / (x * x - 1.0);
                x -= p1 / slope;
            }
            [0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope)]
        })
        .collect()
}

fn half_turn(n: usize) -> Vec<[f64; 2]> {
    (0..n)
        .map(|i| {
            let angle = PI * (i as f64 + 0.5) / n as f64;
            [angle.cos(), angle.sin()]
        })
        .collect()
}

/// A rough boundary with GGX widths `a`, seen from `wo`.
struct Facets {
    wo: DVec3,
    length: f64,
    a: DVec2,
}

impl Facets {
    fn new(wo: DVec3, a: DVec2) -> Self {
        Self { wo, length: stretched(wo, a), a }
    }

    /// Mean of `f(normal)` over the visible normals. If the x axis is a line of symmetry, `spokes` over half a turn
    /// suffice.
    fn mean<const N: usize>(&self, rings: &[[f64; 2]], spokes: &[[f64; 2]], f: impl Fn(DVec3) -> [f64; N]) -> [f64; N] {
        let s = DVec3::new(self.wo.x * self.a.x, self.wo.y * self.a.y, self.wo.z).normalize();
        let mut sum = [0.0; N];
        for &[t, weight] in rings {
            // Normals that reflect below the horizon are concentrated at the end of this range.
            let [u, weight] = [1.0 - t * t, 2.0 * t * weight];
            let q = u * (1.0 + s.z);
            let r = (q * (2.0 - q)).max(0.0).sqrt();
            for [cos, sin] in spokes {
                let h = DVec3::new(r * cos + s.x, r * sin + s.y, (1.0 - u) * (1.0 + s.z));
                let h = DVec3::new(h.x * self.a.x, h.y * self.a.y, h.z).normalize();
                let values = f(h);
                for (sum, value) in sum.iter_mut().zip(values) {
                    *sum += value * weight / spokes.len() as f64;
                }
            }
        }
        sum
    }

    /// Smith's G2 / G1 for `wi`, in reflection or refraction.
    fn shadowing(&self, wi: DVec3) -> f64 {
        let z = wi.z.abs();
        let sum = z * self.length + self.wo.z * stretched(wi, self.a);
        if sum > 0.0 { z * (self.wo.z + self.length) / sum } else { 0.0 }
    }
}

fn stretched(v: DVec3, a: DVec2) -> f64 {
    let [x, y] = [v.x * a.x, v.y * a.y];
    (x * x + y * y + v.z * v.z).sqrt()
}

/// Direction with cosine `z` whose x and y are in the ratio `azimuth` to 1 - `azimuth`.
fn seen_from(z: f64, azimuth: f64) -> DVec3 {
    let r = (1.0 - z * z).max(0.0).sqrt() / (azimuth * azimuth + (1.0 - azimuth) * (1.0 - azimuth)).sqrt();
    DVec3::new(r * azimuth, r * (1.0 - azimuth), z)
}

fn mirrored(v: DVec3, h: DVec3) -> DVec3 {
    2.0 * v.dot(h) * h - v
}

/// Directional albedo of GGX for reflectance 1, and for reflectance (1 - v.h)^5.
fn ggx(wo: DVec3, a: DVec2, rings: &[[f64; 2]], spokes: &[[f64; 2]]) -> [f64; 2] {
    let facets = Facets::new(wo, a);
    facets.mean(rings, spokes, |h| {
        let wi = mirrored(facets.wo, h);
        let g = if wi.z > 0.0 { facets.shadowing(wi) } else { 0.0 };
        [g, g * (1.0 - facets.wo.dot(h)).powi(5)]
    })
}

/// Directional albedo of a rough boundary into a medium of `ior`: with Fresnel's reflectance, and with total internal
/// reflection only; then both for the way out of the medium.
fn glass(wo: DVec3, a: DVec2, ior: f64, rings: &[[f64; 2]], spokes: &[[f64; 2]]) -> [f64; 4] {
    let facets = Facets::new(wo, a);
    facets.mean(rings, spokes, |h| {
        let up = mirrored(wo, h);
        let reflected = if up.z > 0.0 { facets.shadowing(up) } else { 0.0 };
        let c = wo.dot(h).min(1.0);
        let way = |eta: f64| {
            let k = 1.0 - (1.0 - c * c) / (eta * eta);
            if k <= 0.0 {
                return [reflected, reflected];
            }
            let t = k.sqrt();
            let s = (c - eta * t) / (c + eta * t);
            let p = (eta * c - t) / (eta * c + t);
            let f = 0.5 * (s * s + p * p);
            let down = (c / eta - t) * h - wo / eta;
            let through = if down.z < 0.0 { facets.shadowing(down) } else { 0.0 };
            [f * reflected + (1.0 - f) * through, through]
        };
        let [[a, b], [c, d]] = [way(ior), way(1.0 / ior)];
        [a, b, c, d]
    })
}

fn charlie_lambda(c: f64, a: f64) -> f64 {
    let w = (1.0 - a) * (1.0 - a);
    let mix = |rough: f64, smooth: f64| rough + (smooth - rough) * w;
    let [top, slope, power] = [mix(21.5473, 25.3245), mix(3.82987, 3.32435), mix(0.19823, 0.16801)];
    let [linear, offset] = [mix(-1.97760, -1.27393), mix(-4.32054, -4.85967)];
    let curve = |x: f64| top / (1.0 + slope * x.powf(power)) + linear * x + offset;
    if c < 0.5 { curve(c).exp() } else { (2.0 * curve(0.5) - curve(1.0 - c)).exp() }
}

/// Directional albedo of white sheen.
fn sheen(z: f64, a: f64, rings: &[[f64; 2]], spokes: &[[f64; 2]]) -> f64 {
    let wo = seen_from(z, 1.0);
    let lambda_o = charlie_lambda(z.max(MIN_C), a);
    let mut sum = 0.0;
    for &[t, weight] in rings {
        // Substitution cosine = t^4: the lobe's weight is concentrated at the horizon.
        let c = t.powi(4);
        let r = (1.0 - c * c).max(0.0).sqrt();
        let lambda_i = charlie_lambda(c.max(MIN_C), a);
        let visibility = (1.0 / ((1.0 + lambda_o + lambda_i) * 4.0 * z.max(MIN_C) * c.max(MIN_C))).min(1.0);
        for [cos, sin] in spokes {
            let h = (wo + DVec3::new(r * cos, r * sin, c)).normalize();
            let d = (2.0 + 1.0 / a) * (1.0 - h.z * h.z).max(0.0).powf(0.5 / a) / (2.0 * PI);
            sum += d * visibility * c * 4.0 * t.powi(3) * weight * 2.0 * PI / spokes.len() as f64;
        }
    }
    sum
}

fn knot(index: u32, count: u32) -> f64 {
    f64::from(index) / f64::from(count - 1)
}

/// Inverse of [`albedo_cosine`](super::albedo::albedo_cosine).
fn cosine_at(x: f64, width: f64) -> f64 {
    let k = width * (1.0 - 0.75 * width);
    x * k / (1.0 + k - x)
}

impl AlbedoTables {
    /// Computes all tables, on all threads.
    pub fn compute() -> Self {
        let rings = gauss(POINTS[0]);
        let spokes = half_turn(POINTS[1]);
        let glass_rings = gauss(GLASS_POINTS[0]);
        let glass_spokes = half_turn(GLASS_POINTS[1]);
        let few_rings = gauss(ANISOTROPIC_POINTS[0]);
        let few = half_turn(ANISOTROPIC_POINTS[1]);
        let around: Vec<[f64; 2]> = few.iter().flat_map(|&[c, s]| [[c, s], [c, -s]]).collect();
        let width_at = |roughness: f64| (roughness * roughness).max(f64::from(MIN_WIDTH));
        let first = (0..COSINES * ROUGHNESSES).into_par_iter().map(|i| {
            let [x, r] = [knot(i % COSINES, COSINES), knot(i / COSINES, ROUGHNESSES)];
            let a = width_at(r);
            let z = cosine_at(x, a);
            let [white, rising] = ggx(seen_from(z, 1.0), DVec2::splat(a), &rings, &spokes);
            let low = f64::from(MIN_SHEEN_ROUGHNESS);
            let rs = low + (1.0 - low) * r;
            let root = SHEEN_ROOT + (1.0 - SHEEN_ROOT) * x;
            let cloth = sheen(root.powi(4), rs * rs, &rings, &spokes);
            Vec4::new(white as f32, (rising - white * (1.0 - z).powi(5)) as f32, cloth as f32, 0.0)
        });
        let plane = GLASS_COSINES * GLASS_ROUGHNESSES;
        let second = (0..plane * GLASS_IORS).into_par_iter().map(|i| {
            let x = knot(i % GLASS_COSINES, GLASS_COSINES);
            let r = knot(i / GLASS_COSINES % GLASS_ROUGHNESSES, GLASS_ROUGHNESSES);
            let root = IOR_ROOT + (1.0 - IOR_ROOT) * knot(i / plane, GLASS_IORS);
            let ratio = 0.5 * root * root;
            let eta = (1.0 + ratio) / (1.0 - ratio);
            let a = width_at(r);
            let z = cosine_at(x * x, a);
            let sums = glass(seen_from(z, 1.0), DVec2::splat(a), eta, &glass_rings, &glass_spokes);
            Vec4::from_array(sums.map(|x| x as f32))
        });
        let third = (0..ANISOTROPIC.iter().product()).into_par_iter().map(|i: u32| {
            let [nx, ny, nz, nw] = ANISOTROPIC;
            let [x, azimuth] = [knot(i % nx, nx), knot(i / nx % ny, ny)];
            let r = knot(i / (nx * ny) % nz, nz);
            let low = f64::from(MIN_ASPECT);
            let aspect = low + (1.0 - low) * knot(i / (nx * ny * nz), nw);
            let wide = width_at(r);
            let a = DVec2::new(wide, (wide * aspect * aspect).max(f64::from(MIN_WIDTH)));
            let z = cosine_at(x, wide);
            let mean = (0.5 * (a.x * a.x + a.y * a.y)).sqrt();
            let smooth = (1.0 - z).powi(5);
            let [white, rising] = ggx(seen_from(z, azimuth), a, &few_rings, &around);
            let [mean_white, mean_rising] = ggx(seen_from(z, 1.0), DVec2::splat(mean), &few_rings, &few);
            let white = white - mean_white;
            Vec4::new(white as f32, (rising - mean_rising - white * smooth) as f32, 0.0, 0.0)
        });
        let cells: Vec<Vec4> = first.chain(second).chain(third).collect();
        debug_assert_eq!(cells.len(), CELLS as usize);
        Self { cells }
    }
}
