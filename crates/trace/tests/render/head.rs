//! A head and eye in a scene: what gaze rests on, in rendered depth and motion.

use crate::given;
use afterimage_lab::scanpath::{FrameGaze, GazeMap, HeadOptions, HeadPath, Regarded};
use afterimage_lab::scene::Scene;
use afterimage_lab::source::SceneCamera;
use afterimage_trace::head_in_scene;
use glam::DVec3;

const SIZE: [u32; 2] = [320, 320];
const HFOV_DEG: f32 = 100.0;
const FPS: f64 = 60.0;

/// A walk through the courtyard with these gains of the reflex, and no drift; the camera, the gaze of each frame, and
/// what the gaze rests on.
fn walk(rotation_gain: f64, translation_gain: f64) -> (Scene, SceneCamera, FrameGaze, Vec<Regarded>) {
    let scene = given::builtin("courtyard");
    let options = HeadOptions {
        seed: 5,
        duration_s: 6.0,
        // A sample at the time of each frame.
        rate_hz: 8.0 * FPS,
        is_walking: true,
        drifts: false,
        rotation_gain,
        translation_gain,
        ..HeadOptions::default()
    };
    let made = head_in_scene(&scene, &options).unwrap();
    let path = HeadPath::new(made.path.into(), 0.0).unwrap();
    let camera = SceneCamera::head(&scene, path.clone(), SIZE, Some(HFOV_DEG)).unwrap();
    let gaze = FrameGaze::new(path.scanpath(), camera.geometry(), GazeMap::Angle, 0.0, FPS).unwrap();
    (scene, camera, gaze, made.regarded)
}

/// Frames within a rest whose previous frame is, too, and the rest.
fn at_rest(regarded: &[Regarded], frames: u64) -> Vec<(u64, Regarded)> {
    let rest_at = |i: u64| regarded.iter().position(|r| (r.start_s..r.end_s).contains(&(i as f64 / FPS)));
    let all = (1..frames).filter_map(|i| Some((i, rest_at(i)?)));
    all.filter(|&(i, rest)| rest_at(i - 1) == Some(rest)).map(|(i, rest)| (i, regarded[rest])).collect()
}

/// Distances in pixels between the gaze and the projection of the point that it rests on.
fn misses_px(rotation_gain: f64, translation_gain: f64) -> Vec<f64> {
    let (scene, camera, gaze, regarded) = walk(rotation_gain, translation_gain);
    let space = SceneCamera::head_space(&scene);
    let miss = |(i, rest): (u64, Regarded)| {
        let point = space.transform_point3(DVec3::from(rest.point_m));
        let (px, _) = camera.view(&scene, i, i as f64 / FPS).project(point).unwrap();
        let at = gaze.px(i).unwrap();
        (px[0] - f64::from(at[0])).hypot(px[1] - f64::from(at[1]))
    };
    at_rest(&regarded, gaze.frames()).into_iter().map(miss).collect()
}

#[test]
fn gaze_stays_on_a_point_of_the_scene_while_the_head_walks_and_turns() {
    let gains = [(1.0, 1.0), (0.98, 0.6), (0.0, 1.0), (-1.0, 1.0)];
    let misses = gains.map(|(rotation, translation)| misses_px(rotation, translation));
    let [perfect, human, absent, flipped] = misses.each_ref().map(|all| all.iter().copied().fold(0.0, f64::max));
    let frames = misses[0].len();
    println!("{frames} frames at rest; gaze off the point by at most {perfect:.4} px");
    println!("with a human reflex {human:.2}, without {absent:.1}, flipped {flipped:.1}");
    // f32 poses, tangents and pixels.
    assert!(frames > 150 && perfect < 0.01);
    // 2.8 pixels a degree.
    assert!(human > 0.05 && human < 4.0);
    // Planted errors.
    assert!(absent > 10.0 && flipped > 20.0);
}
