//! Materials: parameters of the Disney principled BSDF under glTF's names.

/// A surface material. Colors are linear Rec. 709. Textures multiply their factor.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name in the file.
    pub name: String,
    /// Base color: albedo of the diffuse lobe, reflectance of metal, tint of transmission.
    pub base_color: [f32; 3],
    /// Base color factor in RGB, sRGB-encoded; opacity factor in A, linear.
    pub base_color_texture: Option<TextureRef>,
    /// Opacity, a factor of the alpha of texture and vertices. `alpha` selects its effect.
    pub opacity: f32,
    /// Alpha mode.
    pub alpha: Alpha,
    /// 0 dielectric to 1 metal.
    pub metallic: f32,
    /// Perceptual roughness, 0 to 1; GGX alpha is its square.
    pub roughness: f32,
    /// Roughness factor in G, metallic factor in B, linear.
    pub metallic_roughness_texture: Option<TextureRef>,
    /// Tangent-space normal map, linear.
    pub normal_texture: Option<TextureRef>,
    /// Factor of the normal map's x and y.
    pub normal_scale: f32,
    /// Emitted radiance, strength included. Both sides emit if `double_sided`, else the front.
    pub emissive: [f32; 3],
    /// Factor of `emissive`, sRGB-encoded.
    pub emissive_texture: Option<TextureRef>,
    /// Strength of the dielectric interface, 0 to 1. With 0 the diffuse lobe is Lambert's.
    pub specular: f32,
    /// Factor of `specular` in A.
    pub specular_texture: Option<TextureRef>,
    /// Color of the dielectric reflection at normal incidence, a factor of the reflectance given by `ior`.
    pub specular_color: [f32; 3],
    /// Factor of `specular_color`, sRGB-encoded.
    pub specular_color_texture: Option<TextureRef>,
    /// Tint of the dielectric reflection towards the hue of the base color, 0 to 1.
    pub specular_tint: f32,
    /// Index of refraction, 1 or more.
    pub ior: f32,
    /// Stretch of the highlight along the tangent, 0 to 1.
    pub anisotropy: f32,
    /// Strength of the coat, 0 to 1. Its index of refraction is 1.5.
    pub clearcoat: f32,
    /// Factor of `clearcoat` in R.
    pub clearcoat_texture: Option<TextureRef>,
    /// Perceptual roughness of the coat.
    pub clearcoat_roughness: f32,
    /// Factor of `clearcoat_roughness` in G.
    pub clearcoat_roughness_texture: Option<TextureRef>,
    /// Color of the sheen; black for none.
    pub sheen_color: [f32; 3],
    /// Factor of `sheen_color`, sRGB-encoded.
    pub sheen_color_texture: Option<TextureRef>,
    /// Perceptual roughness of the sheen.
    pub sheen_roughness: f32,
    /// Factor of `sheen_roughness` in A.
    pub sheen_roughness_texture: Option<TextureRef>,
    /// Tint of the sheen towards the hue of the base color, 0 to 1.
    pub sheen_tint: f32,
    /// Share of the light entering the surface that is transmitted instead of scattered diffusely, 0 to 1.
    pub transmission: f32,
    /// Factor of `transmission` in R.
    pub transmission_texture: Option<TextureRef>,
    /// Whether the surface bounds a refracting volume; otherwise it is a thin sheet that does not bend rays.
    pub volume: bool,
    /// Absorption coefficient inside the volume in 1/m, for each color.
    pub absorption: [f32; 3],
    /// Whether the back emits like the front. Both sides always scatter: there is no back-face culling.
    pub double_sided: bool,
    /// Phong parameters for the thesis' mode; `None`: derived from the other parameters.
    pub phong: Option<Phong>,
}

/// The thesis' material: Lambert with albedo `base_color` times (1 - `metallic`), plus this Phong lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phong {
    /// Specular albedo.
    pub specular: [f32; 3],
    /// Phong exponent, 0 or more.
    pub exponent: f32,
}

/// Alpha mode: the effect of opacity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Alpha {
    /// Opacity is ignored.
    Opaque,
    /// Alpha test: the surface is absent where opacity is below the cutoff.
    Mask {
        /// Smallest opacity of a visible surface.
        cutoff: f32,
    },
    /// Opacity is the share of light that interacts with the surface; the rest passes straight through.
    Blend,
}

/// A reference to a texture of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureRef {
    /// Index into the scene's textures.
    pub texture: u32,
}

impl Default for Material {
    /// White, rough, dielectric, opaque: glTF's default except that `metallic` is 0 and `double_sided` is true.
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: [1.0; 3],
            base_color_texture: None,
            opacity: 1.0,
            alpha: Alpha::Opaque,
            metallic: 0.0,
            roughness: 1.0,
            metallic_roughness_texture: None,
            normal_texture: None,
            normal_scale: 1.0,
            emissive: [0.0; 3],
            emissive_texture: None,
            specular: 1.0,
            specular_texture: None,
            specular_color: [1.0; 3],
            specular_color_texture: None,
            specular_tint: 0.0,
            ior: 1.5,
            anisotropy: 0.0,
            clearcoat: 0.0,
            clearcoat_texture: None,
            clearcoat_roughness: 0.0,
            clearcoat_roughness_texture: None,
            sheen_color: [0.0; 3],
            sheen_color_texture: None,
            sheen_roughness: 0.0,
            sheen_roughness_texture: None,
            sheen_tint: 0.0,
            transmission: 0.0,
            transmission_texture: None,
            volume: false,
            absorption: [0.0; 3],
            double_sided: true,
            phong: None,
        }
    }
}
