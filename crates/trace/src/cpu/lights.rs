//! Light sampling (next event estimation) and environment lookup. Twin of `shaders/trace/lights.wgsl`.

use super::surface::emission_at;
use crate::records::{LIGHT_ENVIRONMENT, LIGHT_INDEX, LIGHT_PUNCTUAL, LIGHT_TRIANGLE};
use crate::world::World;
use afterimage_lab::kernel::direction::{to_world, unit};
use afterimage_lab::kernel::light::{cone_falloff, distance_falloff, map_coordinates, map_direction, map_pdf};
use afterimage_lab::kernel::sampling::{area_pdf, barycentrics, cosine_hemisphere, cosine_hemisphere_pdf};
use afterimage_lab::kernel::texel::{WRAP_CLAMP, WRAP_REPEAT, wrap_texel};
use afterimage_lab::kernel::triangle::{magnitude, offset_ray, point_at};
use afterimage_lab::scene::effects::{Effect, Effects};
use afterimage_lab::scene::shading_records::FLAG_DOUBLE_SIDED;
use glam::{Vec2, Vec3};

/// A sampled point on a light, as seen from a surface point.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightSample {
    /// Unit vector towards the light.
    pub direction: Vec3,
    /// Distance in metres; infinity for lights at infinity.
    pub distance: f32,
    /// Radiance; for punctual lights, irradiance on a surface facing the light.
    pub radiance: Vec3,
    /// Density of the sample in 1/sr; for punctual lights, the probability of picking the light.
    pub pdf: f32,
    /// Whether scattered rays can also hit the light, so that the sample needs a MIS weight.
    pub can_be_hit: bool,
}

/// Samples a light and a point on it, seen from `position` with shading frame `frame`. `draws` choose the light and the
/// point, `more` the texel of an environment map.
pub(super) fn sample_light(
    world: &World,
    position: Vec3,
    frame: &[Vec3; 3],
    draws: [f32; 4],
    more: [f32; 4],
    effects: Effects,
) -> Option<LightSample> {
    let count = world.picks.len() as u32;
    if count == 0 {
        return None;
    }
    let row = ((draws[0] * count as f32) as u32).min(count - 1);
    let mut pick = world.picks[row as usize];
    if draws[1] >= pick.keep {
        pick = world.picks[pick.alias as usize];
    }
    let place = Vec2::new(draws[2], draws[3]);
    let index = pick.kind_and_index & LIGHT_INDEX;
    match pick.kind_and_index >> 30 {
        LIGHT_TRIANGLE if effects.has(Effect::EmissiveTriangles) => {
            from_triangle(world, position, index, pick.probability, place, effects)
        }
        LIGHT_PUNCTUAL if effects.has(Effect::PunctualLights) => {
            Some(from_punctual(world, position, index, pick.probability))
        }
        LIGHT_ENVIRONMENT if effects.has(Effect::Environment) => {
            from_environment(world, frame, pick.probability, place, more, effects)
        }
        _ => None,
    }
}

fn from_triangle(
    world: &World,
    position: Vec3,
    index: u32,
    probability: f32,
    place: Vec2,
    effects: Effects,
) -> Option<LightSample> {
    let light = world.geometry.triangle(index);
    let [v0, v1, v2] = light.positions();
    let weights = barycentrics(place);
    let across = (v1 - v0).cross(v2 - v0);
    let face = unit(across);
    let on_light = point_at(v0, v1, v2, weights.y, weights.z);
    let cosine = face.dot(position - on_light);
    let double_sided = world.materials[light.material() as usize].flags & FLAG_DOUBLE_SIDED != 0;
    if cosine <= 0.0 && !double_sided {
        return None;
    }
    // The shadow ray ends just before the light, so that it does not hit the light itself.
    let side = if cosine > 0.0 { face } else { -face };
    let to = offset_ray(on_light, side, magnitude(v0, v1, v2)) - position;
    let squared = to.dot(to);
    let direction = unit(to);
    let area = 0.5 * across.dot(across).sqrt();
    let pdf = probability * area_pdf(area, squared, face.dot(direction));
    let radiance = emission_at(world, index, weights.y, weights.z, effects);
    let distance = squared.sqrt();
    (pdf > 0.0).then_some(LightSample { direction, distance, radiance, pdf, can_be_hit: true })
}

