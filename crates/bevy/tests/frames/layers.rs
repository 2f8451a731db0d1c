//! Several cameras on one target, of which some are foveated: what each of them shows at full rate.

use crate::SIZE;
use crate::common::headless::Headless;
use crate::common::scene::TONEMAPPING;
use bevy::asset::RenderAssetUsages;
use bevy::camera::visibility::RenderLayers;
use bevy::camera::{ClearColorConfig, Hdr, MsaaWriteback, RenderTarget, Viewport};
use bevy::core_pipeline::prepass::DepthPrepass;
use bevy::light::{NotShadowCaster, Skybox};
use bevy::prelude::*;
use bevy::render::RenderApp;
use bevy::render::render_resource::{
    Extent3d, TextureDimension, TextureFormat, TextureViewDescriptor, TextureViewDimension,
};
use bevy_afterimage::testing::recorded;
use bevy_afterimage::{Afterimage, Foveated, FoveationKind};

/// Layer of what only upper cameras show.
const ARM: RenderLayers = RenderLayers::layer(1);

/// At full rate, and by quads without a gaze.
fn kinds() -> [Foveated; 2] {
    [Foveated { kind: FoveationKind::Off, ..default() }, Foveated::uniform(0.25)]
}

/// Where the camera is at a time.
fn place(t_s: f32) -> Transform {
    Transform::from_xyz(0.6 * t_s - 0.6, 1.0, 2.0).looking_at(Vec3::new(0.3 * t_s, 0.6, -3.0), Vec3::Y)
}

/// Cubes on a floor, an arm that only upper cameras show, and for each kind an image to which `spawn` adds cameras.
fn room(spawn: impl Fn(&mut World, RenderTarget, Foveated)) -> (Headless, [Handle<Image>; 2]) {
    let mut headless = Headless::new(SIZE, |_: &mut App| {});
    let white = MeshMaterial3d(headless.asset(StandardMaterial::from(Color::WHITE)));
    let teal = MeshMaterial3d(headless.asset(StandardMaterial::from(Color::srgb(0.0, 0.8, 0.7))));
    let floor = Mesh3d(headless.asset(Plane3d::new(Vec3::Y, Vec2::splat(10.0)).into()));
    let cube = Mesh3d(headless.asset(Cuboid::new(2.0, 0.5, 1.0).into()));
    let arm = Mesh3d(headless.asset(Cuboid::new(0.1, 0.1, 0.5).into()));
    let world = headless.app.world_mut();
    world.spawn((floor, white.clone()));
    world.spawn((cube.clone(), white.clone(), Transform::from_xyz(0.0, 0.25, -3.0)));
    world.spawn((cube, white, Transform::from_xyz(0.75, 1.75, 0.0)));
    world.spawn((arm, teal, place(1.0) * Transform::from_xyz(0.2, -0.1, -0.25), ARM, NotShadowCaster));
    let light = PointLight { color: Color::srgb(1.0, 0.8, 0.8), shadow_maps_enabled: true, ..default() };
    world.spawn((light, Transform::from_xyz(-2.0, 4.0, -0.75), RenderLayers::from_layers(&[0, 1])));
    let targets = kinds().map(|kind| {
        let image = headless.add_target(SIZE);
        spawn(headless.app.world_mut(), RenderTarget::from(image.clone()), kind);
        image
    });
    (headless, targets)
}

/// A camera of the world, which is foveated.
fn world_camera(target: RenderTarget, kind: Foveated) -> impl Bundle {
    (Camera3d::default(), target, TONEMAPPING, place(1.0), Afterimage::default(), kind)
}

/// A camera on top of it that shows the arm.
fn arm_camera(target: RenderTarget, clear_color: ClearColorConfig) -> impl Bundle {
    (Camera3d::default(), Camera { order: 1, clear_color, ..default() }, target, TONEMAPPING, place(1.0), ARM)
}

/// A grey sky.
fn sky() -> Image {
    let size = Extent3d { width: 1, height: 1, depth_or_array_layers: 6 };
    let usage = RenderAssetUsages::default();
    let grey = [128, 128, 128, 255];
    let mut image = Image::new_fill(size, TextureDimension::D2, &grey, TextureFormat::Rgba8UnormSrgb, usage);
    image.texture_view_descriptor =
        Some(TextureViewDescriptor { dimension: Some(TextureViewDimension::Cube), ..default() });
    image
}

