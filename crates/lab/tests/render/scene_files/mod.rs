//! glTF scenes: supported features, animation, and damaged files.

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

use crate::sound_scene::assert_sound;
use afterimage_lab::error::InputError;
use afterimage_lab::scene::{Scene, SceneLimits};
use builder::Gltf;
use std::path::Path;

fn open(path: &Path) -> Result<Scene, InputError> {
    Scene::open(path.to_str().unwrap(), &SceneLimits::default())
}

impl Gltf {
    #[track_caller]
    fn assert_refused(&self, words: &[&str]) {
        assert_refused(&self.written().path, words);
    }
}

/// The same of the default limits; the error names the file, too.
#[track_caller]
fn assert_refused(path: &Path, words: &[&str]) {
    let name = path.file_name().unwrap().to_str().unwrap();
    assert_refused_within(path, &SceneLimits::default(), &[words, &[name]].concat());
}

/// Checks the error of opening a file within limits: one line with a remedy that contains the words.
#[track_caller]
fn assert_refused_within(path: &Path, limits: &SceneLimits, words: &[&str]) {
    let error = Scene::open(path.to_str().unwrap(), limits).map(|_| ()).expect_err("was accepted");
    let text = error.to_string();
    println!("{text}");
    assert!(!text.contains('\n'), "more than one line: {text:?}");
    assert!(!error.message().remedy.is_empty(), "no remedy: {text}");
    for word in words {
        assert!(text.contains(word), "{word:?} is not in: {text}");
    }
}
