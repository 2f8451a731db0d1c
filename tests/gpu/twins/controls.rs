//! Planted errors in the shaders, of each module: the comparison of the function with its Rust twin must find them.

use super::probe::caught;

/// A function, a text of its source, and what stands there instead.
const PLANTED: &[(&str, &str, &str)] = &[
    ("reservoir::combine", "draw * w_sum < w2", "draw * w_sum <= w2"),
    ("wrs::decide_sample", "draw * w_sum < candidate_w", "draw * w_sum <= candidate_w"),
    ("wrs::decide_sample", "weight(past.w_sum * survival)", "past.w_sum * survival"),
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
    ("color::lab", "0.376224", "0.37622404"),
    ("pack::unpack", "out_u(result.age);", ""),
    ("doctor::spline", "(t + 1.0) * 0.5", "(t + 1.0) * 0.51"),
    ("doctor::is_code", "whole <= 254.0", "whole <= 255.0"),
    ("foveate::level_len", "(1u << level) - 1u) >> level", "(1u << level)) >> level"),
    ("foveate::bilinear", "blend(top, bottom, fraction.y)", "blend(top, bottom, fraction.x)"),
    ("foveate::gauss_next", "tap.ratio * tap.ratio_step,", "tap.ratio * tap.ratio,"),
    ("lattice::place_weight", "1.0 + 8.0 *", "1.0 + 4.0 *"),
    ("surface::float14_bits", "+ ((a >> 14u) & 1u)", "+ 1u"),
    ("surface::mip_texel", "vec4f(s.color, 1.0)", "vec4f(s.color, 0.0)"),
    ("resample::taps_around", "catmull_rom(fraction.y)", "catmull_rom(fraction.x)"),
    ("resample::tap_codes_between", "- first.x + last.y", "- first.x"),
    ("resample::nothing_gathered", "vec3f(0.0), 0.0, 0.0, true", "vec3f(0.0), 0.1, 0.0, true"),
    ("smr::decide", "if relit < unlit *", "if relit > unlit *"),
    ("smr::decide", "(correction * e.unit)", "correction"),
    ("reproject::moves_alike", "abs(other.y - own.y) <= within", "abs(other.y - own.x) <= within"),
    ("smr::mip_mean", "(a + b + c + d)", "(a + b + c + c)"),
    ("noise::noise_difference", "deviations * inverse_unit", "deviations"),
    ("noise::add_noise", "(weight * weight) / n.samples", "weight / n.samples"),
    ("lens::is_visible", "f32(x) - f32(y)", "f32(y) - f32(x)"),
    ("quads::no_history_need", "LATER_SHARE * NO_HISTORY_NEED", "NO_HISTORY_NEED"),
    ("quads::octant_offsets", "(5 * rows + 1) / 2", "5 * rows / 2"),
    ("sparse_smr::quad_lit", "10u + 5u * i", "10u"),
    ("resize::resized_lod", "lod + shift", "lod - shift"),
    ("taa::root_luma", "to_ycocg(c).x", "to_ycocg(c).z"),
    ("taa::blend_clipped", "(roots(candidate) - clipped) * alpha", "(roots(candidate) - clipped) * (1.01 * alpha)"),
    ("taa::agreeing", "squares * count - sum * sum", "squares * count"),
    ("taau::sample_weights", "lobe(px2) * interpolation", "lobe(px2 * narrowed) * interpolation"),
    ("taau::accumulate", "vec2f(1.5, 5.0)", "vec2f(1.52, 5.0)"),
    ("stored_sample::pack_stored", "min((code + 8u) >> 4u, 0xffeu)", "min(code >> 4u, 0xffeu)"),
    ("antialias::next_run", "past.run + side", "past.run - side"),
    ("antialias::count_in_run", "past.run == next", "past.run != next"),
    ("stored_sample::interpolate", "a.square.y * a.weight - a.place.x", "a.square.y * a.weight - a.place.y"),
    (
        "sparse_smr::relight",
        "(sqrt(a.squared) * inverse)) * RELIGHT_ERRORS",
        "(sqrt(a.weight) * inverse)) * RELIGHT_ERRORS",
    ),
    ("sparse_smr::mean_fit", "sqrt(a.squared) * inverse)) * MEAN_ERRORS", "inverse)) * MEAN_ERRORS"),
    ("sparse_smr::reconstruct", "share >= KEEP_SHARE && near", "share >= KEEP_SHARE"),
    ("sparse_smr::accumulate", "near && share >= STAY_SHARE", "share >= STAY_SHARE"),
    ("depth::disparity", "if v < 1e-30", "if v < 1e-29"),
    ("antialias::clip", "max(abs(by.x), abs(by.y))", "abs(by.x)"),
];

#[test]
fn planted_errors_are_caught() {
    caught(PLANTED);
}
