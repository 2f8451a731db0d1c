//#use lod
// Twin of src/kernel/resize.rs.

// Position, in a row or column of `old_len` pixels, of pixel `x` of a row or column of the new length.
fn old_position(x: u32, ratio: f32, old_len: u32) -> f32 {
    return clamp((f32(x) + 0.5) * ratio - 0.5, 0.0, f32(old_len - 1u));
}

// Level of detail after resizing: log2 of the block edge in new pixels.
fn resized_lod(lod: f32, shift: f32) -> f32 {
    return clamp(lod + shift, 0.0, MAX_LOD);
}
