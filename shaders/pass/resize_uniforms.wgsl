//#use resize
// Uniforms of the passes that resample history.

// src/gpu/resize.rs: ResizeUniforms, which documents the fields
struct ResizeUniforms {
    size: vec2u,
    old_size: vec2u,
    ratio: vec2f,
    lod_shift: f32,
    unused: u32,
}

@group(0) @binding(0) var<uniform> resize: ResizeUniforms;

// Position of a pixel's centre in the old view.
fn old_position_of(px: vec2u) -> vec2f {
    return vec2f(
        old_position(px.x, resize.ratio.x, resize.old_size.x),
        old_position(px.y, resize.ratio.y, resize.old_size.y),
    );
}

// Pixel of the old view that is nearest to a position.
fn nearest_to(position: vec2f) -> vec2u {
    return min(vec2u(position + 0.5), resize.old_size - 1u);
}
