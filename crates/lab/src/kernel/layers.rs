//! Surface parameters of the principled BSDF, and its layers for a given view direction: the reflection of each layer,
//! and the energy left for the layers below.

use super::albedo::{AlbedoTables, anisotropic_albedo, ggx_albedo, glass_albedo, sheen_albedo};
use super::microfacet::{
    MIN_SHEEN_ROUGHNESS, charlie_lambda, fresnel_dielectric, ggx_mean_width, ggx_widths, reflectance_at_normal,
    schlick_weight,
};
use afterimage::kernel::color::luma;
use glam::{Vec2, Vec3};
use std::f32::consts::FRAC_1_PI;

/// Index of refraction of the clear coat (glTF KHR_materials_clearcoat).
const COAT_IOR: f32 = 1.5;

/// Smallest index of refraction that bends rays. Volumes with a smaller index are treated as thin sheets, because the
/// refraction half vector degenerates as the index approaches 1.
pub const MIN_REFRACTING_IOR: f32 = 1.03;

/// Largest index of refraction used for bending rays.
pub const MAX_REFRACTING_IOR: f32 = 3.0;

/// BSDF parameters of a surface point, with textures and tints applied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Linear, each channel in \[0, 1\].
    pub base_color: Vec3,
    /// 0 dielectric to 1 metal.
    pub metallic: f32,
    /// Perceptual roughness, 0 to 1.
    pub roughness: f32,
    /// Strength of the dielectric interface, 0 to 1. At 0 the diffuse lobe is Lambert's.
    pub specular: f32,
    /// Factor on the dielectric's reflectance at normal incidence, tint applied.
    pub specular_color: Vec3,
    /// Index of refraction, 1 or more.
    pub ior: f32,
    /// Anisotropy along x, 0 to 1.
    pub anisotropy: f32,
    /// Strength of the clear coat, 0 to 1.
    pub clearcoat: f32,
    /// Perceptual roughness of the clear coat, 0 to 1.
    pub clearcoat_roughness: f32,
    /// Sheen color, tint applied, each channel in \[0, 1\].
    pub sheen_color: Vec3,
    /// Perceptual roughness of the sheen, 0 to 1.
    pub sheen_roughness: f32,
    /// Share of the dielectric that transmits instead of scattering diffusely, 0 to 1.
    pub transmission: f32,
    /// Thin sheet that does not bend rays, instead of a volume.
    pub thin: bool,
    /// Whether `wo` is outside the volume.
    pub entering: bool,
}

/// Lobes that are compiled in. A surface that does not use a lobe gives the same bits with and without it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lobes {
    /// Retro-reflection of the diffuse lobe.
    pub retro: bool,
    /// Dielectric reflection.
    pub specular: bool,
    /// Metallic reflection.
    pub metal: bool,
    /// Anisotropic highlights.
    pub anisotropy: bool,
    /// Clear coat.
    pub clearcoat: bool,
    /// Sheen.
    pub sheen: bool,
    /// Refraction and thin sheets.
    pub transmission: bool,
}

impl Lobes {
    /// All lobes.
    pub const ALL: Self = Self {
        retro: true,
        specular: true,
        metal: true,
        anisotropy: true,
        clearcoat: true,
        sheen: true,
        transmission: true,
    };
}

/// Layers of a surface for a given `wo`, each attenuated by the layers above it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layers {
    /// GGX widths of the base.
    pub widths: Vec2,
    /// Diffuse albedo divided by pi.
    pub diffuse: Vec3,
    /// Share of Burley's lobe in the diffuse reflection.
    pub retro: f32,
    /// Roughness of Burley's lobe.
    pub retro_roughness: f32,
    /// Reciprocal of the directional albedo of Burley's lobe.
    pub retro_scale: f32,
    /// Dielectric and metallic reflectance at normal incidence.
    pub reflect: Vec3,
    /// Increase of `reflect` towards grazing angles, weighted by [`schlick_weight`].
    pub reflect_rise: Vec3,
    /// GGX width of the clear coat.
    pub coat_width: f32,
    /// Reflectance of the clear coat at normal incidence.
    pub coat: f32,
    /// Increase of `coat` towards grazing angles, weighted by [`schlick_weight`].
    pub coat_rise: f32,
    /// Sheen color, scaled.
    pub sheen: Vec3,
    /// Squared roughness of the sheen.
    pub sheen_width: f32,
    /// [`charlie_lambda`] of `wo`.
    pub sheen_lambda: f32,
    /// Strength of refraction with its reflection, energy-compensated.
    pub glass: Vec3,
    /// Color of transmitted light.
    pub glass_color: Vec3,
    /// Factor on Fresnel's reflectance of the glass.
    pub glass_reflect: Vec3,
    /// Relative index of refraction: far side over the side of `wo`.
    pub eta: f32,
    /// Whether the surface is a thin sheet.
    pub thin: bool,
    /// Probabilities of sampling the diffuse, reflection, coat and glass lobes. All 0 if nothing scatters.
    pub probabilities: [f32; 4],
}

