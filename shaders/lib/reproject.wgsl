//#use sanitize
// Twin of src/kernel/reproject.rs.

const MAX_MOTION_PX: f32 = 65536.0;

// reproject::Verdict
const VERDICT_VALID: u32 = 0u;
const VERDICT_RESET: u32 = 1u;
const VERDICT_BAD_MOTION: u32 = 2u;
const VERDICT_OFF_SCREEN: u32 = 3u;
const VERDICT_EMPTY: u32 = 4u;
const VERDICT_DISOCCLUDED: u32 = 5u;
const VERDICT_DISTRUSTED: u32 = 6u;
const VERDICT_COUNT: u32 = 7u;

// Position in the previous frame; `at` is (0, 0) unless the verdict is VERDICT_VALID.
struct Reprojection {
    verdict: u32,
    at: vec2<u32>,
}

// reproject::nearest
fn nearest(x: u32, y: u32, motion: vec2<f32>, size: vec2<u32>) -> Reprojection {
    // Bits of sizes are ordered as the sizes are, infinity and NaN last.
    let size_bits = bitcast<vec2<u32>>(motion) & vec2<u32>(0x7fffffffu);
    if max(size_bits.x, size_bits.y) > bitcast<u32>(MAX_MOTION_PX) {
        return Reprojection(VERDICT_BAD_MOTION, vec2<u32>(0u));
    }
    let qx = floor(f32(x) + motion.x + 0.5);
    let qy = floor(f32(y) + motion.y + 0.5);
    if qx >= 0.0 && qy >= 0.0 && qx < f32(size.x) && qy < f32(size.y) {
        return Reprojection(VERDICT_VALID, vec2<u32>(u32(qx), u32(qy)));
    }
    return Reprojection(VERDICT_OFF_SCREEN, vec2<u32>(0u));
}
