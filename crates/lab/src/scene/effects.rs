//! Rendering effects that a scene needs; kernels are compiled with only those.
//!
//! An effect that is left out costs nothing, because its code is not compiled. It is safe to leave it out, because a
//! kernel with more effects than the scene needs gives the same image, bit for bit: unused parameters are exact zeros
//! and ones, and every random number belongs to a purpose, not to a place in a sequence.

use super::{Alpha, Coordinates, Environment, Material, PunctualLight, Scene};

macro_rules! effects {
    ($($name:ident $text:literal $reason:literal,)*) => {
        /// A rendering feature that can be compiled in or left out.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[repr(u32)]
        pub enum Effect {
            $(#[doc = concat!("`", $text, "`: ", $reason, ".")] $name,)*
        }

        impl Effect {
            /// All effects.
            pub const ALL: &[Self] = &[$(Self::$name,)*];

            /// Name in commands and reports, such as `base-color`.
            pub fn name(self) -> &'static str {
                match self { $(Self::$name => $text,)* }
            }

            /// The scene feature that needs this effect.
            pub fn reason(self) -> &'static str {
                match self { $(Self::$name => $reason,)* }
            }
        }
    };
}

effects! {
    Dielectric "dielectric" "a material with dielectric reflection",
    Metal "metal" "a metallic material",
    Anisotropy "anisotropy" "a material with anisotropic highlights",
    Clearcoat "clearcoat" "a material with a clear coat",
    Sheen "sheen" "a material with sheen",
    Transmission "transmission" "a material that transmits light, and may absorb it",
    BaseColor "base-color" "a base color from a texture or vertex colors",
    SurfaceTexture "surface-texture" "metallic, roughness or a layer's strength from a texture",
    NormalMap "normal-map" "a normal map",
    EmissiveTexture "emissive-texture" "an emissive texture",
    TextureCoordinates "texture-coordinates" "textures of one material with different texture coordinates",
    Alpha "alpha" "an alpha-tested or partly transparent surface",
    EmissiveTriangles "emissive-triangles" "a surface that emits light",
    PunctualLights "punctual-lights" "a point, spot or directional light",
    Environment "environment" "an environment that emits light",
    EnvironmentMap "environment-map" "an environment map",
    MovingObjects "moving-objects" "moving triangles",
}

/// A set of effects.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Effects(u32);

impl Effects {
    /// The empty set.
    pub const NONE: Self = Self(0);

    /// The set of all effects.
    pub fn all() -> Self {
        Effect::ALL.iter().copied().collect()
    }

    /// Whether `effect` is in the set.
    pub fn has(self, effect: Effect) -> bool {
        self.0 >> effect as u32 & 1 != 0
    }

    /// Whether the set contains all of `other`.
    pub fn covers(self, other: Self) -> bool {
        other.0 & !self.0 == 0
    }

    /// Effects in either set.
    pub fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Effects of this set that are not in `other`.
    pub fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// The set with `effect` added (`on`) or removed.
    pub fn set(self, effect: Effect, on: bool) -> Self {
        let bit = 1 << effect as u32;
        Self(if on { self.0 | bit } else { self.0 & !bit })
    }

    /// Effects in the set, in the order of [`Effect::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Effect> {
        Effect::ALL.iter().copied().filter(move |e| self.has(*e))
    }

    /// Override values that say which lobes shaders of the BSDF contain.
    pub fn lobe_constants(self) -> impl Iterator<Item = (&'static str, f64)> {
        let lobes = [
            ("LOBE_RETRO", Effect::Dielectric),
            ("LOBE_SPECULAR", Effect::Dielectric),
            ("LOBE_METAL", Effect::Metal),
            ("LOBE_ANISOTROPY", Effect::Anisotropy),
            ("LOBE_CLEARCOAT", Effect::Clearcoat),
            ("LOBE_SHEEN", Effect::Sheen),
            ("LOBE_TRANSMISSION", Effect::Transmission),
        ];
        lobes.into_iter().map(move |(name, effect)| (name, f64::from(u8::from(self.has(effect)))))
    }

    /// Whether the scene has light of its own.
    pub fn has_light(self) -> bool {
        [Effect::EmissiveTriangles, Effect::PunctualLights, Effect::Environment].into_iter().any(|e| self.has(e))
    }

    /// Effects that `scene` needs in any pose.
    pub fn needed(scene: &Scene) -> Self {
        let rest = scene.pose(0.0);
        let mut used = vec![false; scene.materials.len()];
        for &m in scene.still().materials.iter().chain(&rest.moving.materials) {
            used[m as usize] = true;
        }
        let materials = scene.materials.iter().zip(&used).filter(|(_, used)| **used);
        let colored = scene.still().colors.iter().chain(&rest.moving.colors).flatten().any(|c| *c != glam::Vec4::ONE);
        materials
            .map(|(m, _)| Self::of_material(m))
            .fold(Self::NONE, Self::union)
            .union(if colored { Self::NONE.set(Effect::BaseColor, true) } else { Self::NONE })
            .union(Self::of_light(&rest.lights, &scene.environment))
            .set(Effect::MovingObjects, !rest.moving.is_empty())
            .set(Effect::TextureCoordinates, scene.textures.iter().any(|t| t.coordinates != Coordinates::default()))
    }

    fn of_material(m: &Material) -> Self {
        let surface_textures = [
            m.metallic_roughness_texture,
            m.specular_texture,
            m.specular_color_texture,
            m.clearcoat_texture,
            m.clearcoat_roughness_texture,
            m.sheen_color_texture,
            m.sheen_roughness_texture,
            m.transmission_texture,
        ];
        let emits = m.emissive != [0.0; 3];
        Self::NONE
            .set(Effect::Dielectric, m.metallic < 1.0 && m.specular > 0.0 || m.metallic_roughness_texture.is_some())
            .set(Effect::Metal, m.metallic > 0.0)
            .set(Effect::Anisotropy, m.anisotropy > 0.0)
            .set(Effect::Clearcoat, m.clearcoat > 0.0)
            .set(Effect::Sheen, m.sheen_color != [0.0; 3])
            .set(Effect::Transmission, m.transmission > 0.0)
            .set(Effect::BaseColor, m.base_color_texture.is_some())
            .set(Effect::SurfaceTexture, surface_textures.iter().any(Option::is_some))
            .set(Effect::NormalMap, m.normal_texture.is_some())
            .set(Effect::EmissiveTexture, emits && m.emissive_texture.is_some())
            .set(Effect::Alpha, m.alpha != Alpha::Opaque)
            .set(Effect::EmissiveTriangles, emits)
    }

    fn of_light(lights: &[PunctualLight], environment: &Environment) -> Self {
        let map = matches!(environment, Environment::Map(_));
        Self::NONE
            .set(Effect::PunctualLights, !lights.is_empty())
            .set(Effect::EnvironmentMap, map)
            .set(Effect::Environment, map || *environment != Environment::Constant([0.0; 3]))
    }
}

impl FromIterator<Effect> for Effects {
    fn from_iter<I: IntoIterator<Item = Effect>>(effects: I) -> Self {
        effects.into_iter().fold(Self::NONE, |set, e| set.set(e, true))
    }
}
