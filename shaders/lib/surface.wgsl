//#use lod
//#use pack
// Twin of src/kernel/surface.rs, which documents the layout.

const EMPTY_SURFACE: vec2u = vec2u(0u, 0xffff0000u);
const MAX_FLOAT14: f32 = 65472.0;

// A negative `lod` marks an empty texel.
struct Surface {
    color: vec3f,
    lod: f32,
    disparity: f32,
}

// 14-bit float nearest to `x` (ties to even), at most `MAX_FLOAT14`: 5 bits of exponent and 9 of mantissa, without
// sign, infinity and NaN.
fn float14_bits(x: f32) -> u32 {
    let a = bitcast<u32>(select(0.0, min(x, MAX_FLOAT14), x > 0.0));
    let small = bitcast<u32>(bitcast<f32>(a) + 0.5) - bitcast<u32>(0.5f);
    let rounded = (a - (111u << 23u) + 0x1fffu + ((a >> 14u) & 1u)) >> 14u;
    return select(rounded, small, a < (112u << 23u));
}

// Value of a 14-bit float, which is a half, too.
fn float14_value(code: u32) -> f32 {
    let normal = bitcast<f32>((code << 14u) + (111u << 23u));
    return min(normal, 2.0 * normal - 0x1p-15);
}

// Packs a sample.
fn pack_surface(s: Surface) -> vec2u {
    var lod = EMPTY_LOD;
    if s.lod >= 0.0 {
        lod = u32(min(s.lod, MAX_LOD) * LOD_STEPS + 1.5);
    }
    let words = vec2u(
        float14_bits(s.color.x) | (float14_bits(s.color.y) << 14u) | (lod << 28u),
        float14_bits(s.color.z) | ((lod >> 4u) << 14u) | (disparity_code(s.disparity) << 16u),
    );
    return select(words, EMPTY_SURFACE, lod == EMPTY_LOD);
}

// Code of the level of detail; `EMPTY_LOD` for an empty texel.
fn lod_code(words: vec2u) -> u32 {
    return (words.x >> 28u) | ((words.y >> 10u) & 0x30u);
}

// Color of a sample.
fn surface_color(words: vec2u) -> vec3f {
    return vec3f(
        float14_value(words.x & 0x3fffu),
        float14_value((words.x >> 14u) & 0x3fffu),
        float14_value(words.y & 0x3fffu),
    );
}

// Unpacks a sample.
fn unpack_surface(words: vec2u) -> Surface {
    let code = lod_code(words);
    let is_empty = code == EMPTY_LOD;
    return Surface(
        select(surface_color(words), vec3f(0.0), is_empty),
        select(lod_value(code), -1.0, is_empty),
        select(disparity_value(words.y >> 16u), -1.0, is_empty),
    );
}

// Texel of level 0 of the mip chain: the color and a coverage of 1; zeros for an empty texel.
fn mip_texel(words: vec2u) -> vec4f {
    let s = unpack_surface(words);
    if s.lod < 0.0 {
        return vec4f(0.0);
    }
    return vec4f(s.color, 1.0);
}

// Rounds a texel of the mip chain to halves before it is stored, so that rounding is the same on every device.
fn round_mip(v: vec4f) -> vec4f {
    return vec4f(
        half_value(half_bits(v.x)),
        half_value(half_bits(v.y)),
        half_value(half_bits(v.z)),
        half_value(half_bits(v.w)),
    );
}
