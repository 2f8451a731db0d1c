//! Static scenes with one camera.

use crate::scene::{Camera, Environment, Material, Pose, PunctualLight, Scene, Triangles};
use glam::DVec3;

/// A static scene with one camera, under a sky of this radiance.
pub(super) fn still(
    name: &str,
    materials: Vec<Material>,
    still: Triangles,
    camera: Camera,
    lights: Vec<PunctualLight>,
    sky: [f32; 3],
) -> Scene {
    let pose = Pose { lights, cameras: vec![camera], ..Pose::default() };
    let scene = Scene::from_parts(&format!("builtin:{name}"), materials, still, pose, Environment::Constant(sky));
    scene.expect("triangles have all attributes and one of the materials")
}

/// A camera named "main" at `eye` that looks at `target`, with y up.
pub(super) fn look_at(eye: [f64; 3], target: [f64; 3], vfov_deg: f32) -> Camera {
    Camera { name: "main".into(), ..Camera::look_at(DVec3::from(eye), DVec3::from(target), vfov_deg) }
}
