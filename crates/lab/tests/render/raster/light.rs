//! Rasterized colors against closed forms.

use super::rig::{device, draw};
use afterimage_lab::scene::{Scene, SceneLimits};
use afterimage_lab::source::SceneCamera;
use std::f32::consts::PI;
use std::path::PathBuf;

/// A 2x2 m quad facing +z with `material` (JSON), under a directional light of irradiance 2 at 60 degrees to its
/// normal. Vertex alpha grows from 0 on the left to 1 on the right.
fn quad(folder: &std::path::Path, material: &str) -> Scene {
    let mut bytes: Vec<u8> = vec![];
    let corners = [[-1.0_f32, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    for [x, y] in corners {
        for v in [x, y, 0.0] {
            bytes.extend(v.to_le_bytes());
        }
    }
    for [x, _] in corners {
        for v in [1.0, 1.0, 1.0, 0.5 + 0.5 * x] {
            bytes.extend(v.to_le_bytes());
        }
    }
    for i in [0_u16, 1, 2, 0, 2, 3] {
        bytes.extend(i.to_le_bytes());
    }
    std::fs::write(folder.join("quad.bin"), &bytes).unwrap();
    // The light's node is rotated by 60 degrees about y. A light shines along its own -z, so this one comes from +z and
    // +x.
    let (sin, cos) = (0.5_f64, 0.75_f64.sqrt());
    let text = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0,1]}}],
        "extensionsUsed":["KHR_lights_punctual","KHR_materials_specular"],
        "extensions":{{"KHR_lights_punctual":{{"lights":[{{"type":"directional","intensity":2}}]}}}},
        "nodes":[{{"mesh":0}},{{"rotation":[0,{sin},0,{cos}],"extensions":{{"KHR_lights_punctual":{{"light":0}}}}}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"COLOR_0":1}},"indices":2,"material":0}}]}}],
        "materials":[{material}],
        "buffers":[{{"uri":"quad.bin","byteLength":124}}],
        "bufferViews":[{{"buffer":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":64}},
            {{"buffer":0,"byteOffset":112,"byteLength":12}}],
        "accessors":[
            {{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[-1,-1,0],"max":[1,1,0]}},
            {{"bufferView":1,"componentType":5126,"count":4,"type":"VEC4"}},
            {{"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"}}]}}"#
    );
    let path: PathBuf = folder.join("quad.gltf");
    std::fs::write(&path, text).unwrap();
    Scene::open(path.to_str().unwrap(), &SceneLimits::default()).unwrap()
}

const LAMBERT: &str = r#"{"pbrMetallicRoughness":{"baseColorFactor":[0.8,0.4,0.2,1],"metallicFactor":0},
    "extensions":{"KHR_materials_specular":{"specularFactor":0}}ALPHA}"#;

/// Colors of the middle row seen from the front, and which pixels have a surface.
fn middle_row(alpha: &str) -> Option<(Vec<[f32; 3]>, Vec<bool>)> {
    let device = device()?;
    let folder = tempfile::tempdir().unwrap();
    let scene = quad(folder.path(), &LAMBERT.replace("ALPHA", alpha));
    let path = r#"{"horizontal_fov_deg": 53.130102, "keyframes": [{"time_s": 0, "position": [0, 0, 2], "target": [0, 0, 0]}]}"#;
    let file = folder.path().join("front.json");
    std::fs::write(&file, path).unwrap();
    // tan(26.565 degrees) = 1/2: the quad exactly fills the image's width.
    let camera = SceneCamera::choose(&scene, file.to_str(), [128, 64], None).unwrap();
    let view = camera.view(&scene, 0, 0.0);
    let frame = draw(&device, &scene, [&view; 2], [0.0; 2]);
    Some((frame.color.row(32).to_vec(), frame.distance.row(32).iter().map(|d| d.is_finite()).collect()))
}

/// Lambertian reflection of irradiance 2 at 60 degrees.
const EXPECTED: [f32; 3] = [0.8 / PI, 0.4 / PI, 0.2 / PI];

fn off(found: [f32; 3], expected: [f32; 3]) -> f32 {
    (0..3).map(|i| (found[i] / expected[i] - 1.0).abs()).fold(0.0, f32::max)
}

#[test]
fn a_lambert_quad_under_one_light() {
    let Some((row, _)) = middle_row("") else { return };
    // Half floats have 11 significant bits.
    assert!(row.iter().all(|&c| off(c, EXPECTED) < 1.0 / 1024.0), "{:?} not {EXPECTED:?}", row[64]);
    // Planted error: a different angle.
    assert!(off(row[64], EXPECTED.map(|v| v * 0.866 / 0.5)) > 0.1);
}

#[test]
fn masks_cut_at_their_cutoff() {
    let Some((row, there)) = middle_row(r#","alphaMode":"MASK","alphaCutoff":0.75"#) else { return };
    // Alpha of column x is (x + 0.5) / 128; a cutoff of 3/4 removes three quarters of the columns.
    for x in 0..128 {
        assert_eq!(there[x], x >= 96, "column {x}");
        if !(95..=96).contains(&x) {
            let expected = if x < 96 { [0.0; 3] } else { EXPECTED };
            assert!((0..3).all(|i| (row[x][i] - expected[i]).abs() < 1e-3), "column {x}: {:?}", row[x]);
        }
    }
}

#[test]
fn blended_surfaces_are_there_where_they_are_more_than_half() {
    let Some((row, there)) = middle_row(r#","alphaMode":"BLEND""#) else { return };
    for x in 0..128 {
        let alpha = (x as f32 + 0.5) / 128.0;
        assert_eq!(there[x], alpha > 0.5, "column {x}");
        // Blended over black.
        assert!((0..3).all(|i| (row[x][i] - EXPECTED[i] * alpha).abs() < 1e-3), "column {x}: {:?}", row[x]);
    }
}
