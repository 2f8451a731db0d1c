//! Scenes made by code: `builtin:NAME`.

mod cornell;
mod courtyard;
mod furnace;
mod shapes;

pub use cornell::cornell;
pub use courtyard::{courtyard, courtyard_of};
pub use furnace::{furnace, furnace_of};

use super::{Camera, Environment, Material, Pose, Scene, Triangles};
use glam::{DMat4, DVec3};

/// Names of the built-in scenes.
pub const NAMES: &[&str] = &["cornell", "courtyard", "furnace"];

/// The scene of that name.
pub(crate) fn open(name: &str) -> Option<Scene> {
    Some(match name {
        "cornell" => cornell(),
        "courtyard" => courtyard(),
        "furnace" => furnace(),
        _ => return None,
    })
}

/// A scene in which nothing moves, seen from one place.
fn still(name: &str, materials: Vec<Material>, still: Triangles, camera: Camera, environment: Environment) -> Scene {
    Scene {
        name: format!("builtin:{name}"),
        materials,
        textures: vec![],
        environment,
        warnings: vec![],
        still,
        rest: Pose { cameras: vec![camera], ..Pose::default() },
        animated: None,
    }
}

/// A camera at `eye` that looks at `target`, upright.
fn look_at(eye: [f64; 3], target: [f64; 3], vfov_deg: f32) -> Camera {
    let (eye, target) = (DVec3::from(eye), DVec3::from(target));
    let back = (eye - target).normalize();
    let right = DVec3::Y.cross(back).normalize();
    let up = back.cross(right);
    let world_from_camera = DMat4::from_cols(right.extend(0.0), up.extend(0.0), back.extend(0.0), eye.extend(1.0));
    Camera { name: "main".into(), world_from_camera, vfov_deg }
}
