//#use each_pixel
//#use sparse_pixel
//#use sparse_samples
// Reconstruction of sparse frames: candidates of pixels from the samples of lattices. CPU twin: `candidate` in
// src/cpu/sparse_pass/pixel.rs; docs/method.md has the equations.

@group(0) @binding(21) var lights: texture_2d_array<u32>;

// Squared distance in pixels that stands for a missing sample.
const NO_PX2: f32 = 1e30;

// Squared distances of a pixel from two others along an axis.
fn offset_px2(px: u32, others: vec2u) -> vec2f {
    let offset = f32(px) - vec2f(others);
    return offset * offset;
}

// Candidate from the samples around a pixel.
fn candidate_at(px: vec2u, lattice: LatticeUniforms, view: u32, disparity_now: f32) -> Candidate {
    let near = around(px, lattice);
    let is_sample = near.x.fraction == 0.0 && near.y.fraction == 0.0;
    let level = lattice.level;
    var sum = vec4f(0.0);
    var weights = 0.0;
    var gain_sum = vec3f(0.0);
    var fit_sum = 0.0;
    var valid_sum = 0.0;
    var lowest = vec3f(MAX_HALF);
    var highest = vec3f(0.0);
    var nearest_px2 = NO_PX2;
    var own = Sanitized(vec3f(0.0), false);
    var own_alpha = 1.0;
    var own_words = vec2u(0u);
    var noises = NoiseSum(0.0, 0.0, 0.0);
    let codes = codes_between(disparity_now, 1.0f - SAMPLE_RELATIVE, 1.0f / (1.0f - SAMPLE_RELATIVE));
    let x_px2 = offset_px2(px.x, lattice.first_px.x + (near.x.points << vec2u(level)));
    let y_px2 = offset_px2(px.y, lattice.first_px.y + (near.y.points << vec2u(level)));
    let x_weights = vec2f(point_weight(near.x.fraction, 0u), point_weight(near.x.fraction, 1u));
    let y_weights = vec2f(point_weight(near.y.fraction, 0u), point_weight(near.y.fraction, 1u));
    let taps = select(0u, select(4u, 1u, level == 0u), near.any);
    // The pixel's own sample comes last: after the loop, the values are those of that sample.
    for (var left = taps; left > 0u; left--) {
        let tap = left - 1u;
        let right = (tap & 1u) != 0u;
        let below = tap >= 2u;
        let point = vec2u(
            select(near.x.points.x, near.x.points.y, right),
            select(near.y.points.x, near.y.points.y, below),
        );
        let given = sample_at(point, lattice, view);
        let sampled = color(given.xyz);
        let words = textureLoad(lights, lattice.results + point, view, 0).xy;
        let lit = unpack_lit(words);
        let same = DEPTH_TEST == 0u || has_code(words.y, codes);
        own = sampled;
        own_alpha = given.w;
        own_words = words;
        if sampled.usable {
            let share = select(x_weights.x, x_weights.y, right) * select(y_weights.x, y_weights.y, below);
            let weight = max(share, LEAST_SHARE) * select(OTHER_SURFACE, 1.0, same);
            let known = weight * select(BY_NEIGHBOURS, 1.0, lit.is_own);
            sum += vec4f(sampled.color, select(1.0, given.w, is_finite(given.w))) * weight;
            weights += weight;
            gain_sum += lit.gains * known;
            fit_sum += lit.fit * known;
            valid_sum += known;
            lowest = min(lowest, sampled.color);
            highest = max(highest, sampled.color);
            if NOISY != 0u {
                noises = add_noise(noises, noise_at(px_of(point, lattice), view), weight);
            }
            let px2 = select(x_px2.x, x_px2.y, right) + select(y_px2.x, y_px2.y, below);
            nearest_px2 = select(nearest_px2, min(nearest_px2, px2), same);
        }
    }
    if level == 0u {
        let none = no_candidate();
        var candidate = none;
        candidate.color = own.color;
        candidate.usable = own.usable;
        candidate.alpha = own_alpha;
        candidate.is_own = own.usable;
        return candidate;
    }
    if weights == 0.0 {
        return no_candidate();
    }
    let coarsest = f32(level);
    let lod = select(candidate_level(sqrt(nearest_px2), coarsest), coarsest + 1.0, nearest_px2 == NO_PX2);
    let mean = sum * (1.0 / weights);
    let same = DEPTH_TEST == 0u || disparity_now < 0.0 || has_code(own_words.y, codes);
    let is_own = is_sample && own.usable && (ANTIALIAS == 0u || same);
    let known = 1.0 / valid_sum;
    var noise = Noise(1.0, 0.0);
    if NOISY != 0u {
        noise = mean_noise(noises);
        if is_own {
            noise = noise_at(px, view);
        }
    }
    var candidate: Candidate;
    candidate.color = select(mean.xyz, own.color, is_own);
    candidate.usable = true;
    candidate.lod = lod;
    candidate.lowest = lowest;
    candidate.highest = highest;
    candidate.gains = gain_sum * known;
    candidate.fit = min(fit_sum * known, select(1.0, unpack_lit(own_words).own_fit, is_own));
    candidate.alpha = select(mean.w, own_alpha, is_own);
    candidate.noise = noise;
    candidate.is_own = is_own;
    return candidate;
}

