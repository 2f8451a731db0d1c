//! Estimate of indirect light, for scenes whose lights are inside them.

use super::lights::LightRecord;
use crate::kernel::direction::{basis, to_world};
use crate::kernel::sampling::{barycentrics, cosine_hemisphere};
use crate::kernel::triangle::{magnitude, offset_ray, point_at};
use crate::rays::{Bvh, Geometry, Ray};
use crate::scene::{PunctualKind, PunctualLight, Scene, Triangles};
use afterimage::kernel::rng::path_draws;
use glam::{Vec2, Vec3};
use std::f32::consts::PI;

/// Number of rays that measure how enclosed a scene is.
const RAYS: u32 = 1024;

/// Radiance after many bounces, as in an integrating sphere with openings: power times albedo times enclosure squared,
/// over (1 - albedo times enclosure) times wall area times pi. The walls are the faces of the scene's bounding box;
/// `enclosure` is the share of light leaving a surface that hits another.
pub(super) fn radiance(
    scene: &Scene,
    moving: &Triangles,
    lights: &[PunctualLight],
    panels: &[LightRecord],
    size: Vec3,
) -> Vec3 {
    let walls = 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
    let mut power = Vec3::ZERO;
    for l in lights {
        power += Vec3::from(l.intensity)
            * match l.kind {
                PunctualKind::Directional => 0.0,
                PunctualKind::Point => 4.0 * PI,
                PunctualKind::Spot { cos_outer, .. } => 2.0 * PI * (1.0 - cos_outer),
            };
    }
    for p in panels {
        power += p.power();
    }
    if power == Vec3::ZERO || !(walls.is_finite() && walls > 0.0) {
        return Vec3::ZERO;
    }
    let (mut albedo, mut total) = (Vec3::ZERO, 0.0);
    for (triangle, material) in all(scene, moving) {
        if let Some(material) = scene.materials.get(material as usize) {
            albedo += Vec3::from(material.base_color) * area(triangle);
            total += area(triangle);
        }
    }
    let albedo = (albedo / f32::max(total, 1e-30)).clamp(Vec3::ZERO, Vec3::splat(0.9));
    let enclosure = enclosure(scene, moving);
    let radiance = power * albedo * enclosure * enclosure / ((Vec3::ONE - albedo * enclosure) * walls * PI);
    if radiance.is_finite() { radiance } else { Vec3::ZERO }
}

fn all<'a>(scene: &'a Scene, moving: &'a Triangles) -> impl Iterator<Item = ([Vec3; 3], u32)> + 'a {
    [scene.still(), moving].into_iter().flat_map(|t| t.positions.iter().copied().zip(t.materials.iter().copied()))
}

fn area([a, b, c]: [Vec3; 3]) -> f32 {
    let area = 0.5 * (b - a).cross(c - a).length();
    if area.is_finite() { area } else { 0.0 }
}

/// Enclosure: share of cosine-distributed rays from front faces, uniform over their area, that hit another surface.
pub(super) fn enclosure(scene: &Scene, moving: &Triangles) -> f32 {
    let triangles: Vec<_> = all(scene, moving).map(|(t, _)| t).collect();
    let mut sums: Vec<f64> = vec![];
    let mut sum = 0.0;
    for &t in &triangles {
        sum += f64::from(area(t));
        sums.push(sum);
    }
    if !(sum.is_finite() && sum > 0.0) {
        return 0.0;
    }
    let geometry = Geometry {
        still: Bvh::build(scene.still(), None, &scene.materials),
        moving: Bvh::build(moving, None, &scene.materials),
    };
    let meets = |i: u32| {
        let [u, v, s, t] = path_draws(i, 0, 0, 0);
        // Stratified: one ray in each of equal parts of the area.
        let at = (f64::from(i) + 0.5) / f64::from(RAYS) * sum;
        let [a, b, c] = triangles[sums.partition_point(|&s| s <= at).min(triangles.len() - 1)];
        let weights = barycentrics(Vec2::new(u, v));
        let normal = (b - a).cross(c - a).normalize_or(Vec3::Y);
        let [x, y] = basis(normal);
        let direction = to_world(cosine_hemisphere(Vec2::new(s, t)), x, y, normal);
        let origin = offset_ray(point_at(a, b, c, weights.y, weights.z), normal, magnitude(a, b, c));
        geometry.occluded(&Ray { origin, direction, t_max: f32::INFINITY }, |_, _, _| true)
    };
    (0..RAYS).filter(|&i| meets(i)).count() as f32 / RAYS as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::builtin;

    #[test]
    fn a_room_surrounds_itself_and_a_ball_does_not() {
        let cornell = builtin::cornell();
        // A cube with one open side would lose a sixth of its enclosure. Back faces do not count.
        let room = enclosure(&cornell, &Triangles::default());
        assert!((0.6..0.95).contains(&room), "{room}");
        let ball = enclosure(&builtin::furnace(), &Triangles::default());
        assert!(ball < 0.01, "{ball}");
    }
}
