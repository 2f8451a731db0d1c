//! What is traced.

use afterimage::scene::{Scene, SceneLimits};
use std::io::Write;
use std::path::Path;

pub fn builtin(name: &str) -> Scene {
    Scene::open(&format!("builtin:{name}"), &SceneLimits::default()).unwrap()
}

/// Small scenes of the shared data, which others made.
pub const SMALL: &[&str] = &[
    "alpha_blend_mode_test/AlphaBlendModeTest.glb",
    "animated_morph_cube/AnimatedMorphCube.gltf",
    "emissive_cornell_box/CornellBox.glb",
    "flight_helmet/FlightHelmet.gltf",
    "fox/Fox.glb",
    "lights_punctual/Lights.glb",
    "transmission_roughness_test/TransmissionRoughnessTest.glb",
    "vertex_color/22_vertex_color.gltf",
];

/// A scene of the shared data, `None` after saying loudly that it is not there. Scenes without light get a sky.
pub fn shared(name: &str) -> Option<Scene> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/scenes").join(name);
    if !path.is_file() {
        // Not eprintln: the harness would swallow it.
        let _ = writeln!(std::io::stderr(), "SKIPPED: no scene at {}", path.display());
        return None;
    }
    let mut scene = Scene::open(path.to_str().unwrap(), &SceneLimits::default()).unwrap();
    scene.environment = afterimage::scene::Environment::Constant([0.6, 0.7, 0.9]);
    scene.name = name.to_owned();
    Some(scene)
}
