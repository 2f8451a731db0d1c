//! Cameras of a scene.

use glam::{DMat4, DVec3};

/// Where a picture is taken from. Looks along its -z, x right, y up.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// As the file names it; may be empty.
    pub name: String,
    /// Rigid: rotation and translation only.
    pub world_from_camera: DMat4,
    /// Vertical field of view in degrees, above 0 and below 180. The horizontal one follows from the picture's shape.
    pub vfov_deg: f32,
}

impl Camera {
    /// A camera at `eye` that looks at `target`, upright; straight up or down some side is up.
    pub fn look_at(eye: DVec3, target: DVec3, vfov_deg: f32) -> Self {
        let back = (eye - target).normalize_or(DVec3::Z);
        let right = DVec3::Y.cross(back).try_normalize().unwrap_or(DVec3::X);
        let up = back.cross(right);
        let world_from_camera = DMat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), eye.extend(1.0));
        Self { name: String::new(), world_from_camera, vfov_deg }
    }
}