/// Directional albedo of Burley's diffuse lobe with base color 1. Closed form, as the lobe is a polynomial in the
/// cosines.
#[inline]
pub fn retro_albedo(cosine: f32, roughness: f32) -> f32 {
    // Integrals over azimuth and mu of mu f(mu), with P = (1 - mu)^5: P -> 1/42, mu P -> 1/168, mu^2 P -> 1/504.
    // Ordered by powers of the roughness.
    let r = roughness;
    let rise = cosine * (1.0 / 84.0) + 1.0 / 21.0;
    let slope = cosine * (55.0 / 84.0) + 20.0 / 21.0;
    let curve = (cosine * (-1.0 / 56.0) + 1.0 / 42.0) * cosine + 5.0 / 72.0;
    (rise * r + 41.0 / 42.0) + ((curve * r + slope) * r - 41.0 / 84.0) * schlick_weight(cosine)
}

/// Energy compensation for multiple scattering: factor on a GGX lobe with reflectance `f0` at normal incidence, such
/// that the lobe reflects everything at `f0` = 1 (Turquin, "Practical multiple scattering compensation for microfacet
/// models", 2019). `e` is [`ggx_albedo`].
#[inline]
fn compensation(f0: Vec3, e: Vec2) -> Vec3 {
    f0 * ((1.0 - e.x) / e.x) + Vec3::ONE
}

/// Directional albedo of an energy-compensated GGX lobe with reflectance `f0` at normal incidence.
#[inline]
pub fn reflect_albedo(f0: Vec3, e: Vec2) -> Vec3 {
    ((f0 * (e.x - e.y) + Vec3::splat(e.y)) * compensation(f0, e)).min(Vec3::ONE)
}

/// Fresnel reflectance scaled by the glass' factor. Total internal reflection is not scaled.
#[inline]
pub fn glass_fresnel(glass_reflect: Vec3, fresnel: f32) -> Vec3 {
    if fresnel >= 1.0 { Vec3::ONE } else { glass_reflect * fresnel }
}

