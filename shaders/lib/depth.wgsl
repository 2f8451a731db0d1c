// Twin of src/kernel/depth.rs.

const INVALID_DISPARITY: f32 = -1.0;

// Bits of DisparityMap.flags: `invert` and `clamp` of the Rust struct.
const DISPARITY_INVERT: u32 = 1u;
const DISPARITY_CLAMP: u32 = 2u;

struct DisparityMap {
    a: f32,
    b: f32,
    flags: u32,
}

// Disparity of a stored depth value, at least 0; 0 for infinite distance.
fn disparity(stored: f32, map: DisparityMap) -> f32 {
    if (bitcast<u32>(stored) & 0x7fffffffu) > 0x7f800000u {
        return INVALID_DISPARITY;
    }
    let value = select(stored, clamp(stored, 0.0, 1.0), (map.flags & DISPARITY_CLAMP) != 0u);
    let v = map.a * value + map.b;
    if (map.flags & DISPARITY_INVERT) == 0u {
        return select(0.0, v, v > 0.0);
    }
    if v < 1e-30 {
        return INVALID_DISPARITY;
    }
    if v > 1e30 {
        return 0.0;
    }
    return 1.0 / v;
}

// z_previous = z * stretch + shift
fn previous_disparity(disparity: f32, stretch: f32, shift: f32) -> f32 {
    if disparity < 0.0 {
        return INVALID_DISPARITY;
    }
    let denominator = stretch + shift * disparity;
    if denominator <= 1e-6 {
        return INVALID_DISPARITY;
    }
    return disparity / denominator;
}

// Whether disparities differ by at most `relative` of the larger one plus `slope`, by which the surface itself may
// change.
fn same_surface(expected: f32, stored: f32, relative: f32, slope: f32) -> bool {
    if expected < 0.0 || stored < 0.0 {
        return false;
    }
    return abs(expected - stored) <= relative * max(expected, stored) + slope;
}

// INVALID_DISPARITY for a neighbour outside the image. depth::slope, which reads the neighbours, is a loop in the pass.
fn one_sided_slope(center: f32, before: f32, after: f32) -> f32 {
    let back = center - before;
    let ahead = after - center;
    if before >= 0.0 && after >= 0.0 {
        return select(0.0, min(abs(back), abs(ahead)), back * ahead > 0.0);
    }
    if before >= 0.0 {
        return abs(back);
    }
    if after >= 0.0 {
        return abs(ahead);
    }
    return 0.0;
}
