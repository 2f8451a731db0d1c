//! Microfacet functions: GGX, sampling of visible normals, Fresnel's equations, Charlie sheen. In the local frame, z is
//! the normal.

use super::direction::unit;
use afterimage::kernel::approx::{exp_approx, ln_approx, sin_cos_turns};
use glam::{Vec2, Vec3};
use std::f32::consts::PI;

/// Smallest GGX width. Keeps lobes from becoming delta functions, so that f32 can represent every density.
pub const MIN_WIDTH: f32 = 1e-3;

/// Smallest roughness of the sheen. Below it, the distribution near the horizon exceeds f32 precision.
pub const MIN_SHEEN_ROUGHNESS: f32 = 0.1;

/// Smallest cosine in the sheen's visibility, 0.06 degrees above the horizon. Below it the fitted shadowing grows
/// without bound.
pub const MIN_SHEEN_COSINE: f32 = 1e-3;

/// GGX widths along x and y: squared perceptual `roughness`, stretched by Burley's aspect sqrt(1 - 0.9 `anisotropy`)
/// (2012, section 5.4), at most 1.
#[inline]
pub fn ggx_widths(roughness: f32, anisotropy: f32) -> Vec2 {
    let width = (roughness * roughness).clamp(MIN_WIDTH, 1.0);
    let aspect = (1.0 - 0.9 * anisotropy.clamp(0.0, 1.0)).sqrt();
    Vec2::new((width / aspect).min(1.0), (width * aspect).max(MIN_WIDTH))
}

/// Width of an isotropic GGX with the same mean square slope.
#[inline]
pub fn ggx_mean_width(a: Vec2) -> f32 {
    (0.5 * (a.x * a.x + a.y * a.y)).sqrt()
}

/// Length of `v` scaled by the widths: sqrt(ax^2 x^2 + ay^2 y^2 + z^2), equal to |z| sqrt(1 + a^2 tan^2) = |z| (1 + 2
/// Lambda).
#[inline]
pub fn ggx_length(v: Vec3, a: Vec2) -> f32 {
    let x = v.x * a.x;
    let y = v.y * a.y;
    (x * x + y * y + v.z * v.z).sqrt()
}

/// GGX distribution of unit normals `h` in 1/sr (Trowbridge and Reitz 1975; Walter et al. 2007; anisotropic: Burley
/// 2012).
#[inline]
pub fn ggx_d(h: Vec3, a: Vec2) -> f32 {
    let x = h.x / a.x;
    let y = h.y / a.y;
    let e = x * x + y * y + h.z * h.z;
    1.0 / (((PI * a.x) * a.y) * (e * e))
}

/// Samples a GGX normal visible from `v` (z > 0), by spherical caps (Dupuy and Benyoub, "Sampling Visible GGX Normals
/// with Spherical Caps", 2023).
#[inline]
pub fn vndf_sample(v: Vec3, a: Vec2, u: Vec2) -> Vec3 {
    let s = unit(Vec3::new(v.x * a.x, v.y * a.y, v.z));
    let [sin, cos] = sin_cos_turns(u.x);
    // The point on the cap has z = 1 - q. Its sine, and its sum with s.z, are computed without cancellation.
    let q = u.y * (1.0 + s.z);
    let r = (q * (2.0 - q)).max(0.0).sqrt();
    let h = Vec3::new(r * cos + s.x, r * sin + s.y, (1.0 - u.y) * (1.0 + s.z));
    unit(Vec3::new(h.x * a.x, h.y * a.y, h.z))
}

/// (1 - `cosine`)^5 of Schlick's approximation (1994): weight between reflectance at normal incidence and 1.
#[inline]
pub fn schlick_weight(cosine: f32) -> f32 {
    let x = (1.0 - cosine).clamp(0.0, 1.0);
    let x2 = x * x;
    (x2 * x2) * x
}

/// Reflectance at normal incidence of a boundary with relative index of refraction `ior`.
#[inline]
pub fn reflectance_at_normal(ior: f32) -> f32 {
    let r = (ior - 1.0) / (ior + 1.0);
    r * r
}