/// Everything about `surface` that depends on `wo` but not on `wi`.
#[inline]
pub fn layers(surface: &Surface, wo: Vec3, tables: &AlbedoTables, lobes: Lobes) -> Layers {
    let z = wo.z.clamp(0.0, 1.0);
    let base = surface.base_color.clamp(Vec3::ZERO, Vec3::ONE);
    let roughness = surface.roughness.clamp(0.0, 1.0);
    let strength = surface.specular.clamp(0.0, 1.0);
    let specular = if lobes.specular { strength } else { 0.0 };
    let metallic = if lobes.metal { surface.metallic.clamp(0.0, 1.0) } else { 0.0 };
    let transmission = if lobes.transmission { surface.transmission.clamp(0.0, 1.0) } else { 0.0 };
    let anisotropy = if lobes.anisotropy { surface.anisotropy } else { 0.0 };
    let widths = ggx_widths(roughness, anisotropy);
    let dielectric = 1.0 - metallic;
    let opaque = dielectric * (1.0 - transmission);

    // Coat and sheen first, from the top down: each leaves energy for the layers below.
    let mut coat = 0.0;
    let mut coat_rise = 0.0;
    let mut coat_albedo = 0.0;
    let mut coat_width = 1.0;
    if lobes.clearcoat {
        let amount = surface.clearcoat.clamp(0.0, 1.0);
        let coat_roughness = surface.clearcoat_roughness.clamp(0.0, 1.0);
        coat_width = ggx_widths(coat_roughness, 0.0).x;
        let e = ggx_albedo(tables, z, coat_width);
        let f0 = reflectance_at_normal(COAT_IOR);
        let scale = amount * (f0 * ((1.0 - e.x) / e.x) + 1.0);
        coat = scale * f0;
        coat_rise = scale * (1.0 - f0);
        coat_albedo = ((f0 * (e.x - e.y) + e.y) * scale).min(1.0);
    }
    let below_coat = 1.0 - coat_albedo;
    let mut sheen = Vec3::ZERO;
    let mut sheen_probability = 0.0;
    let mut sheen_width = 1.0;
    let mut sheen_lambda = 0.0;
    let mut below = below_coat;
    if lobes.sheen {
        let color = surface.sheen_color.clamp(Vec3::ZERO, Vec3::ONE);
        let sheen_roughness = surface.sheen_roughness.clamp(MIN_SHEEN_ROUGHNESS, 1.0);
        // Charlie is a fit; near the horizon its albedo may exceed 1.
        let e = sheen_albedo(tables, z, sheen_roughness);
        let scale = 1.0 / e.max(1.0);
        let albedo = e * scale;
        sheen = color * (scale * below_coat);
        sheen_probability = luma(color) * (albedo * below_coat);
        sheen_width = sheen_roughness * sheen_roughness;
        sheen_lambda = charlie_lambda(z, sheen_width);
        below = below_coat * (1.0 - color.x.max(color.y).max(color.z) * albedo);
    }

    // The base: dielectric and metallic reflection, and the energy they leave.
    let mut e = Vec2::new(1.0, 0.0);
    let mean_width = ggx_mean_width(widths);
    if lobes.specular || lobes.metal || lobes.transmission {
        e = ggx_albedo(tables, z, mean_width);
        if lobes.anisotropy && anisotropy > 0.0 {
            e += anisotropic_albedo(tables, wo, widths);
        }
    }
    let mut reflect = Vec3::ZERO;
    let mut reflect_rise = Vec3::ZERO;
    let mut reflect_probability = 0.0;
    let mut entered = Vec3::ONE;
    if lobes.specular {
        let normal = reflectance_at_normal(surface.ior.max(1.0));
        let f0 = (surface.specular_color.max(Vec3::ZERO) * normal).min(Vec3::ONE);
        let albedo = reflect_albedo(f0, e) * specular;
        let scale = compensation(f0, e) * ((opaque * below) * specular);
        reflect = scale * f0;
        reflect_rise = scale * (Vec3::ONE - f0);
        reflect_probability = luma(albedo) * (opaque * below);
        entered = Vec3::ONE - albedo;
    }
    if lobes.metal {
        let scale = compensation(base, e) * (metallic * below);
        reflect += scale * base;
        reflect_rise += scale * (Vec3::ONE - base);
        reflect_probability += luma(reflect_albedo(base, e)) * (metallic * below);
    }
    let diffuse_albedo = (base * entered) * (opaque * below);
    let retro = if lobes.retro { strength } else { 0.0 };
    let mut retro_scale = 1.0;
    if lobes.retro {
        retro_scale = 1.0 / retro_albedo(z, roughness);
    }

    let mut glass = Vec3::ZERO;
    let mut glass_reflect = Vec3::ZERO;
    let mut eta = 1.0;
    let mut glass_probability = 0.0;
    let ior = surface.ior.clamp(1.0, MAX_REFRACTING_IOR);
    let thin = surface.thin || ior < MIN_REFRACTING_IOR;
    if lobes.transmission {
        eta = if surface.entering || thin { ior } else { 1.0 / ior };
        glass_reflect = (surface.specular_color * strength).clamp(Vec3::ZERO, Vec3::ONE);
        // Albedo of single scattering with Fresnel's reflectance, and with total internal reflection only.
        let mut returned = Vec2::new(e.x, e.x);
        if !thin {
            returned = glass_albedo(tables, z, mean_width, ior, surface.entering);
        }
        let amount = (dielectric * transmission) * below;
        glass = Vec3::splat(amount) / (glass_reflect * (returned.x - returned.y) + Vec3::splat(returned.y));
        let f = glass_fresnel(glass_reflect, fresnel_dielectric(z, eta));
        // From inside, some facets reflect totally, regardless of the colors.
        let least = if eta < 1.0 { 0.1 } else { 0.0 };
        glass_probability = luma((Vec3::ONE - f) * base + f).max(least) * amount;
    }

    let diffuse_probability = luma(diffuse_albedo) + sheen_probability;
    let total = ((diffuse_probability + reflect_probability) + coat_albedo) + glass_probability;
    let mut probabilities = [0.0; 4];
    if total > 1e-30 {
        probabilities =
            [diffuse_probability / total, reflect_probability / total, coat_albedo / total, glass_probability / total];
    }
    Layers {
        widths,
        diffuse: diffuse_albedo * FRAC_1_PI,
        retro,
        retro_roughness: roughness,
        retro_scale,
        reflect,
        reflect_rise,
        coat_width,
        coat,
        coat_rise,
        sheen,
        sheen_width,
        sheen_lambda,
        glass,
        glass_color: base,
        glass_reflect,
        eta,
        thin,
        probabilities,
    }
}
