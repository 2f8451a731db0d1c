//! State of reading one material, for its core and its extensions.

use super::images::Textures;
use super::uv::UvSource;
use super::warnings::Warnings;
use crate::error::InputError;
use crate::scene::{Material, TextureRef};
use gltf::json;

/// State of reading one material.
pub(super) struct Reader<'a, 'b> {
    pub textures: &'b mut Textures<'a>,
    pub warnings: &'b mut Warnings,
    pub name: String,
    pub material: Material,
    pub tangent_turn: f32,
    /// Coordinates of its textures.
    pub sources: Vec<UvSource>,
}

impl Reader<'_, '_> {
    /// Registers a texture and its source of coordinates.
    pub fn texture(&mut self, info: Option<&json::texture::Info>) -> Result<Option<TextureRef>, InputError> {
        let Some(info) = info else { return Ok(None) };
        self.sources.push(UvSource::of(info));
        self.textures.use_texture(info.index)
    }

    /// A factor clamped to its range, with a warning if it is outside.
    pub fn clamped(&mut self, value: f32, low: f32, high: f32) -> f32 {
        if (low..=high).contains(&value) {
            return value;
        }
        self.warn("factors of materials out of their range are clamped");
        // JSON numbers too large for a float become infinite; they are never NaN.
        value.clamp(low, high)
    }

    pub fn warn(&mut self, text: &str) {
        self.warnings.about(text, || self.name.clone());
    }
}
