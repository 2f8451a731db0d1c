//! The Disney principled BSDF (Burley 2012, 2015) in glTF's parametrization, layered by directional albedo so that a
//! white material with any parameters conserves energy exactly.
//!
//! Local frame: z is the shading normal, on the side of `wo`; x is the tangent. `wo` points to the viewer, `wi` to the
//! light. Values are f |cos wi|; densities are per solid angle of `wi`. Radiance inside a medium is divided by its
//! squared index of refraction (basic radiance), so refraction does not scale it. Where both ends of a path are in air,
//! that equals radiance.
//!
//! [`layers`] computes everything that depends only on the surface point and `wo`, once; [`eval`] and [`sample`] use
//! it.

use super::direction::unit;
use super::layers::glass_fresnel;
pub use super::layers::{Layers, Lobes, Surface, layers};
use super::microfacet::{
    charlie_d, charlie_lambda, charlie_visibility, fresnel_dielectric, ggx_d, ggx_length, mirrored, refracted,
    refraction_discriminant, schlick_weight, vndf_sample,
};
use super::sampling::{cosine_hemisphere, cosine_hemisphere_pdf};
use glam::{Vec2, Vec3};

/// Value and density of the BSDF for a pair of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scatter {
    /// f |cos wi|.
    pub value: Vec3,
    /// Density of [`sample`] at `wi`, 1/sr.
    pub pdf: f32,
}

impl Scatter {
    /// No light and no sample.
    pub const NONE: Self = Self { value: Vec3::ZERO, pdf: 0.0 };
}

/// A sampled direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampled {
    /// Unit vector; meaningless if the density is 0.
    pub wi: Vec3,
    /// Value and density at `wi`. A density of 0 means that this draw has no direction and its light is absorbed.
    pub scatter: Scatter,
}

/// Burley's diffuse lobe with base color 1, times pi (2012, section 5.3).
#[inline]
pub fn retro_value(wo: Vec3, wi: Vec3, roughness: f32) -> f32 {
    let rise = (1.0 + wo.dot(wi)) * roughness - 0.5;
    let i = rise * schlick_weight(wi.z) + 1.0;
    let o = rise * schlick_weight(wo.z) + 1.0;
    i * o
}

/// Probability that sampling reflects at a glass facet whose Fresnel reflectance is `fresnel`.
#[inline]
fn mirror_probability(glass_reflect: Vec3, fresnel: f32) -> f32 {
    if fresnel >= 1.0 {
        return 1.0;
    }
    fresnel * glass_reflect.x.max(glass_reflect.y).max(glass_reflect.z)
}

/// Lobes above the horizon.
#[inline]
fn eval_reflection(layers: &Layers, wo: Vec3, wi: Vec3, lobes: Lobes) -> Scatter {
    let lambert = cosine_hemisphere_pdf(wi.z);
    let mut pdf = layers.probabilities[0] * lambert;
    let mut diffuse = layers.diffuse;
    if lobes.retro {
        let burley = retro_value(wo, wi, layers.retro_roughness) * layers.retro_scale;
        diffuse *= (1.0 - layers.retro) + burley * layers.retro;
    }
    let h = unit(wo + wi);
    let vh = wo.dot(h).clamp(0.0, 1.0);
    let rise = schlick_weight(vh);
    if lobes.sheen {
        let lambda = charlie_lambda(wi.z, layers.sheen_width);
        let visibility = charlie_visibility(wo.z, layers.sheen_lambda, wi.z, lambda);
        diffuse += layers.sheen * (charlie_d(h.z, layers.sheen_width) * visibility);
    }
    let mut value = diffuse * wi.z;
    if lobes.specular || lobes.metal || lobes.transmission {
        let d = 0.5 * ggx_d(h, layers.widths);
        let length_o = ggx_length(wo, layers.widths);
        let length_i = ggx_length(wi, layers.widths);
        let density = d / (wo.z + length_o);
        let shape = (d * wi.z) / (wi.z * length_o + wo.z * length_i);
        value += (layers.reflect_rise * rise + layers.reflect) * shape;
        pdf += layers.probabilities[1] * density;
        if lobes.transmission {
            let fresnel = fresnel_dielectric(vh, layers.eta);
            value += (layers.glass * glass_fresnel(layers.glass_reflect, fresnel)) * shape;
            pdf += (layers.probabilities[3] * mirror_probability(layers.glass_reflect, fresnel)) * density;
        }
    }
    if lobes.clearcoat {
        let a = Vec2::splat(layers.coat_width);
        let d = 0.5 * ggx_d(h, a);
        let length_o = ggx_length(wo, a);
        let length_i = ggx_length(wi, a);
        let shape = (d * wi.z) / (wi.z * length_o + wo.z * length_i);
        value += Vec3::splat((layers.coat_rise * rise + layers.coat) * shape);
        pdf += layers.probabilities[2] * (d / (wo.z + length_o));
    }
    Scatter { value, pdf }
}

