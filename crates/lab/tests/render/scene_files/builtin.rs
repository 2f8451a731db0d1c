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
    assert_eq!(scene.pose(0.0).cameras.len(), 1);
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
