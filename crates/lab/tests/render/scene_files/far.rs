//! Scenes far from the origin of their file are those at the origin.

use super::builder::{Gltf, TRIANGLE, written};
use afterimage_lab::scene::Scene;
use afterimage_lab::source::SceneCamera;
use glam::{DVec3, Vec3};
use serde_json::json;

/// A triangle, a light and, if wanted, a camera and an animation, under a node at `at`; or with vertices there.
fn file(at: [f64; 3], with_camera: bool, animated: bool, in_vertices: bool) -> Gltf {
    let mut file = Gltf::new();
    let (node, vertex) = if in_vertices { ([0.0; 3], at) } else { (at, [0.0; 3]) };
    let corners = TRIANGLE.map(|p| [0, 1, 2].map(|i| p[i] + vertex[i] as f32));
    let positions = file.floats(&corners);
    let of = |pick: fn(f32, f32) -> f32| {
        let fold = |i: usize| corners.iter().map(|p| p[i]).reduce(pick).unwrap();
        json!([fold(0), fold(1), fold(2)])
    };
    file.json["accessors"][positions]["min"] = of(f32::min);
    file.json["accessors"][positions]["max"] = of(f32::max);
    let place = |x: f64, y: f64, z: f64| json!([at[0] + x, at[1] + y, at[2] + z]);
    let triangle = file.shape(json!({"attributes": {"POSITION": positions}}));
    file.json["nodes"][triangle]["translation"] = json!(node);
    file.node(json!({"translation": place(2.0, 0.5, 1.0), "extensions": {"KHR_lights_punctual": {"light": 0}}}));
    file.json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "point"}]}});
    if with_camera {
        let camera = json!({"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}});
        file.push("cameras", camera);
        file.node(json!({"camera": 0, "translation": place(0.0, 0.0, 3.0)}));
    }
    if animated {
        let moved = [0.0f64, 0.5].map(|x| [node[0] as f32, (node[1] + x) as f32, node[2] as f32]);
        file.animate(triangle, "translation", "LINEAR", &[0.0, 1.0], &moved);
    }
    file
}

/// Triangles, lights and cameras at a time.
fn contents(scene: &Scene, time_s: f64) -> (Vec<[Vec3; 3]>, Vec<Vec3>, Vec<DVec3>) {
    let pose = scene.pose(time_s);
    let triangles = scene.still().positions.iter().chain(&pose.moving.positions).copied().collect();
    let eyes = pose.cameras.iter().map(|c| c.world_from_camera.w_axis.truncate()).collect();
    (triangles, pose.lights.iter().map(|l| l.position).collect(), eyes)
}

#[test]
fn what_lies_far_away_is_moved_to_the_origin() {
    for at in [[1e6, 0.0, 0.0], [500_123.0, 120.0, -5_412_345.0], [0.0, 20_000.0, 0.0], [-1e7, 1e7, 3e6]] {
        for (with_camera, animated, in_vertices) in [
            (true, false, false),
            (true, true, false),
            (false, false, false),
            (true, false, true),
            (false, false, true),
        ] {
            // Floats of vertices at 1e7 m are whole metres apart, and a triangle of 1 m is one still.
            let near = file([0.0; 3], with_camera, animated, in_vertices).open();
            let far = file(at, with_camera, animated, in_vertices).open();
            assert_eq!(near.origin, DVec3::ZERO);
            assert_eq!(near.warnings, [""; 0]);
            assert!(far.warnings[0].contains("far from the origin"), "{:?}", far.warnings);
            // Their origins differ by a few metres: one has its camera or middle there.
            let moved = far.origin - DVec3::from(at);
            assert!(moved.abs().max_element() <= 4.0, "{moved}");
            for time_s in [0.0, 0.5] {
                let (triangles, lights, eyes) = contents(&far, time_s);
                let (wanted, near_lights, near_eyes) = contents(&near, time_s);
                let wanted: Vec<_> = wanted.iter().map(|t| t.map(|p| p - moved.as_vec3())).collect();
                // The node's translations are floats in the file, 0.5 m apart at 5e6 m.
                let step = if animated { 0.5 } else { 0.0 };
                let off = triangles.iter().flatten().zip(wanted.iter().flatten()).map(|(a, b)| a.distance(*b));
                assert!(off.fold(0.0, f32::max) <= step, "{at:?}: {triangles:?} not {wanted:?}");
                assert!((near_lights[0] - moved.as_vec3() - lights[0]).abs().max_element() <= 0.5);
                assert_eq!(near_eyes.iter().map(|e| *e - moved).collect::<Vec<_>>(), eyes);
            }
        }
    }
}

#[test]
fn what_lies_near_or_is_large_stays_where_it_is() {
    for at in [[0.0, 0.0, 0.0], [0.0, 0.0, 90.0], [0.0, 300.0, 0.0]] {
        for with_camera in [false, true] {
            let scene = file(at, with_camera, false, false).open();
            assert_eq!((scene.origin, scene.warnings.len()), (DVec3::ZERO, 0), "{at:?}");
        }
    }
}

#[test]
fn cameras_of_files_are_in_the_coordinates_of_the_scenes_file() {
    let scene = file([1e6, 0.0, 0.0], true, false, false).open();
    let keys = json!({"keyframes": [{"time_s": 0, "position": [1e6 + 2.0, 1.0, 5.0], "target": [1e6, 0.0, 0.0]}]});
    let file = written("cameras.json", keys.to_string().as_bytes());
    let camera = SceneCamera::choose(&scene, file.path.to_str(), [64, 36], None).unwrap();
    let eye = camera.view(&scene, 0, 0.0).world_from_camera().w_axis.truncate();
    assert_eq!(eye + scene.origin, DVec3::new(1e6 + 2.0, 1.0, 5.0));
    assert_eq!(camera.camera_pose(&scene, 0, 0.0).origin, scene.origin);
}