/// Share of the pixels of which a channel differs by more than 8 of 255.
fn differing(a: &[u8], b: &[u8]) -> f64 {
    let pixels = a.chunks_exact(4).zip(b.chunks_exact(4));
    let differ = |(a, b): &(&[u8], &[u8])| (0..3).any(|i| a[i].abs_diff(b[i]) > 8);
    pixels.filter(differ).count() as f64 / (a.len() / 4) as f64
}

/// Pixels of the arm.
fn arm_pixels(shot: &[u8]) -> usize {
    let is_arm = |pixel: &&[u8]| pixel[1] > pixel[0].saturating_add(30) && pixel[2] > pixel[0].saturating_add(20);
    shot.chunks_exact(4).filter(is_arm).count()
}

/// Difference of what both kinds show, without errors.
fn compare(headless: &mut Headless, targets: &[Handle<Image>; 2], name: &str) -> [Vec<u8>; 2] {
    headless.frames(40);
    assert_eq!(headless.problems(), &[] as &[String], "{name}");
    let shots = targets.each_ref().map(|target| headless.read_target(target));
    let share = differing(&shots[0], &shots[1]);
    println!("{name}: {:.2} % of the pixels differ, {} of the arm", 100.0 * share, arm_pixels(&shots[0]));
    assert!(shots[0].chunks(4).filter(|pixel| pixel[0] > 120).count() > 1000, "{name}: the world is dark");
    assert!(share < 0.01, "{name}: {:.2} % of the pixels differ", 100.0 * share);
    shots
}

#[test]
fn a_view_model_is_drawn_on_the_world() {
    let (mut headless, targets) = room(|world, target, kind| {
        world.spawn(world_camera(target.clone(), kind));
        world.spawn(arm_camera(target, ClearColorConfig::Default));
    });
    // The camera moves, and stops.
    let world = headless.app.world_mut();
    let mut cameras = world.query_filtered::<&mut Transform, With<Camera3d>>();
    for frame in 0..20 {
        cameras.iter_mut(headless.app.world_mut()).for_each(|mut own| *own = place(0.05 * frame as f32));
        headless.frames(1);
    }
    cameras.iter_mut(headless.app.world_mut()).for_each(|mut own| *own = place(1.0));
    let shots = compare(&mut headless, &targets, "a view model");
    assert!(shots.iter().all(|shot| arm_pixels(shot) > 500), "the arm is missing");
}

