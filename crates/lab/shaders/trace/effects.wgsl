// What is compiled in: trace::effects::Effect. With MOVES and ALPHA of `traverse` and LOBE_* of `bsdf` all of them.

override EFFECT_ANISOTROPY: bool = true;
override EFFECT_CLEARCOAT: bool = true;
override EFFECT_SHEEN: bool = true;
override EFFECT_DIELECTRIC: bool = true;
override EFFECT_TRANSMISSION: bool = true;
override EFFECT_BASE_COLOR: bool = true;
override EFFECT_SURFACE_TEXTURE: bool = true;
override EFFECT_NORMAL_MAP: bool = true;
override EFFECT_EMISSIVE_TEXTURE: bool = true;
override EFFECT_EMISSIVE_TRIANGLES: bool = true;
override EFFECT_PUNCTUAL_LIGHTS: bool = true;
override EFFECT_ENVIRONMENT: bool = true;
override EFFECT_ENVIRONMENT_MAP: bool = true;

// The thesis' model of scattering in place of the principled one.
override PHONG: bool = false;
