//! Planted errors in the shaders: the comparison of the function with its Rust twin must find each.

use super::probe::caught;

/// A function, a text of its source, and what stands there instead.
const PLANTED: &[(&str, &str, &str)] = &[
    // A lax comparison.
    ("reservoir::combine", "draw * w_sum < w2", "draw * w_sum <= w2"),
    ("reservoir::update", "draw * w_sum < w;", "draw * w_sum <= w;"),
    ("wrs::step", "draw * w_sum < candidate_w", "draw * w_sum <= candidate_w"),
    // H04: a weight below the normal range.
    ("wrs::step", "weight(past.w_sum * survival)", "past.w_sum * survival"),
    // A weight one percent off.
    ("acuity::candidate_weight", "* inv_density_at_fovea", "* (1.01 * inv_density_at_fovea)"),
    // A flipped motion sign.
    ("reproject::nearest", "f32(x) + motion.x", "f32(x) - motion.x"),
    // The sky moves with the camera's place; a previous position behind the camera; a turn without its tangent.
    ("reproject::camera_vector", "disparity <= motion.sky", "disparity < motion.sky"),
    ("reproject::camera_vector", "distance <= 1e-6", "distance <= -1.0"),
    ("reproject::has_no_vector", "all(given == none)", "any(given == none)"),
    // Sloppy means and references.
    ("wrs::sharpen", "w *= candidate_w;", "w *= w;"),
    ("wrs::unspread", "+ FAR_FROM_CANDIDATE", ""),
    ("matched::decide", " && costs", ""),
    ("matched::strongest_gain", "least * most < 1.0", "least < 1.0"),
    ("matched::may_relight", "finer == 1.0 || noisy", "true"),
    ("wrs::at_rate", "-2.0 * f32(exponent)", "-2.5 * f32(exponent)"),
    ("wrs::combined", "|| candidate_w == decision.w_sum", ""),
    ("wrs::compared", "reference.color, level != NO_LEVEL && ", "reference.color, "),
    ("wrs::next_reference", "take || ", ""),
    ("wrs::pack_reference", "c * scale + 0.5", "c * scale"),
    // Trust after the fact and a forgotten limit.
    ("wrs::scale_by_trust", "a_es_decay(past.log_key, share)", "past.log_key"),
    ("sanitize::trust", "return 1.0;", "return t;"),
    ("wrs::expose", "clamp(stored_color * ratio, vec3<f32>(-MAX_HALF), vec3<f32>(MAX_HALF))", "stored_color * ratio"),
    // A wrong color of a decision.
    ("debug_view::view_color", "srgb_decode(encoded.x)", "encoded.x"),
    ("debug_view::motion_color", "clamp(-motion.x", "clamp(motion.x"),
    // Draws without the shift.
    ("rng::unit_draw", "f32(bits >> 8u) * (1.0 / 16777216.0)", "f32(bits) * (1.0 / 4294967296.0)"),
    ("rng::bits", "v = v ^ (v >> vec4<u32>(16u));", ""),
    // Swapped colors.
    ("wrs::difference", "delta_e94(reference, stored)", "delta_e94(stored, reference)"),
    ("color::delta_e94", "delta_e94(in_v(0u), in_v(3u))", "delta_e94(in_v(3u), in_v(0u))"),
    // One wrong last bit.
    ("approx::exp", "1.6666665e-1", "1.6666667e-1"),
    ("color::lab", "0.376224", "0.37622404"),
    ("approx::atan2_upper", "const TAN_PI_8: f32 = 0.41421356;", "const TAN_PI_8: f32 = 0.41421354;"),
    // An unwritten word.
    ("pack::unpack", "out_u(result.age);", ""),
    // Wrong evidence.
    ("doctor::spline", "(t + 1.0) * 0.5", "(t + 1.0) * 0.51"),
    ("doctor::lattice_texel", "(point << level) + lattice_offset(level)", "point << level"),
    ("doctor::lattice_len", "max(len, 1u) - 1u, lattice_offset", "len, lattice_offset"),
    ("doctor::kink_class", "at + (at & 1u)", "at"),
    ("doctor::bend", "(after - at) - (at - before)", "(after - at) + (at - before)"),
    ("doctor::is_code", "whole <= 254.0", "whole <= 255.0"),
    ("doctor::kept_bits", "select(bits, 0u, size < 0x00800000u)", "bits"),
    ("doctor::signal", "green >= 1e-30", "green >= 0.0"),
    // A shifted level.
    ("foveate::level_len", "(1u << level) - 1u) >> level", "(1u << level)) >> level"),
    ("foveate::level_coordinate", "(127u - level)", "(126u - level)"),
    ("foveate::block_sample", ">> block_sample_level(level)", ">> level"),
    // Swapped bilinear fractions.
    ("foveate::bilinear", "blend(top, bottom, fraction.y)", "blend(top, bottom, fraction.x)"),
    ("foveate::blend", "a + (b - a) * t", "b + (a - b) * t"),
    // A wrong border.
    ("foveate::split", "0.0, f32(len - 1u)", "0.0, f32(len)"),
    ("foveate::block_center_px", "edge_px - 0.5, f32(len - 1u)", "edge_px - 0.5, f32(len)"),
    // A wrong sample.
    ("lattice::between", "let low = distance >> level;", "let low = distance / (1 << level);"),
    ("lattice::nearest_point", "((1i << level) >> 1u)", "(1i << level)"),
    ("lattice::point_offset_px", "(i32(px) - i32(first))", "(i32(first) - i32(px))"),
    ("lattice::place_weight", "offset_px.y * offset_px.y", "offset_px.x * offset_px.y"),
    ("lattice::point_weight", "point == 0u", "point == 1u"),
    ("lattice::add_sample", "if !usable {", "if false {"),
    ("lattice::add_geometry", "GEOMETRY_RELATIVE: f32 = 0.35", "GEOMETRY_RELATIVE: f32 = 0.36"),
    ("lattice::filled_geometry", "mean.weight == 0.0", "mean.weight <= 0.25"),
    ("lattice::sample_mean", "mean.sum * (1.0 / max(mean.weight, LEAST_WEIGHT))", "mean.sum"),
    // A gaussian of another width.
    ("foveate::gauss_center", "exp(-0.5 / (s * s))", "exp(-0.50001 / (s * s))"),
    ("foveate::gauss_next", "tap.ratio * tap.ratio_step,", "tap.ratio * tap.ratio,"),
    ("foveate::gauss_radius", "u32(3.0 * sigma_px) + 1u", "u32(3.0 * sigma_px)"),
    ("foveate::blur_sigma_px", "0.5 * (exp2(", "0.50000006 * (exp2("),
    ("foveate::blur_lod", "1.0 + 2.0 * sigma", "1.0 + sigma"),
    // A surface stored or read wrongly.
    ("surface::float14_bits", "+ ((a >> 14u) & 1u)", "+ 1u"),
    ("surface::float14_value", "0x1p-15", "0x1p-16"),
    ("surface::lod_code", "& 0x30u", "& 0x10u"),
    ("surface::surface_color", "float14_value(words.y & 0x3fffu)", "float14_value(words.x & 0x3fffu)"),
    ("surface::lod_value", "code - 1u", "code"),
    ("surface::pack_surface", "* LOD_STEPS + 1.5", "* LOD_STEPS + 1.0"),
    ("surface::unpack_surface", "code == EMPTY_LOD", "code > EMPTY_LOD"),
    ("surface::mip_texel", "vec4<f32>(s.color, 1.0)", "vec4<f32>(s.color, 0.0)"),
    ("surface::round_mip", "half_value(half_bits(v.w))", "v.w"),
    // A wrong tap or weight.
    ("resample::taps_around", "catmull_rom(fraction.y)", "catmull_rom(fraction.x)"),
    ("resample::taps_of", "x.x, y.x", "x.x, y.y"),
    ("resample::sharp_sum", "around.sharp_y.w", "around.sharp_y.z"),
    ("resample::codes_between", "last - first + 1u", "last - first"),
    ("resample::tap_codes", "1.0f - TAP_RELATIVE, 1.0f", "1.0f, 1.0f"),
    ("resample::tap_codes_between", "- first.x + last.y", "- first.x"),
    ("resample::has_code", "< codes.y", "<= codes.y"),
    ("resample::surface_tap", "select(has_code(words.y, codes), code != EMPTY_LOD, any_code)", "any_code"),
    ("resample::nothing_gathered", "vec3<f32>(0.0), 0.0, 0.0, true", "vec3<f32>(0.0), 0.1, 0.0, true"),
    ("resample::catmull_rom", "2.0 - 1.5 * t", "2.0 - 1.51 * t"),
    ("resample::second_corner", "select(2u, 1u, along_x)", "select(1u, 2u, along_x)"),
    ("resample::corner_weight", "corner >= 2u", "corner > 2u"),
    ("resample::gather", "b.color * inner.x", "b.color * four.linear_x.x"),
    ("resample::resolve", "g.complete);", "true);"),
    // A wrong match.
    ("matched::smooth_step", "3.0 - 2.0 * t", "3.0 - 2.01 * t"),
    ("matched::distance_of_roots", "luma * luma + 0.5 * chroma", "luma * luma + chroma"),
    ("matched::past_difference", "past_roots(past)", "past"),
    ("matched::past_contrast", "past_roots(next_level)", "next_level"),
    ("matched::light_unit", "then * exposure", "then"),
    ("matched::light_unit", ", LEAST_LIGHT)", ", 0.0)"),
    ("matched::moves_alike", "abs(other.y - own.y) <= within", "abs(other.y - own.x) <= within"),
    ("matched::reuse_weight", "(history_lod - lod) / COARSER_WIDTH", "(lod - history_lod) / COARSER_WIDTH"),
    ("matched::gain", "(observed + DARK) / (predicted + DARK)", "(predicted + DARK) / (observed + DARK)"),
    ("matched::decide", "if relit < unlit *", "if relit > unlit *"),
    ("matched::decide", "(correction * e.unit)", "correction"),
    ("noise::noise_difference", "deviations * inverse_unit", "deviations"),
    ("matched::mip_mean", "(a + b + c + d)", "(a + b + c + c)"),
    ("matched::mip_bilinear", "(b - t) * fraction.y", "(b - t) * fraction.x"),
    // A wrong lens.
    ("lens::is_visible", "f32(x) - f32(y)", "f32(y) - f32(x)"),
    // Wrong quads.
    ("quads::need", "min(lod, COARSEST)", "lod"),
    ("quads::need_of_new", "NOT_IN_TURN * NOTHING", "NOTHING"),
    ("quads::octant_offsets", "(5 * rows + 1) / 2", "5 * rows / 2"),
    ("quads::share_in_block", "other < i", "other > i"),
    ("sparse::quad_lit", "10u + 5u * i", "10u"),
    // A wrong size.
    ("resize::old_position", "* ratio - 0.5", "* ratio"),
    ("resize::resized_lod", "lod + shift", "lod - shift"),
    // A wrong antialiasing.
    ("taa::to_ycocg", "0.5 * (r.x - r.z)", "0.5 * (r.z - r.x)"),
    ("taa::root_luma", "to_ycocg(c).x", "to_ycocg(c).z"),
    ("taa::roots_of_ycocg", "outer - y.y", "outer + y.z"),
    ("taa::clip_to_box", "if inside < 1.0", "if inside < 0.5"),
    ("taa::confidence_of", "NO_CONFIDENCE_LOD - lod", "7.0 - lod"),
    ("taa::lod_of", "2.0 * sqrt(confidence)", "2.01 * sqrt(confidence)"),
    ("taa::confidence_limit", "max(x, y)", "x"),
    ("taa::settled", "(1.0f / SETTLED), 0.0", "(1.0f / SETTLED), 0.5"),
    ("taa::agreeing", "squares * count - sum * sum", "squares * count"),
    ("taa::candidate_share", "1.0 - trusted)", "0.0)"),
    ("taa::box_sigmas", "(still - moving)", "still"),
    ("taa::blend_clipped", "(roots(candidate) - clipped) * alpha", "(roots(candidate) - clipped) * (1.01 * alpha)"),
    // A wrong upsampling.
    ("taau::lobe", "max(1.0 - squared, 0.0)", "(1.0 - squared)"),
    ("taau::tail", "(1.0f - LEAST_TAIL)", "1.0f"),
    ("taau::sample_weights", "(127u - level)", "(128u - level)"),
    ("taau::add_around", "(sampled - centre) * weights.y", "(sampled - centre) * weights.x"),
    ("taau::upsampled", "1.0 / a.weights.y", "1.0 / a.weights.x"),
    ("taau::accumulate", "a.squares * a.count", "a.squares * 9.0"),
    ("taau::narrowing", "NARROWING: f32 = 0.4", "NARROWING: f32 = 0.41"),
    ("taau::accumulate", "vec2<f32>(1.5, 5.0)", "vec2<f32>(1.52, 5.0)"),
    // A wrong turn or draw of a path.
    ("approx::sin_cos_turns", "return vec2<f32>(c, -s);", "return vec2<f32>(c, s);"),
    ("rng::path_draws", "vec4<u32>(pixel, sample, dimension, key)", "vec4<u32>(sample, pixel, dimension, key)"),
    // Wrong reconstructions.
    ("kept::pack_color", "rough + (multiple(largest, rough, up) >> 9u)", "rough"),
    ("kept::unpack_color", "(SMALLEST_EXPONENT - 8u)", "(SMALLEST_EXPONENT - 9u)"),
    ("kept::pack_kept", "min((code + 2u) >> 2u, 0x3ffeu)", "min(code >> 2u, 0x3ffeu)"),
    ("kept::unpack_kept", "unpack_place(words.y >> 26u)", "unpack_place(words.y >> 20u)"),
    ("kept::is_empty", "(words.y & 63u) == EMPTY_LOD", "(words.y & 63u) > EMPTY_LOD"),
    ("kept::code_word", "0xfffc0000u", "0xffff0000u"),
    ("kept::unpack_full", "lod_value(words.y & 63u)", "lod_value(words.y & 31u)"),
    ("kept::moved_kept", "select(max(lod, 1.0), lod, near)", "lod"),
    ("kept::kept_weight", "const SOFTEN_PX2: f32 = 0.03;", "const SOFTEN_PX2: f32 = 0.0301;"),
    ("kept::add_kept", "wx * place.y, wy", "wx * place.x, wy"),
    ("kept::interpolate", "a.square.y * a.weight - a.place.x", "a.square.y * a.weight - a.place.y"),
    ("kept::stands_in", "a.weight >= STAND_IN", "a.weight >= 0.0"),
    ("kept::interpolate", "distance <= EXACT_PX", "distance < 0.0"),
    ("sparse::candidate_level", "1.0 + 2.0 * px", "1.0 + 2.01 * px"),
    ("sparse::expected_error", "by_motion + CONTRAST_ERROR * coarse", "by_motion + CONTRAST_ERROR"),
    ("sparse::agreement", "own.error + other.error", "own.error + own.error"),
    (
        "sparse::relight",
        "(sqrt(l.squared) * inverse)) * RELIGHT_ERRORS",
        "(sqrt(l.weight) * inverse)) * RELIGHT_ERRORS",
    ),
    ("sparse::agreed", "l.known * AGREED.x", "l.spatial * AGREED.x"),
    ("sparse::fit", "1.0 - sure * smooth_step(FIT_ERRORS.x", "1.0 - smooth_step(FIT_ERRORS.x"),
    ("sparse::capped_error", "min(errors, FIT_ERRORS.x + FIT_ERRORS.y)", "errors"),
    ("sparse::fit_around", "capped / max(l.known, 1e-6)", "capped / l.weight"),
    ("sparse::mean_fit", "sqrt(l.squared) * inverse)) * MEAN_ERRORS", "inverse)) * MEAN_ERRORS"),
    ("sparse::noisy_lod_confidence", "max(lod_confidence(lod), noise", "max(0.0 * lod_confidence(lod), noise"),
    ("sparse::own_fit", "own.sure);", "1.0);"),
    ("sparse::pack_lit", "l.fit * 256.0 + 0.5", "l.fit * 256.0"),
    ("sparse::unpack_lit", "(words.y & 512u) != 0u", "(words.y & 1024u) != 0u"),
    ("sparse::reconstruct", "share >= KEEP_SHARE && near", "share >= KEEP_SHARE"),
    ("sparse::reconstruct", "select(WORN.y, WORN.x, r.moved)", "WORN.x"),
    ("sparse::accumulate", "near && share >= STAY_SHARE", "share >= STAY_SHARE"),
    ("sparse::accumulate", "BLURRED_FRAMES * now.samples", "BLURRED_FRAMES * candidate.samples"),
    (
        "noise::expected_noise",
        "1.0 / candidate.samples + 1.0 / max(history.samples, 1.0);\n    return root_slope(around) * sqrt(pooled",
        "1.0 / candidate.samples;\n    return root_slope(around) * sqrt(pooled",
    ),
    ("noise::add_noise", "(weight * weight) / n.samples", "weight / n.samples"),
    ("noise::mean_noise", "sum.weight * sum.weight", "sum.weight"),
    ("sparse::relit", "highest + (highest - lowest)", "highest + highest"),
];

#[test]
fn planted_errors_are_caught() {
    caught(PLANTED);
}
