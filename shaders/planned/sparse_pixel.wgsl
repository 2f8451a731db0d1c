//#use candidate
//#use sparse_history
//#use sparse_noise
//#use output
//#use rng
//#use sparse_smr
// Pixel of smr from stored samples of history and the candidate around it.
// CPU twin: `pixel` in src/cpu/planned/pixel.rs; docs/method.md has the equations.

@group(0) @binding(18) var next_stored: texture_storage_2d_array<rg32uint, write>;
@group(0) @binding(19) var next_noise: texture_storage_2d_array<r32uint, write>;
@group(0) @binding(20) var next_extra: texture_storage_2d_array<r32uint, write>;

// Candidate of a pixel, and its gain and fit.
struct Candidate {
    color: vec3f,
    usable: bool,
    lod: f32,
    lowest: vec3f,
    highest: vec3f,
    gains: vec3f,
    fit: f32,
    alpha: f32,
    noise: Noise,
    // Whether the candidate is this pixel's own sample.
    is_own: bool,
    // Color of the sample of the pixel's surface beside it, and whether there is one.
    beside: vec3f,
    is_beside: bool,
    albedos: SampleAlbedos,
    // Of a noisy pixel with a sample: mean of all samples around it, its own included, and the mean variance of one.
    around: vec4f,
}

// A candidate without samples; the other fields are 0.
fn no_candidate() -> Candidate {
    var none: Candidate;
    none.gains = vec3f(1.0);
    none.fit = 1.0;
    none.alpha = 1.0;
    none.noise = Noise(1.0, 0.0);
    return none;
}

// Whether the samples around a pixel tell the color at its centre: in the fovea of jittered frames.
fn is_centred_at(view: u32, level: u32, candidate: Candidate) -> bool {
    return ANTIALIAS != 0u && candidate.is_own && level == 0u && surrounds_centre(frame.views[view].jitter_px);
}

// Whether the result at a pixel is that of the sample beside it. `at_edge`: whether it is at a moving edge;
// `nearest_lod`: level of detail of history's nearest sample.
fn takes_beside(candidate: Candidate, at_edge: bool, nearest_lod: f32) -> bool {
    return !candidate.is_own && at_edge && candidate.is_beside && nearest_lod <= 0.0;
}

// Result at a pixel that has history and a usable candidate, of jittered frames. `near`: sums over the nine samples
// around a pixel of full rate; `at_edge`: whether it is at a moving edge outside the fovea.
fn antialiased(
    view: u32,
    level: u32,
    given: Reconstruction,
    past: Mean,
    error: f32,
    candidate: Candidate,
    at_edge: bool,
    near: Near,
) -> Averaged {
    let place_px = -frame.views[view].jitter_px;
    var inputs = given;
    if !candidate.is_own {
        if takes_beside(candidate, at_edge, given.nearest.lod) {
            inputs.candidate = candidate.beside;
            return average_beside(inputs, past, place_px);
        }
        return stored_mean(given, reconstruct(given), past);
    }
    let difference = min(root_difference(given.candidate, given.history), MOST_DIFFERENCE);
    var kept = 1.0;
    if level == 0u {
        let by = clip(near, inputs.history);
        inputs.history = clipped(inputs.history, by.change);
        inputs.nearest.color = clipped(inputs.nearest.color, by.change);
        kept = by.kept;
    } else if !at_edge {
        // At a moving edge a sample shows one surface, and history a mean of several.
        let history = relit(given.history, given.gains, given.lowest, given.highest);
        kept = kept_samples(error, root_difference(given.candidate, history));
    }
    let is_centred = is_centred_at(view, level, candidate);
    var change = vec3f(0.0);
    if is_centred {
        change = centred_change(near);
    }
    let regular = with_regular_run(past, level);
    return average(inputs, regular, place_px, at_edge, kept, difference, change, is_centred);
}

// Pixels outside the visible area: black, without stored history.
fn hidden_pixel(px: vec2u, view: u32) {
    let trace = PixelTrace(VERDICT_RESET, 0.0, 0.0, 0u, 0.0, 1.0, true, vec2f(0.0));
    write_output(px, view, vec3f(0.0), 1.0, trace);
    if VIEW == 0u {
        let empty = pack_stored(StoredSample(vec3f(0.0), -1.0, -1.0, vec2f(0.0)));
        textureStore(next_stored, px, view, vec4u(empty, 0u, 0u));
        if NOISY != 0u {
            textureStore(next_noise, px, view, vec4u(pack_noise(Noise(1.0, 0.0)), 0u, 0u, 0u));
        }
        if HAS_ALPHA != 0u {
            textureStore(next_extra, px, view, vec4u(bitcast<u32>(1.0f), 0u, 0u, 0u));
        }
        if HAS_ALBEDO {
            textureStore(next_extra, px, view, vec4u(0u));
        }
    }
}

