//! glTF scenes: supported features, animation, and damaged files.

#[path = "../../common/sound_scene.rs"]
mod sound_scene;

mod bad_input;
pub mod builder;
mod builtin;
mod complete;
mod far;
mod features;
mod framing;
mod limits;
mod materials;
mod mutation;
mod paths;
mod posing;
mod real;
mod tangents;

use afterimage_lab::error::InputError;
use afterimage_lab::scene::{Scene, SceneLimits};
use sound_scene::{assert_sound, assert_triangles_sound};
use std::path::Path;

fn open(path: &Path) -> Result<Scene, InputError> {
    Scene::open(path.to_str().unwrap(), &SceneLimits::default())
}

/// Checks the error of opening a file: one line with a remedy that names the file and contains the words.
#[track_caller]
fn assert_refused(path: &Path, words: &[&str]) {
    let error = match open(path) {
        Ok(_) => panic!("was accepted"),
        Err(e) => e,
    };
    let text = error.to_string();
    println!("{text}");
    assert!(!text.contains('\n'), "more than one line: {text:?}");
    assert!(!error.message().remedy.is_empty(), "no remedy: {text}");
    let name = path.file_name().unwrap().to_str().unwrap();
    for word in words.iter().chain([&name]) {
        assert!(text.contains(word), "{word:?} is not in: {text}");
    }
}
