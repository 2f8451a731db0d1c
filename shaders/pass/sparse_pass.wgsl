//#use kept_history
//#use kept_noise
//#use output
//#use rng
//#use sparse_samples
// Reconstruction of sparse frames from history that keeps samples in their places (smr). CPU twin: `pixel` in
// src/cpu/sparse_pass/pixel.rs; docs/method.md has the equations. One invocation a pixel; z is the view.

@group(0) @binding(7) var repaired_in: texture_2d_array<f32>;
@group(0) @binding(18) var next_kept: texture_storage_2d_array<rg32uint, write>;
@group(0) @binding(19) var next_noise: texture_storage_2d_array<r32uint, write>;
@group(0) @binding(21) var lights: texture_2d_array<u32>;
@group(0) @binding(22) var repair_mask: texture_2d_array<u32>;

// Whether the frame has samples of the pixels that a plan chose.
override REPAIR: u32 = 0u;

// Squared distance in pixels that stands for a missing sample.
const NO_PX2: f32 = 1e30;

// Candidate of a pixel, and its gain and fit.
struct Candidate {
    color: vec3<f32>,
    usable: bool,
    lod: f32,
    lowest: vec3<f32>,
    highest: vec3<f32>,
    gains: vec3<f32>,
    fit: f32,
    alpha: f32,
    noise: Noise,
    // Whether the candidate is this pixel's own sample.
    is_own: bool,
}

// A candidate without samples; the other fields are 0.
fn no_candidate() -> Candidate {
    var none: Candidate;
    none.gains = vec3<f32>(1.0);
    none.fit = 1.0;
    none.alpha = 1.0;
    none.noise = Noise(1.0, 0.0);
    return none;
}

// Squared distances of a pixel from two others along an axis.
fn offset_px2(px: u32, others: vec2<u32>) -> vec2<f32> {
    let offset = f32(px) - vec2<f32>(others);
    return offset * offset;
}

