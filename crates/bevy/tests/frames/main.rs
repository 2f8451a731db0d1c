//! Frames of an application without a window, on software Vulkan.

#[path = "../../examples/common/mod.rs"]
mod common;

mod antialiasing;
mod applications;
mod conventions;
mod events;
mod pixels;
mod quads;
mod reflection;

use bevy::camera::{Hdr, RenderTarget};
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::prelude::*;
use bevy_afterimage::afterimage::{Method, Settings};
use bevy_afterimage::{Afterimage, Foveated, FoveationKind, Gaze};
use common::headless::{Headless, psnr_db};
use common::scene::{Mover, ScenePlugin, TONEMAPPING, stroll};

const SIZE: UVec2 = UVec2::new(320, 180);

/// The courtyard, and a camera with `components` that strolls through it.
fn courtyard(components: impl Bundle) -> Headless {
    let mut headless = Headless::new(SIZE, ScenePlugin { lamps: 4, moves: true });
    let target = headless.render_target();
    headless
        .app
        .world_mut()
        .spawn((Camera3d::default(), target, stroll(0.0), Mover::Stroll))
        .insert((TONEMAPPING, Msaa::Off))
        .insert(components);
    headless
}

/// The courtyard, and cameras that stroll through it on the same way, each with components and an image of its own.
fn courtyards<const N: usize>(cameras: [impl Bundle; N]) -> (Headless, [Handle<Image>; N]) {
    let mut headless = Headless::new(SIZE, ScenePlugin { lamps: 4, moves: true });
    let targets = cameras.map(|components| {
        let image = headless.add_target(SIZE);
        let target = RenderTarget::from(image.clone());
        headless
            .app
            .world_mut()
            .spawn((Camera3d::default(), target, stroll(0.0), Mover::Stroll))
            .insert((TONEMAPPING, Msaa::Off))
            .insert(components);
        image
    });
    (headless, targets)
}

/// At every pixel, by quads without history, and by quads.
fn compared() -> [(Afterimage, Foveated); 3] {
    let every = Foveated { kind: FoveationKind::Off, ..default() };
    let blind = Settings { method: Method::None, ..default() };
    let blind = Afterimage { settings: Some(blind), ..default() };
    [(Afterimage::default(), every), (blind, Foveated::default()), default()]
}

/// Has the camera be shown otherwise from now on, without history.
fn change(headless: &mut Headless, (afterimage, foveated): (Afterimage, Foveated)) -> Entity {
    let world = headless.app.world_mut();
    let camera = world.query_filtered::<Entity, With<Camera3d>>().single(world).expect("a camera");
    world.entity_mut(camera).insert((Afterimage { reset: true, ..afterimage }, foveated)).id()
}

fn kind(kind: FoveationKind) -> impl Bundle {
    (Afterimage::default(), Foveated { kind, ..default() })
}

/// A gaze that wanders through the frame.
fn wander(headless: &mut Headless, frame: usize) {
    let t = frame as f32;
    let uv = Vec2::new(0.5 + 0.3 * (0.11 * t).sin(), 0.55 + 0.2 * (0.07 * t).cos());
    headless.app.world_mut().resource_mut::<Gaze>().set(uv);
}

/// Frames of the wandering gaze in each image, without the first `skipped`.
fn clips<const N: usize>(
    (mut headless, targets): (Headless, [Handle<Image>; N]),
    frames: usize,
    skipped: usize,
) -> [Vec<Vec<u8>>; N] {
    let mut shots = [const { vec![] }; N];
    for frame in 0..frames {
        wander(&mut headless, frame);
        headless.frames(1);
        if frame >= skipped {
            shots.iter_mut().zip(&targets).for_each(|(shots, target)| shots.push(headless.read_target(target)));
        }
    }
    assert_eq!(headless.problems(), &[] as &[String], "validation");
    shots
}

/// PSNR over the frames of a clip, in dB.
fn clip_psnr_db(a: &[Vec<u8>], b: &[Vec<u8>]) -> f64 {
    psnr_db(&a.concat(), &b.concat())
}

/// A camera with `Hdr` whose main texture is shown as it is.
fn linear() -> impl Bundle {
    (Hdr, Tonemapping::None)
}
