//#use acuity
//#use debug_view
//#use depth
//#use pack
//#use reproject
//#use rng
//#use scrub
//#use wrs
// The fused pass of weighted reservoirs: scrub, reproject, flush, expose, gate, bias, combine, store and show. Its twin on the CPU is
// src/cpu/wrs_pass.rs. One invocation a pixel; z is the view.

// What the frame brings and the settings ask for. A pipeline's constants; switched off means not compiled.
override PASS_THROUGH: u32 = 0u;
override COPY_ONLY: u32 = 0u;
override HAS_DEPTH: u32 = 1u;
override HAS_MOTION: u32 = 1u;
override HAS_TRUST: u32 = 1u;
override HAS_EXPOSURE: u32 = 1u;
override DEPTH_TEST: u32 = 1u;
override SAMPLER: u32 = 0u;
override BIAS: u32 = 2u;
override GATE: u32 = 1u;
override COUNT: u32 = 0u;
// 0, or a VIEW_* code: show what would be decided, and decide nothing.
override VIEW: u32 = 0u;

// src/gpu/types.rs: ViewConstants
struct ViewConstants {
    ray_scale: vec2<f32>,
    ray_offset: vec2<f32>,
    gaze_ray: vec4<f32>,
    depth_row: vec4<f32>,
    key: u32,
    unused_0: u32,
    unused_1: u32,
    unused_2: u32,
}

// src/gpu/types.rs: FrameConstants
struct FrameConstants {
    size: vec2<u32>,
    reset: u32,
    frame_low: u32,
    fovea_radius_deg: f32,
    inv_density_at_fovea: f32,
    exponential_survival: f32,
    gate_offset: f32,
    inv_gate_divisor: f32,
    depth_relative: f32,
    depth_slope_px: f32,
    disparity_a: f32,
    motion_scale: vec2<f32>,
    disparity_b: f32,
    disparity_flags: u32,
    exposure: f32,
    unused_0: u32,
    unused_1: u32,
    unused_2: u32,
    views: array<ViewConstants, 4>,
}

@group(0) @binding(0) var<uniform> frame: FrameConstants;
@group(0) @binding(1) var color_in: texture_2d_array<f32>;
@group(0) @binding(2) var depth_in: texture_2d_array<f32>;
@group(0) @binding(3) var motion_in: texture_2d_array<f32>;
@group(0) @binding(4) var trust_in: texture_2d_array<f32>;
@group(0) @binding(5) var past_colors: texture_2d_array<u32>;
@group(0) @binding(6) var past_weights: texture_2d_array<u32>;
@group(0) @binding(7) var past_keys: texture_2d_array<f32>;
@group(0) @binding(8) var next_colors: texture_storage_2d_array<rg32uint, write>;
@group(0) @binding(9) var next_weights: texture_storage_2d_array<r32uint, write>;
@group(0) @binding(10) var next_keys: texture_storage_2d_array<r32float, write>;
@group(0) @binding(11) var color_out: texture_storage_2d_array<rgba16float, write>;
@group(0) @binding(12) var<storage, read_write> counters: array<atomic<u32>, COUNTERS>;

// Words of the counters; src/stats.rs reads them.
const COUNT_NONFINITE: u32 = 0u;
const COUNT_BAD_DEPTH: u32 = 1u;
const COUNT_BAD_TRUST: u32 = 2u;
const COUNT_REPLACED: u32 = 3u;
const COUNT_VERDICTS: u32 = 4u;
const COUNTERS: u32 = COUNT_VERDICTS + VERDICT_COUNT;

// A workgroup's counts, so that few atomics leave it.
var<workgroup> group_counters: array<atomic<u32>, COUNTERS>;

// The history side of a pixel.
struct History {
    verdict: u32,
    past: Past,
    age: u32,
}

fn disparity_at(px: vec2<u32>, view: u32) -> f32 {
    let map = DisparityMap(frame.disparity_a, frame.disparity_b, frame.disparity_flags);
    return disparity(textureLoad(depth_in, px, view, 0).x, map);
}

