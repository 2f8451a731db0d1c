//! Orthographic cameras, as of strategy games: still, panning, zooming, turning, and moving along their axis.

use crate::common::headless::Headless;
use crate::common::scene::{ScenePlugin, TONEMAPPING};
use crate::{SIZE, clip_psnr_db, compared};
use bevy::camera::{RenderTarget, ScalingMode};
use bevy::prelude::*;
use bevy_afterimage::{AfterimageStats, Foveated, FoveationKind};

/// A projection that shows `height` metres.
pub fn flat(height: f32) -> OrthographicProjection {
    let scaling_mode = ScalingMode::FixedVertical { viewport_height: height };
    OrthographicProjection { scaling_mode, far: 60.0, ..OrthographicProjection::default_3d() }
}

/// Above the courtyard.
pub fn above() -> Transform {
    Transform::from_xyz(5.0, 9.0, 12.0).looking_at(Vec3::new(0.0, 1.0, 0.0), Vec3::Y)
}

/// What a camera does from frame to frame: moves `Transform`, or the height that it shows.
type Act = fn(usize, &mut Transform, &mut f32);

#[test]
fn orthographic_cameras_are_foveated() {
    let acts: [(&str, Act); 5] = [
        ("still", |_, _, _| {}),
        ("panning", |_, place, _| place.translation += Vec3::new(0.04, 0.0, -0.06)),
        ("zooming", |frame, _, height| *height *= if frame % 16 < 8 { 0.97 } else { 1.03 }),
        ("turning", |_, place, _| place.rotate_around(Vec3::ZERO, Quat::from_rotation_y(0.015))),
        ("moving along its axis", |_, place, _| place.translation += 0.2 * *place.forward()),
    ];
    let mut headless = Headless::new(SIZE, ScenePlugin { lamps: 4, moves: true });
    for (name, act) in acts {
        let targets = compared().map(|(afterimage, foveated)| {
            let image = headless.add_target(SIZE);
            let view = (Camera3d::default(), Projection::from(flat(9.0)), RenderTarget::from(image.clone()), above());
            let quads = (TONEMAPPING, Msaa::Off, afterimage, foveated, AfterimageStats::default());
            headless.app.world_mut().spawn((view, quads));
            image
        });
        let mut cameras = headless.app.world_mut().query::<(&mut Transform, &mut Projection, &Camera)>();
        let mut clips = [const { vec![] }; 3];
        let mut height = 9.0;
        for frame in 0..20 {
            let mut shown = height;
            for (mut place, mut projection, _) in cameras.iter_mut(headless.app.world_mut()) {
                shown = height;
                act(frame, &mut place, &mut shown);
                *projection = Projection::from(flat(shown));
            }
            height = shown;
            headless.frames(1);
            if frame >= 8 {
                clips.iter_mut().zip(&targets).for_each(|(clip, target)| clip.push(headless.read_target(target)));
            }
        }
        assert_eq!(headless.problems(), &[] as &[String]);
        let [blind, quads] = [&clips[1], &clips[2]].map(|clip| clip_psnr_db(clip, &clips[0]));
        headless.wait();
        headless.frames(1);
        let world = headless.app.world_mut();
        let mut stats = world.query::<(Entity, &Foveated, &AfterimageStats)>();
        let all: Vec<_> = stats.iter(world).map(|(camera, own, stats)| (camera, own.kind, *stats)).collect();
        // The last of them has history.
        let counted = all.iter().rfind(|(_, kind, _)| *kind == FoveationKind::Quads).expect("a foveated camera").2;
        all.iter().for_each(|&(camera, ..)| world.entity_mut(camera).despawn());
        println!("{name}: without history {blind:.2} dB, with {quads:.2} dB; {counted:?}");
        assert!(quads > blind + 2.0, "{name}: without history {blind:.2} dB, with {quads:.2} dB");
        assert!(counted.shaded > 0 && counted.shaded < counted.pixels / 4, "{name}: {counted:?}");
        // Something is uncovered in front of a wall, but no surface is mistaken for another one.
        assert!(20 * counted.disoccluded < counted.pixels, "{name}: {counted:?}");
    }
}

/// A cube flies over a floor. What it uncovers is known to be another surface.
#[test]
fn what_comes_into_sight_is_noticed() {
    let mut headless = Headless::new(SIZE, |_: &mut App| {});
    let material = MeshMaterial3d(headless.asset(StandardMaterial { unlit: true, ..default() }));
    let floor = Mesh3d(headless.asset(Plane3d::new(Vec3::Y, Vec2::splat(20.0)).into()));
    let cube = Mesh3d(headless.asset(Cuboid::from_length(1.0).into()));
    let target = headless.render_target();
    let world = headless.app.world_mut();
    world.spawn((floor, material.clone()));
    let cube = world.spawn((cube, material, Transform::from_xyz(0.0, 1.0, 0.0))).id();
    let quads = (Foveated::default(), crate::aliased(), AfterimageStats::default(), Msaa::Off);
    let camera = world.spawn((Camera3d::default(), Projection::from(flat(9.0)), above(), target, quads)).id();
    for moves in [false, true] {
        for _ in 0..8 {
            let mut cube = headless.app.world_mut().get_mut::<Transform>(cube).expect("a cube");
            cube.translation.x += if moves { 0.2 } else { 0.0 };
            headless.frames(1);
        }
        headless.wait();
        headless.frames(1);
        let counted = *headless.app.world().get::<AfterimageStats>(camera).expect("counts");
        println!("moves {moves}: {counted:?}");
        // 4 pixels of its trail, 20 high.
        assert_eq!(counted.disoccluded > 60, moves, "{counted:?}");
        assert!(counted.disoccluded < 200, "{counted:?}");
    }
}
