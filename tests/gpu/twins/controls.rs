//! Planted errors in the shaders, of each module: the comparison of the function with its Rust twin must find them.

use super::probe::{caught, leaves_out};

/// A function, a text of its source, and what stands there instead.
const PLANTED: &[(&str, &str, &str)] = &[
    ("reservoir::combine", "draw * w_sum < w2", "draw * w_sum <= w2"),
    ("wrs::decide_sample", "draw * w_sum < candidate_w", "draw * w_sum <= candidate_w"),
    ("acuity::candidate_weight", "* inv_density_at_fovea", "* (1.01 * inv_density_at_fovea)"),
    ("reproject::nearest", "f32(x) + motion.x", "f32(x) - motion.x"),
    ("reproject::camera_vector", "disparity <= motion.sky", "disparity < motion.sky"),
    ("wrs::unspread", "+ FAR_FROM_CANDIDATE", ""),
    ("wrs::pack_reference", "c * scale + 0.5", "c * scale"),
    ("wrs::scale_by_trust", "a_es_decay(past.log_key, share)", "past.log_key"),
    ("debug_view::view_color", "srgb_decode(encoded.x)", "encoded.x"),
    ("rng::unit_draw", "f32(bits >> 8u) * (1.0 / 16777216.0)", "f32(bits) * (1.0 / 4294967296.0)"),
    ("rng::bits", "v = v ^ (v >> vec4u(16u));", ""),
    ("wrs::difference", "delta_e94(reference, stored)", "delta_e94(stored, reference)"),
    ("approx::exp_approx", "1.6666665e-1", "1.6666667e-1"),
    ("lab::lab", "0.376224", "0.37622404"),
    ("stored_reservoir::unpack", "out_u(result.age);", ""),
    ("doctor::spline", "(t + 1.0) * 0.5", "(t + 1.0) * 0.51"),
    ("doctor::is_code", "whole <= 254.0", "whole <= 255.0"),
    ("foveate::level_len", "(1u << level) - 1u) >> level", "(1u << level)) >> level"),
    ("foveate::bilinear", "blend(top, bottom, fraction.y)", "blend(top, bottom, fraction.x)"),
    ("foveate::gauss_next", "tap.ratio * tap.ratio_step,", "tap.ratio * tap.ratio,"),
    ("lattice::place_weight", "1.0 + 8.0 *", "1.0 + 4.0 *"),
    ("surface::float14_bits", "+ ((a >> 14u) & 1u)", "+ 1u"),
    ("surface::mip_texel", "vec4f(s.color, 1.0)", "vec4f(s.color, 0.0)"),
    ("resample::taps_around", "catmull_rom(fraction.y)", "catmull_rom(fraction.x)"),
    ("pack::tap_codes_between", "- first.x + last.y", "- first.x"),
    ("resample::nothing_gathered", "vec3f(0.0), 0.0, 0.0, true", "vec3f(0.0), 0.1, 0.0, true"),
    ("smr::decide", "if relit < unlit *", "if relit > unlit *"),
    ("smr::decide", "(correction * e.unit)", "correction"),
    ("reproject::world_motion_px", "motion.y - camera.y", "motion.y + camera.y"),
    ("reproject::moves_alike", "abs(other.y - own.y) <= within", "abs(other.y - own.x) <= within"),
    ("smr::mip_mean", "(a + b + c + d)", "(a + b + c + c)"),
    ("mip_noise::noise_difference", "deviations * inverse_unit", "deviations"),
    ("noise::add_noise", "(weight * weight) / n.samples", "weight / n.samples"),
    ("lens::is_visible", "f32(x) - f32(y)", "f32(y) - f32(x)"),
    ("quads::no_history_need", "LATER_SHARE * NO_HISTORY_NEED", "NO_HISTORY_NEED"),
    ("quads::is_even", "pattern.steps.y, pattern.turn", "pattern.steps.x, pattern.turn"),
    ("quads::with_past", "px2 < around.nearest_px2", "px2 > around.nearest_px2"),
    ("quads::octant_offsets", "(5 * rows + 1) / 2", "5 * rows / 2"),
    ("candidate::sample_weight", "select(OTHER_SURFACE, 1.0, same)", "1.0"),
    ("candidate::add_sample", "same && px2", "px2"),
    ("lod::lod_value", "code - 1u", "code"),
    ("reconstruction::mean_observation", "a.deviation * inverse", "a.deviation"),
    ("reconstruction::neighbour_weight", "own.error >= 0.0", "true"),
    ("reconstruction::unpack_rectification", "10u + 5u * i", "10u"),
    ("resize::resized_lod", "lod + shift", "lod - shift"),
    ("taa::root_luma", "to_ycocg(c).x", "to_ycocg(c).z"),
    ("taa::blend_clipped", "(roots(candidate) - clipped) * alpha", "(roots(candidate) - clipped) * (1.01 * alpha)"),
    ("taa::agreeing", "squares * count - sum * sum", "squares * count"),
    ("taau::sample_weights", "lobe(px2) * interpolation", "lobe(px2 * narrowed) * interpolation"),
    ("taau::accumulate", "vec2f(1.5, 5.0)", "vec2f(1.52, 5.0)"),
    ("stored_sample::pack_stored", "min((code + 16u) >> 5u, 0x7feu)", "min(code >> 5u, 0x7feu)"),
    ("antialias::next_run", "past.run + side", "past.run - side"),
    ("antialias::count_in_run", "past.run == next", "past.run != next"),
    ("stored_sample::with_motion", "moved_px > MOVES_PX", "moved_px >= MOVES_PX"),
    ("stored_sample::moved_alike", "moved_px >= STOPPED_PX", "moved_px > STOPPED_PX"),
    ("stored_sample::resized_stored", "old.y & MOVES", "old.x & MOVES"),
    ("stored_sample::interpolate", "a.square.y * a.weight - a.place.x", "a.square.y * a.weight - a.place.y"),
    (
        "reconstruction::relight",
        "(sqrt(a.squared) * inverse)) * RELIGHT_ERRORS",
        "(sqrt(a.weight) * inverse)) * RELIGHT_ERRORS",
    ),
    ("reconstruction::block_gain", "BLOCK_SHARED * (a.weight * a.weight)", "BLOCK_SHARED * a.weight"),
    ("reconstruction::block_vote", "is_nearer), 1.0", "is_nearer), o.confidence"),
    ("reconstruction::mean_fit", "sqrt(a.squared) * inverse)) * MEAN_ERRORS", "inverse)) * MEAN_ERRORS"),
    ("reconstruction::reconstruct", "share >= KEEP_SHARE && near", "share >= KEEP_SHARE"),
    ("reconstruction::accumulate", "near && share >= STAY_SHARE", "share >= STAY_SHARE"),
    ("demodulation::add_albedo", "select(own.xyz, there.xyz, there.w > 0.0)", "there.xyz"),
    ("demodulation::past_albedo", "> 1.0f / ALBEDO_STEPS", "> 2.0f / ALBEDO_STEPS"),
    ("demodulation::pack_albedo", "* ALBEDO_STEPS + up", "* ALBEDO_STEPS + 0.5"),
    ("demodulation::texture_of", "* ALBEDO_CLIP_COST", "* 3.9"),
    ("demodulation::retextured", "(unpack_albedo(word).xyz - goal)", "vec3f(0.0)"),
    ("antialias::clip", "max(abs(by.x), abs(by.y))", "abs(by.x)"),
];

#[test]
fn planted_errors_are_caught() {
    caught(PLANTED);
}

/// Errors that show only in rows with numbers below 2^-64.
const PLANTED_IN_SMALL_NUMBERS: &[(&str, &str, &str)] = &[
    ("wrs::decide_sample", "weight(past.w_sum * survival)", "past.w_sum * survival"),
    ("depth::disparity", "if v < 1e-30", "if v < 1e-29"),
];

#[test]
fn planted_errors_in_small_numbers_are_caught() {
    if leaves_out() {
        println!("such rows are not compared: the adapter flushes denormals to zero or rounds otherwise");
        return;
    }
    caught(PLANTED_IN_SMALL_NUMBERS);
}
