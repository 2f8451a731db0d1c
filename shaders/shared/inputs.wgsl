//#use depth
//#use lens
//#use noise
//#use origin
//#use reproject
//#use sanitize
//#use view_uniforms
// Inputs of a pixel, and its counters; shared by all methods. CPU twin: src/cpu/inputs.rs.

// Which inputs the frame has, and which features are on. They are constants of a pipeline: code for absent inputs and
// for features that are off is not compiled.
override HAS_DEPTH: u32 = 1u;
override HAS_MOTION: u32 = 1u;
// Bit 0: pixels whose vector is `no_vector` or not finite have none. Bit 1: no vector contains the camera's motion.
override CAMERA_MOTION: u32 = 0u;
override HAS_TRUST_MASK: u32 = 1u;
// Whether there is a reactive mask: the trust is 1 minus it.
override HAS_REACTIVE: u32 = 0u;
override HAS_TRUST: u32 = HAS_TRUST_MASK | HAS_REACTIVE;
override DEPTH_TEST: u32 = 1u;
override NOISY: u32 = 0u;
// Whether colors are radiance, which the passes multiply by an exposure.
override EXPOSED: u32 = 0u;
override COUNT: u32 = 0u;
// 0: inputs and outputs have one layer a view. 1: each view has a region of its own; they are bound view by view.
override REGIONS: u32 = 0u;
// 0, or a VIEW_* code: output a debug view of the decision, and store nothing.
override VIEW: u32 = 0u;

// src/uniforms.rs: CameraUniforms, which documents the fields
struct CameraUniforms {
    motion: ViewMotion,
    no_vector: vec2f,
    is_known: u32,
    unused: u32,
}

// src/gpu/uniforms.rs: FrameUniforms, which documents the fields
struct FrameUniforms {
    size: vec2u,
    past_frame: u32,
    frame_low: u32,
    fovea_radius_deg: f32,
    inv_density_at_fovea: f32,
    exponential_survival: f32,
    gate_offset: f32,
    inv_gate_divisor: f32,
    depth_relative: f32,
    depth_slope_px: f32,
    exposure: f32,
    motion_scale: vec2f,
    mid_radius_deg: f32,
    blend_deg: f32,
    lod_mid: f32,
    lod_far: f32,
    smr_accumulate: f32,
    smr_accumulate_tolerance: f32,
    smr_tolerance: f32,
    first_view: u32,
    missing: u32,
    mip_levels: u32,
    color_exposure: f32,
    inverse_exposure: f32,
    largest_shown: f32,
    first_quad: u32,
    pattern_px: vec4u,
    single_pixels: u32,
    has_half: u32,
    has_budget: u32,
    unused: u32,
    views: array<ViewUniforms, 4>,
    cameras: array<CameraUniforms, 4>,
}

// Value of `FrameUniforms::past_frame` in a frame without history.
const NO_FRAME: u32 = 0xffffffffu;

// Numbers of the bindings of inputs and outputs, and of their entries in `ViewUniforms::origins`: src/gpu/binding.rs.
const COLOR_IN: u32 = 1u;
const DEPTH_IN: u32 = 2u;
const MOTION_IN: u32 = 3u;
const TRUST_IN: u32 = 4u;
const LOD_IN: u32 = 5u;
const NOISE_IN: u32 = 6u;
const REACTIVE_IN: u32 = 8u;
const HALF_IN: u32 = 9u;
const COLOR_OUT: u32 = 10u;
const DEBUG_OUT: u32 = 11u;
const ALBEDO_IN: u32 = 13u;

@group(0) @binding(0) var<uniform> frame: FrameUniforms;
@group(0) @binding(1) var color_in: texture_2d_array<f32>;
@group(0) @binding(2) var depth_in: texture_2d_array<f32>;
@group(0) @binding(3) var motion_in: texture_2d_array<f32>;
@group(0) @binding(4) var trust_in: texture_2d_array<f32>;
@group(0) @binding(6) var noise_in: texture_2d_array<f32>;
@group(0) @binding(8) var reactive_in: texture_2d_array<f32>;
@group(0) @binding(12) var<storage, read_write> counters: array<atomic<u32>, COUNTERS>;