// depth::slope with its reader: how much the surface's disparity changes from pixel to pixel, where that is wanted. A loop, because
// software Vulkan runs the body of an `if` for all pixels, but leaves a loop that no pixel wants after one round.
fn slope_at(px: vec2<u32>, view: u32, center: f32, wanted: bool) -> f32 {
    var total = 0.0;
    var before = INVALID_DISPARITY;
    let taps = select(0u, 4u, wanted);
    for (var i = 0u; i < taps; i++) {
        // Left, right, up, down.
        let ahead = (i & 1u) == 1u;
        let axis = select(vec2<i32>(0, 1), vec2<i32>(1, 0), i < 2u);
        let at = vec2<i32>(px) + select(-axis, axis, ahead);
        var tap = INVALID_DISPARITY;
        if all(at >= vec2<i32>(0)) && all(at < vec2<i32>(frame.size)) {
            tap = disparity_at(vec2<u32>(at), view);
        }
        if ahead {
            total += one_sided_slope(center, before, tap);
        }
        before = tap;
    }
    return total;
}

fn is_same_surface(px: vec2<u32>, view: u32, ray: vec3<f32>, disparity_now: f32, stored: f32) -> bool {
    let row = frame.views[view].depth_row;
    let stretch = row.x * ray.x + row.y * ray.y + row.z;
    let expected = previous_disparity(disparity_now, stretch, row.w);
    let plain = same_surface(expected, stored, frame.depth_relative, 0.0);
    // Few pixels pay for the four taps.
    let slope_px = frame.depth_slope_px * slope_at(px, view, disparity_now, !plain);
    return plain || same_surface(expected, stored, frame.depth_relative, slope_px);
}

fn count_if(condition: bool, word: u32) {
    if COUNT != 0u {
        if condition {
            atomicAdd(&group_counters[word], 1u);
        }
    }
}

fn no_history(verdict: u32) -> History {
    return History(verdict, Past(vec3<f32>(0.0), 0.0, LOWEST), 0u);
}

// The reservoir that a pixel continues and the age of its sample, or why it may not.
fn history_of(px: vec2<u32>, view: u32, ray: vec3<f32>, motion: vec2<f32>, disparity_now: f32) -> History {
    if frame.reset != 0u {
        return no_history(VERDICT_RESET);
    }
    let source = nearest(px.x, px.y, motion, frame.size);
    if source.verdict != VERDICT_VALID {
        return no_history(source.verdict);
    }
    let colors = textureLoad(past_colors, source.at, view, 0).xy;
    let stored = unpack(vec3<u32>(colors, textureLoad(past_weights, source.at, view, 0).x));
    if stored.w_sum == 0.0 {
        return no_history(VERDICT_EMPTY);
    }
    var past = Past(stored.color, stored.w_sum, LOWEST);
    if SAMPLER == SAMPLER_A_ES {
        past.log_key = textureLoad(past_keys, source.at, view, 0).x;
    }
    if HAS_TRUST != 0u {
        past = believe(past, textureLoad(trust_in, px, view, 0).x, SAMPLER);
        if past.w_sum == 0.0 {
            return no_history(VERDICT_DISTRUSTED);
        }
    }
    if DEPTH_TEST != 0u {
        if !is_same_surface(px, view, ray, disparity_now, stored.disparity) {
            return no_history(VERDICT_DISOCCLUDED);
        }
    }
    if HAS_EXPOSURE != 0u {
        past.color = expose(past.color, frame.exposure);
    }
    return History(VERDICT_VALID, past, stored.age);
}

// The same bytes in and out without the work between: what benches hold the pass against.
fn copy_only(px: vec2<u32>, view: u32, shown: vec3<f32>) {
    let motion = textureLoad(motion_in, px, view, 0).xy;
    let depth = textureLoad(depth_in, px, view, 0).x;
    let words = textureLoad(past_colors, px, view, 0).xy;
    let weight_word = textureLoad(past_weights, px, view, 0).x;
    // Nothing that was read may be optimised away.
    let used = bitcast<u32>(motion.x) ^ bitcast<u32>(motion.y) ^ bitcast<u32>(depth);
    textureStore(next_colors, px, view, vec4<u32>(words, 0u, 0u));
    textureStore(next_weights, px, view, vec4<u32>(weight_word ^ used, 0u, 0u, 0u));
    textureStore(color_out, px, view, vec4<f32>(shown, 1.0));
}

