//! What all tests are given: the device, built-in scenes, and scenes made by others.

use crate::roomy::roomy_device;
use crate::shared_data::shared_data;
use afterimage_lab::device::Headless;
use afterimage_lab::scene::{Scene, SceneLimits};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// One device shared by all tests; without an adapter, prints that and returns `None`.
pub fn device() -> Option<Arc<Headless>> {
    static DEVICE: OnceLock<Option<Arc<Headless>>> = OnceLock::new();
    DEVICE.get_or_init(roomy_device).clone()
}

pub fn open(path: &Path) -> Scene {
    Scene::open(path.to_str().unwrap(), &SceneLimits::default()).unwrap()
}

pub fn builtin(name: &str) -> Scene {
    open(Path::new(&format!("builtin:{name}")))
}

/// Path of a scene in the shared data.
pub fn path_of(name: &str) -> Option<PathBuf> {
    shared_data(&format!("scenes/{name}"))
}
