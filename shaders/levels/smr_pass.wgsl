//#use candidate_lod
//#use mip_noise
//#use smr
//#use output
//#use surface_history
// Scale-matched reservoirs. CPU twin: src/cpu/levels/smr_pass.rs, which lists the reads and writes; docs/method.md has
// the equations. One invocation a block of 2x2 pixels, which also writes their mean, the first level of the mip chain;
// z is the view.

override RELIGHT_ON: u32 = 1u;

// Four texels of a level around a position, and the position's fractions between them.
struct Texels {
    low: vec2u,
    high: vec2u,
    fraction: vec2f,
}

fn texels_around(at: vec2f, level: u32) -> Texels {
    let size = vec2u(level_len(frame.size.x, level), level_len(frame.size.y, level));
    let x = split(level_coordinate(at.x, level), size.x);
    let y = split(level_coordinate(at.y, level), size.y);
    let low = vec2u(x.whole, y.whole);
    return Texels(low, min(low + 1u, size - 1u), vec2f(x.fraction, y.fraction));
}

fn past_level(at: vec2f, level: u32, view: u32) -> vec3f {
    let four = texels_around(at, level);
    return mip_bilinear(
        textureLoad(past_mips, four.low, view, level - 1u),
        textureLoad(past_mips, vec2u(four.high.x, four.low.y), view, level - 1u),
        textureLoad(past_mips, vec2u(four.low.x, four.high.y), view, level - 1u),
        textureLoad(past_mips, four.high, view, level - 1u),
        four.fraction,
    );
}

fn past_texel(x: u32, y: u32, view: u32) -> vec4f {
    return mip_texel(textureLoad(past_surfaces, min(vec2u(x, y), frame.size - 1u), view, 0).xy);
}

// History at the sample position of the block of level of detail `lod` around pixel `px`, low-passed like that sample:
// the texel of history that corresponds to the texel that the block filter reads.
fn past_sampled(source: Source, px: vec2u, lod: f32, view: u32) -> vec3f {
    let level = u32(lod + 0.5);
    let finer = min(block_sample_level(level), frame.mip_levels);
    let texel_px = f32(1u << finer);
    let texel_x = block_sample(px.x >> level, level, frame.size.x);
    let texel_y = block_sample(px.y >> level, level, frame.size.y);
    let texel = vec2f(f32(texel_x), f32(texel_y));
    let at = source.previous.at + (((texel + 0.5) * texel_px - 0.5) - vec2f(px));
    if finer > 0u {
        return past_level(at, finer, view);
    }
    let x = split(at.x, frame.size.x);
    let y = split(at.y, frame.size.y);
    return mip_bilinear(
        past_texel(x.whole, y.whole, view),
        past_texel(x.whole + 1u, y.whole, view),
        past_texel(x.whole, y.whole + 1u, view),
        past_texel(x.whole + 1u, y.whole + 1u, view),
        vec2f(x.fraction, y.fraction),
    );
}

struct Matching {
    matched: vec3f,
    level: vec3f,
    next_level: vec3f,
}

// History at a position, at level of detail `lod` and at the whole levels around it. `smooth_color`: history at level
// 0.
fn past_read(at: vec2f, lod: f32, smooth_color: vec3f, view: u32) -> Matching {
    let last = frame.mip_levels;
    let limited = min(lod, f32(last));
    let whole = floor(limited);
    let fraction = limited - whole;
    let level = u32(whole);
    var first = smooth_color;
    if level > 0u {
        first = past_level(at, level, view);
    }
    let second = past_level(at, min(level + 1u, last), view);
    return Matching(first + (second - first) * fraction, first, second);
}

