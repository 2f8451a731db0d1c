//! Animation, skins and morph targets, against a direct evaluation of glTF 2.0 in f64.

use super::builder::{Gltf, TRIANGLE};
use afterimage_lab::scene::{Scene, SceneLimits};
use afterimage_testing::Draws;
use glam::{DMat4, DQuat, DVec3, Vec3};
use serde_json::json;

fn vector(v: [f32; 3]) -> DVec3 {
    Vec3::from_array(v).as_dvec3()
}

/// Position of the first corner at a time.
fn corner(scene: &Scene, time_s: f64) -> Vec3 {
    scene.pose(time_s).moving.positions[0][0]
}

#[test]
fn every_interpolation_between_keys_and_beyond() {
    let keys = [[1.0f32, 0.0, 0.0], [3.0, 2.0, 0.0], [3.0, 2.0, 8.0]];
    let times = [0.5f32, 1.0, 2.0];
    for interpolation in ["STEP", "LINEAR"] {
        let scene = Gltf::animated("translation", interpolation, &times, &keys).open();
        assert_eq!((scene.still().len(), scene.pose(0.0).moving.len(), scene.duration_s()), (0, 1, 1.5));
        let halfway = if interpolation == "STEP" { keys[0] } else { [2.0, 1.0, 0.0] };
        // From its first key, the animation is 1.5 s long; then it loops.
        for (time_s, expected) in
            [(0.0, keys[0]), (0.25, halfway), (0.5, keys[1]), (1.5, keys[0]), (1.75, halfway), (-1.0, keys[1])]
        {
            assert_eq!(corner(&scene, time_s), Vec3::from_array(expected), "{interpolation} at {time_s}");
        }
    }
}

#[test]
fn cubic_splines_follow_their_formula() {
    let mut draws = Draws::new("cubic splines");
    let stored: Vec<[f32; 3]> = (0..9).map(|_| [0; 3].map(|_| draws.range(-2.0, 2.0))).collect();
    let times = [0.0f32, 0.5, 2.5];
    let scene = Gltf::animated("translation", "CUBICSPLINE", &times, &stored).open();
    let at = |key: usize, part: usize| vector(stored[key * 3 + part]);
    for step in 1..50 {
        let time_s = f64::from(step) * 0.05 - 0.001;
        let key = usize::from(time_s >= 0.5);
        let span = f64::from(times[key + 1] - times[key]);
        let t = (time_s - f64::from(times[key])) / span;
        // glTF 2.0, appendix C.5, the tangents scaled by the span.
        let expected = |away_scale: f64| {
            at(key, 1) * (2.0 * t * t * t - 3.0 * t * t + 1.0)
                + at(key, 2) * away_scale * (t * t * t - 2.0 * t * t + t)
                + at(key + 1, 1) * (-2.0 * t * t * t + 3.0 * t * t)
                + at(key + 1, 0) * span * (t * t * t - t * t)
        };
        let found = corner(&scene, time_s).as_dvec3();
        // Positions are rounded to f32: 1e-7 of values up to 4.
        assert!(found.abs_diff_eq(expected(span), 1e-6), "{time_s}: {found}");
        // Planted error: unscaled tangents.
        let off = (found - expected(1.0)).length();
        assert!(off > 1e-3 || !(0.05..=0.95).contains(&t), "{time_s}: {off}");
    }
}

