//! Bounding boxes, and a camera that frames a whole scene.

use super::{Camera, Scene, Triangles};
use glam::{DVec3, Vec3};

/// An axis-aligned bounding box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest coordinates, in metres.
    pub min: Vec3,
    /// Largest coordinates, in metres.
    pub max: Vec3,
}

/// Vertical field of view of the framing camera.
const FRAMING_VFOV_DEG: f32 = 40.0;
/// Direction from the middle of the scene to the framing camera: right of the front, and above.
const AZIMUTH_DEG: f64 = 35.0;
const ELEVATION_DEG: f64 = 20.0;
/// Size of the frame over that of the bounding box.
const MARGIN: f64 = 1.05;

impl Triangles {
    /// Bounding box; `None` without triangles.
    pub fn bounds(&self) -> Option<Bounds> {
        let first = self.positions.first()?[0];
        let start = Bounds { min: first, max: first };
        Some(self.positions.iter().flatten().fold(start, |b, &p| Bounds { min: b.min.min(p), max: b.max.max(p) }))
    }
}

impl Scene {
    /// Bounding box of all triangles at time 0; `None` without triangles.
    pub fn bounds(&self) -> Option<Bounds> {
        match (self.still.bounds(), self.rest.moving.bounds()) {
            (Some(a), Some(b)) => Some(Bounds { min: a.min.min(b.min), max: a.max.max(b.max) }),
            (a, b) => a.or(b),
        }
    }

    /// A camera with the scene's whole bounding box in view, from the front, right and above: for scenes without a
    /// camera.
    ///
    /// `aspect` is width over height of the frame. For an empty scene it looks at the origin.
    pub fn framing_camera(&self, aspect: f32) -> Camera {
        let aspect = if aspect.is_finite() && aspect > 0.0 { f64::from(aspect) } else { 1.0 };
        let (min, max) = self.bounds().map_or((DVec3::NEG_ONE, DVec3::ONE), |b| (b.min.as_dvec3(), b.max.as_dvec3()));
        let center = (min + max) / 2.0;
        let mut half = (max - min) / 2.0;
        if half == DVec3::ZERO {
            half = DVec3::splat(center.length().max(1.0) * 1e-3);
        }
        let (sin_azimuth, cos_azimuth) = AZIMUTH_DEG.to_radians().sin_cos();
        let (sin_elevation, cos_elevation) = ELEVATION_DEG.to_radians().sin_cos();
        let back = DVec3::new(sin_azimuth * cos_elevation, sin_elevation, cos_azimuth * cos_elevation);
        let right = DVec3::Y.cross(back).normalize();
        let up = back.cross(right);
        let tan_y = (f64::from(FRAMING_VFOV_DEG) / 2.0).to_radians().tan() / MARGIN;
        let tan_x = tan_y * aspect;
        // A corner at (x, y, z) in camera axes around the middle is in view from distance d if |x| <= (d - z) tan_x;
        // same for y.
        let distance = (0..8)
            .map(|corner| {
                let sign = |bit: i32| if corner >> bit & 1 == 0 { -1.0 } else { 1.0 };
                let p = half * DVec3::new(sign(0), sign(1), sign(2));
                p.dot(back) + (p.dot(right).abs() / tan_x).max(p.dot(up).abs() / tan_y)
            })
            .fold(0.0, f64::max);
        Camera::look_at(center + back * distance, center, FRAMING_VFOV_DEG)
    }
}
