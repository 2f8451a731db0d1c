//#use candidate
//#use sparse_history
//#use sparse_noise
//#use output
//#use rng
//#use reconstruction
// Pixel of a planned frame, from stored samples of history and the candidate around it.
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

// A candidate with a factor on its colors.
fn times(given: Candidate, factor: vec3f) -> Candidate {
    var candidate = given;
    candidate.color *= factor;
    candidate.lowest *= factor;
    candidate.highest *= factor;
    candidate.beside *= factor;
    return candidate;
}

// Whether the samples around a pixel tell the color at its centre: in the fovea of jittered frames.
fn is_centred_at(view: u32, level: u32, candidate: Candidate) -> bool {
    return ANTIALIAS != 0u && candidate.is_own && level == 0u && surrounds_centre(frame.views[view].jitter_px);
}

// Whether a pixel shows the sample beside it. `at_edge`: whether it is at a moving edge;
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

// What a pixel shows and stores, in frames with albedo still with the texture of its samples.
struct Resolved {
    result: Reconstructed,
    mean: Mean,
    noise: Noise,
    // To show, and to store.
    alpha: vec2f,
    fit: f32,
}

// A pixel without history: its candidate.
fn candidate_alone(view: u32, level: u32, candidate: Candidate, near: Near) -> Resolved {
    let lod = select(-1.0, candidate.lod, candidate.usable);
    var next = StoredSample(candidate.color, lod, -1.0, vec2f(0.0));
    if is_centred_at(view, level, candidate) {
        // The samples around antialias alone.
        next.color = candidate.color + centred_change(near);
    } else if ANTIALIAS != 0u && candidate.is_own {
        next.place_px = -frame.views[view].jitter_px;
    }
    let result = Reconstructed(next.color, next, 0.0, false, 0.0);
    return Resolved(result, Mean(0.0, 1.0, 0.0, 0.0), candidate.noise, vec2f(candidate.alpha), 1.0);
}

// A pixel without a usable candidate: its history.
fn history_alone(past: SparseHistory, noise: Noise) -> Resolved {
    let history = past.interpolated;
    let result = Reconstructed(history.color, history.nearest, 1.0, true, 1.0);
    return Resolved(result, past.mean, noise, past.alpha, 1.0);
}

// A pixel with history and a usable candidate: history, relit, blended with the candidate. Arguments as for
// `show_pixel`; `trust`: trust in history; `past_noise`: its noise.
fn blend_history(
    view: u32,
    level: u32,
    surface: PixelSurface,
    trust: f32,
    past: SparseHistory,
    past_noise: Noise,
    candidate: Candidate,
    near: Near,
) -> Resolved {
    let history = past.interpolated;
    var moved = has_moved(vec2f(0.0), history.nearest.place_px);
    if ANTIALIAS != 0u {
        moved = has_moved(surface.motion, vec2f(0.0));
    }
    var inputs: Reconstruction;
    inputs.candidate = candidate.color;
    inputs.lod = candidate.lod;
    inputs.lowest = candidate.lowest;
    inputs.highest = candidate.highest;
    inputs.history = history.color;
    inputs.history_lod = history.lod;
    inputs.nearest = history.nearest;
    inputs.lod_loss_per_stop = lod_loss_per_stop(moved, ANTIALIAS != 0u);
    inputs.gains = candidate.gains;
    inputs.fit = candidate.fit;
    inputs.trust = trust;
    inputs.accumulate = frame.smr_accumulate;
    var blended: Resolved;
    blended.mean = Mean(0.0, 1.0, 0.0, 0.0);
    blended.noise = candidate.noise;
    blended.fit = candidate.fit;
    if NOISY != 0u {
        let accumulated = accumulate(inputs, past_noise, candidate.noise);
        blended.result = accumulated.result;
        blended.noise = accumulated.noise;
    } else if ANTIALIAS != 0u {
        let contrast = root_difference(history.lowest, history.highest);
        let error = expected_mean_error(past.mean, contrast, moved);
        let averaged = antialiased(view, level, inputs, past.mean, error, candidate, surface.is_moving_edge, near);
        blended.result = averaged.result;
        blended.mean = averaged.mean;
    } else {
        blended.result = reconstruct(inputs);
    }
    blended.alpha = result_alpha(blended.result, candidate.alpha, past.alpha.x, past.alpha.y);
    return blended;
}

