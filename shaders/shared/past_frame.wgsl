//#use inputs
// Whether the frame has history: whether the stored textures are those of the previous frame. They are not if that
// frame never ran, because its encoder was dropped. src/gpu/history.rs writes the number; the CPU has no twin, because
// it processes a frame at once.

// Number of the frame that wrote the stored textures.
@group(0) @binding(14) var<uniform> stored_frame: u32;

fn has_history() -> bool {
    return stored_frame == frame.past_frame;
}

// Texel of history that is nearest to the previous position of a pixel's surface, or the verdict that rejects history
// whatever it holds. CPU twin: Inputs::nearest in src/cpu/inputs.rs.
fn reprojected(px: vec2u, view: u32, motion: vec2f) -> Reprojection {
    if !has_history() {
        return Reprojection(VERDICT_RESET, vec2u(0u));
    }
    return nearest(px.x, px.y, motion, frame.size);
}