// Processes a visible pixel. `level`: log2 of the distance of the samples around it; at level 0 it has a sample in
// every frame. `near`: sums over the nine samples around a pixel of level 0, of jittered frames.
fn show_pixel(px: vec2u, view: u32, level: u32, disparity_now: f32, given: Candidate, near: Near) {
    var candidate = given;
    let surface = surface_of(px, view, level);
    let motion = surface.motion;
    let source = sparse_source(px, view, surface);
    let previous = source.previous;
    let is_final = candidate.usable && level == 0u && NOISY == 0u && ANTIALIAS == 0u;
    let needed = may_have_history(previous) && !is_final;
    let found = sparse_history(source, view, needed, past_albedos(px, view));
    let history = found.found;
    let verdict = select(previous.verdict, VERDICT_VALID, history.lod >= 0.0);
    let valid = verdict == VERDICT_VALID;
    count_pixel(px, view, candidate.usable, disparity_now, verdict);
    if NOISY != 0u && candidate.is_own {
        var past = 0.0;
        if history.lod >= 0.0 {
            past = stored_noise(found.texel, view).samples;
        }
        let with_borrowed = borrow_around(candidate.color, candidate.noise, candidate.around, past);
        candidate.color = with_borrowed.color;
        candidate.noise = with_borrowed.noise;
    }

    var shown = candidate.color;
    let candidate_lod = select(-1.0, candidate.lod, candidate.usable);
    var next = StoredSample(candidate.color, candidate_lod, surface.stored_disparity, vec2f(0.0));
    var mean = Mean(0.0, 1.0, 0.0, 0.0);
    if is_centred_at(view, level, candidate) {
        // Without history the samples around antialias alone.
        shown = candidate.color + centred_change(near);
        next.color = shown;
    } else if ANTIALIAS != 0u && candidate.is_own {
        next.place_px = -frame.views[view].jitter_px;
    }
    var share = 0.0;
    var fits = 1.0;
    var noise = candidate.noise;
    // To show, and to store.
    var alpha = vec2f(candidate.alpha);
    var result = Reconstructed(shown, next, 0.0, false, 0.0);
    if history.lod >= 0.0 {
        if candidate.usable {
            var inputs: Reconstruction;
            inputs.candidate = candidate.color;
            inputs.lod = candidate.lod;
            inputs.lowest = candidate.lowest;
            inputs.highest = candidate.highest;
            inputs.history = history.color;
            inputs.history_lod = history.lod;
            inputs.nearest = history.nearest;
            var moved = has_moved(vec2f(0.0), history.nearest.place_px);
            if ANTIALIAS != 0u {
                moved = has_moved(motion, vec2f(0.0));
            }
            inputs.worn = worn(moved, ANTIALIAS != 0u);
            inputs.gains = candidate.gains;
            inputs.fit = candidate.fit;
            inputs.trust = previous.trust;
            inputs.accumulate = frame.smr_accumulate;
            if NOISY != 0u {
                let accumulated = accumulate(inputs, stored_noise(found.texel, view), candidate.noise);
                result = accumulated.result;
                noise = accumulated.noise;
            } else if ANTIALIAS != 0u {
                let contrast = root_difference(history.lowest, history.highest);
                let error = expected_mean_error(found.mean, contrast, moved);
                let averaged = antialiased(view, level, inputs, found.mean, error, candidate, surface.is_moving_edge, near);
                result = averaged.result;
                mean = averaged.mean;
            } else {
                result = reconstruct(inputs);
            }
            shown = result.color;
            alpha = result_alpha(result, candidate.alpha, found.alpha.x, found.alpha.y);
            share = result.share;
            fits = candidate.fit;
            next = result.stored;
        } else {
            shown = history.color;
            alpha = found.alpha;
            share = 1.0;
            next = history.nearest;
            result = Reconstructed(shown, next, 1.0, true, 1.0);
            mean = found.mean;
            if NOISY != 0u {
                noise = stored_noise(found.texel, view);
            }
        }
        next.disparity = surface.stored_disparity;
    }
    var texture: Retextured;
    if HAS_ALBEDO {
        let of_candidate = candidate.albedos.albedo;
        texture = retexture(px, view, level, surface.is_edge, of_candidate, found.albedos, history, result, mean.samples);
        shown *= texture.shown;
        next.color *= texture.stored;
        next.place_px += (-frame.views[view].jitter_px - next.place_px) * texture.place_share;
    }
    // Means of colors may exceed the largest half.
    shown = clamp(shown, vec3f(-MAX_HALF), vec3f(MAX_HALF));
    count_if(valid && share == 0.0, COUNT_REPLACED);
    let sharpness = exp2_approx(-max(next.lod, 0.0));
    let traced = PixelTrace(verdict, exp2_approx(-candidate.lod), sharpness, 0u, share, fits, share == 0.0, motion);
    if HAS_ALPHA == 0u {
        alpha = vec2f(candidate.alpha);
    }
    write_output(px, view, shown, alpha.x, traced);
    if VIEW == 0u {
        var words = pack_stored(next);
        if ANTIALIAS != 0u {
            // Color, number of samples and deviation are rounded stochastically.
            let random = bits(px.x, px.y, frame.frame_low, frame.views[view].key);
            mean.lod = next.lod;
            next.lod = stored_lod(mean, byte_draws(random));
            words = vec2u(pack_color_by(next.color, unit_draw(random)), pack_stored(next).y);
        }
        textureStore(next_stored, px, view, vec4u(with_motion(words, surface.moved_px), 0u, 0u));
        if NOISY != 0u {
            textureStore(next_noise, px, view, vec4u(pack_noise(noise), 0u, 0u, 0u));
        }
        if HAS_ALPHA != 0u {
            textureStore(next_extra, px, view, vec4u(bitcast<u32>(alpha.y), 0u, 0u, 0u));
        }
        if HAS_ALBEDO {
            textureStore(next_extra, px, view, vec4u(texture.word, 0u, 0u, 0u));
        }
    }
}
