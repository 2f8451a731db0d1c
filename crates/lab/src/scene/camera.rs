//! Cameras of a scene.

use glam::{DMat4, DVec3};

/// A perspective camera. It looks along -z, with x right and y up.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Name in the file; may be empty.
    pub name: String,
    /// Camera-to-world matrix: rotation and translation only.
    pub world_from_camera: DMat4,
    /// Vertical field of view in degrees, above 0 and below 180. The horizontal one follows from the aspect ratio.
    pub vfov_deg: f32,
}

impl Camera {
    /// A camera at `eye` that looks at `target`, with y up. If it looks straight up or down, its x axis is the world's.
    pub fn look_at(eye: DVec3, target: DVec3, vfov_deg: f32) -> Self {
        let back = (eye - target).normalize_or(DVec3::Z);
        let right = DVec3::Y.cross(back).try_normalize().unwrap_or(DVec3::X);
        let up = back.cross(right);
        let world_from_camera = DMat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), eye.extend(1.0));
        Self { name: String::new(), world_from_camera, vfov_deg }
    }
}
