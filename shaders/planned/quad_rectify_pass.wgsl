//#use antialias
//#use past_frame
//#use quad_plan
//#use quad_samples
// Gain and fit of history around shaded quads. CPU twin: `rectify_quad` in src/cpu/planned/quad_samples.rs. One
// invocation a shaded quad; quads of the fovea are not compared.
//
// 112 reads and 1 write a quad: color, depth and observation of its own pixels and of the pixels of eight quads around
// it, and its neighbours; 16 bytes written. Where light changes the reads are made twice, or three times.

override RELIGHT_ON: u32 = 1u;
override ANTIALIAS: u32 = 0u;

@group(0) @binding(21) var observed: texture_2d_array<u32>;
@group(0) @binding(22) var block_gains: texture_2d_array<u32>;
@group(0) @binding(23) var rectified_out: texture_storage_2d_array<rgba32uint, write>;

fn observation_at(px: vec2u, view: u32) -> Observation {
    let words = textureLoad(observed, px, view, 0).xy;
    return unpack_observation(words, color(sample_at(px, view).xyz).color);
}

fn is_alike(own_disparity: f32, px: vec2u, view: u32) -> bool {
    return DEPTH_TEST == 0u || same_surface(own_disparity, disparity_at(px, view), LIGHT_RELATIVE, 0.0);
}

// Whether a pixel of a quad is in the frame and was compared with history.
fn is_compared(px: vec2u, view: u32) -> bool {
    return all(px < frame.size) && is_observed(textureLoad(observed, min(px, frame.size - 1u), view, 0).xy);
}

// The quad's own comparison: the mean over the surface of its first compared pixel. Its error is negative without one.
struct Own {
    observation: Observation,
    disparity: f32,
}

fn own_of(quad: vec2u, view: u32) -> Own {
    var first = 4u;
    for (var left = 4u; left > 0u; left--) {
        first = select(first, left - 1u, is_compared(px_of_quad(quad, left - 1u), view));
    }
    let disparity_now = disparity_at(px_of_quad(quad, first & 3u), view);
    var sum = none_around();
    var confidence = 0.0;
    let taps = select(4u, 0u, first == 4u);
    for (var i = 0u; i < taps; i++) {
        let px = px_of_quad(quad, i);
        if is_compared(px, view) && is_alike(disparity_now, px, view) {
            let o = observation_at(px, view);
            sum = add_observation(sum, o, 1.0, 1.0);
            confidence += o.confidence;
        }
    }
    return Own(mean_observation(sum, confidence), disparity_now);
}

struct Neighbour {
    observation: Observation,
    weight: f32,
    spatial: f32,
}

// Pixel `tap` of 36: four of each of the eight quads around, then the quad's own. Its weight is 0 if it shows nothing
// about the light at the quad.
fn neighbour_at(tap: u32, quad: vec2u, view: u32, own: Own, around: vec2u, least: f32) -> Neighbour {
    let code = select(code_of(around, tap >> 2u), NOWHERE, tap >= 32u);
    let offset = neighbour_offset(code);
    let px = px_of_quad(vec2u(vec2i(quad) + offset), tap & 3u);
    var near = Neighbour(no_observation(), 0.0, 0.0);
    let is_there = code != NOWHERE || tap >= 32u;
    if !is_there || !is_compared(px, view) || !is_alike(own.disparity, px, view) {
        return near;
    }
    near.observation = observation_at(px, view);
    near.spatial = spatial_weight(f32(offset.x * offset.x + offset.y * offset.y), least);
    near.weight = neighbour_weight(own.observation, near.observation, near.spatial);
    return near;
}

fn rectify(quad: vec2u, view: u32) -> vec4u {
    let around = textureLoad(quad_around, quad, view, 0).xy;
    let own = own_of(quad, view);
    var least = 0x1p126;
    for (var i = 0u; i < 8u; i++) {
        let code = code_of(around, i);
        let offset = neighbour_offset(code);
        least = select(least, min(least, f32(offset.x * offset.x + offset.y * offset.y)), code != NOWHERE);
    }
    var sum = none_around();
    var without = 0.0;
    var votes = vec2f(0.0);
    var scatter = 0.0;
    // A variable count on purpose: Mesa would unroll a constant one and reorder its sums of products.
    let is_compared_quad = level_of(textureLoad(quad_mask, quad, view, 0).x) > 0u;
    let taps = select(0u, 36u, has_history() && is_compared_quad);
    for (var tap = 0u; tap < taps; tap++) {
        let near = neighbour_at(tap, quad, view, own, around, least);
        if near.spatial > 0.0 {
            sum = add_observation(sum, near.observation, near.weight, near.spatial);
            let errors = errors_left(near.observation, vec3f(1.0));
            without += errors * near.weight;
            if tap < 32u {
                votes += vote(near.observation, errors, near.spatial);
            }
            if ANTIALIAS != 0u {
                scatter = add_scatter(scatter, near.observation, near.weight);
            }
        }
    }
    var r = QuadRectification(vec3f(1.0), 1.0, vec4f(1.0), own.observation.error >= 0.0, vec4f(INVALID_DISPARITY));
    if sum.weight >= 1e-6 {
        var error = mean_error(sum);
        if ANTIALIAS != 0u {
            error = scattered_error(sum, scatter);
        }
        // The gain around the quad, and that of its block.
        var gains = relight(sum, error);
        var left = without;
        for (var i = 0u; RELIGHT_ON != 0u && i < 2u; i++) {
            let is_relit = any(gains != vec3f(1.0));
            var with_gain = 0.0;
            for (var tap = 0u; tap < select(0u, taps, is_relit); tap++) {
                let near = neighbour_at(tap, quad, view, own, around, least);
                if near.spatial > 0.0 {
                    with_gain += errors_left(near.observation, gains) * near.weight;
                }
            }
            if is_relit && gain_helps(with_gain, without, i == 1u) && with_gain <= left {
                r.gains = gains;
                left = with_gain;
            }
            gains = unpack_color(textureLoad(block_gains, quad / BLOCK_QUADS, view, 0).x);
        }
        var fit_of_quad = 0.0;
        if own.observation.error >= 0.0 {
            fit_of_quad = center_fit(own.observation, vec3f(1.0));
        }
        r.fit = fit_around(sum, left, fit_by_votes(sum, votes, fit_of_quad));
        if NOISY != 0u {
            r.fit = noisy_fit_around(sum, left);
        }
    }
    for (var i = 0u; i < 4u; i++) {
        let px = px_of_quad(quad, i);
        if all(px < frame.size) {
            // Not `r.disparities[i] = ...`: FXC, which wgpu has on Windows without another compiler, cannot write
            // vectors so.
            let is_i = vec4u(0u, 1u, 2u, 3u) == vec4u(i);
            r.disparities = select(r.disparities, vec4f(disparity_at(px, view)), is_i);
            // A single noisy sample does not show whether history fits.
            if NOISY == 0u && is_compared(px, view) {
                let fits = center_fit(observation_at(px, view), r.gains);
                r.center_fits = select(r.center_fits, vec4f(fits), is_i);
            }
        }
    }
    return pack_rectification(r);
}

@compute @workgroup_size(64, 1)
fn main(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) invocation: u32) {
    let view = frame.first_view;
    let i = invocation_of(group, invocation);
    if i < quad_count() {
        let quad = listed_quad(i);
        textureStore(rectified_out, quad, view, rectify(quad, view));
    }
}
