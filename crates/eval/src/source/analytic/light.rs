//! Lighting: a sun with shadows, partly behind a roof of slats, and a sky with ambient occlusion at walls and around
//! objects.

use super::courtyard::{BACK, FLOOR, LEFT, RIGHT};
use super::noise::{fbm, pulse, smoothstep};
use super::scene::{Stage, TO_SUN};
use super::shape::{Ray, Shape};
use glam::{Vec2, Vec3};

/// Shadow ray offset in metres, which avoids self-shadowing.
const NEAR: f32 = 1e-3;
/// Irradiance of the sun over pi. Chosen so that the brightest surface in full sun is a little above 1.
const SUN: Vec3 = Vec3::new(1.30, 1.16, 0.96);
const SKY: Vec3 = Vec3::new(0.34, 0.41, 0.52);
const BOUNCE: Vec3 = Vec3::new(0.26, 0.21, 0.16);
/// Reach of the ambient occlusion around an object, in radii of its occluder.
const REACH: f32 = 4.0;

/// Objects that may take light from a point.
pub(super) struct Occluders<'a> {
    /// They may shade it.
    pub casters: &'a [u16],
    /// They stand on the floor around it.
    pub standing: &'a [u16],
}

/// Irradiance over pi at a point of object `index` with normal `n`: the factor of the albedo.
pub(super) fn arriving(stage: &Stage, occluders: &Occluders<'_>, index: usize, point: Vec3, n: Vec3) -> Vec3 {
    let facing = n.dot(TO_SUN);
    let sun = if facing > 0.0 { facing * sunlight(stage, occluders.casters, point + n * NEAR) } else { 0.0 };
    let upward = 0.5 - 0.5 * n.y;
    let open =
        if index == stage.floor { open_floor(stage, occluders.standing, point) } else { corner(FLOOR - point.y) };
    BOUNCE.lerp(SKY, upward) * (open * stage.ambient) + SUN * sun
}

/// Visible share of the sun from a point, given the objects that may cast a shadow there.
fn sunlight(stage: &Stage, casters: &[u16], point: Vec3) -> f32 {
    let open = slats(point);
    if open <= 0.0 {
        return 0.0;
    }
    let ray = Ray { origin: point, direction: TO_SUN };
    let shaded = casters.iter().any(|&caster| {
        let shape = &stage.objects[caster as usize].shape;
        shape.hit(&ray, NEAR, f32::INFINITY).is_some()
    });
    if shaded { 0.0 } else { open }
}

/// Visible share of the sky at a distance from a wall or the floor.
fn corner(distance: f32) -> f32 {
    0.55 + 0.45 * smoothstep(-0.1, 0.9, distance)
}

/// Visible share of the sky from the floor, given the objects `standing` on it.
fn open_floor(stage: &Stage, standing: &[u16], point: Vec3) -> f32 {
    let mut open = corner(BACK - point.z) * corner(point.x - LEFT) * corner(RIGHT - point.x);
    for &object in standing {
        let Some((centre, radius)) = occluder(&stage.objects[object as usize].shape) else {
            continue;
        };
        // Cosine-weighted share of the hemisphere that a sphere occludes, with a smooth cut-off.
        let to_centre = centre - point;
        let squares = to_centre.length_squared() / (radius * radius);
        let near = (1.0 - squares / (REACH * REACH)).max(0.0);
        let cosine = (-to_centre.y / radius).max(0.0) / squares.sqrt();
        open *= 1.0 - near * cosine / squares.max(1.0);
    }
    open
}

/// Sphere that represents an object on the floor in ambient occlusion; `None` for objects that do not stand on the
/// floor.
fn occluder(shape: &Shape) -> Option<(Vec3, f32)> {
    match *shape {
        Shape::Sphere { centre, radius } if centre.y + radius > FLOOR - 0.1 => Some((centre, radius)),
        Shape::Post { centre, radius, .. } => Some((centre.with_y(FLOOR - radius), radius)),
        Shape::Block { centre, half, .. } if centre.y + half.y > FLOOR - 0.1 => {
            let radius = half.x.max(half.z);
            Some((centre.with_y(FLOOR - radius), radius))
        }
        _ => None,
    }
}

/// Whether ambient occlusion of `shape` reaches the floor somewhere in a sphere.
pub(super) fn occludes_floor(shape: &Shape, (centre, radius): (Vec3, f32)) -> bool {
    occluder(shape).is_some_and(|(middle, size)| middle.distance(centre) < REACH * size + radius)
}

/// Share of the sun that passes the roof of slats above and behind the camera. It casts stripes on the floor and the
/// walls.
fn slats(point: Vec3) -> f32 {
    const HEIGHT: f32 = -3.4;
    /// Angular diameter of the sun, as a slope.
    const BLUR: f32 = 0.0093;
    let t = (HEIGHT - point.y) / TO_SUN.y;
    let above = point + TO_SUN * t;
    if t < 0.0 || !(-6.0..3.2).contains(&above.z) || above.x > 1.4 {
        return 1.0;
    }
    let w = BLUR * t;
    let across = pulse(above.z / 0.42, 0.55, w / 0.42);
    let along = pulse(above.x / 1.6, 0.92, w / 1.6);
    across * along
}

/// Radiance of the sky with clouds, by direction.
pub(super) fn sky(direction: Vec3) -> Vec3 {
    let d = direction.normalize();
    let up = (-d.y).max(0.0);
    let blue = Vec3::new(0.66, 0.80, 0.95).lerp(Vec3::new(0.16, 0.36, 0.74), smoothstep(0.0, 0.75, up));
    let p = Vec2::new(d.x, d.y * 2.0) * (11.0 / (0.6 + d.z.abs()));
    let cover = fbm(p, 0.02, 5, 407);
    let cloud = smoothstep(0.50, 0.68, cover);
    let lit = Vec3::splat(0.72).lerp(Vec3::splat(1.12), smoothstep(0.45, 0.8, cover));
    blue.lerp(lit, 0.85 * cloud)
}
