//! Damaged and odd files: a clear error or a sound scene, never a panic or a hang.

use super::builder::{Gltf, TRIANGLE, encoded, glb, png, written};
use super::{assert_refused, assert_sound};
use serde_json::json;

/// A file that uses every feature.
pub fn everything() -> Gltf {
    let mut file = Gltf::with_material(json!({"name": "m", "normalTexture": {"index": 0}, "alphaMode": "BLEND",
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
        "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatTexture": {"index": 0}},
            "KHR_materials_volume": {"thicknessFactor": 1.0, "attenuationDistance": 2.0},
            "KHR_materials_anisotropy": {"anisotropyStrength": 0.5}}}));
    file.texture(&png([3, 2], |x, y| [x as u8, y as u8, 255, 128]));
    file.push("samplers", json!({"wrapS": 33071}));
    file.json["textures"][0]["sampler"] = json!(0);
    file.json["extensionsUsed"] = json!(["KHR_lights_punctual", "KHR_materials_clearcoat"]);
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {}}]}});
    file.push("cameras", json!({"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}));
    let (target, joints) =
        (file.floats(&[[0.5f32, 0.0, 0.0]; 3]), file.accessor(&[0, 1, 0, 0].repeat(3), 3, "VEC4", 5121));
    file.set("WEIGHTS_0", &[[0.5, 0.5, 0.0, 0.0]; 3]);
    file.sparse(target, &[1], &[0; 12]);
    let indices = file.indices(&[2, 0, 1]);
    let primitive = file.primitive();
    primitive["targets"] = json!([{"POSITION": target}]);
    primitive["indices"] = json!(indices);
    primitive["attributes"]["JOINTS_0"] = json!(joints);
    let leaf = file.push("nodes", json!({"camera": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}}));
    let root = file.node(json!({"children": [leaf], "scale": [1.0, 2.0, -1.0]}));
    let identity = glam::Mat4::IDENTITY.to_cols_array();
    let bind = file.floats(&[identity, identity]);
    file.push("skins", json!({"joints": [root, leaf], "inverseBindMatrices": bind}));
    file.json["nodes"][0]["skin"] = json!(0);
    file.animate(root, "rotation", "LINEAR", &[0.0, 1.0], &[[0.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 0.0]]);
    file.animate(0, "weights", "CUBICSPLINE", &[0.0, 1.0], &[[0.0]; 6]);
    file.join_animations();
    file
}

#[test]
fn containers_and_descriptions_of_other_kinds() {
    let (open, close) = ("[".repeat(100_000), "]".repeat(100_000));
    let asset = r#"{"asset": {"version": "2.0"}"#;
    let wide = [0xFEFF].into_iter().chain("{}".encode_utf16()).flat_map(u16::to_le_bytes);
    let cases = [
        ("a.glb", b"glTF".to_vec(), "ends after"),
        ("a.glb", [b"glTF".as_slice(), &[1, 0, 0, 0], &[12, 0, 0, 0]].concat(), "version 1"),
        ("a.glb", [b"glTF".as_slice(), &[2, 0, 0, 0], &[12, 0, 0, 0]].concat(), "JSON chunk"),
        ("a.glb", [b"glTF".as_slice(), &[2, 0, 0, 0], &[0, 0, 0, 0]].concat(), "JSON chunk"),
        ("a.gltf", Vec::new(), "not a glTF"),
        ("a.gltf", b"{\"asset\": {}}".to_vec(), "version"),
        ("a.gltf", b"{\"asset\": {\"version\": \"1.0\"}}".to_vec(), "version 1.0"),
        ("a.gltf", format!(r#"{asset}, "extensions": {{"x": {open}{close}}}}}"#).into_bytes(), "recursion"),
        ("a.gltf", b"{\"asset\": {\"version\": \"2.0\", \"generator\": \"\xFF\"}}".to_vec(), "not a glTF"),
        ("a.gltf", format!(r#"{asset}, "nodes": 7}}"#).into_bytes(), "not a glTF"),
        ("a.gltf", wide.collect(), "UTF-16 text; expected UTF-8"),
    ];
    for (name, bytes, word) in cases {
        assert_refused(&written(name, &bytes).path, &[word]);
    }
    // A file without buffers needs no binary chunk.
    let bare = written("bare.glb", &glb(format!("{asset}}}").as_bytes(), None));
    let scene = super::open(&bare.path).unwrap();
    assert!(scene.bounds().is_none() && scene.pose(0.0).cameras.is_empty());
    assert_sound(&scene);
}

#[test]
fn accessors_of_the_wrong_type_or_length() {
    let mut file = everything();
    let floats = file.floats(&[[0.0], [1.0], [2.0]]);
    let attribute = |name: &str| everything().primitive()["attributes"][name].clone();
    let (primitive, positions) = ("/meshes/0/primitives/0", "/meshes/0/primitives/0/attributes/POSITION");
    for (path, value, words) in [
        (positions, attribute("TEXCOORD_0"), &["positions", "Vec2"][..]),
        (&format!("{primitive}/indices"), attribute("POSITION"), &["indices", "Vec3"]),
        (&format!("{primitive}/indices"), json!(floats), &["indices", "F32"]),
        ("/accessors/1/count", json!(2), &["texture coordinates", "2 elements, expected 3"]),
        ("/accessors/0/componentType", json!(5124), &["component type"]),
        ("/accessors/0/type", json!("VEC7"), &["unknown type"]),
        ("/accessors/0/count", json!(4), &[]),
        ("/accessors/0/count", json!(1u64 << 40), &[]),
        ("/accessors/0/count", json!(u64::MAX), &[]),
        ("/bufferViews/0/byteOffset", json!(u64::MAX), &[]),
        ("/bufferViews/0/byteLength", json!(u64::MAX), &[]),
        ("/bufferViews/0/byteLength", json!(35), &[]),
        ("/skins/0/joints", json!([1]), &["joint 1 of 1"]),
        ("/skins/0/joints", json!([]), &["of 0"]),
        ("/skins/0/joints", json!([1, 2, 1]), &["3 joints and 2 bind matrices"]),
    ] {
        file.with(path, value).assert_refused(words);
    }
    for stride in [0, 4, 11, u32::MAX] {
        file.json["bufferViews"][0]["byteStride"] = json!(stride);
        file.assert_refused(&["beyond its buffer"]);
    }
}

#[test]
fn indices_and_sparse_elements_out_of_range() {
    let mut file = Gltf::of(&TRIANGLE);
    let indices = file.indices(&[0, 1, 3]);
    file.primitive()["indices"] = json!(indices);
    file.assert_refused(&["index 3 of 3 vertices"]);
    let mut file = Gltf::of(&TRIANGLE);
    file.sparse(0, &[3], &[0; 12]);
    for (count, words) in [(1, "sets element 3"), (2, "beyond its buffer"), (u64::MAX, "beyond its buffer")] {
        file.with("/accessors/0/sparse/count", json!(count)).assert_refused(&[words]);
    }
}

#[test]
fn triangles_that_are_not_finite_are_left_out_and_counted() {
    let broken = [[f32::NAN, 0.0, 0.0], [0.0, f32::INFINITY, 0.0], [3e9, 0.0, 0.0]].map(|p| [p, [0.0; 3], [1.0; 3]]);
    let mut file = Gltf::of(&[&TRIANGLE[..], broken.as_flattened()].concat());
    let scene = file.open();
    assert_eq!(scene.still().len(), 1);
    assert_eq!(scene.warnings, ["3 triangles with corners that are not finite, or farther than 1e9 m, are left out"]);
    // Finite before its node's transform.
    file.json["nodes"][0]["scale"] = json!([1e30, 1.0, 1.0]);
    assert_eq!(file.open().still().len(), 0);
}

#[test]
fn nodes_that_are_no_tree() {
    let mut file = Gltf::new();
    for children in [json!([1]), json!([2]), json!([1])] {
        file.push("nodes", json!({"children": children}));
    }
    file.assert_refused(&["node 1", "must form a tree"]);
    for cycle in [json!([{"children": [0]}]), json!([{"children": [1]}, {"children": [0]}])] {
        let mut file = Gltf::new();
        file.json["nodes"] = cycle;
        file.json["scenes"][0]["nodes"] = json!([0]);
        file.assert_refused(&["cycle"]);
    }
    // A root that the scene lists twice is instanced once.
    let twice = Gltf::of(&TRIANGLE).with("/scenes/0/nodes", json!([0, 0]));
    assert_eq!(twice.open().still().len(), 1);
}

#[test]
fn a_chain_of_a_hundred_thousand_nodes() {
    let mut file = Gltf::new();
    let mesh = file.triangle();
    let n = 100_000;
    let chain = (0..n).map(|i| json!({"children": [i + 1], "translation": [0.001, 0.0, 0.0]}));
    file.json["nodes"] = chain.chain([json!({"mesh": mesh})]).collect();
    file.json["scenes"][0]["nodes"] = json!([0]);
    let scene = file.open();
    // 0.001 as f32 is off by 5e-8 of itself.
    assert!((scene.still().positions[0][0].x - 100.0).abs() < 1e-4);
    file.animate(0, "translation", "LINEAR", &[0.0, 1.0], &[[0.0; 3], [0.0, 5.0, 0.0]]);
    assert!((file.open().pose(0.5).moving.positions[0][0].y - 2.5).abs() < 1e-4);
}

#[test]
fn animations_with_keys_that_do_not_fit() {
    let (two, ones) = ([0.0, 1.0], [[1.0; 3]; 2]);
    for (times, values, interpolation, words) in [
        (&two[..], &ones[..1], "LINEAR", "1 elements, expected 2"),
        (&two, &ones, "CUBICSPLINE", "2 elements, expected 6"),
        (&[1.0, 0.0], &ones, "STEP", "not ascending"),
        (&[0.0, f32::NAN], &ones, "LINEAR", "not finite"),
        (&[], &[], "LINEAR", "empty"),
        (&two, &[[f32::INFINITY; 3]; 2], "LINEAR", "not finite"),
        (&two, &ones, "WOBBLY", "interpolation"),
    ] {
        Gltf::animated("scale", interpolation, times, values).assert_refused(&[words]);
    }
    // Two keys at the same time, which is the whole animation: the later one applies.
    let scene = Gltf::animated("scale", "LINEAR", &[0.5, 0.5], &[[1.0; 3], [3.0; 3]]).open();
    assert_eq!((scene.duration_s(), scene.pose(0.0).moving.positions[0][1].x), (0.0, 3.0));
    // Huge values collapse triangles; coordinates stay finite.
    Gltf::animated("scale", "LINEAR", &two, &[[3e38; 3], [-3e38; 3]]).open();
    let unknown = everything().with("/animations/0/channels/0/target/path", json!("color"));
    assert!(unknown.open().warnings[0].contains("unknown"));
}

#[test]
fn skins_with_odd_weights_and_joints() {
    let with = |joints: [u8; 4], weights: [f32; 4]| {
        let mut file = everything();
        let joints = file.accessor(&joints.repeat(3), 3, "VEC4", 5121);
        file.primitive()["attributes"]["JOINTS_0"] = json!(joints);
        file.set("WEIGHTS_0", &[weights; 3]);
        file
    };
    with([0, 2, 0, 0], [0.5, 0.5, 0.0, 0.0]).assert_refused(&["joint 2 of 2"]);
    // Joints without weight may be out of range.
    assert_eq!(with([0, 200, 0, 0], [1.0, 0.0, 0.0, 0.0]).open().warnings, [""; 0]);
    let even = with([0, 1, 0, 0], [0.5, 0.5, 0.0, 0.0]).open();
    for weights in [[3.0, 3.0, 0.0, 0.0], [0.001, 0.001, 0.0, 0.0], [0.25, 0.25, f32::NAN, -1.0]] {
        let scene = with([0, 1, 0, 0], weights).open();
        assert_eq!(scene.warnings, ["weights of joints that do not sum to 1 are scaled: mesh 0"]);
        for (a, b) in scene.pose(0.3).moving.positions[0].iter().zip(even.pose(0.3).moving.positions[0]) {
            assert!(a.abs_diff_eq(b, 1e-6));
        }
    }
    for weights in [[0.0; 4], [f32::NAN; 4], [-1.0; 4], [f32::MAX; 4]] {
        with([1, 1, 1, 1], weights).open();
    }
}

#[test]
fn primitives_and_scenes_that_lack_something() {
    let mut file = everything();
    file.primitive()["attributes"].as_object_mut().unwrap().remove("POSITION");
    assert!(file.open().warnings.contains(&"primitives without positions are left out: mesh 0".to_owned()));
    // Application-specific attributes are accepted.
    let mut file = everything();
    file.primitive()["attributes"]["_TEMPERATURE"] = json!(0);
    assert_eq!(file.open().pose(0.0).moving.len(), 1);
    let scene = everything().with("/scenes", json!([{"nodes": []}, {"nodes": [0]}])).open();
    assert!(scene.bounds().is_none());
    assert_eq!(scene.warnings, ["scene 0 of 2 is shown, the others are left out"]);
    // Without scenes all nodes are loaded.
    let mut file = Gltf::of(&TRIANGLE);
    file.json.as_object_mut().unwrap().retain(|name, _| !name.starts_with("scene"));
    assert_eq!(file.open().still().len(), 1);
}

#[test]
fn images_that_are_none() {
    let with = |bytes: &[u8]| {
        let mut file = Gltf::with_material(json!({"emissiveTexture": {"index": 0}}));
        file.texture(bytes);
        file
    };
    let whole = png([9, 9], |x, y| [x as u8 * 20, y as u8 * 20, (x * y) as u8, 255]);
    for length in [0, 4, 8, 20, 33, 50, whole.len() - 20] {
        with(&whole[..length]).assert_refused(&["image 0"]);
    }
    with(b"RIFF....WEBPVP8 ").assert_refused(&["WebP", "expected PNG or JPEG"]);
    with(b"plain text").assert_refused(&["unknown format"]);
    let tiny = encoded(&image::DynamicImage::ImageLumaA8(image::ImageBuffer::from_pixel(1, 1, image::LumaA([7, 9]))));
    assert_eq!(with(&tiny).open().textures[0].texels, [[7, 7, 7, 9]]);
}