fn pixel(px: vec2<u32>, view: u32) {
    let candidate = color(textureLoad(color_in, px, view, 0).xyz);
    if COPY_ONLY != 0u {
        copy_only(px, view, candidate.color);
        return;
    }
    count_if(!candidate.usable, COUNT_NONFINITE);
    var motion = vec2<f32>(0.0);
    if HAS_MOTION != 0u {
        motion = textureLoad(motion_in, px, view, 0).xy * frame.motion_scale;
    }
    if PASS_THROUGH != 0u {
        // Never a constant: compilers fold colours of constants with other roundings.
        let verdict = select(VERDICT_EMPTY, VERDICT_RESET, frame.reset != 0u);
        count_if(true, COUNT_VERDICTS + verdict);
        show(px, view, candidate.color, PixelTrace(0.0, 0.0, 0u, 0.0, verdict, 1.0, true, motion));
        return;
    }
    let constants = frame.views[view];
    let ray = vec3<f32>(vec2<f32>(px) * constants.ray_scale + constants.ray_offset, 1.0);
    var candidate_w = 0.0;
    if candidate.usable {
        let e_deg = eccentricity_deg(ray, constants.gaze_ray.xyz);
        candidate_w = candidate_weight(e_deg, frame.fovea_radius_deg, frame.inv_density_at_fovea);
    }
    var disparity_now = INVALID_DISPARITY;
    if HAS_DEPTH != 0u {
        disparity_now = disparity_at(px, view);
        count_if(disparity_now == INVALID_DISPARITY, COUNT_BAD_DEPTH);
    }
    if HAS_TRUST != 0u {
        count_if(!is_finite(textureLoad(trust_in, px, view, 0).x), COUNT_BAD_TRUST);
    }
    let history = history_of(px, view, ray, motion, disparity_now);
    let valid = history.verdict == VERDICT_VALID;
    let params = WrsParams(SAMPLER, BIAS, frame.exponential_survival, GATE, frame.gate_offset, frame.inv_gate_divisor);
    let draw = unit_draw(bits(px.x, px.y, frame.frame_low, constants.key));
    let decision = step(candidate.color, candidate_w, history.past, params, draw);
    count_if(true, COUNT_VERDICTS + history.verdict);
    count_if(valid && decision.take, COUNT_REPLACED);

    let shown = select(history.past.color, candidate.color, decision.take);
    let age = select(min(history.age + 1u, MAX_AGE), 0u, decision.take);
    let survival = select(0.0, decision.survival, valid);
    let traced =
        PixelTrace(candidate_w, decision.w_sum, age, survival, history.verdict, decision.gate, decision.take, motion);
    show(px, view, shown, traced);
    if VIEW != 0u {
        return;
    }
    let words = pack(Stored(shown, disparity_now, decision.w_sum, age));
    textureStore(next_colors, px, view, vec4<u32>(words.xy, 0u, 0u));
    textureStore(next_weights, px, view, vec4<u32>(words.z, 0u, 0u, 0u));
    if SAMPLER == SAMPLER_A_ES {
        textureStore(next_keys, px, view, vec4<f32>(decision.log_key, 0.0, 0.0, 0.0));
    }
}

// The frame, or what was decided about it.
fn show(px: vec2<u32>, view: u32, shown: vec3<f32>, traced: PixelTrace) {
    if VIEW != 0u {
        textureStore(color_out, px, view, vec4<f32>(view_color(VIEW, traced), 1.0));
    } else {
        textureStore(color_out, px, view, vec4<f32>(shown, 1.0));
    }
}

@compute @workgroup_size(64, 1)
fn main(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if id.x < frame.size.x && id.y < frame.size.y {
        // The view from the workgroup, not the invocation: uniform, so that its constants are loaded once.
        pixel(id.xy, group.z);
    }
    if COUNT != 0u {
        workgroupBarrier();
        if lane < COUNTERS {
            let n = atomicLoad(&group_counters[lane]);
            if n > 0u {
                atomicAdd(&counters[lane], n);
            }
        }
    }
}