// Writes the sample that a pixel stores, and what is stored beside it. `moved_px`: motion of its surface in the world.
fn store_sample(px: vec2u, view: u32, pixel: Resolved, moved_px: f32, albedo_word: u32) {
    var next = pixel.result.stored;
    var words = pack_stored(next);
    if ANTIALIAS != 0u {
        // Color, number of samples and deviation are rounded stochastically.
        let random = bits(px.x, px.y, frame.frame_low, frame.views[view].key);
        var mean = pixel.mean;
        mean.lod = next.lod;
        next.lod = stored_lod(mean, byte_draws(random));
        words = vec2u(pack_color_by(next.color, unit_draw(random)), pack_stored(next).y);
    }
    textureStore(next_stored, px, view, vec4u(with_motion(words, moved_px), 0u, 0u));
    if NOISY != 0u {
        textureStore(next_noise, px, view, vec4u(pack_noise(pixel.noise), 0u, 0u, 0u));
    }
    if HAS_ALPHA != 0u {
        textureStore(next_extra, px, view, vec4u(bitcast<u32>(pixel.alpha.y), 0u, 0u, 0u));
    }
    if HAS_ALBEDO {
        textureStore(next_extra, px, view, vec4u(albedo_word, 0u, 0u, 0u));
    }
}

// Processes a visible pixel. `level`: log2 of the distance of the samples around it; at level 0 it has a sample in
// every frame. `near`: sums over the nine samples around a pixel of level 0, of jittered frames.
fn show_pixel(px: vec2u, view: u32, level: u32, disparity_now: f32, given: Candidate, near: Near) {
    let surface = surface_of(px, view, level);
    let source = sparse_source(px, view, surface);
    let is_final = given.usable && level == 0u && NOISY == 0u && ANTIALIAS == 0u;
    let needed = may_have_history(source.previous) && !is_final;
    var past = sparse_history(source, view, needed, past_albedos(px, view));
    let has_history = past.interpolated.lod >= 0.0;
    let verdict = select(source.previous.verdict, VERDICT_VALID, has_history);
    count_pixel(px, view, given.usable, disparity_now, verdict);

    var candidate = given;
    var past_noise = Noise(0.0, 0.0);
    if NOISY != 0u && has_history {
        past_noise = stored_noise(past.texel, view);
    }
    if NOISY != 0u && candidate.is_own {
        let borrowed = borrow_around(candidate.color, candidate.noise, candidate.around, past_noise.samples);
        candidate.color = borrowed.color;
        candidate.noise = borrowed.noise;
    }

    var texture: PixelTexture;
    if HAS_ALBEDO {
        let history = past.interpolated;
        let usable = candidate.usable;
        let of_candidate = candidate.albedos.albedo;
        let at_edge = surface.is_edge;
        texture = pixel_texture(px, view, level, at_edge, past.albedos, history, usable, candidate.color, of_candidate);
        past.interpolated = of_history(texture, history);
        candidate = times(candidate, on_sample(texture));
    }

    var pixel = candidate_alone(view, level, candidate, near);
    if has_history {
        if candidate.usable {
            let trust = source.previous.trust;
            pixel = blend_history(view, level, surface, trust, past, past_noise, candidate, near);
        } else {
            pixel = history_alone(past, past_noise);
        }
    }
    pixel.result.stored.disparity = surface.stored_disparity;

    var albedo_word = 0u;
    if HAS_ALBEDO {
        let is_new = level == 0u || !has_history;
        let retextured = retexture(px, view, texture, pixel.result, is_new, pixel.mean.samples);
        let place_px = pixel.result.stored.place_px;
        pixel.result.stored.color *= retextured.factor;
        pixel.result.stored.place_px += (-frame.views[view].jitter_px - place_px) * retextured.place_share;
        albedo_word = retextured.word;
    }
    // Means of colors may exceed the largest half.
    let shown = clamp(pixel.result.color, vec3f(-MAX_HALF), vec3f(MAX_HALF));

    let share = pixel.result.share;
    count_if(verdict == VERDICT_VALID && share == 0.0, COUNT_REPLACED);
    let sharpness = exp2_approx(-max(pixel.result.stored.lod, 0.0));
    let weight = exp2_approx(-candidate.lod);
    let trace = PixelTrace(verdict, weight, sharpness, 0u, share, pixel.fit, share == 0.0, surface.motion);
    let alpha = select(candidate.alpha, pixel.alpha.x, HAS_ALPHA != 0u);
    write_output(px, view, shown, alpha, trace);
    if VIEW == 0u {
        store_sample(px, view, pixel, surface.moved_px, albedo_word);
    }
}
