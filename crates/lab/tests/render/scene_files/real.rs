//! External scenes. Counts are those in the data's own list.

use super::{assert_sound, open};
use crate::given::path_of;

#[test]
fn every_scene_has_its_triangles() {
    for (name, still, moving) in [
        ("sponza/sponza.gltf", 262_267, 0),
        ("flight_helmet/FlightHelmet.gltf", 94_722, 0),
        ("alpha_blend_mode_test/AlphaBlendModeTest.glb", 61, 0),
        ("transmission_roughness_test/TransmissionRoughnessTest.glb", 77_792, 0),
        ("fox/Fox.glb", 0, 576),
        ("animated_morph_cube/AnimatedMorphCube.gltf", 0, 12),
        ("lights_punctual/Lights.glb", 12, 0),
        ("vertex_color/22_vertex_color.gltf", 5, 0),
        ("emissive_cornell_box/CornellBox.glb", 36, 0),
    ] {
        let Some(path) = path_of(name) else { continue };
        let scene = open(&path).unwrap();
        assert_sound(&scene);
        assert_eq!((scene.still().len(), scene.pose(0.0).moving.len()), (still, moving), "{name}");
        let points = name.starts_with("vertex_color");
        assert_eq!(scene.warnings.len(), usize::from(points), "{name}: {:?}", scene.warnings);
    }
}
