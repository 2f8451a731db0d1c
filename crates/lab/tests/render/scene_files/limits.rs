//! Limits: counts that need too much memory are refused before allocation.

use super::assert_refused_within;
use super::builder::{Gltf, TRIANGLE, Written, png};
use crate::hostile::{claim_size, peak_mb};
use afterimage_lab::scene::{Scene, SceneLimits};
use serde_json::json;

const SMALL: SceneLimits =
    SceneLimits { max_triangles: 10, max_texels: 100, max_file_bytes: 10_000, max_json_bytes: 5_000 };

#[track_caller]
fn assert_open(file: &Written) {
    Scene::open(file.path.to_str().unwrap(), &SMALL).unwrap();
}

#[test]
fn triangles_are_counted_with_every_use() {
    let mut file = Gltf::new();
    let mesh = file.triangle();
    for _ in 0..10 {
        file.node(json!({"mesh": mesh}));
    }
    assert_open(&file.written());
    file.node(json!({"mesh": mesh}));
    assert_refused_within(&file.written().path, &SMALL, &["11 triangles", "limit of 10", "max_triangles"]);
}

#[test]
fn primitives_without_triangles_count_too() {
    let mut file = Gltf::new();
    let positions = file.floats(&TRIANGLE);
    let empty = json!({"attributes": {"POSITION": positions}, "mode": 0});
    file.push("meshes", json!({"primitives": vec![empty; 11]}));
    file.node(json!({"mesh": 0}));
    assert_refused_within(&file.written().path, &SMALL, &["11 triangles"]);
}

#[test]
fn vertices_that_no_triangle_needs_are_bounded() {
    // Many primitives that read the same long accessor for one triangle each.
    let mut file = Gltf::new();
    let (positions, indices) = (file.floats(&[TRIANGLE; 4].concat()), file.indices(&[0, 1, 2]));
    let primitive = json!({"attributes": {"POSITION": positions}, "indices": indices});
    file.push("meshes", json!({"primitives": vec![primitive; 9]}));
    file.node(json!({"mesh": 0}));
    assert_refused_within(&file.written().path, &SMALL, &["elements"]);
}

#[test]
fn texels_are_counted_from_the_headers() {
    let mut file = Gltf::with_material(json!({"emissiveTexture": {"index": 0}, "normalTexture": {"index": 1}}));
    file.texture(&png([6, 10], |_, _| [1; 4]));
    file.texture(&png([4, 10], |_, _| [2; 4]));
    assert_open(&file.written());
    file.texture(&png([1, 1], |_, _| [3; 4]));
    file.json["materials"][0]["pbrMetallicRoughness"] = json!({"baseColorTexture": {"index": 2}});
    assert_refused_within(&file.written().path, &SMALL, &["101 texels", "max_texels"]);
}

#[test]
fn an_image_that_claims_to_be_huge_takes_no_memory() {
    let mut bytes = png([8, 8], |_, _| [1; 4]);
    claim_size(&mut bytes, [0xffff; 2]);
    let mut file = Gltf::with_material(json!({"emissiveTexture": {"index": 0}}));
    file.texture(&bytes);
    assert_refused_within(&file.written().path, &SceneLimits::default(), &["4294836225 texels"]);
}

#[test]
fn bytes_of_all_files_together_and_of_the_description() {
    let mut file = Gltf::of(&TRIANGLE);
    file.json["buffers"] = json!([{"byteLength": 36, "uri": "a.bin"}, {"byteLength": 1, "uri": "b.bin"}]);
    let written = file.written();
    let fill = |a: usize, b: usize| {
        std::fs::write(written.folder.path().join("a.bin"), vec![0; a]).unwrap();
        std::fs::write(written.folder.path().join("b.bin"), vec![0; b]).unwrap();
    };
    fill(4000, 4000);
    assert_open(&written);
    fill(4000, 9000);
    assert_refused_within(&written.path, &SMALL, &["b.bin", "max_file_bytes"]);
    let large = written.folder.path().join("a.bin");
    std::fs::File::create(&large).unwrap().set_len(1 << 34).unwrap();
    assert_refused_within(&written.path, &SceneLimits::default(), &["a.bin", "max_file_bytes"]);
    let tight = SceneLimits { max_json_bytes: 100, ..SMALL };
    assert_refused_within(&written.path, &tight, &["bytes of JSON", "max_json_bytes"]);
    // The file itself.
    std::fs::File::create(&written.path).unwrap().set_len(1 << 34).unwrap();
    assert_refused_within(&written.path, &SceneLimits::default(), &["scene.glb", "max_file_bytes"]);
}

#[test]
fn counts_alone_take_no_memory() {
    afterimage_testing::alone(take_counts);
}

fn take_counts() {
    let before = peak_mb();
    // Accessors without a buffer, all zero: a few bytes of JSON claim gigabytes.
    for count in [100_000_000u64, 1 << 40, u64::MAX] {
        let mut file = Gltf::new();
        let positions = file.push("accessors", json!({"count": count, "type": "VEC3", "componentType": 5126}));
        file.shape(json!({"attributes": {"POSITION": positions}}));
        let limits = SceneLimits { max_triangles: u64::MAX, ..SceneLimits::default() };
        assert_refused_within(&file.written().path, &limits, &["no buffer"]);
        assert_refused_within(&file.written().path, &SMALL, &["triangles"]);
    }
    if let (Some(before), Some(after)) = (before, peak_mb()) {
        println!("took {} MB", after - before);
        // 100 million positions would be 1200 MB.
        assert!(after - before < 100, "took {} MB", after - before);
    }
}
