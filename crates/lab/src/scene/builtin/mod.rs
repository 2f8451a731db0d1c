//! Built-in scenes: `builtin:NAME`.

mod bunny;
mod control;
mod cornell;
mod courtyard;
mod cubes;
mod furnace;
mod mirror_room;
mod patch;
mod shapes;

pub use cornell::cornell;
pub use courtyard::{courtyard, courtyard_of};
pub use furnace::{furnace, furnace_of};

use super::{Camera, Environment, Material, Pose, Scene, Triangles};
use glam::DVec3;

/// Names of the built-in scenes.
pub const NAMES: &[&str] =
    &["bunny-high", "bunny-low", "control", "cornell", "courtyard", "cubes", "furnace", "mirror-room"];

/// The scene of that name.
pub(crate) fn open(name: &str) -> Option<Scene> {
    Some(match name {
        "bunny-high" => bunny::high(),
        "bunny-low" => bunny::low(),
        "control" => control::scene(),
        "cornell" => cornell(),
        "courtyard" => courtyard(),
        "cubes" => cubes::scene(),
        "furnace" => furnace(),
        "mirror-room" => mirror_room::scene(),
        _ => return None,
    })
}

/// A static scene with one camera.
fn still(name: &str, materials: Vec<Material>, still: Triangles, camera: Camera, environment: Environment) -> Scene {
    Scene {
        name: format!("builtin:{name}"),
        materials,
        textures: vec![],
        environment,
        animations: vec![],
        warnings: vec![],
        still,
        rest: Pose { cameras: vec![camera], ..Pose::default() },
        animated: None,
    }
}

/// A camera named "main" at `eye` that looks at `target`, with y up.
fn look_at(eye: [f64; 3], target: [f64; 3], vfov_deg: f32) -> Camera {
    Camera { name: "main".into(), ..Camera::look_at(DVec3::from(eye), DVec3::from(target), vfov_deg) }
}
