//#use matched
// Twin of src/kernel/taa.rs, which explains the constants.

const ALPHA_STILL: f32 = 0.1;
const ALPHA_RESAMPLED: f32 = 0.4;
const BOX_SIGMAS: f32 = 2.0;

// taa::to_ycocg
fn to_ycocg(c: vec3<f32>) -> vec3<f32> {
    let r = roots(c);
    let outer = 0.25 * (r.x + r.z);
    let inner = 0.5 * r.y;
    return vec3<f32>(outer + inner, 0.5 * (r.x - r.z), inner - outer);
}

// taa::roots_of_ycocg
fn roots_of_ycocg(y: vec3<f32>) -> vec3<f32> {
    let outer = y.x - y.z;
    return max(vec3<f32>(outer + y.y, y.x + y.z, outer - y.y), vec3<f32>(0.0));
}

// taa::clip_to_box
fn clip_to_box(history: vec3<f32>, mean: vec3<f32>, extent: vec3<f32>) -> vec3<f32> {
    let d = history - mean;
    let ratio = extent / max(abs(d), vec3<f32>(1e-6));
    let inside = min(min(ratio.x, ratio.y), ratio.z);
    if inside < 1.0 {
        return mean + d * inside;
    }
    return history;
}

// taa::candidate_share
fn candidate_share(fraction: vec2<f32>, trust: f32) -> f32 {
    let x = 4.0 * (fraction.x * (1.0 - fraction.x));
    let y = 4.0 * (fraction.y * (1.0 - fraction.y));
    let resampled = ALPHA_STILL + (ALPHA_RESAMPLED - ALPHA_STILL) * max(x, y);
    return max(resampled, 1.0 - trust);
}

// taa::blend_clipped
fn blend_clipped(
    candidate: vec3<f32>,
    history: vec3<f32>,
    sum: vec3<f32>,
    squares: vec3<f32>,
    alpha: f32,
) -> vec3<f32> {
    let mean = sum * (1.0f / 9.0f);
    let variance = (squares * 9.0 - sum * sum) * (1.0f / 81.0f);
    let clipped = roots_of_ycocg(clip_to_box(to_ycocg(history), mean, roots(variance) * BOX_SIGMAS));
    let shown = clipped + (roots(candidate) - clipped) * alpha;
    return shown * shown;
}
