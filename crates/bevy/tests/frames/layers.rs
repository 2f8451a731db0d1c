//! Several cameras on one target, of which some are foveated: what each of them shows in an application of Bevy without
//! the plugin.

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
use bevy_afterimage::{Afterimage, AfterimagePlugin, Foveated, FoveationKind};

/// Layer of what only upper cameras show.
const ARM: RenderLayers = RenderLayers::layer(1);

/// A camera that is foveated where the application has the plugin.
#[derive(Component)]
struct Foveates;

/// Applications with the same cameras: without the plugin, and with it.
type Rooms = [Headless; 2];

/// Where the camera is at a time.
fn place(t_s: f32) -> Transform {
    Transform::from_xyz(0.6 * t_s - 0.6, 1.0, 2.0).looking_at(Vec3::new(0.3 * t_s, 0.6, -3.0), Vec3::Y)
}

/// Cubes on a floor, and an arm that only upper cameras show.
fn room(has_plugin: bool) -> Headless {
    let mut headless = Headless::with(SIZE, |app| {
        if has_plugin {
            app.add_plugins(AfterimagePlugin);
        }
    });
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
    headless
}

/// Rooms with the cameras that `spawn` adds.
fn rooms(spawn: impl Fn(&mut World, RenderTarget)) -> Rooms {
    let mut rooms = [false, true].map(room);
    add_cameras(&mut rooms, spawn);
    rooms
}

fn add_cameras(rooms: &mut Rooms, spawn: impl Fn(&mut World, RenderTarget)) {
    for (room, has_plugin) in rooms.iter_mut().zip([false, true]) {
        let target = room.render_target();
        let world = room.app.world_mut();
        spawn(world, target);
        if has_plugin {
            for camera in foveated(world) {
                world.entity_mut(camera).insert((Afterimage::default(), Foveated::uniform(0.25)));
            }
        }
    }
}

/// Takes all cameras away, and the user interface.
fn remove_cameras(rooms: &mut Rooms) {
    for room in rooms {
        let world = room.app.world_mut();
        let mut cameras = world.query_filtered::<Entity, Or<(With<Camera>, With<Node>)>>();
        let cameras: Vec<_> = cameras.iter(world).collect();
        cameras.into_iter().for_each(|camera| world.entity_mut(camera).despawn());
    }
}

/// Cameras that are foveated, or would be with the plugin.
fn foveated(world: &mut World) -> Vec<Entity> {
    world.query_filtered::<Entity, With<Foveates>>().iter(world).collect()
}

/// Renders frames, and shows the last one.
fn shots(rooms: &mut Rooms, frames: usize) -> [Vec<u8>; 2] {
    rooms.each_mut().map(|room| {
        room.frames(frames);
        room.read()
    })
}

