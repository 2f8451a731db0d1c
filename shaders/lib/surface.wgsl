//#use pack
// Twin of src/kernel/surface.rs, which documents the layout.

const EMPTY_LOD: u32 = 63u;
const LOD_STEPS: f32 = 7.0;
const MAX_LOD: f32 = 62.0f / LOD_STEPS;

// A negative `lod` marks an empty texel.
struct Surface {
    color: vec3<f32>,
    lod: f32,
    disparity: f32,
}

// surface::half14_bits
fn half14_bits(x: f32) -> u32 {
    let h = half_bits(select(0.0, x, x > 0.0));
    return min((h + ((h >> 1u) & 1u)) >> 1u, 0x3dffu);
}

// surface::half14_value
fn half14_value(bits: u32) -> f32 {
    return half_value((bits & 0x3fffu) << 1u);
}

// surface::pack_surface
fn pack_surface(s: Surface) -> vec2<u32> {
    var lod = EMPTY_LOD;
    if s.lod >= 0.0 {
        lod = u32(min(s.lod, MAX_LOD) * LOD_STEPS + 0.5);
    }
    return vec2<u32>(
        half14_bits(s.color.x) | (half14_bits(s.color.y) << 14u) | (lod << 28u),
        half14_bits(s.color.z) | ((lod >> 4u) << 14u) | (disparity_code(s.disparity) << 16u),
    );
}

// surface::unpack_surface
fn unpack_surface(words: vec2<u32>) -> Surface {
    let lod = (words.x >> 28u) | (((words.y >> 14u) & 3u) << 4u);
    if lod == EMPTY_LOD {
        return Surface(vec3<f32>(0.0), -1.0, -1.0);
    }
    let color = vec3<f32>(
        half14_value(min(words.x & 0x3fffu, 0x3dffu)),
        half14_value(min((words.x >> 14u) & 0x3fffu, 0x3dffu)),
        half14_value(min(words.y & 0x3fffu, 0x3dffu)),
    );
    return Surface(color, f32(lod) / LOD_STEPS, disparity_value(words.y >> 16u));
}

// surface::mip_texel
fn mip_texel(words: vec2<u32>) -> vec4<f32> {
    let s = unpack_surface(words);
    if s.lod < 0.0 {
        return vec4<f32>(0.0);
    }
    return vec4<f32>(s.color, 1.0);
}

// surface::round_mip
fn round_mip(v: vec4<f32>) -> vec4<f32> {
    return vec4<f32>(
        half_value(half_bits(v.x)),
        half_value(half_bits(v.y)),
        half_value(half_bits(v.z)),
        half_value(half_bits(v.w)),
    );
}
