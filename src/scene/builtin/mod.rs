//! Scenes that need no file.

mod bunny;
mod control;
mod cubes;
mod mirror_room;
mod shapes;

use super::Scene;

/// The scene of that name, if there is one.
pub(crate) fn open(name: &str) -> Option<Scene> {
    let scene = match name {
        "bunny-high" => bunny::high(),
        "bunny-low" => bunny::low(),
        "control" => control::scene(),
        "cubes" => cubes::scene(),
        "mirror-room" => mirror_room::scene(),
        _ => return None,
    };
    Some(scene)
}