// Candidate from the samples around a pixel.
fn candidate_at(px: vec2<u32>, lattice: LatticeUniforms, view: u32, disparity_now: f32) -> Candidate {
    let near = around(px, lattice);
    let is_sample = near.x.fraction == 0.0 && near.y.fraction == 0.0;
    let level = lattice.level;
    var sum = vec4<f32>(0.0);
    var weights = 0.0;
    var gain_sum = vec3<f32>(0.0);
    var fit_sum = 0.0;
    var valid_sum = 0.0;
    var lowest = vec3<f32>(MAX_HALF);
    var highest = vec3<f32>(0.0);
    var nearest_px2 = NO_PX2;
    var own = Sanitized(vec3<f32>(0.0), false);
    var own_alpha = 1.0;
    var own_words = vec2<u32>(0u);
    var noises = NoiseSum(0.0, 0.0, 0.0);
    let codes = codes_between(disparity_now, 1.0f - SAMPLE_RELATIVE, 1.0f / (1.0f - SAMPLE_RELATIVE));
    let x_px2 = offset_px2(px.x, lattice.first_px.x + (near.x.points << vec2<u32>(level)));
    let y_px2 = offset_px2(px.y, lattice.first_px.y + (near.y.points << vec2<u32>(level)));
    let x_weights = vec2<f32>(point_weight(near.x.fraction, 0u), point_weight(near.x.fraction, 1u));
    let y_weights = vec2<f32>(point_weight(near.y.fraction, 0u), point_weight(near.y.fraction, 1u));
    let taps = select(0u, select(4u, 1u, level == 0u), near.any);
    // The pixel's own sample comes last: after the loop, the values are those of that sample.
    for (var left = taps; left > 0u; left--) {
        let tap = left - 1u;
        let right = (tap & 1u) != 0u;
        let below = tap >= 2u;
        let point = vec2<u32>(
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
            sum += vec4<f32>(sampled.color, select(1.0, given.w, is_finite(given.w))) * weight;
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

fn lattices_at(px: vec2<u32>, view: u32) -> PixelLattices {
    let index = lattice_index_at(px, view);
    let own = sparse.views[view][index];
    if NOISY == 0u {
        return PixelLattices(own, own);
    }
    let next = min(index + 1u, LATTICES - 1u);
    let coarser = sparse.views[view][next];
    if own.level == 0u && next > index && all(coarser.points > vec2<u32>(0u)) {
        return PixelLattices(own, coarser);
    }
    return PixelLattices(own, own);
}

// Candidate of a pixel at full rate. `fits`: how well history fits the samples of the next lattice.
fn full_rate_candidate(px: vec2<u32>, lattice: LatticeUniforms, view: u32, fits: f32) -> Candidate {
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
fn samples_near(px: vec2<u32>, lattice: LatticeUniforms, view: u32, needed: bool) -> Near {
    var near = Near(vec3<f32>(0.0), vec3<f32>(0.0), 0.0);
    let taps = select(0u, 9u, needed);
    for (var tap = 0u; tap < taps; tap++) {
        let point = px - lattice.first_px + vec2<u32>(tap % 3u, tap / 3u);
        let sampled = color(sample_at(clamp(point, vec2<u32>(1u), lattice.points) - 1u, lattice, view).xyz);
        if sampled.usable {
            near = add_near(near, sampled.color);
        }
    }
    return near;
}

// Result at a pixel that has history and a usable candidate, of jittered frames.
fn antialiased(
    px: vec2<u32>,
    view: u32,
    lattice: LatticeUniforms,
    given: Reconstruction,
    samples: f32,
    is_own: bool,
) -> Averaged {
    let full_rate = is_own && lattice.level == 0u;
    let near = samples_near(px, lattice, view, full_rate);
    if !is_own {
        return kept_mean(given, reconstruct(given), samples);
    }
    var inputs = given;
    var left = 1.0;
    if full_rate {
        let by = clip(near, inputs.history);
        inputs.history = clipped(inputs.history, by.change);
        inputs.nearest.color = clipped(inputs.nearest.color, by.change);
        left = by.kept;
    }
    return average(inputs, samples, -frame.views[view].jitter_px, left);
}

// Color and alpha of a pixel's repaired sample.
struct Repaired {
    color: vec3<f32>,
    alpha: f32,
    usable: bool,
}

// Sample of a pixel that a plan chose. Pixels of the full-rate lattice always have a sample of their own.
fn repaired(px: vec2<u32>, view: u32, level: u32) -> Repaired {
    if REPAIR == 0u {
        return Repaired(vec3<f32>(0.0), 1.0, false);
    }
    let chosen = textureLoad(repair_mask, px >> vec2<u32>(1u), view, 0).x != 0u && level > 0u;
    let given = textureLoad(repaired_in, texel_of(px, view, REPAIRED_IN), layer_of(view), 0);
    let own = color(given.xyz);
    return Repaired(own.color, given.w, chosen && own.usable);
}

// Pixels outside the visible area: black, without stored history.
fn hidden_pixel(px: vec2<u32>, view: u32) {
    let trace = PixelTrace(VERDICT_RESET, 0.0, 0.0, 0u, 0.0, 1.0, true, vec2<f32>(0.0));
    write_output(px, view, vec3<f32>(0.0), 1.0, trace);
    if VIEW == 0u {
        let empty = pack_kept(Kept(vec3<f32>(0.0), -1.0, -1.0, vec2<f32>(0.0)));
        textureStore(next_kept, px, view, vec4<u32>(empty, 0u, 0u));
        if NOISY != 0u {
            textureStore(next_noise, px, view, vec4<u32>(pack_noise(Noise(1.0, 0.0)), 0u, 0u, 0u));
        }
    }
}

fn pixel(px: vec2<u32>, view: u32) {
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
    let repair = repaired(px, view, lattice.level);
    if repair.usable {
        // The samples around the pixel still give gain and fit.
        candidate.color = repair.color;
        candidate.alpha = repair.alpha;
        candidate.usable = true;
        candidate.lod = 0.0;
        candidate.is_own = true;
        if NOISY != 0u {
            candidate.noise = noise_at(px, view);
        }
    }
    let surface = surface_of(px, view, lattice.level);
    let motion = surface.motion;
    let source = kept_source(px, view, surface);
    let previous = source.previous;
    let is_full_rate = lattice.level == 0u || repair.usable;
    let is_final = candidate.usable && is_full_rate && NOISY == 0u && ANTIALIAS == 0u;
    let kept = kept_history(source, view, may_have_history(previous) && !is_final);
    let history = kept.found;
    let verdict = select(previous.verdict, VERDICT_VALID, history.lod >= 0.0);
    let valid = verdict == VERDICT_VALID;
    count_pixel(px, view, candidate.usable, disparity_now, verdict);

    var shown = candidate.color;
    let candidate_lod = select(-1.0, candidate.lod, candidate.usable);
    var next = Kept(candidate.color, candidate_lod, surface.stored_disparity, vec2<f32>(0.0));
    var samples = 1.0;
    if ANTIALIAS != 0u && candidate.is_own {
        next.place_px = -frame.views[view].jitter_px;
    }
    var share = 0.0;
    var fits = 1.0;
    var noise = candidate.noise;
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
            inputs.moved = has_moved(vec2<f32>(0.0), history.nearest.place_px);
            inputs.gains = candidate.gains;
            inputs.fit = candidate.fit;
            inputs.trust = previous.trust;
            inputs.accumulate = frame.smr_accumulate;
            var result: Reconstructed;
            if NOISY != 0u {
                let accumulated = accumulate(inputs, stored_noise(kept.texel, view), candidate.noise);
                result = accumulated.result;
                noise = accumulated.noise;
            } else if ANTIALIAS != 0u {
                let averaged = antialiased(px, view, lattice, inputs, kept.samples, candidate.is_own);
                result = averaged.result;
                samples = averaged.samples;
            } else {
                result = reconstruct(inputs);
            }
            shown = result.color;
            share = result.share;
            fits = candidate.fit;
            next = result.kept;
        } else {
            shown = history.color;
            share = 1.0;
            next = history.nearest;
            samples = kept.samples;
            if NOISY != 0u {
                noise = stored_noise(kept.texel, view);
            }
        }
        next.disparity = surface.stored_disparity;
    }
    // Means of colors may exceed the largest half.
    shown = clamp(shown, vec3<f32>(-MAX_HALF), vec3<f32>(MAX_HALF));
    count_if(valid && share == 0.0, COUNT_REPLACED);
    let sharpness = exp2(-max(next.lod, 0.0));
    write_output(
        px,
        view,
        shown,
        candidate.alpha,
        PixelTrace(verdict, exp2(-candidate.lod), sharpness, 0u, share, fits, share == 0.0, motion),
    );
    if VIEW == 0u {
        var words = pack_kept(next);
        if ANTIALIAS != 0u {
            // The color is rounded stochastically.
            let draw = unit_draw(bits(px.x, px.y, frame.frame_low, frame.views[view].key));
            let stored = Kept(next.color, stored_lod(Mean(next.lod, samples)), next.disparity, next.place_px);
            words = vec2<u32>(pack_color_by(next.color, draw), pack_kept(stored).y);
        }
        textureStore(next_kept, px, view, vec4<u32>(words, 0u, 0u));
        if NOISY != 0u {
            textureStore(next_noise, px, view, vec4<u32>(pack_noise(noise), 0u, 0u, 0u));
        }
    }
}

@compute @workgroup_size(64, 1)
fn main(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) invocation: u32,
) {
    if id.x < frame.size.x && id.y < frame.size.y {
        pixel(id.xy, frame.first_view + group.z);
    }
    add_counts(invocation);
}
