//! `control`: an empty scene under a sky, which gives the cost of a frame whose rays hit nothing.

use crate::scene::{Camera, Environment, Pose, Scene, Triangles};
use glam::DVec3;

/// Sky light alone.
pub(super) fn scene() -> Scene {
    let cameras = vec![Camera::look_at(DVec3::new(0.0, 1.0, 3.0), DVec3::new(0.0, 1.0, 0.0), 60.0)];
    Scene {
        name: "builtin:control".into(),
        materials: Vec::new(),
        textures: Vec::new(),
        environment: Environment::Constant([0.5, 0.7, 1.0]),
        animations: vec![],
        warnings: Vec::new(),
        origin: DVec3::ZERO,
        still: Triangles::default(),
        rest: Pose { cameras, ..Pose::default() },
        animated: None,
    }
}
