//#use surface
// Twin of src/kernel/resample.rs.

const TAP_RELATIVE: f32 = 0.1;
const STAND_IN_WEIGHT: f32 = 0.1;
const TAPS: u32 = 12u;

// resample::tap_at
fn tap_at(tap: u32) -> vec2<u32> {
    return vec2<u32>(((tap + 2u) & 3u) + select(0u, 1u, tap >= 10u) - select(0u, 1u, tap < 2u), (tap + 2u) >> 2u);
}

// resample::second_corner
fn second_corner(fraction: vec2<f32>) -> u32 {
    let nearest = select(0u, 1u, fraction.x >= 0.5) + 2u * select(0u, 1u, fraction.y >= 0.5);
    let along_x = abs(fraction.x - 0.5) <= abs(fraction.y - 0.5);
    return nearest ^ select(2u, 1u, along_x);
}

// resample::corner_weight
fn corner_weight(corner: u32, fraction: vec2<f32>) -> f32 {
    let x = select(1.0 - fraction.x, fraction.x, (corner & 1u) == 1u);
    let y = select(1.0 - fraction.y, fraction.y, corner >= 2u);
    return x * y;
}

// resample::catmull_rom
fn catmull_rom(t: f32) -> vec4<f32> {
    let t2 = t * t;
    return vec4<f32>(
        ((1.0 - 0.5 * t) * t - 0.5) * t,
        (1.5 * t - 2.5) * t2 + 1.0,
        ((2.0 - 1.5 * t) * t + 0.5) * t,
        (0.5 * t - 0.5) * t2,
    );
}

// resample::linear_weights
fn linear_weights(t: f32) -> vec4<f32> {
    return vec4<f32>(0.0, 1.0 - t, t, 0.0);
}

struct Gathered {
    sharp: vec3<f32>,
    sharp_sum: f32,
    smooth_color: vec3<f32>,
    smooth_sum: f32,
    lod: f32,
    missing: u32,
}

// resample::gather
fn gather(g: Gathered, tap: Surface, same: bool, sharp: f32, linear: f32) -> Gathered {
    if !same {
        return Gathered(g.sharp, g.sharp_sum, g.smooth_color, g.smooth_sum, g.lod, g.missing + 1u);
    }
    return Gathered(
        g.sharp + tap.color * sharp,
        g.sharp_sum + sharp,
        g.smooth_color + tap.color * linear,
        g.smooth_sum + linear,
        g.lod + tap.lod * linear,
        g.missing,
    );
}

struct Resampled {
    sharp: vec3<f32>,
    smooth_color: vec3<f32>,
    lod: f32,
}

// resample::resolve
fn resolve(g: Gathered, nearest: Surface) -> Resampled {
    if g.smooth_sum < 0.01 {
        return Resampled(nearest.color, nearest.color, nearest.lod);
    }
    let inverse = 1.0 / g.smooth_sum;
    let smooth_color = g.smooth_color * inverse;
    let sharp = select(smooth_color, max(g.sharp * (1.0 / g.sharp_sum), vec3<f32>(0.0)), g.missing == 0u);
    return Resampled(sharp, smooth_color, g.lod * inverse);
}