// Layout of the counters; FrameStats::from_counters in src/stats.rs reads them.
const COUNT_NONFINITE: u32 = 0u;
const COUNT_BAD_DEPTH: u32 = 1u;
const COUNT_BAD_TRUST: u32 = 2u;
const COUNT_REPLACED: u32 = 3u;
const COUNT_VERDICTS: u32 = 4u;
const COUNTERS: u32 = COUNT_VERDICTS + VERDICT_COUNT;

// Counts of a workgroup. They need one global atomic for each counter and workgroup, instead of one for each pixel.
var<workgroup> group_counters: array<atomic<u32>, COUNTERS>;

// Texel of an input or output, of number `binding`.
fn texel_of(px: vec2u, view: u32, binding: u32) -> vec2u {
    if REGIONS == 0u {
        return px;
    }
    return from_origin(px, frame.views[view].origins[binding / 4u][binding % 4u]);
}

// Layer of an input or output.
fn layer_of(view: u32) -> u32 {
    if REGIONS == 0u {
        return view;
    }
    return 0u;
}

// Color and alpha of a texel, as the renderer wrote them.
fn given_at(texel: vec2u, view: u32) -> vec4f {
    return textureLoad(color_in, texel_of(texel, view, COLOR_IN), layer_of(view), 0);
}

// The same with the color in this frame's exposure.
fn color_at(texel: vec2u, view: u32) -> vec4f {
    return in_exposure(given_at(texel, view));
}

// A color and alpha as the renderer wrote them, with the color in this frame's exposure.
fn in_exposure(given: vec4f) -> vec4f {
    if EXPOSED == 0u {
        return given;
    }
    return vec4f(given.xyz * frame.color_exposure, given.w);
}

// A color in this frame's exposure, in the unit of the color input.
fn unexposed(exposed: vec3f) -> vec3f {
    if EXPOSED == 0u {
        return exposed;
    }
    return exposed * frame.inverse_exposure;
}

// The same, clamped to what the output can hold.
fn delivered(exposed: vec3f) -> vec3f {
    if EXPOSED == 0u {
        return exposed;
    }
    return clamp(unexposed(exposed), vec3f(-frame.largest_shown), vec3f(frame.largest_shown));
}

// Trust mask, not sanitized.
fn trust_at(px: vec2u, view: u32) -> f32 {
    if HAS_REACTIVE != 0u {
        return 1.0 - textureLoad(reactive_in, texel_of(px, view, REACTIVE_IN), layer_of(view), 0).x;
    }
    return textureLoad(trust_in, texel_of(px, view, TRUST_IN), layer_of(view), 0).x;
}

// Whether the lens shows a pixel.
fn is_seen(px: vec2u, view: u32) -> bool {
    return is_visible(px.x, px.y, frame.views[view].lowest_px, frame.views[view].highest_px);
}

fn ray_at(px: vec2u, view: u32) -> vec3f {
    return vec3f(vec2f(px) * frame.views[view].ray_scale + frame.views[view].ray_offset, 1.0);
}

// Motion vector of a pixel: previous minus current position in pixels, y down, without jitter, with the camera's
// motion.
fn motion_at(px: vec2u, view: u32) -> vec2f {
    var own = vec2f(0.0);
    if HAS_MOTION != 0u {
        let given = textureLoad(motion_in, texel_of(px, view, MOTION_IN), layer_of(view), 0).xy;
        own = given * frame.motion_scale + frame.views[view].motion_offset;
        if (CAMERA_MOTION & 1u) != 0u {
            let is_missing = has_no_vector(given, frame.cameras[view].no_vector);
            if !is_missing && CAMERA_MOTION == 1u {
                return own;
            }
            own = select(own, vec2f(0.0), is_missing);
        }
    }
    if CAMERA_MOTION == 0u {
        return own;
    }
    // An object's own motion ends where the camera would have seen it without moving.
    let ray = (vec2f(px) + own) * frame.views[view].ray_scale + frame.views[view].ray_offset;
    return own + camera_vector(ray, disparity_at(px, view), frame.cameras[view].motion);
}

