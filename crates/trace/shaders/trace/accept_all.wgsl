// Accepts every hit: for scenes without alpha modes MASK and BLEND.

fn accept_hit(triangle: u32, u: f32, v: f32, key: u32) -> bool {
    return true;
}
