//! Invalid values and scene files.

use super::rig::refuses;
use crate::rig::Folder;

#[test]
fn values_that_cannot_be_are_refused_in_one_line() {
    let scene = "builtin:cornell";
    for (more, words) in [
        (&["--size", "0x10"][..], &["--size"][..]),
        (&["--size", "abc"], &["--size"]),
        (&["--size", "70000x10"], &["--size", "too large"]),
        (&["--size", "60000x60000"], &["--size", "too large"]),
        (&["--spp", "0"], &["--spp"]),
        (&["--spp=-1"], &["--spp"]),
        (&["--spp", "99999999"], &["--spp"]),
        (&["--frames", "0"], &["--frames"]),
        (&["--max-depth", "65"], &["--max-depth", "64"]),
        (&["--fps", "0"], &["--fps"]),
        (&["--fps", "NaN"], &["--fps"]),
        (&["--hfov", "180"], &["--hfov", "below 180"]),
        (&["--hfov=-3"], &["hfov"]),
        (&["--exposure", "inf"], &["--exposure"]),
        (&["--integrator", "best"], &["--integrator"]),
        (&["--bsdf", "lambert"], &["--bsdf"]),
        (&["--sampling", "some"], &["--sampling"]),
        (&["--format", "gif"], &["--format"]),
        (&["--tonemap", "filmic"], &["--tonemap"]),
        (&["--aov", "normals"], &["--aov"]),
        (&["--backend", "tpu"], &["--backend"]),
        (&["--effects", "glow"], &["--effects", "glow"]),
        (&["--effects", ""], &["--effects"]),
        (&["--sky", "1,2"], &["--sky"]),
        (&["--sky", "1,2,-3"], &["--sky"]),
        (&["--sky", "1,2,nan"], &["--sky"]),
        (&["--sky", "missing.exr"], &["missing.exr"]),
        (&["--camera", "nobody"], &["--camera", "nobody"]),
        (&["--camera", "missing.json"], &["missing.json"]),
        (&["--clip", "dance"], &["dance"]),
        (&["--seed=-1"], &["--seed"]),
        (&["--nonsense"], &["--nonsense"]),
    ] {
        refuses(scene, more, words);
    }
}

#[test]
fn hostile_scene_files_are_refused_in_one_line() {
    let folder = Folder::new();
    let header = |length: u32| [b"glTF".to_vec(), 2u32.to_le_bytes().to_vec(), length.to_le_bytes().to_vec()].concat();
    let huge = br#"{"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4000000000000}],
        "bufferViews": [{"buffer": 0, "byteLength": 4000000000000}],
        "accessors": [{"bufferView": 0, "count": 100000000000, "type": "VEC3", "componentType": 5126}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]}"#;
    let outside = br#"{"asset": {"version": "2.0"}, "buffers": [{"byteLength": 12, "uri": "../../../etc/passwd"}],
        "bufferViews": [{"buffer": 0, "byteLength": 12}],
        "accessors": [{"bufferView": 0, "count": 1, "type": "VEC3", "componentType": 5126}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]}"#;
    let circle = br#"{"asset": {"version": "2.0"}, "nodes": [{"children": [1]}, {"children": [0]}], "scenes": [{"nodes": [0]}]}"#;
    for (name, bytes) in [
        ("empty.gltf", &b""[..]),
        ("empty.glb", b""),
        ("text.gltf", b"this is no scene"),
        ("cut.glb", &header(1000)),
        ("lies.glb", &header(u32::MAX)),
        ("huge.gltf", huge),
        ("outside.gltf", outside),
        ("circle.gltf", circle),
        ("scene.fbx", b"whatever"),
    ] {
        refuses(&folder.write(name, bytes), &[], &[name]);
    }
    refuses("missing.glb", &[], &["missing.glb"]);
    refuses("builtin:teapot", &[], &["teapot", "cornell"]);
    refuses(&folder.text(""), &[], &[]);
}