#[test]
fn rotations_take_the_shorter_arc() {
    // The second key is a quarter turn about z with its sign flipped: the same rotation.
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let mut file = Gltf::of(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    file.animate(0, "rotation", "LINEAR", &[0.0, 1.0], &[[0.0, 0.0, 0.0, 2.0], [0.0, 0.0, -half, -half]]);
    let scene = file.open();
    let found = corner(&scene, 1.0 / 3.0);
    let (sin, cos) = (std::f32::consts::FRAC_PI_6).sin_cos();
    assert!(found.abs_diff_eq(Vec3::new(cos, sin, 0.0), 1e-6), "{found}");
}

#[test]
fn a_clip_is_chosen_by_name_or_number() {
    let mut file = Gltf::new();
    let (a, b) = (file.soup(&TRIANGLE), file.soup(&TRIANGLE));
    file.animate(a, "translation", "STEP", &[0.0], &[[5.0, 0.0, 0.0]]);
    file.animate(b, "scale", "LINEAR", &[0.0, 3.0], &[[1.0; 3], [2.0; 3]]);
    assert_eq!(file.open().duration_s(), 0.0);
    // An animation with one key has one pose.
    assert_eq!(corner(&file.open(), 7.0), Vec3::X * 5.0);
    let written = file.written();
    let open = |clip| Scene::open_clip(written.path.to_str().unwrap(), Some(clip), &SceneLimits::default());
    for clip in ["scale LINEAR", "1"] {
        let scene = open(clip).unwrap();
        assert_eq!((scene.duration_s(), scene.still().len()), (3.0, 1));
        assert_eq!(scene.pose(1.5).moving.positions[0][1], Vec3::X * 1.5);
    }
    for clip in ["walk", "2", "-1"] {
        let text = open(clip).unwrap_err().to_string();
        assert!(text.contains(clip) && text.contains("animation 1 (scale LINEAR)"), "{text}");
    }
}

/// Clips cut out of a longer timeline keep its times.
#[test]
fn an_animation_starts_at_its_first_key() {
    let keys = [[1.0f32, 0.0, 0.0], [5.0, 0.0, 0.0]];
    for (begin, is_said) in [(0.5f32, false), (10.0, true)] {
        let scene = Gltf::animated("translation", "LINEAR", &[begin, begin + 2.0], &keys).open();
        assert_eq!(scene.duration_s(), 2.0);
        for (time_s, x) in [(0.0, 1.0), (1.0, 3.0), (1.5, 4.0), (2.0, 1.0)] {
            assert_eq!(corner(&scene, time_s), Vec3::X * x, "{begin} {time_s}");
        }
        let said = scene.warnings.iter().any(|w| w.contains("first key of its animation is at 10 s"));
        assert_eq!(said, is_said, "{:?}", scene.warnings);
    }
    // The clip starts with the earliest of its curves; the others wait for theirs.
    let mut file = Gltf::animated("translation", "LINEAR", &[3.0, 4.0], &keys);
    file.animate(0, "scale", "LINEAR", &[2.0, 4.0], &[[1.0; 3], [1.0; 3]]);
    file.join_animations();
    let scene = file.open();
    assert_eq!((scene.duration_s(), corner(&scene, 0.9).x, corner(&scene, 1.5).x), (2.0, 1.0, 3.0));
}

/// A strip skinned to two joints; the second is a child of the first and rotates.
struct Bent {
    file: Gltf,
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    weights: Vec<[f32; 4]>,
    inverse_bind: [DMat4; 2],
}

const ROOT_SHIFT: [f32; 3] = [0.5, -1.0, 2.0];
const JOINT_SHIFT: [f32; 3] = [0.0, 1.5, 0.0];
const JOINT_SCALE: [f32; 3] = [1.0, 0.5, 2.0];

fn bent() -> Bent {
    let mut draws = Draws::new("bent");
    let positions: Vec<[f32; 3]> = (0..30).map(|_| [0; 3].map(|_| draws.range(-1.0, 1.0))).collect();
    let mut normal = || Vec3::from_array([0; 3].map(|_| draws.range(-1.0, 1.0))).normalize().to_array();
    let normals: Vec<[f32; 3]> = (0..30).map(|_| normal()).collect();
    let weights: Vec<[f32; 4]> = (0..30).map(|_| draws.uniform()).map(|w| [w, 1.0 - w, 0.0, 0.0]).collect();
    let inverse_bind = [
        DMat4::from_translation(DVec3::new(0.0, 0.25, 0.0)),
        DMat4::from_rotation_x(0.5) * DMat4::from_translation(DVec3::NEG_Y),
    ];
    let mut file = Gltf::new();
    let attributes = json!({
        "POSITION": file.floats(&positions), "NORMAL": file.floats(&normals), "WEIGHTS_0": file.floats(&weights),
        "JOINTS_0": file.accessor(&[0u8, 1, 200, 0].repeat(30), 30, "VEC4", 5121)
    });
    let mesh = file.mesh(json!({"attributes": attributes}));
    let matrices = file.floats(&inverse_bind.map(|m| m.as_mat4().to_cols_array()));
    let joint = file.push("nodes", json!({"translation": JOINT_SHIFT, "scale": JOINT_SCALE}));
    let root = file.node(json!({"children": [joint], "translation": ROOT_SHIFT}));
    let skin = file.push("skins", json!({"joints": [root, joint], "inverseBindMatrices": matrices}));
    // The transform of the mesh's own node is ignored.
    file.node(json!({"mesh": mesh, "skin": skin, "translation": [100.0, 0.0, 0.0]}));
    let half = std::f32::consts::FRAC_1_SQRT_2;
    file.animate(joint, "rotation", "LINEAR", &[0.0, 1.0], &[[0.0, 0.0, 0.0, 1.0], [half, 0.0, 0.0, half]]);
    // Values of the file, rounded to f32.
    let inverse_bind = inverse_bind.map(|m| m.as_mat4().as_dmat4());
    Bent { file, positions, normals, weights, inverse_bind }
}

impl Bent {
    /// Position and normal of a vertex at a share of the rotation.
    fn expected(&self, vertex: usize, share: f64, inverse_bind: &[DMat4; 2]) -> (DVec3, DVec3) {
        let turn = DQuat::from_rotation_x(share * std::f64::consts::FRAC_PI_2);
        let root = DMat4::from_translation(vector(ROOT_SHIFT));
        let joint = root * DMat4::from_scale_rotation_translation(vector(JOINT_SCALE), turn, vector(JOINT_SHIFT));
        let [w0, w1, ..] = self.weights[vertex].map(f64::from);
        let m = (root * inverse_bind[0]) * w0 + (joint * inverse_bind[1]) * w1;
        let position = m.transform_point3(vector(self.positions[vertex]));
        let normal = m.inverse().transpose().transform_vector3(vector(self.normals[vertex])).normalize();
        (position, normal)
    }
}

#[test]
fn skinned_vertices_are_where_f64_puts_them() {
    let bent = bent();
    let scene = bent.file.open();
    assert_eq!(scene.warnings, [""; 0]);
    assert_eq!((scene.still().len(), scene.pose(0.0).moving.len()), (0, 10));
    for share in [0.0, 0.3, 0.99] {
        let moving = scene.pose(share).moving;
        let vertices = moving.positions.iter().flatten().zip(moving.normals.iter().flatten());
        for (vertex, (found, normal)) in vertices.enumerate() {
            let (position, expected_normal) = bent.expected(vertex, share, &bent.inverse_bind);
            // Four products and sums in f32, of values up to 5.
            assert!(found.as_dvec3().abs_diff_eq(position, 3e-6), "{found} {position}");
            assert!(normal.as_dvec3().abs_diff_eq(expected_normal, 1e-5), "{normal} {expected_normal}");
            // Planted error: the bind pose is ignored.
            let (wrong, _) = bent.expected(vertex, share, &[DMat4::IDENTITY; 2]);
            assert!((found.as_dvec3() - wrong).length() > 0.01);
        }
    }
}

#[test]
fn morph_targets_add_up() {
    let deltas = [[[1.0f32, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0; 3]], [[0.0, 0.0, -3.0]; 3]];
    let tilt = [[1.0f32, 0.0, 0.0]; 3];
    let mut file = Gltf::new();
    let attributes = json!({"POSITION": file.floats(&TRIANGLE), "NORMAL": file.floats(&[[0.0, 0.0, 1.0]; 3])});
    let first = json!({"POSITION": file.floats(&deltas[0]), "NORMAL": file.floats(&tilt)});
    let targets = json!([first, {"POSITION": file.floats(&deltas[1])}]);
    let primitive = json!({"attributes": attributes, "targets": targets});
    let mesh = file.push("meshes", json!({"primitives": [primitive], "weights": [0.0, 1.0]}));
    let node = file.node(json!({"mesh": mesh, "weights": [0.5, 0.0]}));
    file.node(json!({"mesh": mesh}));
    let expected = |corner: usize, w: [f64; 2]| {
        vector(TRIANGLE[corner]) + vector(deltas[0][corner]) * w[0] + vector(deltas[1][corner]) * w[1]
    };
    let still = file.open();
    for corner in 0..3 {
        // The node's weights override the mesh's.
        assert_eq!(still.still().positions[0][corner].as_dvec3(), expected(corner, [0.5, 0.0]));
        assert_eq!(still.still().positions[1][corner].as_dvec3(), expected(corner, [0.0, 1.0]));
    }
    file.animate(node, "weights", "LINEAR", &[0.0, 2.0], &[[0.0], [0.5], [1.0], [-0.5]]);
    let scene = file.open();
    assert_eq!((scene.still().len(), scene.pose(0.0).moving.len()), (1, 1));
    let moving = scene.pose(1.0).moving;
    let normal = Vec3::new(0.5, 0.0, 1.0).normalize();
    for corner in 0..3 {
        let (found, expected) = (moving.positions[0][corner].as_dvec3(), expected(corner, [0.5, 0.0]));
        assert!(found.abs_diff_eq(expected, 1e-6), "{found} {expected}");
        assert!(moving.normals[0][corner].abs_diff_eq(normal, 1e-6));
    }
}

#[test]
fn what_hangs_below_an_animated_node_moves_with_it() {
    let mut file = Gltf::new();
    file.push("cameras", json!({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}));
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "point"}]}});
    let mesh = file.triangle();
    let light = json!({"KHR_lights_punctual": {"light": 0}});
    let leaf = file.push("nodes", json!({"mesh": mesh, "camera": 0, "extensions": light}));
    let up = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1];
    let middle = file.push("nodes", json!({"children": [leaf], "matrix": up}));
    let top = file.node(json!({"children": [middle]}));
    file.node(json!({"mesh": mesh}));
    file.animate(top, "translation", "LINEAR", &[0.0, 1.0], &[[0.0; 3], [4.0, 0.0, 0.0]]);
    let scene = file.open();
    assert_eq!(scene.still().len(), 1);
    let pose = scene.pose(0.5);
    let expected = Vec3::new(2.0, 1.0, 0.0);
    assert_eq!(pose.moving.positions[0][0], expected);
    assert_eq!(pose.lights[0].position, expected);
    assert_eq!(pose.cameras[0].world_from_camera.w_axis.truncate().as_vec3(), expected);
}