// Noise of the candidate; valid only if NOISY is set.
fn noise_at(px: vec2u, view: u32) -> Noise {
    let given = textureLoad(noise_in, texel_of(px, view, NOISE_IN), layer_of(view), 0).xy;
    if EXPOSED == 0u {
        return candidate_noise(given);
    }
    return candidate_noise(vec2f(given.x * frame.color_exposure, given.y));
}

fn disparity_at(px: vec2u, view: u32) -> f32 {
    if HAS_DEPTH == 0u {
        return INVALID_DISPARITY;
    }
    let constants = frame.views[view];
    let map = DisparityMap(constants.disparity_a, constants.disparity_b, constants.disparity_flags);
    return disparity(textureLoad(depth_in, texel_of(px, view, DEPTH_IN), layer_of(view), 0).x, map);
}

// depth::slope: change of the surface's disparity a pixel; 0 unless `needed`. It is a loop with zero iterations for
// most pixels: software Vulkan runs the body of an `if` for all pixels, but leaves such a loop at once.
fn slope_at(px: vec2u, view: u32, center: f32, needed: bool) -> f32 {
    var total = 0.0;
    var before = INVALID_DISPARITY;
    let taps = select(0u, 4u, needed);
    for (var i = 0u; i < taps; i++) {
        // Left, right, up, down.
        let ahead = (i & 1u) == 1u;
        let axis = select(vec2i(0, 1), vec2i(1, 0), i < 2u);
        let at = vec2i(px) + select(-axis, axis, ahead);
        var tap = INVALID_DISPARITY;
        if all(at >= vec2i(0)) && all(at < vec2i(frame.size)) {
            tap = disparity_at(vec2u(at), view);
        }
        if ahead {
            total += one_sided_slope(center, before, tap);
        }
        before = tap;
    }
    return total;
}

// Disparity that the pixel's surface had in the previous frame.
fn expected_disparity(view: u32, ray: vec3f, disparity_now: f32) -> f32 {
    let row = frame.views[view].depth_row;
    let stretch = row.x * ray.x + row.y * ray.y + row.z;
    return previous_disparity(disparity_now, stretch, row.w);
}

// Depth test: whether the `stored` disparity belongs to this pixel's surface, which had the disparity `expected`. True
// without a depth test.
fn is_same_surface(px: vec2u, view: u32, disparity_now: f32, expected: f32, stored: f32) -> bool {
    if DEPTH_TEST == 0u {
        return true;
    }
    let plain = same_surface(expected, stored, frame.depth_relative, 0.0);
    // Only few pixels need the four taps of the slope.
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

// Counts a pixel's unusable inputs, and the verdict on its history.
fn count_pixel(px: vec2u, view: u32, usable: bool, disparity_now: f32, verdict: u32) {
    count_if(!usable, COUNT_NONFINITE);
    if HAS_DEPTH != 0u {
        count_if(disparity_now == INVALID_DISPARITY, COUNT_BAD_DEPTH);
    }
    if HAS_TRUST != 0u {
        count_if(!is_finite(trust_at(px, view)), COUNT_BAD_TRUST);
    }
    count_if(true, COUNT_VERDICTS + verdict);
}

// Adds a workgroup's counts to the frame's. All invocations of the workgroup must call it (it has a barrier).
fn add_counts(invocation: u32) {
    if COUNT != 0u {
        workgroupBarrier();
        if invocation < COUNTERS {
            let n = atomicLoad(&group_counters[invocation]);
            if n > 0u {
                atomicAdd(&counters[invocation], n);
            }
        }
    }
}
