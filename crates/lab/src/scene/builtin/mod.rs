//! Built-in scenes: `builtin:NAME`.

mod bunny;
mod control;
mod cornell;
mod courtyard;
mod cubes;
mod furnace;
mod interior;
mod mirror_room;
mod patch;
mod shapes;
mod still;

pub use cornell::cornell;
pub use courtyard::{courtyard, courtyard_of};
pub use furnace::{furnace, furnace_of};

use super::Scene;

/// Names of the built-in scenes.
pub const NAMES: &[&str] =
    &["bunny-high", "bunny-low", "control", "cornell", "courtyard", "cubes", "furnace", "interior", "mirror-room"];

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
        "interior" => interior::scene(),
        "mirror-room" => mirror_room::scene(),
        _ => return None,
    })
}
