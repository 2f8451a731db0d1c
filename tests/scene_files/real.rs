//! Scenes that others made. Counts are those of the data's own list.

use crate::{assert_sound, open};
use afterimage::report::clock::Stopwatch;
use afterimage::scene::Scene;
use std::io::Write;
use std::path::Path;

/// A scene of the shared data; says loudly when it is not there.
fn real(name: &str) -> Option<Scene> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/scenes").join(name);
    if !path.is_file() {
        // Not eprintln: the harness would swallow it.
        let _ = writeln!(std::io::stderr(), "SKIPPED: no scene at {}", path.display());
        return None;
    }
    let clock = Stopwatch::start();
    let scene = open(&path).unwrap();
    println!(
        "{name}: {:?} ms of CPU time (other tests included), {:.0} ms on the clock",
        clock.cpu_ms(),
        clock.wall_ms()
    );
    println!("warnings: {:#?}", scene.warnings);
    assert_sound(&scene);
    Some(scene)
}

fn triangles(scene: &Scene) -> usize {
    scene.still().len() + scene.pose(0.0).moving.len()
}

#[test]
fn every_scene_has_its_triangles() {
    for (name, count) in [
        ("sponza/sponza.gltf", 262_267),
        ("flight_helmet/FlightHelmet.gltf", 94_722),
        ("alpha_blend_mode_test/AlphaBlendModeTest.glb", 61),
        ("transmission_roughness_test/TransmissionRoughnessTest.glb", 77_792),
        ("fox/Fox.glb", 576),
        ("animated_morph_cube/AnimatedMorphCube.gltf", 12),
        ("lights_punctual/Lights.glb", 12),
        ("vertex_color/22_vertex_color.gltf", 5),
        ("emissive_cornell_box/CornellBox.glb", 36),
    ] {
        if let Some(scene) = real(name) {
            assert_eq!(triangles(&scene), count, "{name}");
        }
    }
}
