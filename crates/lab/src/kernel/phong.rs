//! The thesis' material: Lambert's kd / pi and Phong's ks (n + 2) / (2 pi) (r.o)^n. Directions are sampled uniformly
//! over the hemisphere; each sample evaluates one lobe, chosen by mean albedo. In the local frame, z is the normal.

use super::bsdf::{Sampled, Scatter};
use super::sampling::{uniform_hemisphere, uniform_hemisphere_pdf};
use afterimage::kernel::approx::{exp_approx, ln_approx};
use glam::{Vec2, Vec3};
use std::f32::consts::FRAC_1_PI;

/// Albedos of the lobes. They conserve energy if their sum is at most 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhongSurface {
    /// Albedo of Lambert's lobe.
    pub diffuse: Vec3,
    /// Albedo of Phong's lobe at normal incidence.
    pub specular: Vec3,
    /// Phong's exponent, 0 or more.
    pub exponent: f32,
}

/// `x`^`y` for x in \[0, 1\] and y in \[0, 1e6\]; 0^0 is 1. Results below e^-60 become e^-60; 0 at x = 0.
#[inline]
pub fn phong_power(x: f32, y: f32) -> f32 {
    if y <= 0.0 {
        return 1.0;
    }
    if x <= 0.0 {
        return 0.0;
    }
    exp_approx((ln_approx(x.max(1e-30)) * y).max(-60.0))
}

/// Probability of choosing Phong's lobe: its share of the mean albedo.
#[inline]
pub fn phong_specular_probability(surface: &PhongSurface) -> f32 {
    let diffuse = (surface.diffuse.x + surface.diffuse.y) + surface.diffuse.z;
    let specular = (surface.specular.x + surface.specular.y) + surface.specular.z;
    let sum = diffuse + specular;
    if sum > 0.0 { specular / sum } else { 0.0 }
}

/// f |cos wi| of Lambert's lobe.
#[inline]
pub fn phong_diffuse(surface: &PhongSurface, wi: Vec3) -> Vec3 {
    surface.diffuse * (wi.z.max(0.0) * FRAC_1_PI)
}

/// f |cos wi| of Phong's lobe, whose `r` is `wi` mirrored at the normal.
#[inline]
pub fn phong_specular(surface: &PhongSurface, wo: Vec3, wi: Vec3) -> Vec3 {
    let cosine = (wi.z * wo.z - (wi.x * wo.x + wi.y * wo.y)).clamp(0.0, 1.0);
    let top = (surface.exponent + 2.0) * (0.5 * FRAC_1_PI);
    surface.specular * ((top * phong_power(cosine, surface.exponent)) * wi.z.max(0.0))
}

/// Value of both lobes and density of [`phong_sample`]; 0 below the horizon.
#[inline]
pub fn phong_eval(surface: &PhongSurface, wo: Vec3, wi: Vec3) -> Scatter {
    if wo.z <= 0.0 || wi.z <= 0.0 {
        return Scatter::NONE;
    }
    Scatter { value: phong_diffuse(surface, wi) + phong_specular(surface, wo, wi), pdf: uniform_hemisphere_pdf(wi.z) }
}

/// Samples a direction uniformly over the hemisphere. `u[0]` chooses a lobe; the value is that lobe's over its
/// probability, so its mean is [`phong_eval`]'s value.
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