/// Fresnel reflectance of unpolarized light at `cosine` >= 0. `eta` is the ratio of the indices of refraction behind
/// and in front of the boundary. 1 under total internal reflection.
#[inline]
pub fn fresnel_dielectric(cosine: f32, eta: f32) -> f32 {
    let c = cosine.clamp(0.0, 1.0);
    let k = refraction_discriminant(c, eta);
    if k <= 0.0 {
        return 1.0;
    }
    let t = k.sqrt();
    let s = (c - eta * t) / (c + eta * t);
    let p = (eta * c - t) / (eta * c + t);
    0.5 * (s * s + p * p)
}

/// Squared cosine of the refracted ray, from the cosine of the incident ray (Snell). Not positive under total internal
/// reflection.
#[inline]
pub fn refraction_discriminant(cosine: f32, eta: f32) -> f32 {
    1.0 - (1.0 - cosine) * (1.0 + cosine) / (eta * eta)
}

/// `v` reflected about the normal `h`.
#[inline]
pub fn mirrored(v: Vec3, h: Vec3) -> Vec3 {
    let d = 2.0 * v.dot(h);
    Vec3::new(d * h.x - v.x, d * h.y - v.y, d * h.z - v.z)
}

/// `v` refracted at the normal `h` (v.h > 0) into the side whose index of refraction is `eta` times larger. Requires a
/// positive [`refraction_discriminant`] of v.h.
#[inline]
pub fn refracted(v: Vec3, h: Vec3, eta: f32) -> Vec3 {
    let c = v.dot(h);
    let t = refraction_discriminant(c, eta).max(0.0).sqrt();
    let d = c / eta - t;
    Vec3::new(d * h.x - v.x / eta, d * h.y - v.y / eta, d * h.z - v.z / eta)
}

/// Charlie distribution of normals with cosine `cosine`: (2 + 1/a) sin^(1/a) / (2 pi) (Estevez and Kulla, "Production
/// Friendly Microfacet Sheen BRDF", 2017). The power is clamped to at least e^-60, to avoid denormals. `a` is the
/// squared perceptual roughness.
#[inline]
pub fn charlie_d(cosine: f32, a: f32) -> f32 {
    let sin2 = ((1.0 - cosine) * (1.0 + cosine)).max(1e-30);
    ((a * (1.0 / PI) + 0.5 / PI) / a) * exp_approx((ln_approx(sin2) * (0.5 / a)).max(-60.0))
}

/// Charlie's shadowing curve L, fitted for a = 1 and a = 0 and blended by (1 - a)^2.
#[inline]
pub fn charlie_curve(x: f32, a: f32) -> f32 {
    let w = (1.0 - a) * (1.0 - a);
    let top = 21.5473 + 3.7772 * w;
    let slope = 3.82987 - 0.50552 * w;
    let power = 0.19823 - 0.03022 * w;
    let linear = -1.9776 + 0.70367 * w;
    let offset = -4.32054 - 0.53913 * w;
    let raised = exp_approx(ln_approx(x.max(1e-30)) * power);
    (top / (slope * raised + 1.0) + offset) + linear * x
}

/// Charlie's Lambda for a direction with cosine `cosine` in \[0, 1\].
#[inline]
pub fn charlie_lambda(cosine: f32, a: f32) -> f32 {
    let c = cosine.clamp(MIN_SHEEN_COSINE, 1.0);
    if c < 0.5 {
        return exp_approx(charlie_curve(c, a));
    }
    exp_approx(2.0 * charlie_curve(0.5, a) - charlie_curve(1.0 - c, a))
}

/// Visibility of the sheen, G / (4 cos cos), at most 1 (glTF KHR_materials_sheen).
#[inline]
pub fn charlie_visibility(cos_o: f32, lambda_o: f32, cos_i: f32, lambda_i: f32) -> f32 {
    let o = cos_o.max(MIN_SHEEN_COSINE);
    let i = cos_i.max(MIN_SHEEN_COSINE);
    let x = ((1.0 + lambda_o) + lambda_i) * ((4.0 * o) * i);
    if x > 1.0 { 1.0 / x } else { 1.0 }
}