fn candidate_level(at: vec2f, level: u32, view: u32) -> vec4f {
    let four = texels_around(at, level);
    return candidate_bilinear(
        textureLoad(candidate_mips, four.low, view, level - 1u),
        textureLoad(candidate_mips, vec2u(four.high.x, four.low.y), view, level - 1u),
        textureLoad(candidate_mips, vec2u(four.low.x, four.high.y), view, level - 1u),
        textureLoad(candidate_mips, four.high, view, level - 1u),
        four.fraction,
    );
}

struct Around {
    // Color and variance at the level of detail.
    compared: vec4f,
    // Color and variance at the next whole level.
    coarser: vec4f,
}

// Mean of noisy candidates around a position, at level of detail `lod` of at least 1.
fn candidates_read(at: vec2f, lod: f32, view: u32) -> Around {
    let last = frame.mip_levels;
    let limited = min(lod, f32(last));
    let whole = floor(limited);
    let level = u32(whole);
    let first = candidate_level(at, level, view);
    let second = candidate_level(at, min(level + 1u, last), view);
    return Around(first + (second - first) * (limited - whole), second);
}

// Candidate at an offset from a pixel; `own` if it is not finite, because a non-finite pixel must not count as black.
fn candidate_near(px: vec2u, view: u32, own: vec3f, offset: vec2f) -> vec3f {
    let at = clamp(floor((vec2f(px) + 0.5) + offset), vec2f(0.0), vec2f(frame.size - 1u));
    let near = color(color_at(vec2u(at), view).xyz);
    return select(own, near.color, near.usable);
}

// Mean of the four candidates at diagonal offsets of 3/4 of a block of level `lod`, times a factor; black unless
// `needed`, by a loop with zero iterations.
fn candidates_around(px: vec2u, view: u32, own: vec3f, lod: f32, factor: f32, needed: bool) -> vec3f {
    var mean = vec3f(0.0);
    let rounds = select(0u, 1u, needed);
    for (var i = 0u; i < rounds; i++) {
        let radius = 0.75 * exp2_approx(lod);
        mean = mean_of_four(
            candidate_near(px, view, own, vec2f(-radius, -radius)),
            candidate_near(px, view, own, vec2f(radius, -radius)),
            candidate_near(px, view, own, vec2f(-radius, radius)),
            candidate_near(px, view, own, vec2f(radius, radius)),
        ) * factor;
    }
    return mean;
}

fn matched_pixel(
    px: vec2u,
    view: u32,
    candidate: vec3f,
    lod: f32,
    source: Source,
    history: Resampled,
    finer: f32,
) -> Matched {
    // Point samples alias at their own scale: compare one level coarser.
    let shift = select(0.0, 1.0, FILTER == FILTER_BLOCK);
    let past = past_read(source.previous.at, lod + shift, history.smooth_color, view);
    let unit = brightness_unit(candidate, past.matched, frame.exposure);
    let inverse_unit = 1.0 / unit;
    let per_stored = frame.exposure * inverse_unit;
    let matched = past.matched * per_stored;
    let whole_level = past.level * per_stored;
    let next_level = past.next_level * per_stored;
    let own = candidate * inverse_unit;
    let blocks = FILTER == FILTER_BLOCK;
    // Levels of history are means of blocks, not Gaussian blurs: the two agree better one level coarser.
    let gauss = FILTER == FILTER_GAUSS;
    // The second operand of && is a branch, in which differences would be computed once more than in `decide`.
    let differs = is_changed(own, matched, whole_level, next_level);
    let changed = differs && RELIGHT_ON != 0u && may_relight(finer, false);
    let around = candidates_around(px, view, candidate, lod, inverse_unit, blocks || changed);
    var predicted = matched;
    if FILTER == FILTER_BLOCK {
        predicted = past_sampled(source, px, lod, view) * per_stored;
    }
    var evidence: Evidence;
    evidence.candidate = candidate;
    evidence.unit = unit;
    evidence.compared = select(own, around, blocks);
    evidence.compared_coarser = select(around, own, gauss);
    evidence.observed = select(own, around, gauss);
    evidence.lod = lod;
    evidence.history = exposed(history.sharp);
    evidence.history_lod = history.lod;
    evidence.resampled = any(source.fraction != vec2f(0.0)) && !gauss;
    evidence.matched = matched;
    evidence.level = whole_level;
    evidence.next_level = next_level;
    evidence.matched_coarser = select(next_level, matched, blocks || gauss);
    evidence.predicted = select(predicted, next_level, gauss);
    evidence.trust = source.previous.trust;
    evidence.noise = 0.0;
    evidence.confidence = vec2f(1.0);
    return decide(evidence, params_with(frame.smr_accumulate));
}

