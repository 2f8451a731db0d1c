//! Features of meshes, nodes, lights and cameras.

use super::builder::{Gltf, TRIANGLE, written};
use afterimage_lab::scene::PunctualKind;
use glam::{Vec2, Vec3, Vec4};
use serde_json::json;

const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];

/// Positions with the given indices and mode.
fn with_mode(positions: &[[f32; 3]], indices: Option<&[u32]>, mode: u32) -> Gltf {
    let mut file = Gltf::new();
    let attributes = json!({"POSITION": file.floats(positions)});
    let mut primitive = json!({"attributes": attributes, "mode": mode});
    if let Some(indices) = indices {
        primitive["indices"] = json!(file.indices(indices));
    }
    file.shape(primitive);
    file
}

#[test]
fn lists_strips_and_fans_give_the_same_square() {
    let list = with_mode(&SQUARE, Some(&[0, 1, 2, 1, 3, 2]), 4).open();
    let strip = with_mode(&SQUARE, None, 5).open();
    let fan = with_mode(&SQUARE, Some(&[0, 1, 3, 2]), 6).open();
    for scene in [&list, &strip, &fan] {
        let triangles = scene.still();
        assert_eq!(triangles.len(), 2);
        let area: f32 = triangles.positions.iter().map(|[a, b, c]| (*b - *a).cross(*c - *a).z / 2.0).sum();
        // Counter-clockwise seen from +z: the area is positive.
        assert_eq!(area, 1.0, "{:?}", triangles.positions);
        assert!(triangles.normals.iter().flatten().all(|n| *n == Vec3::Z));
        assert!(scene.warnings.is_empty());
    }
}

#[test]
fn a_binary_scene_with_another_ending_is_read_by_its_first_bytes() {
    let file = with_mode(&SQUARE, Some(&[0, 1, 2, 1, 3, 2]), 4);
    for name in ["SCENE.GLB", "scene.bin", "download"] {
        let file = written(name, &file.glb());
        assert!(afterimage_lab::source::is_scene(file.path.to_str().unwrap()), "{name}");
        assert_eq!(super::open(&file.path).unwrap().still().len(), 2, "{name}");
    }
    assert!(!afterimage_lab::source::is_scene(written("scene.bin", b"words").path.to_str().unwrap()));
}

#[test]
fn points_and_lines_are_named() {
    for mode in [0, 1, 2, 3] {
        let scene = with_mode(&SQUARE, None, mode).open();
        assert!(scene.still().is_empty());
        assert_eq!(scene.warnings, ["points and lines are left out: mesh 0"]);
    }
}

#[test]
fn integer_attributes_are_scaled_where_they_are_normalised() {
    let mut file = Gltf::new();
    let positions: Vec<u8> = [0i16, 0, 0, 300, 0, 0, 0, -32768, 0].iter().flat_map(|x| x.to_le_bytes()).collect();
    let positions = file.accessor(&positions, 3, "VEC3", 5122);
    let colors = file.accessor(&[255, 0, 51, 0, 255, 0, 0, 0, 255], 3, "VEC3", 5121);
    let uvs: Vec<u8> = [0u16, 65535, 13107, 0, 0, 0].iter().flat_map(|x| x.to_le_bytes()).collect();
    let uvs = file.accessor(&uvs, 3, "VEC2", 5123);
    [colors, uvs].into_iter().for_each(|i| file.json["accessors"][i]["normalized"] = json!(true));
    file.shape(json!({"attributes": {"POSITION": positions, "COLOR_0": colors, "TEXCOORD_0": uvs}}));
    let scene = file.open();
    let triangles = scene.still();
    assert_eq!(triangles.positions[0], [Vec3::ZERO, Vec3::X * 300.0, Vec3::Y * -32768.0]);
    assert_eq!(triangles.colors[0][0], Vec4::new(1.0, 0.0, 0.2, 1.0));
    assert_eq!(triangles.uvs[0], [Vec2::new(0.0, 1.0), Vec2::new(0.2, 0.0), Vec2::ZERO]);

    file.json["accessors"][positions]["normalized"] = json!(true);
    // -32768 / 32767 is clamped to -1 (glTF 2.0, 3.11).
    assert_eq!(file.open().still().positions[0][2], -Vec3::Y);
}

