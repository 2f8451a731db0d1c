//! `control`: an empty scene under a sky, which gives the cost of a frame whose rays hit nothing.

use super::still::still;
use crate::scene::{Camera, Scene, Triangles};
use glam::DVec3;

/// Sky light alone.
pub(super) fn scene() -> Scene {
    let camera = Camera::look_at(DVec3::new(0.0, 1.0, 3.0), DVec3::new(0.0, 1.0, 0.0), 60.0);
    still("control", vec![], Triangles::default(), camera, vec![], [0.5, 0.7, 1.0])
}
