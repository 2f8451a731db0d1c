//! `interior`: a furnished room of thin parts, before a bright window, in which a camera, a fan and a figure move.

mod cupboards;
mod furniture;
mod lamps;
mod materials;
mod moving;
mod rig;
mod shell;
mod size;
mod solids;
mod textures;
mod window;

use crate::scene::{Scene, Triangles};
use std::sync::Arc;

/// A room of 5.2 x 2.6 x 6.4 m with two cameras: `still`, which sees all of it, and `walk`, which passes the cupboards
/// at 1 m. Sun and sky shine through the window.
pub(super) fn scene() -> Scene {
    let mut still = Triangles::default();
    shell::push(&mut still);
    window::push(&mut still);
    cupboards::push(&mut still);
    furniture::push(&mut still);
    lamps::push(&mut still);
    moving::push_fan_stand(&mut still);
    let animated = moving::animated();
    let name = "builtin:interior";
    let scene = Scene::from_parts(name, materials::all(), still, animated.pose(0.0), window::environment());
    Scene {
        textures: textures::all(),
        animations: vec!["loop".into()],
        animated: Some(Arc::new(animated)),
        ..scene.expect("triangles have all attributes and one of the materials")
    }
}