#[test]
fn interleaved_vertices_are_read_by_their_stride() {
    let mut file = Gltf::new();
    let bytes: Vec<u8> =
        TRIANGLE.iter().flat_map(|p| [p[0], p[1], p[2], 0.25, 0.5].into_iter().flat_map(f32::to_le_bytes)).collect();
    let view = file.view(&bytes);
    file.json["bufferViews"][view]["byteStride"] = json!(20);
    let accessor = |offset, kind| json!({"bufferView": view, "byteOffset": offset, "count": 3, "type": kind, "componentType": 5126});
    let positions = file.push("accessors", accessor(0, "VEC3"));
    let uvs = file.push("accessors", accessor(12, "VEC2"));
    file.shape(json!({"attributes": {"POSITION": positions, "TEXCOORD_0": uvs}}));
    let scene = file.open();
    assert_eq!(scene.still().positions[0], TRIANGLE.map(Vec3::from_array));
    assert_eq!(scene.still().uvs[0], [Vec2::new(0.25, 0.5); 3]);
}

#[test]
fn sparse_accessors_replace_elements_with_or_without_a_base() {
    let mut file = Gltf::of(&TRIANGLE);
    let values: Vec<u8> = [5.0f32, 0.0, 0.0, 0.0, 7.0, 0.0].iter().flat_map(|v| v.to_le_bytes()).collect();
    file.sparse(0, &[1, 2], &values);
    let expected = [Vec3::ZERO, Vec3::X * 5.0, Vec3::Y * 7.0];
    assert_eq!(file.open().still().positions[0], expected);
    file.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    assert_eq!(file.open().still().positions[0], expected);
}

#[test]
fn nodes_place_their_meshes_through_the_tree() {
    let mut file = Gltf::new();
    let mesh = file.triangle();
    let leaf = file.push("nodes", json!({"mesh": mesh, "scale": [2.0, 1.0, 1.0]}));
    let half = std::f32::consts::FRAC_1_SQRT_2;
    file.node(json!({"children": [leaf], "translation": [10.0, 0.0, 0.0], "rotation": [0.0, 0.0, half, half]}));
    // A second instance, by a column-major matrix.
    file.node(json!({"mesh": mesh, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1]}));
    let scene = file.open();
    let [a, b] = [0, 1].map(|i| scene.still().positions[i]);
    // A quarter turn about z takes 2x to 2y and y to -x. Coordinates around 10 round by 1e-6.
    let expected = [Vec3::X * 10.0, Vec3::new(10.0, 2.0, 0.0), Vec3::X * 9.0];
    assert!((0..3).all(|i| a[i].abs_diff_eq(expected[i], 2e-6)), "{a:?} {expected:?}");
    assert_eq!(b[0], Vec3::Z * 5.0);
}

#[test]
fn mirrored_triangles_stay_counter_clockwise_from_the_front() {
    let mut file = Gltf::new();
    let attributes = json!({"POSITION": file.floats(&TRIANGLE), "NORMAL": file.floats(&[[0.0, 0.0, 1.0]; 3]),
        "TEXCOORD_0": file.floats(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])});
    let mesh = file.mesh(json!({"attributes": attributes}));
    for scale in [[-1.0, 1.0, 1.0], [-1.0, -2.0, 1.0], [1.0, 1.0, -1.0], [-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]] {
        file.node(json!({"mesh": mesh, "scale": scale}));
    }
    let scene = file.open();
    for i in 0..5 {
        let [a, b, c] = scene.still().positions[i];
        assert_eq!((b - a).cross(c - a).normalize(), scene.still().normals[i][0], "{i}");
        // Corners keep their texture coordinates.
        let uv_of_x = scene.still().positions[i].iter().position(|p| p.x != 0.0).unwrap();
        assert_eq!(scene.still().uvs[i][uv_of_x], Vec2::X, "{i}");
    }
    // Fronts keep facing outwards.
    assert_eq!([0, 1, 2, 3, 4].map(|i| scene.still().normals[i][0].z), [1.0, 1.0, -1.0, -1.0, 1.0]);
}

#[test]
fn normals_stay_perpendicular_under_uneven_scale() {
    let mut file = Gltf::new();
    // A slope with given normals, so that they are transformed and not regenerated.
    let normal = Vec3::new(1.0, 1.0, 0.0).normalize().to_array();
    let slope = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 1.0]];
    let attributes = json!({"POSITION": file.floats(&slope), "NORMAL": file.floats(&[normal; 3])});
    let mesh = file.mesh(json!({"attributes": attributes}));
    for scale in [[10.0, 1.0, 3.0], [1e-12, 2e-12, 1e-12], [1e6, 1.0, 1e-3]] {
        file.node(json!({"mesh": mesh, "scale": scale}));
    }
    let scene = file.open();
    for i in 0..3 {
        let [a, b, c] = scene.still().positions[i].map(|p| p.as_dvec3());
        let n = scene.still().normals[i][0].as_dvec3();
        for edge in [(b - a).normalize(), (c - a).normalize()] {
            // f32 normals round by 6e-8.
            assert!(n.dot(edge).abs() < 3e-7, "{i}: {}", n.dot(edge));
        }
    }
    // Planted error: a normal transformed like a direction is tilted.
    let wrong = (Vec3::new(10.0, 1.0, 3.0) * Vec3::from_array(normal)).normalize();
    let [a, b, _] = scene.still().positions[0];
    assert!(wrong.dot((b - a).normalize()).abs() > 0.5);
}

