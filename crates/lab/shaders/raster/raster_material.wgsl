//#use raster_frame
// Group 1: a material in the tracer's layout, and its textures, white by default.

override BASE_COLOR_TEXTURE: bool = true;
// Whether textures transform texture coordinates.
override TEXTURE_COORDINATES: bool = true;

const NO_TEXTURE: u32 = 0xffffffffu;
const FLAG_MASK: u32 = 1u;
const FLAG_BLEND: u32 = 2u;
const FLAG_DOUBLE_SIDED: u32 = 4u;
const FLAG_VOLUME: u32 = 8u;

// MaterialRecord in src/scene/shading_records.rs, the index in its unused part, and the coordinates of the textures.
struct RasterMaterial {
    base_color: vec3f,
    opacity: f32,
    emissive: vec3f,
    cutoff: f32,
    metallic: f32,
    roughness: f32,
    specular: f32,
    ior: f32,
    specular_color: vec3f,
    specular_tint: f32,
    sheen_color: vec3f,
    sheen_roughness: f32,
    anisotropy: f32,
    clearcoat: f32,
    clearcoat_roughness: f32,
    transmission: f32,
    absorption: vec3f,
    normal_scale: f32,
    phong_specular: vec3f,
    phong_exponent: f32,
    flags: u32,
    sheen_tint: f32,
    base_color_texture: u32,
    metallic_roughness_texture: u32,
    normal_texture: u32,
    emissive_texture: u32,
    specular_texture: u32,
    specular_color_texture: u32,
    clearcoat_texture: u32,
    clearcoat_roughness_texture: u32,
    sheen_color_texture: u32,
    sheen_roughness_texture: u32,
    transmission_texture: u32,
    phong_diffuse: f32,
    // Place among the scene's materials.
    index: f32,
    unused: f32,
    // Of each texture, in the order of their bindings: rows of the transform; the fourth element of the first row is 1
    // for the second texture coordinates.
    coordinates: array<array<vec4f, 2>, 11>,
}

@group(1) @binding(0) var<storage, read> material: RasterMaterial;
@group(1) @binding(1) var base_color_map: texture_2d<f32>;
@group(1) @binding(2) var base_color_sampler: sampler;
@group(1) @binding(3) var metallic_roughness_map: texture_2d<f32>;
@group(1) @binding(4) var metallic_roughness_sampler: sampler;
@group(1) @binding(5) var normal_map: texture_2d<f32>;
@group(1) @binding(6) var normal_sampler: sampler;
@group(1) @binding(7) var emissive_map: texture_2d<f32>;
@group(1) @binding(8) var emissive_sampler: sampler;
@group(1) @binding(9) var specular_map: texture_2d<f32>;
@group(1) @binding(10) var specular_color_map: texture_2d<f32>;
@group(1) @binding(11) var clearcoat_map: texture_2d<f32>;
@group(1) @binding(12) var clearcoat_roughness_map: texture_2d<f32>;
@group(1) @binding(13) var sheen_color_map: texture_2d<f32>;
@group(1) @binding(14) var sheen_roughness_map: texture_2d<f32>;
@group(1) @binding(15) var transmission_map: texture_2d<f32>;

// Texture coordinates of the texture of slot `slot`.
fn uv_of(slot: u32, uvs: vec4f) -> vec2f {
    if !TEXTURE_COORDINATES {
        return uvs.xy;
    }
    let r0 = material.coordinates[slot][0];
    let r1 = material.coordinates[slot][1];
    let uv = select(uvs.xy, uvs.zw, r0.w != 0.0);
    return vec2f((r0.x * uv.x + r0.z) + r0.y * uv.y, (r1.x * uv.x + r1.z) + r1.y * uv.y);
}

// Base color and opacity.
fn base_at(uvs: vec4f, color: vec4f) -> vec4f {
    var base = vec4f(material.base_color, material.opacity) * color;
    if BASE_COLOR_TEXTURE {
        base *= textureSampleBias(base_color_map, base_color_sampler, uv_of(0u, uvs), frame.texture_bias);
    }
    return base;
}

// Interpolated colors of vertices may round below the value that all of them have; less than a step of 8 bits.
const ALPHA_ROUNDING: f32 = 0x1p-11;

// Alpha test: cutoff for MASK, more than half opaque for BLEND.
fn passes_alpha_test(opacity: f32) -> bool {
    if (material.flags & FLAG_MASK) != 0u {
        return opacity >= material.cutoff - ALPHA_ROUNDING;
    }
    return (material.flags & FLAG_BLEND) == 0u || opacity > 0.5;
}
