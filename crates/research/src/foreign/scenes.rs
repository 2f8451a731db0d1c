//! The scenes at hand.

use super::options::ForeignArgs;
use crate::error::AnyError;
use afterimage_lab::scene::builtin;
use std::fs;
use std::path::{Path, PathBuf};

/// Endings of scene files, with those first that can be opened.
const ENDINGS: [&str; 3] = ["gltf", "glb", "obj"];

/// A scene to be opened.
pub struct SceneInput {
    /// Name of its folder, or of the built-in scene.
    pub name: String,
    /// A file, or `builtin:NAME`.
    pub path: String,
}

/// A scene that could not be opened or rendered, and why.
pub struct Unread {
    pub name: String,
    pub reason: String,
}

/// The scenes that the options choose: files first, in the order of their names.
pub fn chosen(options: &ForeignArgs) -> Result<Vec<SceneInput>, AnyError> {
    let mut scenes = of_folder(&options.folder);
    scenes.extend(builtin::NAMES.iter().map(|&name| SceneInput { name: name.into(), path: format!("builtin:{name}") }));
    let names = &options.scenes;
    if let Some(unknown) = names.iter().find(|&name| !scenes.iter().any(|s| s.name == *name)) {
        let known: Vec<_> = scenes.iter().map(|s| &*s.name).collect();
        return Err(format!("scene {unknown}: expected one of {}", known.join(", ")).into());
    }
    scenes.retain(|s| names.is_empty() || names.contains(&s.name));
    Ok(scenes)
}

/// One scene a folder. A folder that cannot be read, or has no file of a scene, is a scene that cannot be opened.
fn of_folder(folder: &Path) -> Vec<SceneInput> {
    let mut folders: Vec<_> = entries(folder).into_iter().filter(|path| path.is_dir()).collect();
    folders.sort();
    if folders.is_empty() {
        eprintln!("{}: has no folders of scenes", folder.display());
    }
    let scene = |folder: PathBuf| {
        let files = entries(&folder);
        let with = |ending: &&str| files.iter().find(|f| f.extension().is_some_and(|e| e == *ending));
        let path = ENDINGS.iter().find_map(with).unwrap_or(&folder);
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        SceneInput { name, path: path.display().to_string() }
    };
    folders.into_iter().map(scene).collect()
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    fs::read_dir(folder).into_iter().flatten().filter_map(|entry| Some(entry.ok()?.path())).collect()
}
