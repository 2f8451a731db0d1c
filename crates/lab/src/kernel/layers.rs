//! A surface point of the principled BSDF, and its layers as a viewer sees them: what each reflects, and what it leaves to those
//! below it.

use super::albedo::{AlbedoTables, anisotropic_albedo, ggx_albedo, glass_albedo, sheen_albedo};
use super::microfacet::{
    MIN_SHEEN_ROUGHNESS, charlie_lambda, fresnel_dielectric, ggx_mean_width, ggx_widths, reflectance_at_normal,
    schlick_weight,
};
use afterimage::kernel::color::luma;
use glam::{Vec2, Vec3};
use std::f32::consts::FRAC_1_PI;

/// Index of refraction of the coat (glTF KHR_materials_clearcoat).
const COAT_IOR: f32 = 1.5;

/// Smallest index of refraction that bends rays. A body below it is a sheet: towards 1 refraction has no half vector.
pub const MIN_REFRACTING_IOR: f32 = 1.03;

/// Largest index of refraction that rays are bent by.
pub const MAX_REFRACTING_IOR: f32 = 3.0;

/// Parameters of a surface point, textures and tints resolved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Linear, each channel in \[0, 1\].
    pub base_color: Vec3,
    /// 0 dielectric to 1 metal.
    pub metallic: f32,
    /// Perceptual roughness, 0 to 1.
    pub roughness: f32,
    /// Strength of the dielectric interface, 0 to 1. With 0 the diffuse lobe is Lambert's.
    pub specular: f32,
    /// Factor of the dielectric's reflectance at normal incidence, tint resolved.
    pub specular_color: Vec3,
    /// Index of refraction, 1 or more.
    pub ior: f32,
    /// 0 to 1, stretch of the highlight along x.
    pub anisotropy: f32,
    /// Strength of the coat, 0 to 1.
    pub clearcoat: f32,
    /// Perceptual roughness of the coat.
    pub clearcoat_roughness: f32,
    /// Tint resolved, each channel in \[0, 1\].
    pub sheen_color: Vec3,
    /// Perceptual roughness of the sheen.
    pub sheen_roughness: f32,
    /// Share of the dielectric that refracts in place of scattering back, 0 to 1.
    pub transmission: f32,
    /// A sheet that does not bend rays, in place of a body.
    pub thin: bool,
    /// Whether `wo` is outside the body.
    pub entering: bool,
}

/// Which lobes are compiled in. A surface that does not use a lobe gives the same bits with and without it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lobes {
    /// Retro-reflection of the diffuse lobe.
    pub retro: bool,
    /// The dielectric interface.
    pub specular: bool,
    /// Metal.
    pub metal: bool,
    /// Stretched highlights.
    pub anisotropy: bool,
    /// The clear coat.
    pub clearcoat: bool,
    /// Sheen.
    pub sheen: bool,
    /// Refraction and thin sheets.
    pub transmission: bool,
}

impl Lobes {
    /// Every lobe.
    pub const ALL: Self = Self {
        retro: true,
        specular: true,
        metal: true,
        anisotropy: true,
        clearcoat: true,
        sheen: true,
        transmission: true,
    };
    /// Lambert's diffuse lobe only.
    pub const NONE: Self = Self {
        retro: false,
        specular: false,
        metal: false,
        anisotropy: false,
        clearcoat: false,
        sheen: false,
        transmission: false,
    };

    /// The lobes that `surface` uses.
    pub fn used_by(surface: &Surface) -> Self {
        Self {
            retro: surface.specular > 0.0,
            specular: surface.specular > 0.0,
            metal: surface.metallic > 0.0,
            anisotropy: surface.anisotropy > 0.0,
            clearcoat: surface.clearcoat > 0.0,
            sheen: surface.sheen_color.max_element() > 0.0,
            transmission: surface.transmission > 0.0,
        }
    }

    /// The lobes of either.
    pub fn union(self, other: Self) -> Self {
        Self {
            retro: self.retro | other.retro,
            specular: self.specular | other.specular,
            metal: self.metal | other.metal,
            anisotropy: self.anisotropy | other.anisotropy,
            clearcoat: self.clearcoat | other.clearcoat,
            sheen: self.sheen | other.sheen,
            transmission: self.transmission | other.transmission,
        }
    }
}

