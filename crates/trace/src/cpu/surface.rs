//! Surface properties at a hit. Twin of `shaders/trace/surface_point.wgsl`.

use super::texture::texture;
use crate::world::World;
use afterimage_lab::kernel::bsdf::{Lobes, Surface};
use afterimage_lab::kernel::direction::{basis, unit};
use afterimage_lab::kernel::phong::PhongSurface;
use afterimage_lab::kernel::shading::{mapped_normal, tint, visible_normal};
use afterimage_lab::kernel::triangle::{magnitude, point_at};
use afterimage_lab::rays::{AttributesAt, Hit};
use afterimage_lab::scene::effects::{Effect, Effects};
use afterimage_lab::scene::shading_records::{
    FLAG_BLEND, FLAG_DOUBLE_SIDED, FLAG_MASK, FLAG_VOLUME, MaterialRecord, NO_TEXTURE,
};
use glam::{Vec2, Vec3, Vec4};

/// A surface point as seen along an incoming ray.
pub(super) struct SurfacePoint {
    /// World space, metres.
    pub position: Vec3,
    /// Largest coordinate of the triangle, which bounds the position's rounding.
    pub magnitude: f32,
    /// Geometric normal, on the side of the ray's origin.
    pub geometric: Vec3,
    /// Shading frame: tangent, bitangent, normal. The normal is on the side of the ray's origin.
    pub frame: [Vec3; 3],
    /// Whether the ray hit the front face.
    pub front: bool,
    /// Radiance emitted towards the ray's origin.
    pub emitted: Vec3,
    /// Absorption coefficient in 1/m of the volume behind the surface.
    pub absorption: Vec3,
    /// Parameters of the principled BSDF.
    pub surface: Surface,
    /// Parameters of the thesis' Phong model.
    pub phong: PhongSurface,
}

/// Surface point at `hit` of a ray with unit `direction`.
pub(super) fn surface_point(world: &World, hit: &Hit, direction: Vec3, effects: Effects) -> SurfacePoint {
    let triangle = world.geometry.triangle(hit.triangle);
    let place = world.geometry.attributes_at(hit.triangle, hit.u, hit.v, effects.has(Effect::TextureCoordinates));
    let material = &world.materials[triangle.material() as usize];
    let [v0, v1, v2] = triangle.positions();
    let toward = -direction;

    let face = unit((v1 - v0).cross(v2 - v0));
    let front = face.dot(toward) >= 0.0;
    let side = if front { 1.0 } else { -1.0 };
    let geometric = face * side;

    let mut normal = unit(place.normal);
    // Shading normals on the wrong side of the triangle are replaced by the geometric normal.
    if normal.dot(face) <= 0.0 {
        normal = face;
    }
    if effects.has(Effect::NormalMap) && material.normal_texture != NO_TEXTURE {
        let texel = texture(world, material.normal_texture, place.uvs(), false, effects).truncate();
        normal = mapped_normal(normal, place.tangent, place.bitangent_sign, texel, material.normal_scale);
    }
    let normal = visible_normal(normal * side, geometric, toward);
    let mut along = Vec3::ZERO;
    if effects.has(Effect::Anisotropy) && material.anisotropy > 0.0 {
        along = place.tangent - normal * normal.dot(place.tangent);
    }
    let frame = if along.dot(along) > 1e-12 {
        let x = unit(along);
        [x, normal.cross(x), normal]
    } else {
        let [x, y] = basis(normal);
        [x, y, normal]
    };

    let mut emitted = Vec3::ZERO;
    if effects.has(Effect::EmissiveTriangles) && (front || material.flags & FLAG_DOUBLE_SIDED != 0) {
        emitted = emission(world, material, place.uvs(), effects);
    }
    let mut absorption = Vec3::ZERO;
    if effects.has(Effect::Transmission) && material.flags & FLAG_VOLUME != 0 {
        absorption = Vec3::from(material.absorption);
    }
    let surface = resolve(world, material, &place, front, effects);
    let phong = PhongSurface {
        // Clamped to conserve energy, as in the principled model. The clamp also keeps compilers from moving the factor
        // out of sums.
        diffuse: (surface.base_color * material.phong_diffuse).clamp(Vec3::ZERO, Vec3::ONE),
        specular: Vec3::from(material.phong_specular),
        exponent: material.phong_exponent,
    };
    let (position, magnitude) = (point_at(v0, v1, v2, hit.u, hit.v), magnitude(v0, v1, v2));
    SurfacePoint { position, magnitude, geometric, frame, front, emitted, absorption, surface, phong }
}