/// Refraction, and transmission through thin sheets (Walter et al., "Microfacet Models for Refraction through Rough
/// Surfaces", 2007).
#[inline]
fn eval_transmission(layers: &Layers, wo: Vec3, wi: Vec3) -> Scatter {
    let below = Vec3::new(wi.x, wi.y, -wi.z);
    let length_o = ggx_length(wo, layers.widths);
    let length_i = ggx_length(wi, layers.widths);
    let mut h = unit(wo + below);
    let mut jacobian = 0.25;
    if !layers.thin {
        h = unit(wo + wi * layers.eta);
        if h.z < 0.0 {
            h = -h;
        }
        let vh = wo.dot(h);
        let lh = wi.dot(h);
        if vh <= 0.0 || lh >= 0.0 {
            return Scatter::NONE;
        }
        // Jacobian from the half vector's solid angle to that of wi (their eq. 17), times v.h.
        let root = (vh + lh * layers.eta) / layers.eta;
        jacobian = (vh * -lh) / (root * root);
    }
    let vh = wo.dot(h);
    let fresnel = fresnel_dielectric(vh, layers.eta);
    if fresnel >= 1.0 {
        return Scatter::NONE;
    }
    let d = (2.0 * ggx_d(h, layers.widths)) * jacobian;
    let shape = (d * below.z) / (below.z * length_o + wo.z * length_i);
    let density = d / (wo.z + length_o);
    let through = Vec3::ONE - glass_fresnel(layers.glass_reflect, fresnel);
    Scatter {
        value: (layers.glass * layers.glass_color) * through * shape,
        pdf: (layers.probabilities[3] * (1.0 - mirror_probability(layers.glass_reflect, fresnel))) * density,
    }
}

/// Value and density of `wi`; 0 if `wo` is below the horizon.
#[inline]
pub fn eval(layers: &Layers, wo: Vec3, wi: Vec3, lobes: Lobes) -> Scatter {
    if wo.z > 0.0 && wi.z > 0.0 {
        return eval_reflection(layers, wo, wi, lobes);
    }
    if lobes.transmission && wo.z > 0.0 && wi.z < 0.0 && layers.probabilities[3] > 0.0 {
        return eval_transmission(layers, wo, wi);
    }
    Scatter::NONE
}

/// Samples a direction. `u[0]` chooses the lobe, `u[1]` and `u[2]` the direction, `u[3]` reflection or transmission at
/// a glass facet.
#[inline]
pub fn sample(layers: &Layers, wo: Vec3, u: [f32; 4], lobes: Lobes) -> Sampled {
    let none = Sampled { wi: Vec3::Z, scatter: Scatter::NONE };
    if wo.z <= 0.0 {
        return none;
    }
    let up_to_reflect = layers.probabilities[0] + layers.probabilities[1];
    let up_to_coat = up_to_reflect + layers.probabilities[2];
    let total = up_to_coat + layers.probabilities[3];
    let at = u[0] * total;
    let direction = Vec2::new(u[1], u[2]);
    let mut wi;
    let mut side = 1.0;
    if at < layers.probabilities[0] {
        wi = cosine_hemisphere(direction);
    } else if at < up_to_reflect {
        wi = mirrored(wo, vndf_sample(wo, layers.widths, direction));
    } else if at < up_to_coat {
        wi = mirrored(wo, vndf_sample(wo, Vec2::splat(layers.coat_width), direction));
    } else if at < total {
        let h = vndf_sample(wo, layers.widths, direction);
        let vh = wo.dot(h).clamp(0.0, 1.0);
        wi = mirrored(wo, h);
        if u[3] >= mirror_probability(layers.glass_reflect, fresnel_dielectric(vh, layers.eta)) {
            side = -1.0;
            if layers.thin {
                wi.z = -wi.z;
            } else if refraction_discriminant(vh, layers.eta) > 0.0 {
                wi = refracted(wo, h, layers.eta);
            }
        }
    } else {
        return none;
    }
    let wi = unit(wi);
    if wi.z * side <= 0.0 {
        return none;
    }
    Sampled { wi, scatter: eval(layers, wo, wi, lobes) }
}
