//! Static scenes with one camera.

use crate::scene::{Camera, Environment, Material, Pose, Scene, Triangles};
use glam::DVec3;

/// A static scene with one camera.
pub(super) fn still(
    name: &str,
    materials: Vec<Material>,
    still: Triangles,
    camera: Camera,
    environment: Environment,
) -> Scene {
    Scene {
        name: format!("builtin:{name}"),
        materials,
        textures: vec![],
        environment,
        animations: vec![],
        warnings: vec![],
        origin: DVec3::ZERO,
        still,
        rest: Pose { cameras: vec![camera], ..Pose::default() },
        animated: None,
    }
}

/// A camera named "main" at `eye` that looks at `target`, with y up.
pub(super) fn look_at(eye: [f64; 3], target: [f64; 3], vfov_deg: f32) -> Camera {
    Camera { name: "main".into(), ..Camera::look_at(DVec3::from(eye), DVec3::from(target), vfov_deg) }
}
