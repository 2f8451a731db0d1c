//#use resize
// Uniforms of the passes that resample history.

// src/resize.rs, which documents the fields
struct Resize {
    size_px: vec2u,
    old_size_px: vec2u,
    ratio: vec2f,
    lod_shift: f32,
    unused: u32,
}

@group(0) @binding(0) var<uniform> resize: Resize;

// Position of a pixel's centre in the old view.
fn old_position_of(px: vec2u) -> vec2f {
    return vec2f(
        old_position(px.x, resize.ratio.x, resize.old_size_px.x),
        old_position(px.y, resize.ratio.y, resize.old_size_px.y),
    );
}

// Pixel of the old view that is nearest to a position.
fn nearest_to(position: vec2f) -> vec2u {
    return min(vec2u(position + 0.5), resize.old_size_px - 1u);
}
