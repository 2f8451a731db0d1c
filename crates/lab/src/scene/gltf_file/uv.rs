//! Texture coordinates: one set and one transform per material, baked into its triangles.

use super::warnings::Warnings;
use gltf::json::texture;
use serde_json::Value;

/// A set of texture coordinates and its transform (KHR_texture_transform).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct UvSource {
    pub set: u32,
    pub offset: [f32; 2],
    /// Rotation in radians, counter-clockwise in the image.
    pub rotation: f32,
    pub scale: [f32; 2],
}

/// Set 0 without a transform.
pub(super) const PLAIN: UvSource = UvSource { set: 0, offset: [0.0; 2], rotation: 0.0, scale: [1.0; 2] };

impl UvSource {
    /// Source of a texture.
    pub fn of(info: &texture::Info) -> Self {
        let plain = Self { set: info.tex_coord, ..PLAIN };
        let Some(t) = info.extensions.as_ref().and_then(|e| e.texture_transform.as_ref()) else { return plain };
        Self { set: t.tex_coord.unwrap_or(plain.set), offset: t.offset.0, rotation: t.rotation.0, scale: t.scale.0 }
    }

    /// Source of a normal map, whose extensions the crate `gltf` leaves as JSON.
    pub fn of_value(set: u32, transform: Option<&Value>) -> Self {
        let plain = Self { set, ..PLAIN };
        let Some(t) = transform else { return plain };
        let number = |name: &str| t.get(name).and_then(Value::as_f64);
        Self {
            set: t.get("texCoord").and_then(Value::as_u64).and_then(|s| u32::try_from(s).ok()).unwrap_or(set),
            offset: array_of(t.get("offset")).unwrap_or(plain.offset),
            rotation: number("rotation").unwrap_or(0.0) as f32,
            scale: array_of(t.get("scale")).unwrap_or(plain.scale),
        }
    }

    /// Scales, rotates and translates coordinates, in this order. Results that are not finite become 0.
    pub fn apply(&self, [u, v]: [f32; 2]) -> [f32; 2] {
        let (sin, cos) = self.rotation.sin_cos();
        let (u, v) = (u * self.scale[0], v * self.scale[1]);
        let transformed = [cos * u + sin * v + self.offset[0], cos * v - sin * u + self.offset[1]];
        transformed.map(|x| if x.is_finite() { x } else { 0.0 })
    }
}

/// Common source of all textures of a material: the first of `sources`, with a warning if they differ.
pub(super) fn common_source(sources: &[UvSource], warnings: &mut Warnings, name: impl FnOnce() -> String) -> UvSource {
    let Some(&first) = sources.first() else { return PLAIN };
    if sources.iter().any(|s| *s != first) {
        warnings.about("textures of one material with different texture coordinates all take the first one's", name);
    }
    first
}

/// Numbers of a JSON array of that length.
pub(super) fn array_of<const N: usize>(value: Option<&Value>) -> Option<[f32; N]> {
    let numbers: Option<Vec<f32>> = value?.as_array()?.iter().map(|x| x.as_f64().map(|x| x as f32)).collect();
    numbers?.try_into().ok()
}
