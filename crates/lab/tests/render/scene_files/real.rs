//! External scenes. Counts are those in the data's own list.

use super::{assert_sound, open};
use crate::given::path_of;
use afterimage_lab::clock::Stopwatch;
use afterimage_lab::scene::{Alpha, PunctualKind, Scene, Triangles};
use glam::{DMat4, DQuat, DVec3, Vec3, Vec4};
use serde_json::Value;

fn real(name: &str) -> Option<Scene> {
    let path = path_of(name)?;
    let clock = Stopwatch::start();
    let scene = open(&path).unwrap();
    println!(
        "{name}: {:?} ms of CPU time (other tests included), {:.0} ms on the clock",
        clock.cpu_ms(),
        clock.wall_ms()
    );
    assert_sound(&scene);
    Some(scene)
}

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
        if let Some(scene) = real(name) {
            assert_eq!((scene.still().len(), scene.pose(0.0).moving.len()), (still, moving), "{name}");
            let points = name.starts_with("vertex_color");
            assert_eq!(scene.warnings.len(), usize::from(points), "{name}: {:?}", scene.warnings);
        }
    }
}

#[test]
fn sponza_is_textured_and_in_metres() {
    let Some(scene) = real("sponza/sponza.gltf") else { return };
    let bounds = scene.bounds().unwrap();
    let size = bounds.max - bounds.min;
    // The atrium is about 30 m long, 18 m wide and 12 m high.
    assert!(size.abs_diff_eq(Vec3::new(29.8, 12.5, 18.3), 1.0), "{size}");
    assert!(scene.materials.iter().filter(|m| m.normal_texture.is_some()).count() > 10);
    assert!(scene.materials.iter().any(|m| matches!(m.alpha, Alpha::Mask { .. })));
    assert_eq!(scene.textures.iter().flat_map(|t| t.size).max(), Some(512));
    assert!(scene.still().uvs.iter().any(|t| t[0] != t[1]));
}

#[test]
fn lights_of_the_light_scene() {
    let Some(scene) = real("lights_punctual/Lights.glb") else { return };
    let pose = scene.pose(0.0);
    let count = |wanted: fn(&PunctualKind) -> bool| pose.lights.iter().filter(|l| wanted(&l.kind)).count();
    assert!(count(|k| *k == PunctualKind::Directional) > 0);
    assert!(count(|k| *k == PunctualKind::Point) > 0);
    assert!(count(|k| matches!(k, PunctualKind::Spot { .. })) > 0);
    assert_eq!(pose.cameras.len(), 1);
}

#[test]
fn materials_of_the_material_scenes() {
    if let Some(scene) = real("emissive_cornell_box/CornellBox.glb") {
        let brightest = scene.materials.iter().flat_map(|m| m.emissive).fold(0.0, f32::max);
        assert_eq!(brightest, 100.0);
    }
    if let Some(scene) = real("vertex_color/22_vertex_color.gltf") {
        assert!(scene.still().colors.iter().flatten().any(|c| *c != Vec4::ONE));
    }
    if let Some(scene) = real("alpha_blend_mode_test/AlphaBlendModeTest.glb") {
        let mut cutoffs: Vec<_> = scene
            .materials
            .iter()
            .filter_map(|m| match m.alpha {
                Alpha::Mask { cutoff } => Some(cutoff),
                _ => None,
            })
            .collect();
        cutoffs.sort_by(f32::total_cmp);
        assert_eq!(cutoffs, [0.25, 0.5, 0.75]);
        assert!(scene.materials.iter().any(|m| m.alpha == Alpha::Blend));
    }
    if let Some(scene) = real("transmission_roughness_test/TransmissionRoughnessTest.glb") {
        assert!(scene.materials.iter().any(|m| m.transmission > 0.0 && m.volume && m.ior > 1.0));
    }
}

/// Largest distance between corners of two poses.
fn moved(a: &Triangles, b: &Triangles) -> f32 {
    a.positions.iter().flatten().zip(b.positions.iter().flatten()).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max)
}

#[test]
fn the_morph_cube_changes_and_comes_back() {
    let Some(scene) = real("animated_morph_cube/AnimatedMorphCube.gltf") else { return };
    let length = scene.duration_s();
    assert!(length > 0.0);
    let [start, middle, again] = [0.0, length / 2.0, length].map(|t| scene.pose(t).moving);
    assert!(moved(&start, &middle) > 0.0);
    assert_eq!(start, again);
}

/// The fox's file, parsed independently: its JSON and its binary chunk.
struct Fox {
    root: Value,
    bin: Vec<u8>,
}

impl Fox {
    fn floats(&self, accessor: &Value, i: usize, width: usize) -> Vec<f64> {
        let accessor = &self.root["accessors"][accessor.as_u64().unwrap() as usize];
        assert_eq!(accessor["componentType"], 5126);
        let at = self.start(accessor, width * 4, i);
        self.bin[at..at + width * 4].as_chunks::<4>().0.iter().map(|b| f32::from_le_bytes(*b).into()).collect()
    }

