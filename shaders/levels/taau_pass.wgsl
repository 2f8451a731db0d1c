//#use each_pixel
//#use output
//#use settled_history
//#use surface_history
//#use taau
// Temporal upsampling. CPU twin: src/cpu/levels/taau_pass.rs, which lists the reads and writes.

// Whether the frame is shaded by quads: what was filled between them is no sample.
override BY_QUADS: u32 = 0u;

@group(0) @binding(27) var quad_mask: texture_2d_array<u32>;

struct Samples {
    around: SamplesAround,
    // Color and alpha of the nearest sample, as the renderer wrote them.
    given: vec4f,
    // The same color, sanitized.
    nearest: Sanitized,
    // Sum of history's lumas at the samples' pixels; 0 if history is not compared.
    past_luma: f32,
}

fn is_shaded(px: vec2u, view: u32) -> bool {
    let place = (px.x & 1u) | ((px.y & 1u) << 1u);
    return ((textureLoad(quad_mask, px >> vec2u(1u), view, 0).x >> place) & 1u) != 0u;
}

// Nine samples around a pixel. At the frame's border the last samples repeat at positions beyond it. `kernel`: tail and
// narrowing. The loop has a variable count on purpose: Mesa would unroll a constant one and reorder its sums of
// products.
fn samples(px: vec2u, view: u32, kernel: vec2f, source: Source, compared: bool) -> Samples {
    var around = SamplesAround(vec3f(0.0), vec2f(0.0), vec3f(0.0), vec3f(0.0), 0.0);
    var past_luma = 0.0;
    let given = color_at(px, view);
    let nearest = color(given.xyz);
    let taps = select(0, 9, all(px < frame.size));
    for (var tap = 0; tap < taps; tap++) {
        let offset_px = vec2i(tap % 3, tap / 3) - 1;
        let at = vec2u(clamp(vec2i(px) + offset_px, vec2i(0), vec2i(frame.size) - 1));
        let sampled = color(color_at(at, view).xyz);
        if sampled.usable {
            // A sample shows the point at its pixel minus the jitter.
            let offset = vec2f(offset_px) - frame.views[view].jitter_px;
            var weights = sample_weights(offset, kernel.x, kernel.y);
            // They still tell what is around.
            if BY_QUADS != 0u && !is_shaded(at, view) {
                weights = vec2f(0.0);
            }
            around = add_around(around, nearest.color, sampled.color, weights);
            if compared {
                past_luma += luma_beside(source, offset_px, view);
            }
        }
    }
    return Samples(around, given, nearest, past_luma);
}

fn pixel(px: vec2u, view: u32) {
    let disparity_now = disparity_at(px, view);
    let motion = motion_at(px, view);
    let source = source_of(px, view, motion, disparity_now);
    let valid = source.previous.verdict == VERDICT_VALID;

    let resampled = resample(source, view, valid);
    var history = vec3f(0.0);
    var confidence = 0.0;
    if valid {
        history = exposed(resampled.sharp);
        confidence = min(confidence_of(resampled.lod), confidence_limit(source.fraction, UPSAMPLED_SPREAD));
    }
    let compared = confidence > SETTLED;
    let kernel = vec2f(tail(confidence * source.previous.trust), narrowing(confidence));
    let near = samples(px, view, kernel, source, compared);
    if compared {
        confidence = min(confidence, agreeing(near.around.sum.x, near.around.squares.x, near.past_luma, near.around.count));
    }
    count_pixel(px, view, near.nearest.usable, disparity_now, source.previous.verdict);

    let sampled = near.around.weights.y >= LEAST_SAMPLE_WEIGHT;
    var result = Accumulated(history, confidence, 0.0, 1.0);
    if sampled && valid {
        result = accumulate(near.around, near.nearest.color, history, confidence, source.previous.trust);
    } else if sampled {
        result = Accumulated(upsampled(near.around, near.nearest.color), near.around.weights.y, 1.0, 1.0);
    } else if BY_QUADS != 0u && !valid && near.nearest.usable {
        result = Accumulated(near.nearest.color, LEAST_SAMPLE_WEIGHT, 1.0, 1.0);
    }
    // With the overshoot of Catmull-Rom, colors may exceed the largest half.
    let shown = min(result.color, vec3f(MAX_HALF));
    let quality = min(0.5 * result.confidence, 1.0);
    let survival = select(0.0, 1.0 - result.share, valid);
    let traced = PixelTrace(source.previous.verdict, result.share, quality, 0u, survival, result.kept, !valid, motion);
    write_output(px, view, shown, near.given.w, traced);
    if VIEW != 0u {
        return;
    }
    let is_filled = BY_QUADS != 0u && near.nearest.usable;
    let lod = select(-1.0, lod_of(result.confidence), sampled || valid || is_filled);
    let words = pack_surface(Surface(shown, lod, disparity_now));
    textureStore(next_surfaces, px, view, vec4u(words, 0u, 0u));
}