/// Cameras on one target: with an arm or without, and how many are foveated.
type Setup = (&'static str, bool, usize, fn(&mut World, RenderTarget, Foveated));

fn check_setups(setups: &[Setup]) {
    for &(name, has_arm, foveated, spawn) in setups {
        let (mut headless, targets) = room(spawn);
        let shots = compare(&mut headless, &targets, name);
        let found = recorded(headless.app.sub_app_mut(RenderApp).world_mut()).len();
        assert_eq!(found, foveated, "{name}: foveated cameras");
        let arms = shots.each_ref().map(|shot| arm_pixels(shot));
        assert!(!has_arm || arms.iter().all(|&pixels| pixels > 20), "{name}: the arm is missing: {arms:?}");
    }
}

#[test]
fn cameras_on_one_target_show_what_they_show_at_full_rate() {
    check_setups(&[
        ("hdr below hdr", true, 1, |world, target, kind| {
            world.spawn((world_camera(target.clone(), kind), Hdr));
            world.spawn((arm_camera(target, ClearColorConfig::Default), Hdr));
        }),
        ("hdr below, without MSAA, not cleared", true, 1, |world, target, kind| {
            world.spawn((world_camera(target.clone(), kind), Hdr, Msaa::Off));
            world.spawn((arm_camera(target, ClearColorConfig::None), Hdr, Msaa::Off));
        }),
        ("not cleared", true, 1, |world, target, kind| {
            world.spawn(world_camera(target.clone(), kind));
            world.spawn(arm_camera(target, ClearColorConfig::None));
        }),
        ("both foveated", true, 1, |world, target, kind| {
            world.spawn(world_camera(target.clone(), kind));
            world.spawn((arm_camera(target, ClearColorConfig::Default), Afterimage::default(), kind));
        }),
        ("a user interface on an arm", true, 1, |world, target, kind| {
            world.spawn(world_camera(target.clone(), kind));
            world.spawn(arm_camera(target.clone(), ClearColorConfig::Default));
            let camera = Camera { order: 2, clear_color: ClearColorConfig::None, ..default() };
            let camera = world.spawn((Camera2d, camera, target, RenderLayers::layer(2))).id();
            let bar = Node { width: Val::Px(60.0), height: Val::Px(20.0), ..default() };
            world.spawn((bar, BackgroundColor(Color::srgb(1.0, 1.0, 0.0)), UiTargetCamera(camera)));
        }),
        ("split screen", false, 2, |world, target, kind| {
            for side in 0..2 {
                let physical_position = UVec2::new(side * SIZE.x / 2, 0);
                let physical_size = UVec2::new(SIZE.x / 2, SIZE.y);
                let viewport = Some(Viewport { physical_position, physical_size, ..default() });
                world.spawn((
                    world_camera(target.clone(), kind),
                    Camera { order: side as isize, viewport, ..default() },
                ));
            }
        }),
        ("a picture in the picture", true, 1, |world, target, kind| {
            world.spawn(world_camera(target.clone(), kind));
            let viewport = Viewport { physical_size: SIZE / 4, ..default() };
            world
                .spawn(arm_camera(target, ClearColorConfig::Default))
                .insert(Camera { order: 1, viewport: Some(viewport), ..default() })
                .insert(Projection::from(PerspectiveProjection { fov: 1.5, ..default() }));
        }),
        ("below a camera that hides it", true, 2, |world, target, kind| {
            world.spawn((world_camera(target.clone(), kind), Msaa::Off));
            // Its sides clear what lies below.
            let camera = Camera { order: 1, msaa_writeback: MsaaWriteback::Off, ..default() };
            world.spawn((arm_camera(target.clone(), ClearColorConfig::Default), Msaa::Off)).insert(camera);
            let viewport = Some(Viewport { physical_size: UVec2::new(SIZE.x / 2, SIZE.y), ..default() });
            world.spawn((world_camera(target, kind), Camera { order: 2, viewport, ..default() }, Msaa::Off));
        }),
        ("the upper one is older", true, 1, |world, target, kind| {
            world.spawn(arm_camera(target.clone(), ClearColorConfig::Default));
            world.spawn(world_camera(target, kind));
        }),
        ("a camera between them is not active", true, 1, |world, target, kind| {
            world.spawn(world_camera(target.clone(), kind));
            let idle = Camera { order: 1, is_active: false, ..default() };
            world.spawn((Camera3d::default(), idle, target.clone()));
            world.spawn(arm_camera(target, ClearColorConfig::Default)).insert(Camera { order: 2, ..default() });
        }),
        ("above one that its sky hides", false, 1, |world, target, kind| {
            world.spawn(arm_camera(target.clone(), ClearColorConfig::Default)).insert(Camera::default());
            let image = world.resource_mut::<Assets<Image>>().add(sky());
            let camera = Camera { order: 1, clear_color: ClearColorConfig::None, ..default() };
            world.spawn(world_camera(target, kind)).insert((camera, Skybox { image: Some(image), ..default() }));
        }),
    ]);
}

/// What lies below shows through where nothing is drawn.
const SEE_THROUGH: ClearColorConfig = ClearColorConfig::Custom(Color::NONE);

/// A camera between a world and an arm that sees the arm elsewhere.
fn wide_camera(target: RenderTarget) -> impl Bundle {
    (arm_camera(target, SEE_THROUGH), Projection::from(PerspectiveProjection { fov: 1.5, ..default() }))
}

#[test]
fn cameras_of_two_formats_show_what_they_show_at_full_rate() {
    // Each format has a texture of its own, which is blended with the target.
    check_setups(&[
        ("hdr below none", true, 1, |world, target, kind| {
            world.spawn((world_camera(target.clone(), kind), Hdr));
            world.spawn(arm_camera(target, SEE_THROUGH));
        }),
        ("none below hdr", true, 1, |world, target, kind| {
            world.spawn(world_camera(target.clone(), kind));
            world.spawn((arm_camera(target, SEE_THROUGH), Hdr));
        }),
        // Writeback is that of the lowest camera, not of the one in the middle.
        ("hdr, none, hdr", true, 1, |world, target, kind| {
            world.spawn((world_camera(target.clone(), kind), Hdr));
            world.spawn(wide_camera(target.clone()));
            let camera = Camera { order: 2, ..default() };
            world.spawn((arm_camera(target, ClearColorConfig::Default), Hdr)).insert(camera);
        }),
        ("hdr, see-through, above none", false, 1, |world, target, kind| {
            let backdrop = ClearColorConfig::Custom(Color::srgb(0.6, 0.5, 0.5));
            world.spawn(arm_camera(target.clone(), backdrop)).insert(Camera { clear_color: backdrop, ..default() });
            let camera = Camera { order: 1, clear_color: SEE_THROUGH, ..default() };
            world.spawn((world_camera(target, kind), Hdr)).insert(camera);
        }),
        ("hdr beside none", false, 2, |world, target, kind| {
            let physical_size = UVec2::new(SIZE.x / 2, SIZE.y);
            let half = |order: u32| {
                let physical_position = UVec2::new(order * SIZE.x / 2, 0);
                let viewport = Some(Viewport { physical_position, physical_size, ..default() });
                Camera { order: order as isize, viewport, ..default() }
            };
            world.spawn((world_camera(target.clone(), kind), Hdr)).insert(half(0));
            world.spawn(world_camera(target, kind)).insert(half(1));
        }),
        ("hdr below none with a prepass", true, 1, |world, target, kind| {
            world.spawn((world_camera(target.clone(), kind), Hdr));
            world.spawn((arm_camera(target, SEE_THROUGH), DepthPrepass));
        }),
    ]);
}

#[test]
fn hdr_comes_and_goes() {
    // Where it clears, all is white: on a texture of its own.
    let white = ClearColorConfig::Custom(Color::WHITE);
    let (mut headless, targets) = room(|world, target, kind| {
        world.spawn(world_camera(target.clone(), kind));
        world.spawn(arm_camera(target, white));
    });
    let clears = |shots: &[Vec<u8>; 2]| shots.each_ref().map(|shot| shot[..3] == [255; 3]);
    let shots = compare(&mut headless, &targets, "none");
    assert_eq!(clears(&shots), [false; 2]);
    let world = headless.app.world_mut();
    let mut cameras = world.query_filtered::<(Entity, Has<Afterimage>), With<Camera3d>>();
    let cameras: Vec<_> = cameras.iter(world).collect();
    for (name, of_world, hides) in [("the world's", true, true), ("all", false, false)] {
        for &(camera, _) in cameras.iter().filter(|(_, is_world)| *is_world == of_world) {
            headless.app.world_mut().entity_mut(camera).insert(Hdr);
        }
        let shots = compare(&mut headless, &targets, name);
        assert_eq!(clears(&shots), [hides; 2], "{name}");
    }
    for &(camera, _) in &cameras {
        headless.app.world_mut().entity_mut(camera).remove::<Hdr>();
    }
    let shots = compare(&mut headless, &targets, "none again");
    assert_eq!(clears(&shots), [false; 2]);
}

#[test]
fn cameras_on_a_foveated_one_come_and_go() {
    let (mut headless, targets) = room(|world, target, kind| {
        world.spawn(world_camera(target, kind));
    });
    let [alone, with] = [false, true].map(|has_arm| {
        let uppers = targets.each_ref().map(|target| {
            let target = RenderTarget::from(target.clone());
            has_arm.then(|| headless.app.world_mut().spawn(arm_camera(target, ClearColorConfig::Default)).id())
        });
        // The world is there in the first frame, too.
        headless.frames(1);
        let shots = targets.each_ref().map(|target| headless.read_target(target));
        if has_arm {
            let share = differing(&shots[0], &shots[1]);
            println!("the frame in which it comes: {:.2} %", 100.0 * share);
            assert!(share < 0.02, "{share}");
        }
        let shots = compare(&mut headless, &targets, "with and without an arm");
        for upper in uppers.into_iter().flatten() {
            headless.app.world_mut().entity_mut(upper).despawn();
        }
        shots.map(|shot| arm_pixels(&shot))
    });
    assert!(alone.iter().all(|&pixels| pixels < 20) && with.iter().all(|&pixels| pixels > 500), "{alone:?} {with:?}");
    headless.frames(1);
    let shots = targets.each_ref().map(|target| headless.read_target(target));
    assert!(shots.iter().all(|shot| arm_pixels(shot) < 20), "the arm stays");
    // The lower camera no longer is foveated, and is again.
    let mut cameras = headless.app.world_mut().query_filtered::<Entity, With<Afterimage>>();
    let cameras: Vec<Entity> = cameras.iter(headless.app.world()).collect();
    for target in &targets {
        let target = RenderTarget::from(target.clone());
        headless.app.world_mut().spawn((arm_camera(target, ClearColorConfig::Default), Hdr)).remove::<Hdr>();
    }
    for camera in &cameras {
        headless.app.world_mut().entity_mut(*camera).remove::<Afterimage>();
    }
    compare(&mut headless, &targets, "without Afterimage");
    for camera in cameras {
        headless.app.world_mut().entity_mut(camera).insert(Afterimage::default());
    }
    compare(&mut headless, &targets, "with it again");
}
