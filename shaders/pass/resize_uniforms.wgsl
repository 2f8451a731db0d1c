//#use resize
// Uniforms of the passes that resample history.

// src/gpu/resize.rs: ResizeUniforms, which documents the fields
struct ResizeUniforms {
    size: vec2<u32>,
    old_size: vec2<u32>,
    ratio: vec2<f32>,
    lod_shift: f32,
    unused: u32,
}

@group(0) @binding(0) var<uniform> resize: ResizeUniforms;

// Position of a pixel's centre in the old view.
fn old_position_of(px: vec2<u32>) -> vec2<f32> {
    return vec2<f32>(
        old_position(px.x, resize.ratio.x, resize.old_size.x),
        old_position(px.y, resize.ratio.y, resize.old_size.y),
    );
}

// Pixel of the old view that is nearest to a position.
fn nearest_to(position: vec2<f32>) -> vec2<u32> {
    return min(vec2<u32>(position + 0.5), resize.old_size - 1u);
}
