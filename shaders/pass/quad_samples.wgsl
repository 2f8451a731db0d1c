//#use inputs
//#use quads
//#use sparse_smr
// Shaded quads and their samples. CPU twin: src/cpu/sparse_pass/quad_samples.rs.

// Bit 0: whether a quad is shaded; bits 1 and 2: its region.
@group(0) @binding(27) var quad_mask: texture_2d_array<u32>;
@group(0) @binding(28) var quad_around: texture_2d_array<u32>;

fn mask_at(px: vec2u, view: u32) -> u32 {
    return textureLoad(quad_mask, px >> vec2u(1u), view, 0).x;
}

// log2 of the distance of the pattern's quads in pixels, where a pixel lies; 0 in the fovea.
fn level_of(mask_word: u32) -> u32 {
    let region_now = (mask_word >> 1u) & 3u;
    return select(u32(select(frame.lod_far, frame.lod_mid, region_now == IN_MIDDLE)), 0u, region_now == IN_FOVEA);
}

// Code of neighbour `i` of a quad: words of `quad_around`.
fn code_of(around: vec2u, i: u32) -> u32 {
    return (select(around.x, around.y, i >= 4u) >> (8u * (i & 3u))) & 255u;
}

// Pixel `i` of a quad.
fn px_of_quad(quad: vec2u, i: u32) -> vec2u {
    return 2u * quad + vec2u(i & 1u, i >> 1u);
}