fn params_with(accumulate: f32) -> SmrParams {
    return SmrParams(
        accumulate,
        frame.smr_accumulate_tolerance,
        frame.smr_tolerance,
        FILTER == FILTER_BLOCK,
        RELIGHT_ON != 0u,
        NOISY != 0u,
    );
}

struct Averaged {
    result: Matched,
    noise: Noise,
}

// Output color for a noisy candidate, and its noise.
fn averaged_pixel(
    px: vec2u,
    view: u32,
    candidate: vec3f,
    noise: Noise,
    lod: f32,
    source: Source,
    history: Resampled,
) -> Averaged {
    let past_noise = past_noise_of(source, view);
    let shown = exposed(history.sharp);
    let own = Noise(noise.samples, past_noise.variance);
    let confidence = vec2f(noise_confidence(past_noise, luma(shown)), noise_confidence(own, luma(shown)));
    let discounted = discount_coarser(past_noise, noise, history.lod - lod);
    let params = params_with(history_share(discounted, noise, frame.smr_accumulate));
    let reuse = reuse_weight(lod, history.lod, params.accumulate, true, confidence);
    if reuse.share == 0.0 {
        return Averaged(Matched(candidate, lod, 0.0, 1.0), noise);
    }
    let around = candidates_read(vec2f(px), lod + NOISY_LEVELS, view);
    let past = past_read(source.previous.at, lod + NOISY_LEVELS, history.smooth_color, view);
    let unit = brightness_unit(around.compared.xyz, past.matched, frame.exposure);
    let inverse_unit = 1.0 / unit;
    let per_stored = frame.exposure * inverse_unit;
    let matched = past.matched * per_stored;
    let next_level = past.next_level * per_stored;
    let mean = around.compared.xyz * inverse_unit;
    let noise_around = Noise(noise.samples, around.compared.w * noise.samples);
    var evidence: Evidence;
    evidence.candidate = candidate;
    evidence.unit = unit;
    evidence.compared = mean;
    evidence.compared_coarser = around.coarser.xyz * inverse_unit;
    evidence.observed = mean;
    evidence.lod = lod;
    evidence.history = shown;
    evidence.history_lod = history.lod;
    evidence.resampled = any(source.fraction != vec2f(0.0));
    evidence.matched = matched;
    evidence.level = past.level * per_stored;
    evidence.next_level = next_level;
    evidence.matched_coarser = next_level;
    evidence.predicted = matched;
    evidence.trust = source.previous.trust;
    evidence.noise = noise_difference(past_noise, noise_around, luma(matched), inverse_unit);
    evidence.confidence = confidence;
    let result = decide(evidence, params);
    let acceptance = result.fit * source.previous.trust;
    return Averaged(result, noise_after(past_noise, noise_around, result.share, reuse.finer * acceptance));
}