/// Base color and opacity.
fn base(world: &World, material: &MaterialRecord, place: &AttributesAt, effects: Effects) -> Vec4 {
    let mut base = Vec3::from(material.base_color).extend(material.opacity);
    if effects.has(Effect::BaseColor) {
        base *= place.color;
        if material.base_color_texture != NO_TEXTURE {
            base *= texture(world, material.base_color_texture, place.uvs(), true, effects);
        }
    }
    base
}

/// Alpha test: opacity against the cutoff (MASK) or against the random `draw` (BLEND).
pub(super) fn passes_alpha_test(world: &World, triangle: u32, u: f32, v: f32, draw: f32, effects: Effects) -> bool {
    let material = &world.materials[world.geometry.triangle(triangle).material() as usize];
    let place = world.geometry.attributes_at(triangle, u, v, effects.has(Effect::TextureCoordinates));
    let opacity = base(world, material, &place, effects).w;
    if material.flags & FLAG_MASK != 0 {
        return opacity >= material.cutoff;
    }
    material.flags & FLAG_BLEND == 0 || draw < opacity
}

/// Radiance that a material emits at these texture coordinates.
fn emission(world: &World, material: &MaterialRecord, uvs: [Vec2; 2], effects: Effects) -> Vec3 {
    let mut radiance = Vec3::from(material.emissive);
    if effects.has(Effect::EmissiveTexture) && material.emissive_texture != NO_TEXTURE {
        radiance *= texture(world, material.emissive_texture, uvs, true, effects).truncate();
    }
    radiance
}

/// Radiance that a triangle emits at barycentric weights `u` and `v`.
pub(super) fn emission_at(world: &World, triangle: u32, u: f32, v: f32, effects: Effects) -> Vec3 {
    let material = &world.materials[world.geometry.triangle(triangle).material() as usize];
    let place = world.geometry.attributes_at(triangle, u, v, effects.has(Effect::TextureCoordinates));
    emission(world, material, place.uvs(), effects)
}

/// BSDF parameters with textures and tints applied.
fn resolve(world: &World, m: &MaterialRecord, place: &AttributesAt, front: bool, effects: Effects) -> Surface {
    let base_color = base(world, m, place, effects).truncate();
    let mut s = Surface {
        base_color,
        metallic: m.metallic,
        roughness: m.roughness,
        specular: m.specular,
        specular_color: Vec3::from(m.specular_color),
        ior: m.ior,
        anisotropy: m.anisotropy,
        clearcoat: m.clearcoat,
        clearcoat_roughness: m.clearcoat_roughness,
        sheen_color: Vec3::from(m.sheen_color),
        sheen_roughness: m.sheen_roughness,
        transmission: m.transmission,
        thin: m.flags & FLAG_VOLUME == 0,
        entering: front,
    };
    if effects.has(Effect::SurfaceTexture) {
        let of = |id: u32, is_color: bool| {
            if id == NO_TEXTURE { Vec4::ONE } else { texture(world, id, place.uvs(), is_color, effects) }
        };
        let metallic_roughness = of(m.metallic_roughness_texture, false);
        s.roughness *= metallic_roughness.y;
        s.metallic *= metallic_roughness.z;
        s.specular *= of(m.specular_texture, false).w;
        s.specular_color *= of(m.specular_color_texture, true).truncate();
        if effects.has(Effect::Clearcoat) {
            s.clearcoat *= of(m.clearcoat_texture, false).x;
            s.clearcoat_roughness *= of(m.clearcoat_roughness_texture, false).y;
        }
        if effects.has(Effect::Sheen) {
            s.sheen_color *= of(m.sheen_color_texture, true).truncate();
            s.sheen_roughness *= of(m.sheen_roughness_texture, false).w;
        }
        if effects.has(Effect::Transmission) {
            s.transmission *= of(m.transmission_texture, false).x;
        }
    }
    if effects.has(Effect::Dielectric) && m.specular_tint > 0.0 {
        s.specular_color *= tint(base_color, m.specular_tint);
    }
    if effects.has(Effect::Sheen) && m.sheen_tint > 0.0 {
        s.sheen_color *= tint(base_color, m.sheen_tint);
    }
    s
}

/// Lobes that the effects include.
pub(super) fn lobes(effects: Effects) -> Lobes {
    Lobes {
        retro: effects.has(Effect::Dielectric),
        specular: effects.has(Effect::Dielectric),
        metal: effects.has(Effect::Metal),
        anisotropy: effects.has(Effect::Anisotropy),
        clearcoat: effects.has(Effect::Clearcoat),
        sheen: effects.has(Effect::Sheen),
        transmission: effects.has(Effect::Transmission),
    }
}
