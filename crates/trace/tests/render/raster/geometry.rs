//! Depth and motion of the rasterizer against rays through pixel centres.

use super::rays::{compare, rays};
use super::rig::draw;
use crate::given;
use crate::given::device;
use afterimage_lab::scene::Scene;
use afterimage_lab::source::SceneCamera;
use afterimage_lab::view::View;
use glam::{DMat4, DQuat, DVec3};

const SIZE: [u32; 2] = [320, 180];

/// Compared away from silhouettes. Vertices are snapped to 1/256 pixel, which shifts the surface point by at most that;
/// motion varies little over that distance, so 0.01 px suffices.
const MOTION_PX: f32 = 0.01;

/// A view moved sideways, turned and set back.
fn moved(view: &View, scale: f64) -> View {
    let turn = DQuat::from_rotation_y(0.01) * DQuat::from_rotation_x(-0.006);
    let step = DMat4::from_translation(DVec3::new(0.02, -0.011, 0.015) * scale);
    View::new(*view.geometry(), view.world_from_camera() * step * DMat4::from_quat(turn))
}

/// A scene through a camera's view; `None` if it is missing.
fn seen(name: &str, camera: &str) -> Option<(Scene, View)> {
    let scene = if name.contains('/') { given::open(&given::path_of(name)?) } else { given::builtin(name) };
    let view = SceneCamera::choose(&scene, Some(camera), SIZE, None).unwrap().view(&scene, 0, 0.0);
    Some((scene, view))
}

/// Turned by 0.01 rad, about 4 px everywhere: using one view for both frames would be wrong by that much.
#[test]
fn cameras_nodes_skins_and_morph_targets_move() {
    let Some(device) = device() else { return };
    for (name, camera, times, least_surface, least_sky) in [
        ("courtyard", "lateral", [0.0, 0.0], 10_000, 1_000),
        ("cubes", "lateral", [1.25, 1.2], 2_000, 0),
        ("fox/Fox.glb", "framing", [0.35, 0.3], 1_000, 10_000),
        ("animated_morph_cube/AnimatedMorphCube.gltf", "framing", [0.9, 0.8], 1_000, 0),
    ] {
        let Some((scene, now)) = seen(name, camera) else { continue };
        let bounds = scene.bounds().unwrap();
        let before = moved(&now, f64::from((bounds.max - bounds.min).length()) * 0.2);
        let views = [&now, &before];
        let d = compare(&draw(&device, &scene, views, times), &rays(&scene, views, times));
        println!("{name}: {d:?}");
        assert!(d.motion_px <= MOTION_PX && d.surface_pixels > least_surface && d.sky_pixels >= least_sky, "{name}");
    }
}

#[test]
fn motion_of_another_moment_is_seen() {
    let Some(device) = device() else { return };
    let Some((scene, view)) = seen("fox/Fox.glb", "framing") else { return };
    let frame = draw(&device, &scene, [&view; 2], [0.35, 0.34]);
    let d = compare(&frame, &rays(&scene, [&view; 2], [0.35, 0.3]));
    assert!(d.motion_px > 0.5, "{d:?}");
}

#[test]
fn depth_is_that_of_rays_and_reversed() {
    let Some(device) = device() else { return };
    let (scene, view) = seen("courtyard", "lateral").unwrap();
    let frame = draw(&device, &scene, [&view; 2], [0.0; 2]);
    let d = compare(&frame, &rays(&scene, [&view; 2], [0.0; 2]));
    println!("{d:?}");
    // Eight roundings of 2^-24 in the rasterizer and as many in the ray would be far less; but vertices may be off by
    // 1/256 px, and floors near the horizon, the steepest here, change by some percent per pixel.
    assert!(d.distance < 1e-3, "{d:?}");
    // Without motion the result is exactly 0, except for the sky, whose pixels pass through a matrix.
    assert!(frame.motion.pixels().iter().flatten().all(|m| m.abs() < 1e-6));
    // The depth buffer itself: near over distance, so 0 for the sky and larger for nearer surfaces.
    assert!(frame.distance.pixels().iter().any(|v| v.is_infinite()));
}
