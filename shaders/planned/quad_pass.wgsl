//#use candidate
//#use each_pixel
//#use quad_samples
//#use sparse_pixel
// Reconstruction of frames shaded by quads: candidates of pixels from the shaded quads around them. CPU twin:
// `quad_candidate` in src/cpu/planned/quad_samples.rs.

@group(0) @binding(21) var rectified: texture_2d_array<u32>;

// Mean of the samples around a noisy pixel with a sample, its own included, and the mean variance of one.
fn mean_around(around: AroundPixel, px: vec2u, view: u32, codes: vec2u) -> vec4f {
    var sums = NoisySums(vec4f(0.0), 0.0);
    // A variable count on purpose, as below.
    let taps = select(0u, 12u, around.count > 0u);
    for (var tap = 0u; tap < taps; tap++) {
        let sample = noisy_tap(around, tap, px, view);
        let at = min(sample.at, frame.size - 1u);
        let sampled = color(sample_at(at, view).xyz);
        let words = textureLoad(rectified, at >> vec2u(1u), view, 0);
        let place = (at.x & 1u) | ((at.y & 1u) << 1u);
        let same = DEPTH_TEST == 0u || has_code(quad_code(words, place), codes);
        if sample.is_there && sampled.usable && (same || all(at == px)) {
            let x = f32(at.x) - f32(px.x);
            let y = f32(at.y) - f32(px.y);
            sums = add_noisy(sums, sampled.color, noise_at(at, view), x * x + y * y);
        }
    }
    return noisy_mean(sums);
}

// Candidate from the samples that stand for a pixel.
fn candidate_at(px: vec2u, view: u32, mask_word: u32, disparity_now: f32) -> Candidate {
    let around = around_pixel(px, view, mask_word);
    let coarsest = f32(level_of(mask_word));
    let codes = sample_codes(disparity_now);
    var sums = no_samples();
    var is_own = false;
    var own = vec4f(0.0);
    var own_fit = 1.0;
    var noises = NoiseSum(0.0, 0.0, 0.0);
    var albedos = sample_albedos(px, view);
    // A variable count on purpose: Mesa would unroll a constant one and reorder its sums of products.
    let taps = select(0u, around.count, coarsest > 0.0);
    for (var tap = 0u; tap < taps; tap++) {
        let sample = sample_tap(around, tap, px, view);
        let at = min(sample.at, frame.size - 1u);
        let given = sample_at(at, view);
        let sampled = color(given.xyz);
        if sample.is_there && sampled.usable {
            let words = textureLoad(rectified, at >> vec2u(1u), view, 0);
            let place = (at.x & 1u) | ((at.y & 1u) << 1u);
            let r = unpack_rectification(words, place);
            let same = DEPTH_TEST == 0u || has_code(quad_code(words, place), codes);
            let x = f32(at.x) - f32(px.x);
            let y = f32(at.y) - f32(px.y);
            let px2 = x * x + y * y;
            let weight = sample_weight(px2, same);
            let alpha = usable_alpha(given.w);
            sums = add_sample(sums, sampled.color, alpha, r, weight, px2, same);
            if HAS_ALBEDO {
                albedos = with_sample(albedos, at, view, sampled.color, weight);
            }
            if NOISY != 0u {
                noises = add_noise(noises, noise_at(at, view), weight);
            }
            if all(at == px) {
                is_own = true;
                own = vec4f(sampled.color, alpha);
                own_fit = r.center_fit;
            }
        }
    }
    var candidate = no_candidate();
    if sums.weight == 0.0 {
        return candidate;
    }
    let mean = sample_mean(sums, coarsest);
    candidate.usable = true;
    candidate.is_own = is_own;
    candidate.color = select(mean.color, own.xyz, is_own);
    candidate.alpha = select(mean.alpha, own.w, is_own);
    candidate.lod = select(mean.lod, 0.0, is_own);
    candidate.gains = mean.gains;
    candidate.fit = min(mean.fit, own_fit);
    candidate.lowest = sums.lowest;
    candidate.highest = sums.highest;
    candidate.beside = sums.beside;
    candidate.is_beside = is_beside(sums);
    if HAS_ALBEDO {
        albedos = with_change(albedos, is_own, has_surface(sums));
        candidate = times(candidate, albedos.factor);
        candidate.albedos = albedos;
    }
    if NOISY != 0u {
        candidate.noise = mean_noise(noises);
        if is_own {
            candidate.noise = noise_at(px, view);
            candidate.around = mean_around(around, px, view, codes);
        }
    }
    return candidate;
}

// Candidate of a pixel in the fovea.
fn full_rate_candidate(px: vec2u, view: u32, mask_word: u32) -> Candidate {
    let given = sample_at(px, view);
    let own = color(given.xyz);
    let usable = own.usable && is_shaded(mask_word, px);
    var candidate = no_candidate();
    candidate.color = select(vec3f(0.0), own.color, usable);
    candidate.alpha = select(1.0, usable_alpha(given.w), usable);
    candidate.usable = usable;
    candidate.is_own = usable;
    if HAS_ALBEDO && usable {
        candidate.albedos = with_change(sample_albedos(px, view), true, true);
    }
    return candidate;
}

// Sums over the nine pixels around a pixel of the fovea with the sample `own`, as far as they are shaded; without any
// unless `needed`. A variable count on purpose: Mesa would unroll a constant one and reorder its sums of products.
fn samples_near(px: vec2u, view: u32, own: vec3f, needed: bool) -> Near {
    let place_px = -frame.views[view].jitter_px;
    var near = Near(vec3f(0.0), vec3f(0.0), 0.0, vec3f(0.0), 0.0);
    let taps = select(0u, 9u, needed);
    for (var tap = 0u; tap < taps; tap++) {
        let offset = vec2u(tap % 3u, tap / 3u);
        let at = clamp(px + offset, vec2u(1u), frame.size) - 1u;
        let sampled = color(sample_at(at, view).xyz);
        if sampled.usable && is_shaded(mask_at(at, view), at) {
            near = add_near(near, sampled.color, own, (vec2f(offset) - 1.0) + place_px);
        }
    }
    return near;
}

fn pixel(px: vec2u, view: u32) {
    if !is_seen(px, view) {
        hidden_pixel(px, view);
        return;
    }
    let disparity_now = disparity_at(px, view);
    let mask_word = mask_at(px, view);
    let level = level_of(mask_word);
    var candidate = candidate_at(px, view, mask_word, disparity_now);
    if level == 0u {
        candidate = full_rate_candidate(px, view, mask_word);
    }
    let is_near = ANTIALIAS != 0u && candidate.is_own && level == 0u;
    let near = samples_near(px, view, candidate.color, is_near);
    show_pixel(px, view, level, disparity_now, candidate, near);
}
