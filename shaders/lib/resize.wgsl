//#use surface
// Twin of src/kernel/resize.rs.

fn old_position(x: u32, ratio: f32, old_len: u32) -> f32 {
    return clamp((f32(x) + 0.5) * ratio - 0.5, 0.0, f32(old_len - 1u));
}

fn resized_lod(lod: f32, shift: f32) -> f32 {
    return clamp(lod + shift, 0.0, MAX_LOD);
}