// Outputs and stores a pixel; returns the stored words.
fn pixel(px: vec2u, view: u32) -> vec2u {
    let given = color_at(px, view);
    let candidate = color(given.xyz);
    let ray = ray_at(px, view);
    let disparity_now = disparity_at(px, view);
    let motion = motion_at(px, view);
    let lod = candidate_lod(px, view, region_angle_deg(ray, frame.views[view].gaze_ray));
    let coherent_motion = is_coherent(px, view, motion);
    var source = source_of(px, view, motion, disparity_now);
    if source.previous.verdict == VERDICT_VALID && !coherent_motion {
        source.previous.verdict = VERDICT_DISOCCLUDED;
    }
    let valid = source.previous.verdict == VERDICT_VALID;
    count_pixel(px, view, candidate.usable, disparity_now, source.previous.verdict);

    var result = Matched(candidate.color, select(-1.0, lod, candidate.usable), 0.0, 1.0);
    var noise = Noise(1.0, 0.0);
    if NOISY != 0u {
        noise = noise_at(px, view);
    }
    if valid {
        let history = resample(source, view, NOISY != 0u || lod > 0.0 || !candidate.usable);
        if !candidate.usable {
            result = Matched(exposed(history.sharp), history.lod, 1.0, 1.0);
            if NOISY != 0u {
                noise = past_noise_of(source, view);
            }
        } else if NOISY != 0u {
            let averaged = averaged_pixel(px, view, candidate.color, noise, lod, source, history);
            result = averaged.result;
            noise = averaged.noise;
        } else if lod > 0.0 {
            let reuse = reuse_weight(lod, history.lod, frame.smr_accumulate, false, vec2f(1.0));
            if reuse.share > 0.0 {
                result = matched_pixel(px, view, candidate.color, lod, source, history, reuse.finer);
            }
        }
    }
    // With gains, and with the overshoot of Catmull-Rom, colors may exceed the largest half.
    result.color = min(result.color, vec3f(MAX_HALF));
    let replaced = result.share == 0.0;
    count_if(valid && replaced, COUNT_REPLACED);
    let sharpness = exp2_approx(-max(result.lod, 0.0));
    let verdict = source.previous.verdict;
    let traced = PixelTrace(verdict, exp2_approx(-lod), sharpness, 0u, result.share, result.fit, replaced, motion);
    write_output(px, view, result.color, given.w, traced);
    // Colors on a moving silhouette mix two surfaces. With the coarsest level of detail, the next candidate replaces
    // them.
    let stored_lod = select(MAX_LOD, result.lod, coherent_motion || result.lod < 0.0);
    let words = pack_surface(Surface(result.color, stored_lod, disparity_now));
    if VIEW == 0u {
        textureStore(next_surfaces, px, view, vec4u(words, 0u, 0u));
        if NOISY != 0u {
            textureStore(next_noise, px, view, vec4u(pack_noise(noise), 0u, 0u, 0u));
        }
    }
    return words;
}

@compute @workgroup_size(64, 1)
fn main(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) invocation: u32,
) {
    let first = 2u * id.xy;
    let view = frame.first_view + group.z;
    if all(first < frame.size) {
        var words_0 = vec2u(0u);
        var words_1 = vec2u(0u);
        var words_2 = vec2u(0u);
        var words_3 = vec2u(0u);
        // A loop, because four copies of the code would take four times as long to compile.
        for (var i = 0u; i < 4u; i++) {
            let px = first + vec2u(i & 1u, i >> 1u);
            // At an odd border the neighbour counts twice.
            let column = select(0u, i & 1u, px.x < frame.size.x);
            let row = select(0u, i >> 1u, px.y < frame.size.y);
            var words = select(select(words_0, words_1, column == 1u), words_2, row == 1u && column == 0u);
            if all(px < frame.size) {
                words = pixel(px, view);
            }
            words_0 = select(words_0, words, i == 0u);
            words_1 = select(words_1, words, i == 1u);
            words_2 = select(words_2, words, i == 2u);
            words_3 = select(words_3, words, i == 3u);
        }
        if VIEW == 0u {
            let mean = mip_mean(mip_texel(words_0), mip_texel(words_1), mip_texel(words_2), mip_texel(words_3));
            textureStore(next_mips, id.xy, view, round_mip(mean));
        }
    }
    add_counts(invocation);
}
