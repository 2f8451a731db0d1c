//! Albedo along a ray: that of the first rough surface behind perfect mirrors and clear glass.

use super::is_half_opaque;
use super::surface::{SurfacePoint, lobes, surface_point};
use crate::settings::{Bsdf, TraceSettings};
use crate::world::World;
use afterimage_lab::kernel::albedo::ggx_albedo;
use afterimage_lab::kernel::bsdf::{Layers, Lobes, layers};
use afterimage_lab::kernel::direction::{to_local, to_world, unit};
use afterimage_lab::kernel::microfacet::{ggx_mean_width, mirrored, refracted, refraction_discriminant};
use afterimage_lab::kernel::triangle::offset_ray;
use afterimage_lab::rays::Ray;
use afterimage_lab::scene::effects::{Effect, Effects};
use glam::Vec3;
use std::f32::consts::PI;

/// Largest number of mirrors, and of faces of glass, on the way to a rough surface.
const MOST_PASSED: u32 = 16;
/// Largest roughness of a perfect mirror or of clear glass: a few steps of an 8-bit texture.
const CLEAR_ROUGHNESS: f32 = 0.02;
/// Least share of a lobe that is the only one of its surface.
const WHOLE: f32 = 0.98;

/// Share of uniform light that the surface on a ray returns, by its diffuse lobe and its reflections, times the tints
/// of the mirrors and the glass before it; 0 for the sky, and beyond too many mirrors.
pub(crate) fn albedo_along(world: &World, origin: Vec3, direction: Vec3, settings: &TraceSettings) -> Vec3 {
    let effects = settings.effects.unwrap_or(world.needs);
    let mut tint = Vec3::ONE;
    let mut ray = Ray { origin, direction, t_max: f32::INFINITY };
    for _ in 0..MOST_PASSED {
        let opaque = |triangle, u, v| !effects.has(Effect::Alpha) || is_half_opaque(world, triangle, u, v, effects);
        let Some(hit) = world.geometry.closest(&ray, opaque) else { return Vec3::ZERO };
        let point = surface_point(world, &hit, ray.direction, effects);
        if settings.bsdf == Bsdf::Phong {
            return tint * (point.phong.diffuse + point.phong.specular).min(Vec3::ONE);
        }
        let [x, y, z] = point.frame;
        let wo = to_local(-ray.direction, x, y, z);
        let layers = layers(&point.surface, wo, &world.tables, lobes(effects));
        let Some(wi) = passed(&point, &layers, wo, effects) else {
            return tint * albedo_of(world, &layers, wo.z, lobes(effects));
        };
        tint *= point.surface.base_color.clamp(Vec3::ZERO, Vec3::ONE);
        let direction = unit(to_world(wi, x, y, z));
        let side = if point.geometric.dot(direction) > 0.0 { point.geometric } else { -point.geometric };
        ray = Ray { origin: offset_ray(point.position, side, point.magnitude), direction, t_max: f32::INFINITY };
    }
    Vec3::ZERO
}

/// Direction in which a perfect mirror or clear glass is passed; `None` at any other surface.
fn passed(point: &SurfacePoint, layers: &Layers, wo: Vec3, effects: Effects) -> Option<Vec3> {
    let surface = &point.surface;
    if surface.roughness > CLEAR_ROUGHNESS || wo.z <= 0.0 {
        return None;
    }
    if effects.has(Effect::Metal) && surface.metallic >= WHOLE {
        return Some(mirrored(wo, Vec3::Z));
    }
    let is_glass = effects.has(Effect::Transmission) && surface.transmission * (1.0 - surface.metallic) >= WHOLE;
    if !is_glass {
        return None;
    }
    if layers.thin {
        return Some(-wo);
    }
    let is_bent = refraction_discriminant(wo.z, layers.eta) > 0.0;
    Some(if is_bent { refracted(wo, Vec3::Z, layers.eta) } else { mirrored(wo, Vec3::Z) })
}

/// As `albedo_of` of the rasteriser (`raster_lighting.wgsl`), and what rough glass lets through.
fn albedo_of(world: &World, l: &Layers, cosine: f32, lobes: Lobes) -> Vec3 {
    let mut albedo = l.diffuse * PI + l.glass * l.glass_color;
    if lobes.specular || lobes.metal {
        let e = ggx_albedo(&world.tables, cosine, ggx_mean_width(l.widths));
        albedo += l.reflect * e.x + l.reflect_rise * e.y;
    }
    if lobes.clearcoat {
        let e = ggx_albedo(&world.tables, cosine, l.coat_width);
        albedo += Vec3::splat(l.coat * e.x + l.coat_rise * e.y);
    }
    albedo
}
