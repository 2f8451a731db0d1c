//! Texture coordinates. Where all textures of a material share a set and a transform, these are baked into its
//! triangles; else triangles have up to two sets, and each texture its transform.

use super::warnings::Warnings;
use crate::scene::Coordinates;
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

    /// The same as a matrix. Elements that are not finite become 0.
    fn rows(&self) -> [[f32; 3]; 2] {
        let (sin, cos) = self.rotation.sin_cos();
        let ([x, y], [u, v]) = (self.scale, self.offset);
        let rows = [[cos * x, sin * y, u], [-sin * x, cos * y, v]];
        rows.map(|row| row.map(|x| if x.is_finite() { x } else { 0.0 }))
    }
}

/// How the textures of a material find their coordinates among those of its triangles.
#[derive(Clone, Copy, Debug)]
pub(super) struct UvPlan {
    /// First coordinates of the triangles: the set, and its transform where all textures share one.
    pub first: UvSource,
    /// Set of the second coordinates.
    pub second: Option<u32>,
    /// Whether the textures differ, so that each transforms the coordinates itself.
    each: bool,
}

/// The first coordinates as they are.
pub(super) const PLAIN_PLAN: UvPlan = UvPlan { first: PLAIN, second: None, each: false };

impl UvPlan {
    /// Plan for textures with these sources; a warning if they take more than two sets.
    pub fn of(sources: &[UvSource], warnings: &mut Warnings, name: impl FnOnce() -> String) -> Self {
        let Some(&first) = sources.first() else { return PLAIN_PLAN };
        if sources.iter().all(|s| *s == first) {
            return Self { first, second: None, each: false };
        }
        let second = sources.iter().map(|s| s.set).find(|&set| set != first.set);
        if sources.iter().any(|s| s.set != first.set && Some(s.set) != second) {
            warnings.about("textures with a third set of texture coordinates take the first one", name);
        }
        Self { first: UvSource { set: first.set, ..PLAIN }, second, each: true }
    }

    /// Coordinates of a texture with this source.
    pub fn coordinates(&self, source: &UvSource) -> Coordinates {
        if !self.each {
            return Coordinates::default();
        }
        Coordinates { second: self.second == Some(source.set), rows: source.rows() }
    }
}

/// Numbers of a JSON array of that length.
pub(super) fn array_of<const N: usize>(value: Option<&Value>) -> Option<[f32; N]> {
    let numbers: Option<Vec<f32>> = value?.as_array()?.iter().map(|x| x.as_f64().map(|x| x as f32)).collect();
    numbers?.try_into().ok()
}
