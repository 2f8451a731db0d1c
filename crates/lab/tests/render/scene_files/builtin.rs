//! Built-in scenes.

use super::assert_sound;
use crate::given;
use afterimage_lab::scene::Scene;
use glam::Vec3;
use std::collections::HashMap;

fn builtin(name: &str) -> Scene {
    let scene = given::builtin(name);
    assert_eq!(scene.name, format!("builtin:{name}"));
    assert_sound(&scene);
    assert!(!scene.pose(0.0).cameras.is_empty());
    scene
}

/// Number of directed edges without an opposite one.
fn open_edges(triangles: &[[Vec3; 3]]) -> usize {
    let mut edges: HashMap<[[u32; 3]; 2], i32> = HashMap::new();
    let bits = |p: Vec3| (p + Vec3::ZERO).to_array().map(f32::to_bits);
    for t in triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            *edges.entry([bits(a), bits(b)]).or_default() += 1;
            *edges.entry([bits(b), bits(a)]).or_default() -= 1;
        }
    }
    edges.values().filter(|&&n| n != 0).count()
}

#[test]
fn triangles_are_as_many_as_the_thesis_has() {
    for (name, count) in [("control", 0), ("bunny-low", 292), ("bunny-high", 4_968), ("cubes", 441 * 12)] {
        assert_eq!(builtin(name).still().len(), count, "{name}");
    }
    assert!(builtin("mirror-room").still().len() > 100);
}

#[test]
fn bodies_are_closed_and_face_outwards() {
    for name in ["bunny-low", "bunny-high", "cubes", "mirror-room"] {
        let scene = builtin(name);
        assert_eq!(open_edges(&scene.still().positions), 0, "{name}");
        for (p, n) in scene.still().positions.iter().zip(&scene.still().normals) {
            let face = (p[1] - p[0]).cross(p[2] - p[0]);
            assert!(face.length() > 0.0, "{name}: a triangle without area");
            assert!(n.iter().all(|n| n.dot(face) > 0.0), "{name}: shading normals point away from the front");
        }
        // Planted error: a removed triangle leaves three edges without an opposite one.
        assert_eq!(open_edges(&scene.still().positions[1..]), 6, "{name}");
    }
}

#[test]
fn the_interior_moves_smoothly_and_repeats() {
    let scene = builtin("interior");
    let counts = [scene.still().len(), scene.pose(0.0).moving.len()];
    assert!(counts.iter().sum::<usize>() < 150_000 && counts[1] > 1_000, "{counts:?}");
    let frame_s = 1.0 / 60.0;
    let largest_step = |from_s: f64| {
        let [before, now] = [from_s, from_s + frame_s].map(|time_s| scene.pose(time_s).moving.positions);
        before.iter().flatten().zip(now.iter().flatten()).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max)
    };
    // The tips of the blades are the fastest, also where the loop ends.
    for from_s in [0.0, 3.3, scene.duration_s() - frame_s] {
        let step_m = largest_step(from_s);
        assert!((0.02..0.05).contains(&step_m), "{step_m} m in a frame at {from_s} s");
    }
}

#[test]
fn a_camera_walks_past_the_cupboards_of_the_interior() {
    let scene = builtin("interior");
    let eye = |frame: u32| {
        let cameras = scene.pose(f64::from(frame) / 60.0).cameras;
        assert_eq!(cameras.iter().map(|c| c.name.as_str()).collect::<Vec<_>>(), ["still", "walk"]);
        cameras[1].world_from_camera.w_axis.truncate()
    };
    for frame in 0..64 {
        let step_m = eye(frame).distance(eye(frame + 1));
        assert!((0.005..0.02).contains(&step_m), "{step_m} m in frame {frame}");
        let eye = eye(frame).as_vec3();
        let corners = scene.still().positions.iter().flatten();
        // The counter's edge, below the eye, is at 1 m along x.
        let nearest_m = corners.map(|p| p.distance(eye)).fold(f32::INFINITY, f32::min);
        assert!((0.6..2.0).contains(&nearest_m), "{nearest_m} m in frame {frame}");
    }
}
