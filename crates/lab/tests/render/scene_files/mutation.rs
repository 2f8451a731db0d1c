//! Damaged descriptions must give an error or a sound scene, never a panic, a hang or excessive memory. For changed
//! bytes see `crates/tool/tests/fuzz_replay.rs`.

use super::assert_sound;
use super::bad_input::everything;
use afterimage_lab::scene::{Scene, SceneLimits};
use serde_json::{Value, json};

/// Small, so that a damaged file that is accepted takes little memory.
const LIMITS: SceneLimits =
    SceneLimits { max_triangles: 10_000, max_texels: 10_000, max_file_bytes: 1 << 20, max_json_bytes: 1 << 20 };

#[test]
fn every_number_of_the_description_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("damaged.glb");
    let file = everything();
    let mut paths = Vec::new();
    numbers_of(&file.json, String::new(), &mut paths);
    assert!(paths.len() > 80, "{}", paths.len());
    let numbers = json!([0, 1, -1, 5126, 1u64 << 31, u64::MAX, 1e38, 0.5]);
    let others = json!([null, []]);
    let values = [numbers, others].map(|v| v.as_array().unwrap().clone()).concat();
    let mut read = 0;
    for pointer in &paths {
        for value in &values {
            std::fs::write(&path, file.with(pointer, value.clone()).glb()).unwrap();
            match Scene::open(path.to_str().unwrap(), &LIMITS) {
                Ok(scene) => {
                    assert_sound(&scene);
                    read += 1;
                }
                Err(error) => {
                    let (text, has_remedy) = (error.to_string(), !error.message().remedy.is_empty());
                    assert!(has_remedy && !text.contains('\n') && text.contains("damaged.glb"), "{text}");
                }
            }
        }
    }
    println!("{read} of {} damaged files were still scenes", paths.len() * values.len());
    assert!(read > 100, "{read}");
}

/// JSON pointers of all numbers.
fn numbers_of(value: &Value, at: String, out: &mut Vec<String>) {
    match value {
        Value::Number(_) => out.push(at),
        Value::Array(list) => list.iter().enumerate().for_each(|(i, v)| numbers_of(v, format!("{at}/{i}"), out)),
        Value::Object(map) => map.iter().for_each(|(k, v)| numbers_of(v, format!("{at}/{k}"), out)),
        _ => {}
    }
}