// The lattice by which a pixel is shaded, and the lattice whose samples give the fit of history. For noisy pixels at
// full rate that is the next lattice, if it has samples.
struct PixelLattices {
    own: LatticeUniforms,
    judging: LatticeUniforms,
}

fn lattices_at(px: vec2u, view: u32) -> PixelLattices {
    let index = lattice_index_at(px, view);
    let own = sparse.views[view][index];
    if NOISY == 0u {
        return PixelLattices(own, own);
    }
    let next = min(index + 1u, LATTICES - 1u);
    let coarser = sparse.views[view][next];
    if own.level == 0u && next > index && all(coarser.points > vec2u(0u)) {
        return PixelLattices(own, coarser);
    }
    return PixelLattices(own, own);
}

// Candidate of a pixel at full rate. `fits`: how well history fits the samples of the next lattice.
fn full_rate_candidate(px: vec2u, lattice: LatticeUniforms, view: u32, fits: f32) -> Candidate {
    let given = sample_at(px - lattice.first_px, lattice, view);
    let own = color(given.xyz);
    var candidate = no_candidate();
    candidate.alpha = given.w;
    if own.usable {
        candidate.color = own.color;
        candidate.usable = true;
        candidate.fit = fits;
        candidate.noise = noise_at(px, view);
    }
    return candidate;
}

// Sums over the nine samples around a pixel of full rate, whose own sample is usable; without samples unless `needed`.
// A variable count on purpose: Mesa would unroll a constant one and reorder its sums of products.
fn samples_near(px: vec2u, lattice: LatticeUniforms, view: u32, needed: bool) -> Near {
    var near = Near(vec3f(0.0), vec3f(0.0), 0.0);
    let taps = select(0u, 9u, needed);
    for (var tap = 0u; tap < taps; tap++) {
        let point = px - lattice.first_px + vec2u(tap % 3u, tap / 3u);
        let sampled = color(sample_at(clamp(point, vec2u(1u), lattice.points) - 1u, lattice, view).xyz);
        if sampled.usable {
            near = add_near(near, sampled.color);
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
    let lattices = lattices_at(px, view);
    let lattice = lattices.own;
    var candidate = candidate_at(px, lattices.judging, view, disparity_now);
    if NOISY != 0u && lattice.level == 0u {
        candidate = full_rate_candidate(px, lattice, view, candidate.fit);
    }
    let has_near = ANTIALIAS != 0u && candidate.is_own && lattice.level == 0u;
    let near = samples_near(px, lattice, view, has_near);
    show_pixel(px, view, lattice.level, disparity_now, candidate, near);
}