/// A surface as `wo` sees it: each layer's strength under the layers above it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layers {
    /// Widths of the base's GGX.
    pub widths: Vec2,
    /// Albedo of the diffuse lobe over pi.
    pub diffuse: Vec3,
    /// Share of Burley's lobe in it.
    pub retro: f32,
    /// Its roughness.
    pub retro_roughness: f32,
    /// One over the directional albedo of Burley's lobe.
    pub retro_scale: f32,
    /// Dielectric and metal: reflectance at normal incidence.
    pub reflect: Vec3,
    /// What is added to it by [`schlick_weight`].
    pub reflect_rise: Vec3,
    /// The coat's width.
    pub coat_width: f32,
    /// The coat's reflectance at normal incidence.
    pub coat: f32,
    /// Its rise.
    pub coat_rise: f32,
    /// The sheen's color.
    pub sheen: Vec3,
    /// Its squared roughness.
    pub sheen_width: f32,
    /// [`charlie_lambda`] of `wo`.
    pub sheen_lambda: f32,
    /// Strength of refraction and the reflection that belongs to it, compensated.
    pub glass: Vec3,
    /// Color of what is transmitted.
    pub glass_color: Vec3,
    /// Factor of Fresnel's reflectance.
    pub glass_reflect: Vec3,
    /// Index of refraction on the other side over that on the side of `wo`.
    pub eta: f32,
    /// A sheet.
    pub thin: bool,
    /// Probabilities of the lobes: diffuse, reflection, coat, glass. All 0 for what scatters nothing.
    pub probabilities: [f32; 4],
}

/// Directional albedo of Burley's diffuse lobe with base color 1, in closed form: the lobe is a polynomial in the cosines.
#[inline]
pub fn retro_albedo(cosine: f32, roughness: f32) -> f32 {
    let p = schlick_weight(cosine);
    let r = roughness;
    let b = r - 0.5;
    let rc = r * cosine;
    // Integrals over the azimuth and mu of mu f(mu), (1 - mu)^5 = P: P -> 1/42, mu P -> 1/168, mu^2 P -> 1/504.
    let rise_i = b / 42.0 + rc / 168.0;
    let rise_o = b / 2.0 + rc / 3.0;
    let squares = ((11.0 / 1008.0) * r) * r * (1.0 - cosine * cosine);
    let both = ((rc * rc) / 504.0 + squares) + (b / 42.0 + rc / 84.0) * b;
    (rise_i + (rise_o + both) * p) * 2.0 + 1.0
}

/// Reflectance at normal incidence `f0`, rise and compensation in one: factors of Schlick's reflectance so that at `f0` = 1 the
/// lobe reflects everything (Turquin, "Practical multiple scattering compensation for microfacet models", 2019). `e` is
/// [`ggx_albedo`].
#[inline]
fn compensation(f0: Vec3, e: Vec2) -> Vec3 {
    f0 * ((1.0 - e.x) / e.x) + Vec3::ONE
}

/// Directional albedo of a compensated GGX lobe with reflectance `f0` at normal incidence.
#[inline]
pub fn reflect_albedo(f0: Vec3, e: Vec2) -> Vec3 {
    ((f0 * (e.x - e.y) + Vec3::splat(e.y)) * compensation(f0, e)).min(Vec3::ONE)
}

/// Fresnel's reflectance as the glass scales it; total internal reflection is never scaled.
#[inline]
pub fn glass_fresnel(glass_reflect: Vec3, fresnel: f32) -> Vec3 {
    if fresnel >= 1.0 { Vec3::ONE } else { glass_reflect * fresnel }
}

/// Everything about `surface` that does not depend on `wi`.
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

    // From the top down: what the coat and the sheen leave.
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
        // Charlie is no more than a fit: at the horizon it may reflect more than there is.
        let e = sheen_albedo(tables, z, sheen_roughness);
        let scale = 1.0 / e.max(1.0);
        let albedo = e * scale;
        sheen = color * (scale * below_coat);
        sheen_probability = luma(color) * (albedo * below_coat);
        sheen_width = sheen_roughness * sheen_roughness;
        sheen_lambda = charlie_lambda(z, sheen_width);
        below = below_coat * (1.0 - color.x.max(color.y).max(color.z) * albedo);
    }

    // The base: reflection of the dielectric and the metal, and what it leaves.
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
        // What single scattering returns with Fresnel's reflectance, and without it but for total internal reflection.
        let mut returned = Vec2::new(e.x, e.x);
        if !thin {
            returned = glass_albedo(tables, z, mean_width, ior, surface.entering);
        }
        let amount = (dielectric * transmission) * below;
        glass = Vec3::splat(amount) / (glass_reflect * (returned.x - returned.y) + Vec3::splat(returned.y));
        let f = glass_fresnel(glass_reflect, fresnel_dielectric(z, eta));
        // From inside, some facets reflect totally whatever the colors.
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
