// Twin of src/kernel/lattice.rs.

const LEAST_PLACE_EXPONENT: u32 = 40u;

// Weight of a pixel's candidate by the offset of its nearest sample in pixels: a power of two, 1 at the sample itself.
fn place_weight(offset_px: vec2f) -> f32 {
    let inverse = 1.0 + 8.0 * (offset_px.x * offset_px.x + offset_px.y * offset_px.y);
    let exponent = 4u * ((bitcast<u32>(inverse) >> 23u) - 127u);
    return bitcast<f32>((127u - min(exponent, LEAST_PLACE_EXPONENT)) << 23u);
}
