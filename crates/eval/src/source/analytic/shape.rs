//! Shapes in world space, and their intersection with rays.

use super::noise::split;
use glam::{Mat3, Vec2, Vec3};

/// A ray. Its direction has z = 1 in view space, so that the ray parameter of a hit is its depth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    pub origin: Vec3,
    pub direction: Vec3,
}

impl Ray {
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }
}

/// Geometry of an object. x right, y down, z away from the first camera.
#[derive(Clone, Copy, Debug)]
pub(super) enum Shape {
    /// A two-sided rectangle. `u` and `v` are orthogonal unit axes.
    Rect { centre: Vec3, u: Vec3, v: Vec3, half: Vec2, cutout: Cutout },
    /// A ball.
    Sphere { centre: Vec3, radius: f32 },
    /// A vertical cylinder without caps.
    Post { centre: Vec3, radius: f32, half_height: f32 },
    /// A box along the columns of `axes`, a rotation.
    Block { centre: Vec3, half: Vec3, axes: Mat3 },
}

/// Alpha test of a rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cutout {
    /// None.
    Solid,
    /// Pickets with pointed tops on two rails.
    Pickets,
}

/// Period of the pickets and half the width of one, in metres.
pub(super) const PICKET_PERIOD: f32 = 0.16;
const PICKET_HALF: f32 = 0.05;

impl Cutout {
    /// Whether the rectangle is opaque `uv` metres from its centre; `half` is half its size.
    fn solid(self, uv: Vec2, half: Vec2) -> bool {
        match self {
            Self::Solid => true,
            Self::Pickets => {
                let across = (split(uv.x / PICKET_PERIOD).1 - 0.5).abs() * PICKET_PERIOD;
                let below_top = uv.y + half.y;
                let rail = (below_top - 0.25).abs() < 0.035 || (half.y - uv.y - 0.2).abs() < 0.035;
                rail || (across < PICKET_HALF && below_top > 1.4 * across)
            }
        }
    }
}

/// Local geometry at a hit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surface {
    /// Unit normal on the side of the ray's origin.
    pub normal: Vec3,
    /// Unit tangents along the texture axes.
    pub tangents: [Vec3; 2],
    /// Texture coordinates in metres along the tangents (posts: arc length and height; spheres: unused).
    pub uv: Vec2,
}

impl Surface {
    /// This geometry in a space in which its axes are the columns of `axes`.
    fn turned(self, axes: Mat3) -> Self {
        Self { normal: axes * self.normal, tangents: self.tangents.map(|t| axes * t), uv: self.uv }
    }
}

impl Shape {
    /// This shape, translated. Blocks are turned by `spin`, too; other shapes keep their axes.
    pub fn moved(self, by: Vec3, spin: Mat3) -> Self {
        let mut moved = self;
        match &mut moved {
            Self::Rect { centre, .. } | Self::Sphere { centre, .. } | Self::Post { centre, .. } => {
                *centre += by;
            }
            Self::Block { centre, axes, .. } => {
                *centre += by;
                *axes = spin;
            }
        }
        moved
    }

    /// Centre and radius of a bounding sphere.
    pub fn bound(&self) -> (Vec3, f32) {
        match *self {
            Self::Rect { centre, half, .. } => (centre, half.length()),
            Self::Sphere { centre, radius } => (centre, radius),
            Self::Post { centre, radius, half_height } => (centre, radius.hypot(half_height)),
            Self::Block { centre, half, .. } => (centre, half.length()),
        }
    }

    /// Corners of a bounding box (of a rectangle: its own corners, twice).
    pub fn corners(&self) -> [Vec3; 8] {
        let (centre, axes) = match *self {
            Self::Rect { centre, u, v, half, .. } => (centre, [u * half.x, v * half.y, Vec3::ZERO]),
            Self::Sphere { centre, radius } => (centre, [Vec3::X, Vec3::Y, Vec3::Z].map(|a| a * radius)),
            Self::Post { centre, radius, half_height } => {
                (centre, [Vec3::X * radius, Vec3::Y * half_height, Vec3::Z * radius])
            }
            Self::Block { centre, half, axes } => {
                (centre, [axes.x_axis * half.x, axes.y_axis * half.y, axes.z_axis * half.z])
            }
        };
        std::array::from_fn(|i| {
            let sign = |bit: usize| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
            centre + axes[0] * sign(0) + axes[1] * sign(1) + axes[2] * sign(2)
        })
    }

    /// Ray parameter of the first hit in (`near`, `far`).
    #[inline]
    pub fn hit(&self, ray: &Ray, near: f32, far: f32) -> Option<f32> {
        let t = match *self {
            Self::Rect { centre, u, v, half, cutout } => return hit_rect(ray, [centre, u, v], half, cutout, near, far),
            Self::Sphere { centre, radius } => hit_ball(ray, centre, radius, near)?,
            Self::Post { centre, radius, half_height } => hit_post(ray, centre, radius, half_height, near)?,
            Self::Block { centre, half, axes } => hit_block(ray, centre, half, axes, near)?,
        };
        (t > near && t < far).then_some(t)
    }