fn from_punctual(world: &World, position: Vec3, index: u32, probability: f32) -> LightSample {
    let light = world.punctual[index as usize];
    let axis = Vec3::from(light.direction);
    let mut radiance = Vec3::from(light.intensity);
    let (mut direction, mut distance) = (-axis, f32::INFINITY);
    if light.kind != 0 {
        let to = Vec3::from(light.position) - position;
        distance = to.dot(to).sqrt();
        direction = unit(to);
        radiance *= distance_falloff(distance, light.range);
    }
    if light.kind == 2 {
        radiance *= cone_falloff(-direction.dot(axis), light.cos_inner, light.cos_outer);
    }
    LightSample { direction, distance, radiance, pdf: probability, can_be_hit: false }
}

fn from_environment(
    world: &World,
    frame: &[Vec3; 3],
    probability: f32,
    place: Vec2,
    more: [f32; 4],
    effects: Effects,
) -> Option<LightSample> {
    let (direction, pdf) = if has_map(world, effects) {
        let count = world.map.len() as u32;
        let mut index = ((more[0] * count as f32) as u32).min(count - 1);
        if more[1] >= world.map[index as usize].keep {
            index = world.map[index as usize].alias;
        }
        let [w, h] = world.map_size;
        let u = ((index % w) as f32 + place.x) / w as f32;
        let v = ((index / w) as f32 + place.y) / h as f32;
        let (direction, sine) = map_direction(u, v);
        (direction, map_pdf(world.map[index as usize].probability, count as f32, sine))
    } else {
        let local = cosine_hemisphere(place);
        (to_world(local, frame[0], frame[1], frame[2]), cosine_hemisphere_pdf(local.z))
    };
    let pdf = probability * pdf;
    let radiance = sky(world, direction, effects);
    (pdf > 0.0).then_some(LightSample { direction, distance: f32::INFINITY, radiance, pdf, can_be_hit: true })
}

fn has_map(world: &World, effects: Effects) -> bool {
    effects.has(Effect::EnvironmentMap) && world.map_size[0] > 0
}

/// Radiance of the environment in a direction.
pub(super) fn sky(world: &World, direction: Vec3, effects: Effects) -> Vec3 {
    if !has_map(world, effects) {
        return world.sky;
    }
    let [w, h] = world.map_size;
    let [u, v] = map_coordinates(direction);
    let (x, y) = (u * w as f32 - 0.5, v * h as f32 - 0.5);
    let (i, j) = (x.floor(), y.floor());
    let (s, t) = (x - i, y - j);
    let texel = |i: i32, j: i32| {
        let index = wrap_texel(j, h, WRAP_CLAMP) * w + wrap_texel(i, w, WRAP_REPEAT);
        Vec3::from(world.map[index as usize].radiance)
    };
    let (i, j) = (i as i32, j as i32);
    let top = texel(i, j) * (1.0 - s) + texel(i + 1, j) * s;
    let bottom = texel(i, j + 1) * (1.0 - s) + texel(i + 1, j + 1) * s;
    top * (1.0 - t) + bottom * t
}

/// Density in 1/sr with which [`sample_light`] would sample this direction of the environment. `cosine` is the cosine
/// between the direction and the shading normal.
pub(super) fn sky_pdf(world: &World, direction: Vec3, cosine: f32, effects: Effects) -> f32 {
    if !has_map(world, effects) {
        return world.sky_probability * cosine_hemisphere_pdf(cosine);
    }
    let [w, h] = world.map_size;
    let [u, v] = map_coordinates(direction);
    let i = ((u * w as f32) as u32).min(w - 1);
    let j = ((v * h as f32) as u32).min(h - 1);
    let sine = (direction.x * direction.x + direction.z * direction.z).sqrt();
    let probability = world.map[(j * w + i) as usize].probability;
    world.sky_probability * map_pdf(probability, world.map.len() as f32, sine)
}

/// Density in 1/sr with which [`sample_light`] would sample the point where a path hit triangle `index`, at `distance`.
/// `cosine` is the cosine between the ray and the triangle's normal.
pub(super) fn triangle_pdf(world: &World, index: u32, distance: f32, cosine: f32) -> f32 {
    let light = world.geometry.triangle(index);
    let Some(row) = light.light() else { return 0.0 };
    let [v0, v1, v2] = light.positions();
    let across = (v1 - v0).cross(v2 - v0);
    let area = 0.5 * across.dot(across).sqrt();
    world.picks[row as usize].probability * area_pdf(area, distance * distance, cosine)
}
