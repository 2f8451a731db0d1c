//! Cameras of mirrors: reflected, with an oblique near plane.

use crate::common::headless::Headless;
use crate::common::scene::{ScenePlugin, TONEMAPPING, stroll};
use crate::orthographic::{above, flat};
use crate::{SIZE, aliased, clip_psnr_db, compared, read};
use bevy::camera::{RenderTarget, Viewport};
use bevy::prelude::*;
use bevy::render::RenderApp;
use bevy_afterimage::testing::recorded;
use bevy_afterimage::{Afterimage, AfterimageStats, FoveationKind};

/// Where a mirror shows the camera, behind the courtyard's wall, which its near plane leaves out.
fn reflected(t_s: f32) -> Transform {
    Transform::from_matrix(Mat4::from_scale(Vec3::new(1.0, 1.0, -1.0)) * stroll(t_s).to_matrix())
}

#[test]
fn mirrors_are_foveated() {
    let mut headless = Headless::new(SIZE, ScenePlugin { lamps: 4, moves: true });
    let near_clip_plane = Vec4::new(0.25, 0.1, -0.95, -3.0);
    let targets = compared().map(|(afterimage, foveated)| {
        let image = headless.add_target(SIZE);
        let projection = Projection::from(PerspectiveProjection { near_clip_plane, ..default() });
        let camera = Camera { invert_culling: true, ..default() };
        let view = (Camera3d::default(), camera, projection, RenderTarget::from(image.clone()), TONEMAPPING, Msaa::Off);
        headless.app.world_mut().spawn((view, reflected(0.0), afterimage, foveated, AfterimageStats::default()));
        image
    });
    let mut cameras = headless.app.world_mut().query_filtered::<&mut Transform, With<Camera3d>>();
    let mut clips = [const { vec![] }; 3];
    for frame in 0..16 {
        let place = reflected(frame as f32 / 60.0);
        cameras.iter_mut(headless.app.world_mut()).for_each(|mut own| *own = place);
        headless.frames(1);
        if frame >= 8 {
            clips.iter_mut().zip(&targets).for_each(|(clip, target)| clip.push(headless.read_target(target)));
        }
    }
    assert_eq!(headless.problems(), &[] as &[String]);
    let [blind, quads] = [&clips[1], &clips[2]].map(|clip| clip_psnr_db(clip, &clips[0]));
    println!("a mirror: without history {blind:.2} dB, with {quads:.2} dB");
    assert!(quads > blind + 2.0, "without history {blind:.2} dB, with {quads:.2} dB");

    // Antialiased and still: surfaces are recognized in spite of the jitter.
    let world = headless.app.world_mut();
    let mut foveated = world.query::<(&mut Afterimage, &bevy_afterimage::Foveated, &AfterimageStats)>();
    for (mut afterimage, ..) in foveated.iter_mut(world) {
        *afterimage = Afterimage::default();
    }
    headless.frames(12);
    headless.wait();
    headless.frames(2);
    let world = headless.app.world_mut();
    for (.., stats) in foveated.iter(world).filter(|(_, own, _)| own.kind == FoveationKind::Quads) {
        println!("{stats:?}");
        assert!(stats.shaded > 0 && stats.shaded < stats.pixels / 4, "{stats:?}");
        assert!(50 * stats.disoccluded < stats.pixels, "{stats:?}");
    }
}

/// Depth in a camera's viewport: what its prepass drew, and what the post-process was given in its place.
fn depths(projection: impl Into<Projection>, place: Transform) -> (Vec<f32>, Option<Vec<f32>>) {
    let mut headless = Headless::new(SIZE, ScenePlugin { lamps: 0, moves: false });
    let target = headless.render_target();
    let (origin, size) = (UVec2::new(48, 20), UVec2::new(256, 144));
    let viewport = Some(Viewport { physical_position: origin, physical_size: size, ..default() });
    let camera = (Camera3d::default(), Camera { viewport, ..default() }, projection.into(), Msaa::Off, target, place);
    headless.app.world_mut().spawn((camera, TONEMAPPING, aliased()));
    headless.frames(3);
    assert_eq!(headless.problems(), &[] as &[String]);
    let recorded = recorded(headless.app.sub_app_mut(RenderApp).world_mut()).remove(0);
    let floats = |texture| -> Vec<f32> {
        let bytes = read(&headless, texture);
        bytes.chunks_exact(4).map(|value| f32::from_ne_bytes([value[0], value[1], value[2], value[3]])).collect()
    };
    let open = floats(recorded.open.as_ref().expect("a copy of depth"));
    let rows = open.chunks_exact(SIZE.x as usize).skip(origin.y as usize).take(size.y as usize);
    let columns = origin.x as usize..(origin.x + size.x) as usize;
    (rows.flat_map(|row| row[columns.clone()].to_vec()).collect(), recorded.plain.as_ref().map(floats))
}

/// Asserts that nearly all of the values are those expected, and exactly so where nothing is.
fn assert_depth(given: &[f32], expected: &[f32], name: &str) {
    let differ = |(a, b): &(&f32, &f32)| if **b == 0.0 { **a != 0.0 } else { (**a / **b - 1.0).abs() > 1e-3 };
    let wrong = given.iter().zip(expected).filter(differ).count();
    let [skies, surfaces] = [true, false].map(|is_sky| expected.iter().filter(|v| (**v == 0.0) == is_sky).count());
    println!("{name}: {wrong} of {} differ, {skies} of nothing", expected.len());
    assert!(given.len() == expected.len() && skies > 200 && surfaces > 200, "{name}: {skies} of nothing, {surfaces}");
    assert!(wrong * 200 < expected.len(), "{name}: {wrong} of {} pixels", expected.len());
}

#[test]
fn the_post_process_gets_depth_of_a_distance() {
    let (plain, none) = depths(PerspectiveProjection::default(), stroll(1.0));
    assert!(none.is_none());
    // Nothing is before this plane.
    let near_clip_plane = Vec4::new(0.25, 0.1, -0.95, -0.3);
    let (_, mirror) = depths(PerspectiveProjection { near_clip_plane, ..default() }, stroll(1.0));
    assert_depth(&mirror.expect("depth of a distance"), &plain, "a mirror");
    let (drawn, flat) = depths(flat(24.0), above());
    let expected: Vec<f32> = drawn.iter().map(|d| if *d == 0.0 { 0.0 } else { (40.0 * (d - 1.0)).exp() }).collect();
    assert_depth(&flat.expect("an exponential"), &expected, "orthographic");
}
