//! Cameras of a scene.

use glam::DMat4;

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