/// A camera of the world, which is foveated.
fn world_camera(target: RenderTarget) -> impl Bundle {
    (Camera3d::default(), target, TONEMAPPING, place(1.0), Foveates)
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

/// Difference of what both show, without errors.
fn compare(rooms: &mut Rooms, name: &str) -> [Vec<u8>; 2] {
    let shots = shots(rooms, 24);
    assert!(rooms.iter().all(|room| room.problems().is_empty()), "{name}: {:?}", rooms[1].problems());
    let share = differing(&shots[0], &shots[1]);
    println!("{name}: {:.2} % of the pixels differ, {} of the arm", 100.0 * share, arm_pixels(&shots[0]));
    assert!(shots[0].chunks(4).filter(|pixel| pixel[0] > 120).count() > 1000, "{name}: the world is dark");
    assert!(share < 0.01, "{name}: {:.2} % of the pixels differ", 100.0 * share);
    shots
}

#[test]
fn a_view_model_is_drawn_on_the_world() {
    let mut rooms = rooms(|world, target| {
        world.spawn(world_camera(target.clone()));
        world.spawn(arm_camera(target, ClearColorConfig::Default));
    });
    // The camera moves, and stops.
    for frame in 0..=20 {
        for room in &mut rooms {
            let world = room.app.world_mut();
            let mut cameras = world.query_filtered::<&mut Transform, With<Camera3d>>();
            cameras.iter_mut(world).for_each(|mut own| *own = place(0.05 * frame as f32));
            room.frames(1);
        }
    }
    let shots = compare(&mut rooms, "a view model");
    assert!(shots.iter().all(|shot| arm_pixels(shot) > 500), "the arm is missing");
}

/// Cameras on one target: with an arm or without, and how many are foveated.
type Setup = (&'static str, bool, usize, fn(&mut World, RenderTarget));

/// Checks them in turn, in the same applications, which takes a third of the time of an application each.
fn check_setups(setups: &[Setup]) {
    let mut rooms = [false, true].map(room);
    for &(name, has_arm, foveated, spawn) in setups {
        remove_cameras(&mut rooms);
        add_cameras(&mut rooms, spawn);
        let shots = compare(&mut rooms, name);
        let found = recorded(rooms[1].app.sub_app_mut(RenderApp).world_mut()).len();
        assert_eq!(found, foveated, "{name}: foveated cameras");
        let arms = shots.each_ref().map(|shot| arm_pixels(shot));
        assert!(!has_arm || arms.iter().all(|&pixels| pixels > 20), "{name}: the arm is missing: {arms:?}");
    }
}

#[test]
fn cameras_on_one_target_show_what_bevy_shows() {
    check_setups(&[
        ("hdr below hdr", true, 1, |world, target| {
            world.spawn((world_camera(target.clone()), Hdr));
            world.spawn((arm_camera(target, ClearColorConfig::Default), Hdr));
        }),
        ("hdr below, without MSAA, not cleared", true, 1, |world, target| {
            world.spawn((world_camera(target.clone()), Hdr, Msaa::Off));
            world.spawn((arm_camera(target, ClearColorConfig::None), Hdr, Msaa::Off));
        }),
        ("not cleared", true, 1, |world, target| {
            world.spawn(world_camera(target.clone()));
            world.spawn(arm_camera(target, ClearColorConfig::None));
        }),
        ("both foveated", true, 1, |world, target| {
            world.spawn(world_camera(target.clone()));
            world.spawn((arm_camera(target, ClearColorConfig::Default), Foveates));
        }),
        ("a user interface on an arm", true, 1, |world, target| {
            world.spawn(world_camera(target.clone()));
            world.spawn(arm_camera(target.clone(), ClearColorConfig::Default));
            let camera = Camera { order: 2, clear_color: ClearColorConfig::None, ..default() };
            let camera = world.spawn((Camera2d, camera, target, RenderLayers::layer(2))).id();
            let bar = Node { width: Val::Px(60.0), height: Val::Px(20.0), ..default() };
            world.spawn((bar, BackgroundColor(Color::srgb(1.0, 1.0, 0.0)), UiTargetCamera(camera)));
        }),
        ("split screen", false, 2, |world, target| {
            for side in 0..2 {
                let physical_position = UVec2::new(side * SIZE.x / 2, 0);
                let physical_size = UVec2::new(SIZE.x / 2, SIZE.y);
                let viewport = Some(Viewport { physical_position, physical_size, ..default() });
                world.spawn((world_camera(target.clone()), Camera { order: side as isize, viewport, ..default() }));
            }
        }),
        ("a picture in the picture", true, 1, |world, target| {
            world.spawn(world_camera(target.clone()));
            let viewport = Viewport { physical_size: SIZE / 4, ..default() };
            world
                .spawn(arm_camera(target, ClearColorConfig::Default))
                .insert(Camera { order: 1, viewport: Some(viewport), ..default() })
                .insert(Projection::from(PerspectiveProjection { fov: 1.5, ..default() }));
        }),
        ("below a camera that hides it", true, 2, |world, target| {
            world.spawn((world_camera(target.clone()), Msaa::Off));
            // Its sides clear what lies below.
            let camera = Camera { order: 1, msaa_writeback: MsaaWriteback::Off, ..default() };
            world.spawn((arm_camera(target.clone(), ClearColorConfig::Default), Msaa::Off)).insert(camera);
            let viewport = Some(Viewport { physical_size: UVec2::new(SIZE.x / 2, SIZE.y), ..default() });
            world.spawn((world_camera(target), Camera { order: 2, viewport, ..default() }, Msaa::Off));
        }),
        ("the upper one is older", true, 1, |world, target| {
            world.spawn(arm_camera(target.clone(), ClearColorConfig::Default));
            world.spawn(world_camera(target));
        }),
        ("a camera between them is not active", true, 1, |world, target| {
            world.spawn(world_camera(target.clone()));
            let idle = Camera { order: 1, is_active: false, ..default() };
            world.spawn((Camera3d::default(), idle, target.clone()));
            world.spawn(arm_camera(target, ClearColorConfig::Default)).insert(Camera { order: 2, ..default() });
        }),
        ("above one that its sky hides", false, 1, |world, target| {
            world.spawn(arm_camera(target.clone(), ClearColorConfig::Default)).insert(Camera::default());
            let image = world.resource_mut::<Assets<Image>>().add(sky());
            let camera = Camera { order: 1, clear_color: ClearColorConfig::None, ..default() };
            world.spawn(world_camera(target)).insert((camera, Skybox { image: Some(image), ..default() }));
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
fn cameras_of_two_formats_show_what_bevy_shows() {
    // Each format has a texture of its own, which is blended with the target.
    check_setups(&[
        ("hdr below none", true, 1, |world, target| {
            world.spawn((world_camera(target.clone()), Hdr));
            world.spawn(arm_camera(target, SEE_THROUGH));
        }),
        ("none below hdr", true, 1, |world, target| {
            world.spawn(world_camera(target.clone()));
            world.spawn((arm_camera(target, SEE_THROUGH), Hdr));
        }),
        // Writeback is that of the lowest camera, not of the one in the middle.
        ("hdr, none, hdr", true, 1, |world, target| {
            world.spawn((world_camera(target.clone()), Hdr));
            world.spawn(wide_camera(target.clone()));
            let camera = Camera { order: 2, ..default() };
            world.spawn((arm_camera(target, ClearColorConfig::Default), Hdr)).insert(camera);
        }),
        ("hdr, see-through, above none", false, 1, |world, target| {
            let backdrop = ClearColorConfig::Custom(Color::srgb(0.6, 0.5, 0.5));
            world.spawn(arm_camera(target.clone(), backdrop)).insert(Camera { clear_color: backdrop, ..default() });
            let camera = Camera { order: 1, clear_color: SEE_THROUGH, ..default() };
            world.spawn((world_camera(target), Hdr)).insert(camera);
        }),
        ("hdr beside none", false, 2, |world, target| {
            let physical_size = UVec2::new(SIZE.x / 2, SIZE.y);
            let half = |order: u32| {
                let physical_position = UVec2::new(order * SIZE.x / 2, 0);
                let viewport = Some(Viewport { physical_position, physical_size, ..default() });
                Camera { order: order as isize, viewport, ..default() }
            };
            world.spawn((world_camera(target.clone()), Hdr)).insert(half(0));
            world.spawn(world_camera(target)).insert(half(1));
        }),
        ("hdr below none with a prepass", true, 1, |world, target| {
            world.spawn((world_camera(target.clone()), Hdr));
            world.spawn((arm_camera(target, SEE_THROUGH), DepthPrepass));
        }),
    ]);
}

#[test]
fn hdr_comes_and_goes() {
    // Where it clears, all is white: on a texture of its own.
    let white = ClearColorConfig::Custom(Color::WHITE);
    let mut rooms = rooms(|world, target| {
        world.spawn(world_camera(target.clone()));
        world.spawn(arm_camera(target, white));
    });
    let clears = |shots: &[Vec<u8>; 2]| shots.each_ref().map(|shot| shot[..3] == [255; 3]);
    let shots = compare(&mut rooms, "none");
    assert_eq!(clears(&shots), [false; 2]);
    let mut change = |name: &str, change: &dyn Fn(EntityWorldMut, bool), hides: bool| {
        for room in &mut rooms {
            let world = room.app.world_mut();
            let mut cameras = world.query_filtered::<(Entity, Has<Foveates>), With<Camera3d>>();
            let cameras: Vec<_> = cameras.iter(world).collect();
            cameras.into_iter().for_each(|(camera, is_world)| change(world.entity_mut(camera), is_world));
        }
        let shots = compare(&mut rooms, name);
        assert_eq!(clears(&shots), [hides; 2], "{name}");
    };
    for (name, of_world, hides) in [("the world's", true, true), ("all", false, false)] {
        let insert = |mut camera: EntityWorldMut, is_world| {
            if is_world == of_world {
                camera.insert(Hdr);
            }
        };
        change(name, &insert, hides);
    }
    let remove = |mut camera: EntityWorldMut, _| {
        camera.remove::<Hdr>();
    };
    change("none again", &remove, false);
}

/// Adds a camera that shows the arm to each.
fn add_arms(rooms: &mut Rooms) -> [Entity; 2] {
    rooms.each_mut().map(|room| {
        let camera = arm_camera(room.render_target(), ClearColorConfig::Default);
        room.app.world_mut().spawn(camera).id()
    })
}

#[test]
fn cameras_on_a_foveated_one_come_and_go() {
    let mut rooms = rooms(|world, target| {
        world.spawn(world_camera(target));
    });
    let alone = compare(&mut rooms, "without an arm").map(|shot| arm_pixels(&shot));
    let arms = add_arms(&mut rooms);
    // The world is there in the first frame, too.
    let first = shots(&mut rooms, 1);
    let share = differing(&first[0], &first[1]);
    println!("the frame in which it comes: {:.2} %", 100.0 * share);
    assert!(share < 0.02, "{share}");
    let with = compare(&mut rooms, "with an arm").map(|shot| arm_pixels(&shot));
    assert!(alone.iter().all(|&pixels| pixels < 20) && with.iter().all(|&pixels| pixels > 500), "{alone:?} {with:?}");
    for (room, arm) in rooms.iter_mut().zip(arms) {
        room.app.world_mut().entity_mut(arm).despawn();
    }
    assert!(shots(&mut rooms, 1).iter().all(|shot| arm_pixels(shot) < 20), "the arm stays");
    // The lower camera no longer is foveated, and is again.
    add_arms(&mut rooms);
    let world = rooms[1].app.world_mut();
    let camera = foveated(world)[0];
    world.entity_mut(camera).remove::<Afterimage>();
    compare(&mut rooms, "without Afterimage");
    rooms[1].app.world_mut().entity_mut(camera).insert(Afterimage::default());
    compare(&mut rooms, "with it again");
    let off = Foveated { kind: FoveationKind::Off, ..default() };
    rooms[1].app.world_mut().entity_mut(camera).insert(off);
    compare(&mut rooms, "at full rate");
}
