//#use each_pixel
//#use output
//#use settled_history
//#use surface_history
//#use taa
// Temporal antialiasing of the foveated frame. CPU twin: src/cpu/levels/taa_pass.rs, which lists the reads and writes.

struct Neighbourhood {
    sum: vec3f,
    squares: vec3f,
    past_luma: f32,
}

// Sums of colors and of their squares over 3x3 pixels, in YCoCg, and of the luma of history if it is `compared`.
// Non-finite pixels count as the centre, whose color is `own`. The loop has a variable count on purpose: Mesa would
// unroll a constant one and reorder its sums of products.
fn neighbourhood(px: vec2u, view: u32, own: vec3f, needed: bool, source: Source, compared: bool) -> Neighbourhood {
    var around = Neighbourhood(vec3f(0.0), vec3f(0.0), 0.0);
    let taps = select(0, 9, needed);
    for (var tap = 0; tap < taps; tap++) {
        let offset = vec2i(tap % 3, tap / 3) - 1;
        let at = clamp(vec2i(px) + offset, vec2i(0), vec2i(frame.size) - 1);
        let near = color(color_at(vec2u(at), view).xyz);
        let v = to_ycocg(select(own, near.color, near.usable));
        around.sum += v;
        around.squares += v * v;
        if compared {
            around.past_luma += luma_beside(source, offset, view);
        }
    }
    return around;
}

fn pixel(px: vec2u, view: u32) {
    let given = color_at(px, view);
    let candidate = color(given.xyz);
    let disparity_now = disparity_at(px, view);
    let motion = motion_at(px, view);
    let source = source_of(px, view, motion, disparity_now);
    let valid = source.previous.verdict == VERDICT_VALID;
    count_pixel(px, view, candidate.usable, disparity_now, source.previous.verdict);

    var shown = candidate.color;
    var share = 0.0;
    let resampled = resample(source, view, valid);
    var confidence = 1.0;
    if valid {
        confidence = min(confidence_of(resampled.lod), confidence_limit(source.fraction, SPREAD));
    }
    let compared = confidence > SETTLED;
    let around = neighbourhood(px, view, candidate.color, valid && candidate.usable, source, compared);
    if valid {
        let history = exposed(resampled.sharp);
        if candidate.usable {
            if compared {
                confidence = min(confidence, agreeing(around.sum.x, around.squares.x, around.past_luma, 9.0));
            }
            let alpha = candidate_share(confidence, source.previous.trust);
            shown = blend_clipped(candidate.color, history, around.sum, around.squares, alpha, confidence);
            share = 1.0 - alpha;
            confidence = 1.0 / alpha;
        } else {
            shown = history;
            share = 1.0;
        }
    }
    // With the overshoot of Catmull-Rom, colors may exceed the largest half.
    shown = min(shown, vec3f(MAX_HALF));
    write_output(px, view, shown, given.w, PixelTrace(source.previous.verdict, 1.0 - share, 0.0, 0u, share, 1.0, !valid, motion));
    if VIEW != 0u {
        return;
    }
    let lod = select(-1.0, lod_of(confidence), candidate.usable || valid);
    let words = pack_surface(Surface(shown, lod, disparity_now));
    textureStore(next_surfaces, px, view, vec4u(words, 0u, 0u));
}
