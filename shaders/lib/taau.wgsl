//#use taa
// Twin of src/kernel/taau.rs, which explains the constants.

const TAIL: f32 = 0.02;
const LEAST_TAIL: f32 = 0.02;
const TAIL_UNTIL: f32 = 0.5;
const LEAST_SAMPLE_WEIGHT: f32 = 1e-5;
const UPSAMPLED_SPREAD: f32 = 1.0;
const NARROWING: f32 = 0.4;
const UPSAMPLED_BOX_SIGMAS: vec2f = vec2f(1.5, 5.0);
const LEAST_CLIP: f32 = 0.1;
const CLIP_COST: f32 = 10.0;

// Weight of a sample at a squared distance, in units of the kernel's reach: the main lobe of Lanczos 2, as FSR2
// approximates it.
fn lobe(squared: f32) -> f32 {
    let b = 1.0 - 0.25 * squared;
    return (max(1.0 - squared, 0.0) * b) * (b * b);
}

// Weight of interpolation between samples, for history of a confidence.
fn tail(confidence: f32) -> f32 {
    let unknown = clamp(1.0 - confidence * (1.0f / TAIL_UNTIL), 0.0, 1.0);
    return (unknown * (1.0f - LEAST_TAIL) + LEAST_TAIL) * TAIL;
}

// Factor on squared distances of a pixel's own samples, for history of a confidence.
fn narrowing(confidence: f32) -> f32 {
    return settled(confidence) * NARROWING + 1.0;
}

// Two weights of a sample: its weight as one of the pixel's own samples, and the sum of this weight and its weight for
// interpolation.
fn sample_weights(offset_px: vec2f, interpolation: f32, narrowed: f32) -> vec2f {
    let px2 = offset_px.x * offset_px.x + offset_px.y * offset_px.y;
    let own = lobe(px2 * narrowed);
    return vec2f(own, own + lobe(px2) * interpolation);
}

struct SamplesAround {
    difference: vec3f,
    weights: vec2f,
    sum: vec3f,
    squares: vec3f,
    count: f32,
}

// The sums after one more sample.
fn add_around(a: SamplesAround, centre: vec3f, sampled: vec3f, weights: vec2f) -> SamplesAround {
    let v = to_ycocg(sampled);
    return SamplesAround(
        a.difference + (sampled - centre) * weights.y,
        a.weights + weights,
        a.sum + v,
        a.squares + v * v,
        a.count + 1.0,
    );
}

// Color of the samples at the pixel.
fn upsampled(a: SamplesAround, centre: vec3f) -> vec3f {
    return centre + a.difference * (1.0 / a.weights.y);
}

struct Accumulated {
    color: vec3f,
    confidence: f32,
    share: f32,
    kept: f32,
}

// Blends this frame's samples with history, which is clipped to their distribution.
fn accumulate(a: SamplesAround, centre: vec3f, history: vec3f, confidence: f32, trusted: f32) -> Accumulated {
    let inverse = 1.0 / a.count;
    let variance = (a.squares * a.count - a.sum * a.sum) * (inverse * inverse);
    let past = to_ycocg(history);
    let sigmas = box_sigmas(UPSAMPLED_BOX_SIGMAS.x, UPSAMPLED_BOX_SIGMAS.y, confidence);
    let extent = roots(variance) * sigmas + vec3f(ROUNDING);
    let inside = clip_to_box(past, a.sum * inverse, extent);
    let strength = min(a.weights.x, 1.0) * (1.0f - LEAST_CLIP) + LEAST_CLIP;
    let clip = inside - past;
    let moved = max(max(abs(clip.x), abs(clip.y)), abs(clip.z));
    let kept = 1.0 - min(moved * CLIP_COST / max(past.x, 1.0), 1.0) * strength;
    let clipped = roots_of_ycocg(past + clip * strength);
    let share = max(a.weights.y / (confidence * kept + a.weights.y), 1.0 - trusted);
    let shown = clipped + (roots(upsampled(a, centre)) - clipped) * share;
    return Accumulated(shown * shown, a.weights.y / share, share, kept);
}
