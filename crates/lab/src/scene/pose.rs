//! The moving part of a scene.

use super::camera::Camera;
use super::light::PunctualLight;
use super::triangles::Triangles;

/// Animated triangles, lights and cameras at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    /// Animated triangles, in the same order and number at every time. Their corners keep their order too, unless an
    /// animation mirrors them.
    pub moving: Triangles,
    /// Punctual lights, in the same order and number at every time.
    pub lights: Vec<PunctualLight>,
    /// Cameras, in the same order and number at every time.
    pub cameras: Vec<Camera>,
}
