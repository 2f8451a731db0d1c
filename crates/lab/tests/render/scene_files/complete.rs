//! Files that are legal, and that the crate `gltf` alone would refuse.

use super::builder::{Gltf, TRIANGLE, glb, written};
use super::open;
use serde_json::json;

/// An animation with a channel of a node and others without one.
#[test]
fn channels_without_a_node_are_left_out() {
    let mut file = Gltf::of(&TRIANGLE);
    let (times, values) = (file.floats(&[[0.0], [1.0]]), file.floats(&[[0.0_f32; 3], [1.0, 0.0, 0.0]]));
    let with_node = json!({"sampler": 0, "target": {"node": 0, "path": "translation"}});
    let without = json!({"sampler": 0, "target": {"path": "translation"}});
    let pointer = json!({"sampler": 0, "target": {
        "path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": "/nodes/0/translation"}}
    }});
    let samplers = json!([{"input": times, "output": values}]);
    file.push("animations", json!({"name": "a", "samplers": samplers, "channels": [without, with_node, pointer]}));
    file.push("animations", json!({"samplers": samplers, "channels": [without]}));
    let scene = file.open();
    assert_eq!(scene.duration_s(), 1.0, "the channel of the node is there");
    let warning = scene.warnings.iter().find(|line| line.contains("without a node")).unwrap();
    assert!(warning.contains("animation 0 (a), animation 1"), "{warning}");
}

#[test]
fn textures_without_an_image_are_left_out() {
    for texture in [json!({}), json!({"extensions": {"EXT_texture_webp": {"source": 0}}})] {
        let factor = json!([0.5, 0.25, 1.0, 1.0]);
        let info = json!({"index": 0});
        let core = json!({"baseColorTexture": info, "metallicRoughnessTexture": info, "baseColorFactor": factor});
        let material = json!({"pbrMetallicRoughness": core, "normalTexture": info, "emissiveTexture": info});
        let mut file = Gltf::with_material(material);
        file.push("images", json!({"uri": "gone.webp"}));
        file.push("textures", texture.clone());
        let scene = file.open();
        assert_eq!(scene.textures.len(), 0);
        let warning = scene.warnings.iter().find(|line| line.contains("without an image")).unwrap();
        assert_eq!(warning.contains("EXT_texture_webp"), texture.get("extensions").is_some(), "{warning}");
    }
}

/// Extensions describe what they decompress by buffers without bytes.
#[test]
fn a_buffer_without_bytes_is_legal_until_something_reads_it() {
    let with = |reads: bool| {
        let mut file = Gltf::of(&TRIANGLE);
        file.json["buffers"] = json!([{"byteLength": file.bin.len()}, {"byteLength": 40}]);
        if reads {
            file.json["bufferViews"][0]["buffer"] = json!(1);
        }
        file
    };
    let scene = with(false).open();
    assert_eq!((scene.still().len(), scene.warnings.len()), (1, 0));
    with(true).assert_refused(&["buffer 1 has neither an address nor a binary chunk"]);
}

/// The schema allows `3.0` as an integer; some exporters write `null` for what is absent.
#[test]
fn whole_numbers_may_have_a_point_and_absent_properties_be_null() {
    let mut file = Gltf::of(&TRIANGLE);
    file.json["accessors"][0]["componentType"] = json!(5126.0);
    file.json["accessors"][0]["count"] = json!(3.0);
    file.json["scene"] = json!(0.0);
    let scene = file.open();
    assert_eq!((scene.still().len(), scene.warnings.len()), (1, 0));
    let mut file = Gltf::of(&TRIANGLE);
    file.json["extensionsRequired"] = json!(null);
    file.json["nodes"][0]["extensions"] = json!(null);
    file.json["animations"] = json!(null);
    let scene = file.open();
    assert_eq!(scene.still().len(), 1);
    assert_eq!(scene.warnings, ["properties that are null are taken as absent"]);
    Gltf::of(&TRIANGLE).with("/accessors/0/count", json!(2.5)).assert_refused(&["not a glTF 2.0 file"]);
}

/// Byte order mark in front; NUL bytes and spaces behind, in both containers.
#[test]
fn padding_around_the_json_is_skipped() {
    let mut file = Gltf::of(&TRIANGLE);
    file.json["buffers"] = json!([{"byteLength": file.bin.len()}]);
    for (before, after) in [("", "\0\0\0"), ("\u{feff}", ""), ("", " \n\0"), ("\u{feff}", "  \0")] {
        let mut json = format!("{before}{}{after}", file.json).into_bytes();
        json.resize(json.len().next_multiple_of(4), if after.contains('\0') { 0 } else { b' ' });
        let file = written("a.glb", &glb(&json, Some(&file.bin)));
        assert_eq!(open(&file.path).unwrap().still().len(), 1, "{before:?}, {after:?}");
    }
}
