// Twin of src/kernel/lod.rs: levels of detail, and their codes in stored words.

const EMPTY_LOD: u32 = 0u;
const LOD_STEPS: f32 = 7.0;
const MAX_LOD: f32 = 62.0 * (1.0 / LOD_STEPS);
const COARSER_WIDTH: f32 = 0.25;

// Level of detail of a code.
fn lod_value(code: u32) -> f32 {
    return f32(code - 1u) * (1.0f / LOD_STEPS);
}