    /// Normal, tangents and texture coordinates at a point of the surface seen along `direction`.
    pub fn surface(&self, point: Vec3, direction: Vec3) -> Surface {
        match *self {
            Self::Rect { centre, u, v, .. } => {
                let n = u.cross(v);
                let local = point - centre;
                Surface {
                    normal: if n.dot(direction) > 0.0 { -n } else { n },
                    tangents: [u, v],
                    uv: Vec2::new(local.dot(u), local.dot(v)),
                }
            }
            Self::Sphere { centre, .. } => {
                let normal = (point - centre).normalize();
                let u = normal.any_orthonormal_vector();
                Surface { normal, tangents: [u, normal.cross(u)], uv: Vec2::ZERO }
            }
            Self::Post { centre, radius, .. } => {
                let local = point - centre;
                let normal = Vec3::new(local.x, 0.0, local.z) / radius;
                Surface {
                    normal,
                    tangents: [Vec3::new(normal.z, 0.0, -normal.x), Vec3::Y],
                    uv: Vec2::new(radius * local.x.atan2(local.z), local.y),
                }
            }
            Self::Block { centre, half, axes } => block_surface(axes.transpose() * (point - centre), half).turned(axes),
        }
    }
}

#[inline]
fn hit_rect(ray: &Ray, [centre, u, v]: [Vec3; 3], half: Vec2, cutout: Cutout, near: f32, far: f32) -> Option<f32> {
    let n = u.cross(v);
    let t = n.dot(centre - ray.origin) / n.dot(ray.direction);
    // Also rejects the NaN of a ray within the plane.
    if !(t > near && t < far) {
        return None;
    }
    let local = ray.at(t) - centre;
    let uv = Vec2::new(local.dot(u), local.dot(v));
    (uv.abs().cmple(half).all() && cutout.solid(uv, half)).then_some(t)
}

/// Ray-sphere intersection relative to the ray's point nearest to the centre, which keeps precision far away.
#[inline]
fn hit_ball(ray: &Ray, centre: Vec3, radius: f32, near: f32) -> Option<f32> {
    let d = ray.direction;
    let to_centre = centre - ray.origin;
    let length2 = d.length_squared();
    let t_mid = d.dot(to_centre) / length2;
    let off = to_centre - d * t_mid;
    let inside2 = radius * radius - off.length_squared();
    if inside2 <= 0.0 {
        return None;
    }
    let half_chord = (inside2 / length2).sqrt();
    let first = t_mid - half_chord;
    Some(if first > near { first } else { t_mid + half_chord })
}

#[inline]
fn hit_post(ray: &Ray, centre: Vec3, radius: f32, half_height: f32, near: f32) -> Option<f32> {
    let d = Vec2::new(ray.direction.x, ray.direction.z);
    let to_centre = Vec2::new(centre.x - ray.origin.x, centre.z - ray.origin.z);
    let length2 = d.length_squared();
    let t_mid = d.dot(to_centre) / length2;
    let inside2 = radius * radius - (to_centre - d * t_mid).length_squared();
    if inside2 <= 0.0 {
        return None;
    }
    let half_chord = (inside2 / length2).sqrt();
    [t_mid - half_chord, t_mid + half_chord]
        .into_iter()
        .find(|&t| t > near && (ray.origin.y + ray.direction.y * t - centre.y).abs() <= half_height)
}

#[inline]
fn hit_block(ray: &Ray, centre: Vec3, half: Vec3, axes: Mat3, near: f32) -> Option<f32> {
    let direction = axes.transpose() * ray.direction;
    // A zero in the direction would give inf - inf for a ray whose origin is level with the centre.
    let tiny = Vec3::splat(1e-12);
    let inverse = Vec3::select(direction.abs().cmplt(tiny), tiny, direction).recip();
    let middle = axes.transpose() * (centre - ray.origin) * inverse;
    let reach = half * inverse.abs();
    let enter = (middle - reach).max_element();
    let leave = (middle + reach).min_element();
    (enter <= leave && leave > near).then_some(if enter > near { enter } else { leave })
}

fn block_surface(local: Vec3, half: Vec3) -> Surface {
    let share = (local / half).abs();
    let (normal, tangents) = if share.x >= share.y && share.x >= share.z {
        (Vec3::X * local.x.signum(), [Vec3::Z, Vec3::Y])
    } else if share.y >= share.z {
        (Vec3::Y * local.y.signum(), [Vec3::X, Vec3::Z])
    } else {
        (Vec3::Z * local.z.signum(), [Vec3::X, Vec3::Y])
    };
    Surface { normal, tangents, uv: Vec2::new(local.dot(tangents[0]), local.dot(tangents[1])) }
}
