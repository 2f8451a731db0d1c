//#use antialias
//#use past_frame
//#use sparse_samples
// Gain and fit of history around samples. CPU twin: `light` in src/cpu/sparse_pass/light.rs. One invocation a sample of
// lattice `frame.lattice`; z is the view.
//
// 27 reads and 1 write a sample: color, depth and observation of itself and its eight neighbours; 8 bytes written.

override RELIGHT_ON: u32 = 1u;
override ANTIALIAS: u32 = 0u;

@group(0) @binding(21) var observed: texture_2d_array<u32>;
@group(0) @binding(23) var lights_out: texture_storage_2d_array<rg32uint, write>;

struct Neighbour {
    observation: Observation,
    weight: f32,
    spatial: f32,
}

fn observation_at(point: vec2u, lattice: LatticeUniforms, view: u32) -> Observation {
    let words = textureLoad(observed, lattice.results + point, view, 0).xy;
    let sampled = color(sample_at(point, lattice, view).xyz).color;
    let known = words.y >> 16u;
    return Observation(
        sampled,
        unpack_color(words.x),
        half_value(words.y),
        known_confidence(known),
        known_deviation(known),
    );
}

fn disparity_of(point: vec2u, lattice: LatticeUniforms, view: u32) -> f32 {
    return disparity_at(px_of(point, lattice), view);
}

// Neighbour `tap` of 3x3. Its weight is 0 if it shows nothing about the light at the sample.
fn neighbour(
    tap: u32,
    point: vec2u,
    lattice: LatticeUniforms,
    view: u32,
    own: Observation,
    own_disparity: f32,
) -> Neighbour {
    let offset = vec2i(vec2u(tap % 3u, tap / 3u)) - 1;
    let at = vec2i(point) + offset;
    let points = lattice.points;
    let inside = all(at >= vec2i(0)) && all(at < vec2i(points));
    let other_point = vec2u(clamp(at, vec2i(0), vec2i(points) - 1));
    let other = observation_at(other_point, lattice, view);
    let same = alike(own_disparity, disparity_of(other_point, lattice, view), LIGHT_RELATIVE);
    if !(inside && same && other.error >= 0.0) {
        return Neighbour(other, 0.0, 0.0);
    }
    let spatial = neighbour_weight(offset);
    if own.error >= 0.0 {
        return Neighbour(other, agreement(own, other, spatial), spatial);
    }
    return Neighbour(other, spatial * other.confidence, spatial);
}

// Fit at the sample's own pixel. A single noisy sample does not show whether history fits.
fn fit_at_sample(own: Observation, gains: vec3f) -> f32 {
    if NOISY != 0u || own.error < 0.0 {
        return 1.0;
    }
    return own_fit(own, gains);
}

fn light(point: vec2u, lattice: LatticeUniforms, view: u32) -> vec2u {
    let own = observation_at(point, lattice, view);
    let own_disparity = disparity_of(point, lattice, view);
    var without = 0.0;
    var capped = 0.0;
    var scatter = 0.0;
    var sum = ObservedAround(vec3f(0.0), vec3f(0.0), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    // A variable count on purpose: Mesa would unroll a constant one and reorder its sums of products.
    let taps = select(0u, 9u, has_history());
    for (var tap = 0u; tap < taps; tap++) {
        let near = neighbour(tap, point, lattice, view, own, own_disparity);
        if near.spatial > 0.0 {
            sum = add_observation(sum, near.observation, near.weight, near.spatial);
            let errors = errors_left(near.observation, vec3f(1.0));
            without += errors * near.weight;
            capped += capped_error(near.observation, errors, near.spatial);
            if ANTIALIAS != 0u {
                let difference = min(root_difference(near.observation.sampled, near.observation.history), 1e6);
                scatter += (difference * difference) * near.weight;
            }
        }
    }
    let is_own = own.error >= 0.0;
    // A sample without disparity is interpolated only where no other sample is near.
    let own_surface = select(own_disparity, INVALID_DISPARITY, ANTIALIAS != 0u && own.error == DOUBTFUL);
    if sum.weight < 1e-6 {
        let fit_unlit = fit_at_sample(own, vec3f(1.0));
        return pack_lit(Lit(vec3f(1.0), 1.0, fit_unlit, is_own, own_surface));
    }
    var gains = vec3f(1.0);
    if RELIGHT_ON != 0u {
        var error = mean_error(sum);
        if ANTIALIAS != 0u {
            error = scattered_error(sum, scatter);
        }
        gains = relight(sum, error);
    }
    let is_relit = any(gains != vec3f(1.0));
    var with_gain = 0.0;
    for (var tap = 0u; tap < select(0u, taps, is_relit); tap++) {
        let near = neighbour(tap, point, lattice, view, own, own_disparity);
        if near.spatial > 0.0 {
            with_gain += errors_left(near.observation, gains) * near.weight;
        }
    }
    if !is_relit || with_gain > without {
        gains = vec3f(1.0);
        with_gain = without;
    }
    var fit_now = fit_around(sum, with_gain, fit_of_samples(sum, capped));
    if NOISY != 0u {
        let confidence = min(sum.weight / sum.spatial, 1.0);
        fit_now = min(fit(with_gain / sum.weight, confidence), mean_fit(sum, confidence));
    }
    return pack_lit(Lit(gains, fit_now, fit_at_sample(own, gains), is_own, own_surface));
}

@compute @workgroup_size(64, 1)
fn main(@builtin(global_invocation_id) id: vec3u, @builtin(workgroup_id) group: vec3u) {
    let view = frame.first_view + group.z;
    let lattice = sparse.views[view][frame.lattice];
    if all(id.xy < lattice.points) {
        let words = light(id.xy, lattice, view);
        textureStore(lights_out, lattice.results + id.xy, view, vec4u(words, 0u, 0u));
    }
}
