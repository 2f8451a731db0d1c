// Effects that are compiled in: trace::effects::Effect. MOVES and ALPHA in `traverse` and LOBE_* in `layers` complete
// the set.

override EFFECT_ANISOTROPY: bool = true;
override EFFECT_CLEARCOAT: bool = true;
override EFFECT_SHEEN: bool = true;
override EFFECT_DIELECTRIC: bool = true;
override EFFECT_TRANSMISSION: bool = true;
override EFFECT_BASE_COLOR: bool = true;
override EFFECT_SURFACE_TEXTURE: bool = true;
override EFFECT_NORMAL_MAP: bool = true;
override EFFECT_EMISSIVE_TEXTURE: bool = true;
override EFFECT_TEXTURE_COORDINATES: bool = true;
override EFFECT_EMISSIVE_TRIANGLES: bool = true;
override EFFECT_PUNCTUAL_LIGHTS: bool = true;
override EFFECT_ENVIRONMENT: bool = true;
override EFFECT_ENVIRONMENT_MAP: bool = true;

// Use the thesis' Phong model instead of the principled BSDF.
override PHONG: bool = false;
