//! Builder of small glTF files: JSON and a binary buffer.

use crate::sound_scene::assert_sound;
use afterimage_lab::scene::{Scene, SceneLimits};
use serde_json::{Value, json};
use std::path::PathBuf;
use tempfile::TempDir;

/// A file under construction, with one buffer.
#[derive(Clone)]
pub struct Gltf {
    pub json: Value,
    pub bin: Vec<u8>,
}

/// A file on disk, with its temporary folder.
pub struct Written {
    pub folder: TempDir,
    pub path: PathBuf,
}

pub const TRIANGLE: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

impl Gltf {
    pub fn new() -> Self {
        let json = json!({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [],
            "accessors": [], "bufferViews": []
        });
        Self { json, bin: Vec::new() }
    }

    /// Appends to a top-level array and returns the index.
    pub fn push(&mut self, list: &str, value: Value) -> usize {
        if self.json.get(list).is_none() {
            self.json[list] = json!([]);
        }
        let list = self.json[list].as_array_mut().unwrap();
        list.push(value);
        list.len() - 1
    }

    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let offset = self.bin.len();
        self.bin.extend_from_slice(bytes);
        self.push("bufferViews", json!({"buffer": 0, "byteOffset": offset, "byteLength": bytes.len()}))
    }

    /// An accessor of the given GL component type.
    pub fn accessor(&mut self, bytes: &[u8], count: usize, kind: &str, component: u32) -> usize {
        let view = self.view(bytes);
        self.push("accessors", json!({"bufferView": view, "count": count, "type": kind, "componentType": component}))
    }

    pub fn floats<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = values.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let kind = match N {
            1 => "SCALAR",
            2 => "VEC2",
            3 => "VEC3",
            4 => "VEC4",
            _ => "MAT4",
        };
        self.accessor(&bytes, values.len(), kind, 5126)
    }

    pub fn indices(&mut self, values: &[u32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.accessor(&bytes, values.len(), "SCALAR", 5125)
    }

    /// A mesh of one primitive.
    pub fn mesh(&mut self, primitive: Value) -> usize {
        self.push("meshes", json!({"primitives": [primitive]}))
    }

    /// A mesh of one triangle.
    pub fn triangle(&mut self) -> usize {
        let positions = self.floats(&TRIANGLE);
        self.mesh(json!({"attributes": {"POSITION": positions}}))
    }

    /// The first primitive of the first mesh.
    pub fn primitive(&mut self) -> &mut Value {
        &mut self.json["meshes"][0]["primitives"][0]
    }

    /// Gives the first primitive an attribute.
    pub fn set<const N: usize>(&mut self, attribute: &str, values: &[[f32; N]]) {
        let values = self.floats(values);
        self.primitive()["attributes"][attribute] = json!(values);
    }

    /// Replaces elements of an accessor.
    pub fn sparse(&mut self, accessor: usize, at: &[u8], values: &[u8]) {
        let (indices, values) = (self.view(at), self.view(values));
        self.json["accessors"][accessor]["sparse"] = json!({"count": at.len(),
            "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": values}});
    }

    /// An animation of one channel.
    pub fn animate<const N: usize>(
        &mut self,
        node: usize,
        path: &str,
        interpolation: &str,
        times: &[f32],
        values: &[[f32; N]],
    ) {
        let times: Vec<[f32; 1]> = times.iter().map(|&t| [t]).collect();
        let (input, output) = (self.floats(&times), self.floats(values));
        let sampler = json!({"input": input, "output": output, "interpolation": interpolation});
        let channel = json!({"sampler": 0, "target": {"node": node, "path": path}});
        let name = format!("{path} {interpolation}");
        self.push("animations", json!({"name": name, "channels": [channel], "samplers": [sampler]}));
    }

    /// Makes one of the last two animations, of one channel each.
    pub fn join_animations(&mut self) {
        let animations = self.json["animations"].as_array_mut().unwrap();
        let mut last = animations.pop().unwrap();
        last["channels"][0]["sampler"] = json!(1);
        for list in ["channels", "samplers"] {
            animations.last_mut().unwrap()[list].as_array_mut().unwrap().push(last[list][0].take());
        }
    }

    /// A node without a parent, in the scene.
    pub fn node(&mut self, node: Value) -> usize {
        let index = self.push("nodes", node);
        self.json["scenes"][0]["nodes"].as_array_mut().unwrap().push(json!(index));
        index
    }

    /// A node with a mesh of one primitive.
    pub fn shape(&mut self, primitive: Value) -> usize {
        let mesh = self.mesh(primitive);
        self.node(json!({"mesh": mesh}))
    }

    /// A node with a mesh of the given positions.
    pub fn soup(&mut self, positions: &[[f32; 3]]) -> usize {
        let positions = self.floats(positions);
        self.shape(json!({"attributes": {"POSITION": positions}}))
    }

    /// A file of one node with a mesh of the given positions.
    pub fn of(positions: &[[f32; 3]]) -> Self {
        let mut file = Self::new();
        file.soup(positions);
        file
    }

    /// One triangle that this animation moves.
    pub fn animated<const N: usize>(path: &str, interpolation: &str, times: &[f32], values: &[[f32; N]]) -> Self {
        let mut file = Self::of(&TRIANGLE);
        file.animate(0, path, interpolation, times, values);
        file
    }

    /// One triangle with the given material.
    pub fn with_material(material: Value) -> Self {
        let mut file = Self::new();
        let material = file.push("materials", material);
        let positions = file.floats(&TRIANGLE);
        let uvs = file.floats(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        let attributes = json!({"POSITION": positions, "TEXCOORD_0": uvs});
        file.shape(json!({"attributes": attributes, "material": material}));
        file
    }

    /// The same with another value at a JSON pointer.
    pub fn with(&self, pointer: &str, value: Value) -> Self {
        let mut file = self.clone();
        *file.json.pointer_mut(pointer).unwrap_or_else(|| panic!("{pointer}")) = value;
        file
    }

    /// A texture with its encoded image in the buffer.
    pub fn texture(&mut self, encoded: &[u8]) -> usize {
        let view = self.view(encoded);
        let image = self.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
        self.push("textures", json!({"source": image}))
    }

    /// The bytes of a `.glb`.
    pub fn glb(&self) -> Vec<u8> {
        let mut root = self.json.clone();
        if root.get("buffers").is_none() {
            root["buffers"] = json!([{"byteLength": self.bin.len()}]);
        }
        glb(root.to_string().as_bytes(), Some(&self.bin))
    }

    pub fn written(&self) -> Written {
        written("scene.glb", &self.glb())
    }

    #[track_caller]
    pub fn open(&self) -> Scene {
        let file = self.written();
        let scene = Scene::open(file.path.to_str().unwrap(), &SceneLimits::default()).unwrap();
        assert_sound(&scene);
        scene
    }
}

