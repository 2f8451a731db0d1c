//! State of reading one material, for its core and its extensions.

use super::images::Textures;
use super::uv::{UvPlan, UvSource};
use super::warnings::Warnings;
use crate::error::InputError;
use crate::scene::{Material, TextureRef};
use gltf::json::{self, Index, texture};

/// State of reading one material.
pub(super) struct Reader<'a, 'b> {
    pub textures: &'b mut Textures<'a>,
    pub warnings: &'b mut Warnings,
    pub name: String,
    pub material: Material,
    pub tangent_turn: f32,
    /// Coordinates of its textures.
    pub sources: Vec<UvSource>,
    /// How they are found; `None` while the sources are collected, and no texture is registered.
    pub plan: Option<UvPlan>,
}

impl<'a, 'b> Reader<'a, 'b> {
    pub fn new(
        json: &json::Material,
        textures: &'b mut Textures<'a>,
        warnings: &'b mut Warnings,
        name: String,
        plan: Option<UvPlan>,
    ) -> Self {
        let own = json.name.clone().unwrap_or_default();
        let material = Material { name: own, double_sided: json.double_sided, ..Material::default() };
        Self { textures, warnings, name, material, tangent_turn: 0.0, sources: Vec::new(), plan }
    }

    /// Registers a texture and its source of coordinates.
    pub fn texture(&mut self, info: Option<&texture::Info>) -> Result<Option<TextureRef>, InputError> {
        let Some(info) = info else { return Ok(None) };
        self.sourced_texture(info.index, UvSource::of(info), None)
    }

    /// The same for a texture with this source of coordinates, as it is or as roughness of a glossiness.
    pub fn sourced_texture(
        &mut self,
        index: Index<json::Texture>,
        source: UvSource,
        glossiness: Option<f32>,
    ) -> Result<Option<TextureRef>, InputError> {
        let Some(plan) = &self.plan else {
            self.sources.extend(self.textures.has_image(index).then_some(source));
            return Ok(None);
        };
        self.textures.use_texture(index, glossiness, plan.coordinates(&source))
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