    fn start(&self, accessor: &Value, packed: usize, i: usize) -> usize {
        let view = &self.root["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        let number = |v: &Value| v.as_u64().unwrap_or(0) as usize;
        let stride = view["byteStride"].as_u64().map_or(packed, |s| s as usize);
        number(&view["byteOffset"]) + number(&accessor["byteOffset"]) + i * stride
    }

    /// Value of a curve of the first animation at a time, by linear interpolation.
    fn curve(&self, node: usize, path: &str, time_s: f64) -> Option<Vec<f64>> {
        let animation = &self.root["animations"][0];
        let channel = animation["channels"]
            .as_array()?
            .iter()
            .find(|c| c["target"]["node"] == node && c["target"]["path"] == path)?;
        let sampler = &animation["samplers"][channel["sampler"].as_u64()? as usize];
        let n = self.root["accessors"][sampler["input"].as_u64()? as usize]["count"].as_u64()? as usize;
        let times: Vec<f64> = (0..n).map(|i| self.floats(&sampler["input"], i, 1)[0]).collect();
        let width = if path == "rotation" { 4 } else { 3 };
        let value = |i: usize| self.floats(&sampler["output"], i, width);
        let next = times.iter().position(|&t| t > time_s).unwrap_or(n);
        if next == 0 || next == n {
            return Some(value(next.min(n - 1)));
        }
        let t = (time_s - times[next - 1]) / (times[next] - times[next - 1]);
        let (a, mut b) = (value(next - 1), value(next));
        if path == "rotation" {
            let mut cos: f64 = a.iter().zip(&b).map(|(a, b)| a * b).sum();
            if cos < 0.0 {
                b.iter_mut().for_each(|x| *x = -*x);
                cos = -cos;
            }
            let angle = cos.min(1.0).acos();
            if angle > 1e-9 {
                let (from, to) = (((1.0 - t) * angle).sin() / angle.sin(), (t * angle).sin() / angle.sin());
                return Some(a.iter().zip(&b).map(|(a, b)| a * from + b * to).collect());
            }
        }
        Some(a.iter().zip(&b).map(|(a, b)| a + (b - a) * t).collect())
    }

    /// World transform of a node at a time, by recursion over its ancestors.
    fn world(&self, node: usize, time_s: f64) -> DMat4 {
        let json = &self.root["nodes"][node];
        let part = |path: &str, default: &[f64]| {
            let own = || json[path].as_array().map(|a| a.iter().map(|x| x.as_f64().unwrap()).collect());
            self.curve(node, path, time_s).or_else(own).unwrap_or(default.to_vec())
        };
        let (t, r, s) =
            (part("translation", &[0.0; 3]), part("rotation", &[0.0, 0.0, 0.0, 1.0]), part("scale", &[1.0; 3]));
        let local = DMat4::from_scale_rotation_translation(
            DVec3::from_slice(&s),
            DQuat::from_slice(&r).normalize(),
            DVec3::from_slice(&t),
        );
        let is_parent = |n: &Value| n["children"].as_array().is_some_and(|c| c.iter().any(|c| *c == node));
        match self.root["nodes"].as_array().unwrap().iter().position(is_parent) {
            Some(parent) => self.world(parent, time_s) * local,
            None => local,
        }
    }

    fn vertex(&self, i: usize, time_s: f64) -> DVec3 {
        let attributes = &self.root["meshes"][0]["primitives"][0]["attributes"];
        let position = DVec3::from_slice(&self.floats(&attributes["POSITION"], i, 3));
        let joints = &self.root["accessors"][attributes["JOINTS_0"].as_u64().unwrap() as usize];
        assert_eq!(joints["componentType"], 5123);
        let at = self.start(joints, 8, i);
        let weights = self.floats(&attributes["WEIGHTS_0"], i, 4);
        let skin = &self.root["skins"][0];
        let mut sum = DVec3::ZERO;
        for (k, weight) in weights.iter().enumerate() {
            let joint = u16::from_le_bytes([self.bin[at + 2 * k], self.bin[at + 2 * k + 1]]) as usize;
            let bind: [f64; 16] = self.floats(&skin["inverseBindMatrices"], joint, 16).try_into().unwrap();
            let node = skin["joints"][joint].as_u64().unwrap() as usize;
            sum += (self.world(node, time_s) * DMat4::from_cols_array(&bind)).transform_point3(position) * *weight;
        }
        sum
    }
}

#[test]
fn the_fox_is_where_its_file_puts_it() {
    let Some(scene) = real("fox/Fox.glb") else { return };
    let bytes = std::fs::read(path_of("fox/Fox.glb").unwrap()).unwrap();
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    let json_end = 20 + word(12);
    let fox = Fox { root: serde_json::from_slice(&bytes[20..json_end]).unwrap(), bin: bytes[json_end + 8..].to_vec() };
    let length = scene.duration_s();
    let [a, b] = [0.2, 0.6].map(|share| scene.pose(share * length).moving);
    assert!(moved(&a, &b) > 1.0, "the fox stands still");
    let mut worst = 0.0f64;
    for (pose, time_s) in [(&a, 0.2 * length), (&b, 0.6 * length)] {
        // Vertices are not shared, so corners are vertices in order.
        for i in (0..1728).step_by(53) {
            let found = pose.positions[i / 3][i % 3].as_dvec3();
            worst = worst.max((found - fox.vertex(i, time_s)).length());
        }
    }
    println!("the fox is off by {worst:.2e} of its 150 units at most");
    // Sums of four products in f32 of numbers up to 150: a few units in the last place.
    assert!(worst < 2e-4, "{worst}");
    // Planted error: the pose of a slightly later time.
    let later = scene.pose(0.25 * length).moving;
    assert!((later.positions[0][0].as_dvec3() - fox.vertex(0, 0.2 * length)).length() > 0.01);
    let other =
        Scene::open_clip(path_of("fox/Fox.glb").unwrap().to_str().unwrap(), Some("Run"), &Default::default()).unwrap();
    assert!(moved(&other.pose(0.3).moving, &scene.pose(0.3).moving) > 1.0);
}
