//! A scene as functions of time ([`Scene`]), and its state at a frame and the previous one ([`Stage`]).

use super::shape::Shape;
use super::texture::Material;
use glam::{Mat3, Vec3};

/// Direction towards the sun: behind the first camera, to its left and above.
pub(super) const TO_SUN: Vec3 = Vec3::new(-0.529_808, -0.739_731_9, -0.414_849_64);

/// Pose of an object: rotation by `spin` about the shape's centre, then translation by `offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose {
    pub offset: Vec3,
    pub spin: Mat3,
}

/// An object of the scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct Object {
    pub shape: Shape,
    pub material: Material,
    /// Pose at a time in seconds; `None` for static objects. Only spheres and blocks rotate.
    pub path: Option<fn(f64) -> Pose>,
}

/// Position and axes (columns: right, down, forward) of the view in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Camera {
    pub origin: Vec3,
    pub axes: Mat3,
}

impl Camera {
    /// A level camera turned to the right by `yaw` and down by `pitch`, in radians.
    pub fn looking(origin: Vec3, yaw: f32, pitch: f32) -> Self {
        Self { origin, axes: Mat3::from_rotation_y(yaw) * Mat3::from_rotation_x(-pitch) }
    }

    /// A world point in view space.
    pub fn view(&self, point: Vec3) -> Vec3 {
        self.axes.transpose() * (point - self.origin)
    }

    /// Row-major matrix from this view's space to the other camera's.
    pub fn to(&self, other: &Self) -> [[f32; 4]; 4] {
        let (turn, shift) = if self.axes == other.axes {
            // The identity is exact; the product of both matrices would equal it only up to rounding.
            (Mat3::IDENTITY, other.view(self.origin))
        } else {
            (other.axes.transpose() * self.axes, other.view(self.origin))
        };
        let rows = turn.transpose().to_cols_array_2d();
        let row = |i: usize| [rows[i][0], rows[i][1], rows[i][2], shift[i]];
        [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]]
    }
}

/// Objects and camera with their motion.
#[derive(Clone, Debug)]
pub(super) struct Scene {
    pub objects: Vec<Object>,
    /// The camera at a time in seconds.
    pub camera: fn(f64) -> Camera,
    /// Index of the floor, which has ambient occlusion around the objects on it.
    pub floor: usize,
    /// Index of the panel whose content moves without motion vectors.
    pub panel: Option<usize>,
    /// Factor on the light that does not come from the sun.
    pub ambient: f32,
}

/// An object at the time of a frame.
#[derive(Clone, Debug)]
pub(super) struct Placed {
    pub shape: Shape,
    pub material: Material,
    /// Poses now and in the previous frame; `None` for static objects.
    pub poses: Option<[Pose; 2]>,
    /// Objects that may cast a shadow on this one.
    pub casters: Vec<u16>,
}

/// A scene at the time of one frame and the frame before.
#[derive(Clone, Debug)]
pub(super) struct Stage {
    pub objects: Vec<Placed>,
    /// Camera now and in the previous frame.
    pub cameras: [Camera; 2],
    pub floor: usize,
    pub panel: Option<usize>,
    pub ambient: f32,
}

impl Scene {
    /// State of the scene at the times `now` and `before`, in seconds.
    pub fn stage(&self, now: f64, before: f64) -> Stage {
        let mut objects: Vec<Placed> = self
            .objects
            .iter()
            .map(|object| {
                let poses = object.path.map(|path| [path(now), path(before)]);
                Placed {
                    shape: poses.map_or(object.shape, |p| object.shape.moved(p[0].offset, p[0].spin)),
                    material: object.material,
                    poses,
                    casters: Vec::new(),
                }
            })
            .collect();
        let bounds: Vec<_> = objects.iter().map(|o| o.shape.bound()).collect();
        for (receiver, object) in objects.iter_mut().enumerate() {
            object.casters = (0..bounds.len())
                .filter(|&caster| {
                    caster != receiver && caster != self.floor && may_shade(bounds[caster], bounds[receiver])
                })
                .map(|caster| caster as u16)
                .collect();
        }
        Stage {
            objects,
            cameras: [(self.camera)(now), (self.camera)(before)],
            floor: self.floor,
            panel: self.panel,
            ambient: self.ambient,
        }
    }
}

/// Whether a sphere can cast a shadow on another.
pub(super) fn may_shade((caster, caster_radius): (Vec3, f32), (receiver, receiver_radius): (Vec3, f32)) -> bool {
    let between = caster - receiver;
    let along = between.dot(TO_SUN);
    let reach = caster_radius + receiver_radius;
    along > -reach && (between - TO_SUN * along).length() < reach
}

impl Placed {
    /// Position in the previous frame of the surface point that is at `point` now.
    pub fn previous(&self, centre_now: Vec3, point: Vec3) -> Vec3 {
        let Some([now, before]) = self.poses else {
            return point;
        };
        if now == before {
            return point;
        }
        let local = now.spin.transpose() * (point - centre_now);
        before.spin * local + centre_now + (before.offset - now.offset)
    }
}
