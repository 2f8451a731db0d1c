//#use depth
//#use sanitize
// Twin of src/kernel/lattice.rs.

const LEAST_WEIGHT: f32 = 1.0 / 65536.0;
const LEAST_PLACE_EXPONENT: u32 = 40u;

struct Between {
    points: vec2u,
    fraction: f32,
}

fn between(px: u32, first: u32, level: u32, count: u32) -> Between {
    // The shift of a signed number rounds down.
    let offset = i32(px) - i32(first);
    let low = offset >> level;
    let fraction = f32(offset - (low << level)) * bitcast<f32>((127u - level) << 23u);
    let points = clamp(vec2i(low, low + 1), vec2i(0), vec2i(i32(count) - 1));
    return Between(vec2u(points), fraction);
}

fn nearest_point(px: u32, first: u32, level: u32) -> i32 {
    // The shift of a signed number rounds down.
    return (i32(px) - i32(first) + ((1i << level) >> 1u)) >> level;
}

fn point_offset_px(px: u32, first: u32, level: u32, point: i32) -> f32 {
    return f32((point << level) - (i32(px) - i32(first)));
}

fn place_weight(offset_px: vec2f) -> f32 {
    let inverse = 1.0 + 8.0 * (offset_px.x * offset_px.x + offset_px.y * offset_px.y);
    let exponent = 4u * ((bitcast<u32>(inverse) >> 23u) - 127u);
    return bitcast<f32>((127u - min(exponent, LEAST_PLACE_EXPONENT)) << 23u);
}

fn point_weight(fraction: f32, point: u32) -> f32 {
    return select(fraction, 1.0 - fraction, point == 0u);
}

struct SampleMean {
    sum: vec4f,
    weight: f32,
}

fn add_sample(mean: SampleMean, sampled: vec4f, usable: bool, sample_weight: f32) -> SampleMean {
    if !usable {
        return mean;
    }
    return SampleMean(mean.sum + sampled * sample_weight, mean.weight + sample_weight);
}

fn sample_mean(mean: SampleMean) -> vec4f {
    return mean.sum * (1.0 / max(mean.weight, LEAST_WEIGHT));
}

const GEOMETRY_RELATIVE: f32 = 0.35;

struct GeometryMean {
    disparity: f32,
    motion: vec2f,
    weight: f32,
}

fn add_geometry(mean: GeometryMean, own: f32, disparity: f32, motion: vec2f, sample_weight: f32) -> GeometryMean {
    let usable = is_finite(motion.x) && is_finite(motion.y);
    if sample_weight == 0.0 || !usable || !same_surface(own, disparity, GEOMETRY_RELATIVE, 0.0) {
        return mean;
    }
    return GeometryMean(
        mean.disparity + disparity * sample_weight,
        mean.motion + motion * sample_weight,
        mean.weight + sample_weight,
    );
}

fn filled_geometry(mean: GeometryMean, own: f32, own_motion: vec2f) -> vec3f {
    if mean.weight == 0.0 {
        return vec3f(distance_of(own), own_motion);
    }
    let inverse = 1.0 / mean.weight;
    return vec3f(distance_of(mean.disparity * inverse), mean.motion * inverse);
}
