//! The thesis' material: Lambert's kd / pi and Phong's ks (n + 2) / (2 pi) (r.o)^n, sampled uniformly over the hemisphere, one lobe
//! a sample, chosen by mean albedo. Local frame, z is the normal.

use super::bsdf::{Sampled, Scatter};
use super::sampling::{uniform_hemisphere, uniform_hemisphere_pdf};
use afterimage::kernel::approx::{exp, ln};
use glam::{Vec2, Vec3};
use std::f32::consts::{FRAC_1_PI, PI};

/// The lobes' albedos; together at most 1 for a material that creates no light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhongSurface {
    /// Lambert's.
    pub diffuse: Vec3,
    /// Phong's, at normal incidence.
    pub specular: Vec3,
    /// 0 or more.
    pub exponent: f32,
}

/// `x`^`y` for x in \[0, 1\], y in \[0, 1e6\]; 0^0 is 1. Results below e^-60 are e^-60, or 0 at x = 0.
#[inline]
pub fn phong_power(x: f32, y: f32) -> f32 {
    if y <= 0.0 {
        return 1.0;
    }
    if x <= 0.0 {
        return 0.0;
    }
    exp((ln(x.max(1e-30)) * y).max(-60.0))
}

/// Probability that a sample is of Phong's lobe: its share of the mean albedo.
#[inline]
pub fn phong_specular_probability(surface: &PhongSurface) -> f32 {
    let diffuse = (surface.diffuse.x + surface.diffuse.y) + surface.diffuse.z;
    let specular = (surface.specular.x + surface.specular.y) + surface.specular.z;
    let sum = diffuse + specular;
    if sum > 0.0 { specular / sum } else { 0.0 }
}

/// Lambert's lobe: f |cos wi|.
#[inline]
pub fn phong_diffuse(surface: &PhongSurface, wi: Vec3) -> Vec3 {
    surface.diffuse * (wi.z.max(0.0) * FRAC_1_PI)
}

/// Phong's lobe: f |cos wi|; `r` is `wi` mirrored at the normal.
#[inline]
pub fn phong_specular(surface: &PhongSurface, wo: Vec3, wi: Vec3) -> Vec3 {
    let cosine = (wi.z * wo.z - (wi.x * wo.x + wi.y * wo.y)).clamp(0.0, 1.0);
    let top = (surface.exponent + 2.0) / (2.0 * PI);
    surface.specular * ((top * phong_power(cosine, surface.exponent)) * wi.z.max(0.0))
}

/// Both lobes and the density of [`phong_sample`]; 0 below the horizon.
#[inline]
pub fn phong_eval(surface: &PhongSurface, wo: Vec3, wi: Vec3) -> Scatter {
    if wo.z <= 0.0 || wi.z <= 0.0 {
        return Scatter::NONE;
    }
    Scatter { value: phong_diffuse(surface, wi) + phong_specular(surface, wo, wi), pdf: uniform_hemisphere_pdf(wi.z) }
}

/// A direction, uniform over the hemisphere. The value is of the one lobe that `u[0]` chooses, over its probability; its mean is
/// [`phong_eval`]'s.
#[inline]
pub fn phong_sample(surface: &PhongSurface, wo: Vec3, u: [f32; 3]) -> Sampled {
    let wi = uniform_hemisphere(Vec2::new(u[1], u[2]));
    if wo.z <= 0.0 || wi.z <= 0.0 {
        return Sampled { wi, scatter: Scatter::NONE };
    }
    let probability = phong_specular_probability(surface);
    let value = if u[0] < probability {
        phong_specular(surface, wo, wi) / probability
    } else {
        phong_diffuse(surface, wi) / (1.0 - probability)
    };
    Sampled { wi, scatter: Scatter { value, pdf: uniform_hemisphere_pdf(wi.z) } }
}
