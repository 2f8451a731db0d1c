//! Renders a scene with Afterimage, without a window, and writes the frame as PNG: `out/headless.png`, or the given
//! path.
//!
//! `cargo run --example headless_png [-- PATH]`

mod common;

use bevy::prelude::*;
use bevy_afterimage::{Afterimage, Foveated, Gaze};
use common::headless::{Headless, write_png};
use common::scene::{Mover, ScenePlugin, TONEMAPPING, stroll};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "out/headless.png".into());
    let size = UVec2::new(640, 360);
    let mut headless = Headless::new(size, ScenePlugin { lamps: 16, moves: true });
    println!("adapter: {}", headless.adapter());

    let target = headless.render_target();
    headless.app.world_mut().spawn((
        (Camera3d::default(), Afterimage::default(), Foveated::default()),
        (target, TONEMAPPING, stroll(0.0), Mover::Stroll),
    ));
    let mut frame = vec![];
    for i in 0..24 {
        // The eye wanders from the left to the middle.
        headless.app.world_mut().resource_mut::<Gaze>().set(Vec2::new(0.25 + 0.01 * i as f32, 0.6));
        frame = headless.shot();
    }
    write_png(path.as_ref(), size, &frame)?;
    println!("{path}: {} validation errors", headless.problems().len());
    headless.problems().first().map_or(Ok(()), |problem| Err(problem.as_str().into()))
}