#[test]
fn lights_and_cameras_follow_their_nodes() {
    let mut file = Gltf::new();
    file.json["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    let spot = json!({"type": "spot", "color": [1.0, 0.5, 0.0], "intensity": 8.0, "range": 20.0,
        "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}});
    let lights = json!([spot, {"type": "directional"}, {"type": "point", "intensity": 3.0}]);
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": lights}});
    file.push("cameras", json!({"type": "perspective", "name": "main", "perspective": {"yfov": 0.5, "znear": 0.1}}));
    let flat = json!({"xmag": 1.0, "ymag": 1.0, "znear": 0.1, "zfar": 9.0});
    file.push("cameras", json!({"type": "orthographic", "orthographic": flat}));
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let camera = file.push("nodes", json!({"camera": 0, "scale": [3.0, 3.0, 3.0]}));
    let mut children = vec![camera];
    for light in 0..3 {
        let extensions = json!({"KHR_lights_punctual": {"light": light}});
        children.push(file.push("nodes", json!({"extensions": extensions, "translation": [0.0, 0.0, 1.0]})));
    }
    // A quarter turn about y takes -z to -x, and z to x.
    file.node(json!({"children": children, "rotation": [0.0, half, 0.0, half], "scale": [2.0, 2.0, 2.0]}));
    file.node(json!({"camera": 1}));
    let scene = file.open();
    let pose = scene.pose(0.0);
    assert_eq!(scene.warnings, ["orthographic cameras are left out: camera 1"]);
    assert_eq!(pose.lights.len(), 3);
    for light in &pose.lights {
        let [place, axis] = [light.position, light.direction];
        assert!(place.abs_diff_eq(Vec3::X * 2.0, 1e-6) && axis.abs_diff_eq(-Vec3::X, 1e-6), "{light:?}");
    }
    assert_eq!(pose.lights[0].intensity, [8.0, 4.0, 0.0]);
    assert_eq!(pose.lights[0].range, 20.0);
    assert_eq!(pose.lights[0].kind, PunctualKind::Spot { cos_inner: 0.25f32.cos(), cos_outer: 0.5f32.cos() });
    assert_eq!((pose.lights[1].kind, pose.lights[1].intensity), (PunctualKind::Directional, [1.0; 3]));
    assert_eq!((pose.lights[2].kind, pose.lights[2].range), (PunctualKind::Point, f32::INFINITY));
    let [camera] = &pose.cameras[..] else { panic!() };
    assert_eq!(camera.name, "main");
    assert!((camera.vfov_deg - 0.5f32.to_degrees()).abs() < 1e-4);
    // Scales of nodes do not affect the camera.
    let looks = camera.world_from_camera.transform_vector3(-glam::DVec3::Z);
    assert!(looks.abs_diff_eq(-glam::DVec3::X, 1e-7), "{looks}");
}

/// A triangle under a node at (0, 0, 1) that turns by 90 degrees about z, with this instancing.
fn instanced(attributes: serde_json::Value, make: impl FnOnce(&mut Gltf)) -> Gltf {
    let mut file = Gltf::new();
    let mesh = file.triangle();
    make(&mut file);
    let turn = [0.0, 0.0, 0.5f64.sqrt(), 0.5f64.sqrt()];
    let instancing = json!({"EXT_mesh_gpu_instancing": {"attributes": attributes}});
    file.node(json!({"mesh": mesh, "translation": [0, 0, 1], "rotation": turn, "extensions": instancing}));
    file.json["extensionsUsed"] = json!(["EXT_mesh_gpu_instancing"]);
    file
}

#[test]
fn instances_stand_below_their_node() {
    let moved = [[0.0, 0.0, 0.0], [5.0, 0.0, 0.0], [0.0, 0.0, -2.0f32]];
    let mut file = instanced(json!({"TRANSLATION": 1, "SCALE": 2, "ROTATION": 3}), |file| {
        assert_eq!(file.floats(&moved), 1);
        file.floats(&[[1.0; 3], [2.0; 3], [1.0, 1.0, -1.0]]);
        // Half a turn about x in the last one, in normalised bytes.
        let turns = [[0, 0, 0, 127], [0, 0, 0, 127], [127, 0, 0, 0u8]];
        let turns = file.accessor(turns.as_flattened(), 3, "VEC4", 5120);
        file.json["accessors"][turns]["normalized"] = json!(true);
    });
    let scene = file.open();
    assert_eq!(scene.warnings, [""; 0]);
    let world = |p: [f32; 3]| [-p[1], p[0], p[2] + 1.0];
    let expected = [
        TRIANGLE.map(world),
        TRIANGLE.map(|p| world([2.0 * p[0] + 5.0, 2.0 * p[1], 2.0 * p[2]])),
        // Mirrored: two corners change places.
        [0, 2, 1].map(|i| TRIANGLE[i]).map(|p| world([p[0], -p[1], -2.0])),
    ];
    assert_eq!(scene.still().len(), 3);
    for (found, expected) in scene.still().positions.iter().flatten().zip(expected.as_flattened()) {
        assert!(found.distance((*expected).into()) < 1e-6, "{found} not {expected:?}");
    }
    // With the node in motion, its instances move with it.
    file.animate(0, "translation", "LINEAR", &[0.0, 1.0], &[[0.0, 0.0, 1.0], [0.0, 0.0, 3.0]]);
    let moving = file.open();
    let (now, later) = (moving.pose(0.0).moving, moving.pose(0.5).moving);
    assert_eq!((now.len(), moving.still().len()), (3, 0));
    for (a, b) in now.positions.iter().flatten().zip(later.positions.iter().flatten()) {
        assert!(b.distance(*a + glam::Vec3::Z) < 1e-6);
    }
}

#[test]
fn instances_of_a_wrong_number_are_refused_and_none_are_none() {
    let two = |file: &mut Gltf| {
        file.floats(&[[0.0f32; 3]; 2]);
        file.floats(&[[1.0f32; 3]; 3]);
    };
    let file = |attributes| instanced(attributes, two);
    file(json!({"TRANSLATION": 1, "SCALE": 2})).assert_refused(&["scales of instances", "expected 2"]);
    file(json!({"TRANSLATION": 9})).assert_refused(&["accessor 9"]);
    file(json!({"TRANSLATION": "x"})).assert_refused(&["TRANSLATION"]);
    file(json!({"ROTATION": 1})).assert_refused(&["rotations of instances"]);
    file(json!({"SCALE": 1})).with("/accessors/1/count", json!(u64::MAX)).assert_refused(&[]);
    assert_eq!(file(json!({"SCALE": 2})).open().still().len(), 3);
    assert_eq!(file(json!({})).open().still().len(), 1, "no attributes");
    assert_eq!(file(json!({"_ID": 1})).open().still().len(), 1, "an attribute of an application");
}

/// Blender and Godot hide objects, and Godot requires the extension by default.
#[test]
fn hidden_nodes_hide_their_meshes_and_lights_and_those_below() {
    let seen = |visible: [serde_json::Value; 2]| {
        let mut file = Gltf::new();
        let mesh = file.triangle();
        let lit = json!({"mesh": mesh, "extensions": {"KHR_lights_punctual": {"light": 0}}});
        let child = file.push("nodes", json!({"mesh": mesh, "camera": 0}));
        let mut parent = file.node(lit);
        for (node, visible) in [(parent, &visible[0]), (child, &visible[1])] {
            if !visible.is_null() {
                file.json["nodes"][node]["extensions"]["KHR_node_visibility"] = visible.clone();
            }
        }
        file.json["nodes"][parent]["children"] = json!([child]);
        parent = file.node(json!({"mesh": mesh}));
        file.json["nodes"][parent]["translation"] = json!([0, 0, 5]);
        file.json["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}]);
        file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "point"}]}});
        file.json["extensionsUsed"] = json!(["KHR_node_visibility", "KHR_lights_punctual"]);
        file.json["extensionsRequired"] = json!(["KHR_node_visibility"]);
        let scene = file.open();
        assert_eq!(scene.warnings, [""; 0]);
        let pose = scene.pose(0.0);
        // A camera shows, and is not shown.
        assert_eq!(pose.cameras.len(), 1);
        (scene.still().len(), pose.lights.len())
    };
    let hidden = || json!({"visible": false});
    assert_eq!(seen([json!(null), json!({"visible": true})]), (3, 1));
    assert_eq!(seen([json!({}), json!(null)]), (3, 1));
    assert_eq!(seen([json!(null), hidden()]), (2, 1));
    assert_eq!(seen([hidden(), json!({"visible": true})]), (1, 0));
}
