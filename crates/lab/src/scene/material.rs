//! Materials: the parameters of the Disney principled BRDF in glTF's terms.

/// What a surface is made of. Colors are linear Rec. 709. Textures multiply their factor.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// As the file names it.
    pub name: String,
    /// Base color: of the diffuse lobe, of metal, of what is transmitted.
    pub base_color: [f32; 3],
    /// sRGB-encoded; alpha linear.
    pub base_color_texture: Option<TextureRef>,
    /// Opacity, factor of the texture's and the vertices' alpha; what it means is said by `alpha`.
    pub opacity: f32,
    /// What opacity does.
    pub alpha: Alpha,
    /// 0 dielectric to 1 metal.
    pub metallic: f32,
    /// Perceptual roughness, 0 to 1; GGX' width is its square.
    pub roughness: f32,
    /// Linear: roughness in G, metallic in B.
    pub metallic_roughness_texture: Option<TextureRef>,
    /// Linear, tangent space.
    pub normal_texture: Option<TextureRef>,
    /// Factor of the normal map's x and y.
    pub normal_scale: f32,
    /// Emitted radiance, strength included; both sides emit where `double_sided`, else the front.
    pub emissive: [f32; 3],
    /// sRGB-encoded.
    pub emissive_texture: Option<TextureRef>,
    /// Strength of the dielectric interface, 0 to 1. With 0 the diffuse lobe is Lambert's.
    pub specular: f32,
    /// Factor in A.
    pub specular_texture: Option<TextureRef>,
    /// Color of the dielectric reflection at normal incidence, factor of what `ior` gives.
    pub specular_color: [f32; 3],
    /// sRGB-encoded.
    pub specular_color_texture: Option<TextureRef>,
    /// 0 to 1: how far the hue of the base color tints the dielectric reflection.
    pub specular_tint: f32,
    /// Index of refraction, 1 or more.
    pub ior: f32,
    /// 0 to 1: stretch of the highlight along the tangent.
    pub anisotropy: f32,
    /// Strength of the coat, 0 to 1. Its index of refraction is 1.5.
    pub clearcoat: f32,
    /// Factor in R.
    pub clearcoat_texture: Option<TextureRef>,
    /// Perceptual roughness of the coat.
    pub clearcoat_roughness: f32,
    /// Factor in G.
    pub clearcoat_roughness_texture: Option<TextureRef>,
    /// Color of the sheen; black for none.
    pub sheen_color: [f32; 3],
    /// sRGB-encoded.
    pub sheen_color_texture: Option<TextureRef>,
    /// Perceptual roughness of the sheen.
    pub sheen_roughness: f32,
    /// Factor in A.
    pub sheen_roughness_texture: Option<TextureRef>,
    /// 0 to 1: how far the hue of the base color tints the sheen.
    pub sheen_tint: f32,
    /// Share of what enters the surface that passes through instead of being scattered back, 0 to 1.
    pub transmission: f32,
    /// Factor in R.
    pub transmission_texture: Option<TextureRef>,
    /// Whether the surface bounds a body that refracts; a thin sheet that does not bend rays otherwise.
    pub volume: bool,
    /// Absorption inside the body, 1/m for each color.
    pub absorption: [f32; 3],
    /// Whether the back emits as the front does. Both sides always scatter: a surface does not vanish from behind.
    pub double_sided: bool,
    /// Phong's specular albedo and exponent, for the thesis' mode; `None`: derived from the other parameters.
    pub phong: Option<Phong>,
}

/// The thesis' material: Lambert with `base_color` times (1 - `metallic`), and this lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phong {
    /// Specular albedo.
    pub specular: [f32; 3],
    /// Exponent, 0 or more.
    pub exponent: f32,
}

/// What opacity does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Alpha {
    /// Nothing.
    Opaque,
    /// Below the cutoff the surface is not there.
    Mask {
        /// Smallest opacity that is seen.
        cutoff: f32,
    },
    /// That share of light meets the surface, the rest passes straight on.
    Blend,
}

/// A texture of the scene as a material uses it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureRef {
    /// Index into the scene's textures.
    pub texture: u32,
}

impl Default for Material {
    /// White, rough, dielectric, opaque: glTF's default but for `metallic`, which is 0 here, and for emission from both sides.
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
