//! Cameras of mirrors: reflected, with an oblique near plane.

use crate::common::headless::Headless;
use crate::common::scene::{ScenePlugin, TONEMAPPING, stroll};
use crate::{SIZE, clip_psnr_db, compared};
use bevy::camera::RenderTarget;
use bevy::prelude::*;
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