/// A `.glb` of a JSON and a binary chunk.
pub fn glb(json: &[u8], bin: Option<&[u8]>) -> Vec<u8> {
    let mut body = Vec::new();
    for (kind, data, fill) in [(b"JSON", json, b' ')].into_iter().chain(bin.map(|b| (b"BIN\0", b, 0))) {
        let length = data.len().next_multiple_of(4);
        body.extend_from_slice(&(length as u32).to_le_bytes());
        body.extend_from_slice(kind);
        body.extend_from_slice(data);
        body.resize(body.len() + length - data.len(), fill);
    }
    let mut bytes = b"glTF".to_vec();
    bytes.extend_from_slice(&2u32.to_le_bytes());
    bytes.extend_from_slice(&(body.len() as u32 + 12).to_le_bytes());
    bytes.extend(body);
    bytes
}

pub fn written(name: &str, bytes: &[u8]) -> Written {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    Written { folder, path }
}

/// A PNG of 8 bit RGBA.
pub fn png(size: [u32; 2], texel: impl Fn(u32, u32) -> [u8; 4]) -> Vec<u8> {
    let image = image::RgbaImage::from_fn(size[0], size[1], |x, y| image::Rgba(texel(x, y)));
    encoded(&image::DynamicImage::ImageRgba8(image))
}

pub fn encoded(image: &image::DynamicImage) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}
