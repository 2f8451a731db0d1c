//! Planted errors in the shaders: the comparison of the function with its Rust twin must find each.

use super::probe::caught;
use super::{
    decisions, doctor, foveation, lattice, lens, matching, mathematics, noise, repair, sparse, state, surfaces,
    upsampling, weighted,
};

#[test]
fn a_lax_comparison_is_caught() {
    caught(state::PROBES, "combine", "draw * w_sum < w2", "draw * w_sum <= w2");
    caught(state::PROBES, "update", "draw * w_sum < w;", "draw * w_sum <= w;");
    caught(decisions::PROBES, "step", "draw * w_sum < candidate_w", "draw * w_sum <= candidate_w");
}

#[test]
fn h04_a_weight_below_the_normal_range_is_caught() {
    caught(decisions::PROBES, "step", "weight(past.w_sum * survival)", "past.w_sum * survival");
}

#[test]
fn a_weight_one_percent_off_is_caught() {
    caught(mathematics::PROBES, "candidate_weight", "* inv_density_at_fovea", "* (1.01 * inv_density_at_fovea)");
}

#[test]
fn a_flipped_motion_sign_is_caught() {
    caught(state::PROBES, "nearest", "f32(x) + motion.x", "f32(x) - motion.x");
    caught(state::PROBES, "nearest", "f32(y) + motion.y", "f32(y) - motion.y");
}

#[test]
fn sloppy_means_and_references_are_caught() {
    caught(weighted::PROBES, "sharpen", "w *= candidate_w;", "w *= w;");
    caught(weighted::PROBES, "at_rate", "-2.0 * f32(exponent)", "-2.5 * f32(exponent)");
    caught(weighted::PROBES, "combined", "|| candidate_w == decision.w_sum", "");
    caught(weighted::PROBES, "compared", "reference.color, level != NO_LEVEL && ", "reference.color, ");
    caught(weighted::PROBES, "next_reference", "take || ", "");
    caught(weighted::PROBES, "pack_reference", "c * scale + 0.5", "c * scale");
}

#[test]
fn trust_after_the_fact_and_a_forgotten_limit_are_caught() {
    caught(decisions::PROBES, "scale_by_trust", "a_es_decay(past.log_key, share)", "past.log_key");
    caught(state::PROBES, "trust", "return 1.0;", "return t;");
    caught(
        decisions::PROBES,
        "expose",
        "clamp(stored_color * ratio, vec3<f32>(-MAX_HALF), vec3<f32>(MAX_HALF))",
        "stored_color * ratio",
    );
}

#[test]
fn a_wrong_color_of_a_decision_is_caught() {
    caught(decisions::PROBES, "view_color", "srgb_decode(encoded.x)", "encoded.x");
    caught(decisions::PROBES, "motion_color", "clamp(-motion.x", "clamp(motion.x");
}

#[test]
fn draws_without_the_shift_are_caught() {
    caught(state::PROBES, "unit_draw", "f32(bits >> 8u) * (1.0 / 16777216.0)", "f32(bits) * (1.0 / 4294967296.0)");
    caught(state::PROBES, "bits", "v = v ^ (v >> vec4<u32>(16u));", "");
}

#[test]
fn swapped_colors_are_caught() {
    caught(decisions::PROBES, "difference", "delta_e94(reference, stored)", "delta_e94(stored, reference)");
    caught(decisions::PROBES, "step", "difference(candidate, past.color,", "difference(past.color, candidate,");
    caught(mathematics::PROBES, "delta_e94", "delta_e94(in_v(0u), in_v(3u))", "delta_e94(in_v(3u), in_v(0u))");
}

#[test]
fn one_wrong_last_bit_is_caught() {
    caught(mathematics::PROBES, "exp", "1.6666665e-1", "1.6666667e-1");
    caught(mathematics::PROBES, "lab", "0.376224", "0.37622404");
    caught(
        mathematics::PROBES,
        "atan2_upper",
        "const TAN_PI_8: f32 = 0.41421356;",
        "const TAN_PI_8: f32 = 0.41421354;",
    );
}

#[test]
fn an_unwritten_word_is_caught() {
    caught(state::PROBES, "unpack", "out_u(result.age);", "");
}

#[test]
fn wrong_evidence_is_caught() {
    caught(doctor::PROBES, "spline", "(t + 1.0) * 0.5", "(t + 1.0) * 0.51");
    caught(doctor::PROBES, "lattice_texel", "(point << level) + lattice_offset(level)", "point << level");
    caught(doctor::PROBES, "lattice_len", "max(len, 1u) - 1u, lattice_offset", "len, lattice_offset");
    caught(doctor::PROBES, "kink_class", "at + (at & 1u)", "at");
    caught(doctor::PROBES, "bend", "(after - at) - (at - before)", "(after - at) + (at - before)");
    caught(doctor::PROBES, "is_code", "whole <= 254.0", "whole <= 255.0");
    caught(doctor::PROBES, "kept_bits", "select(bits, 0u, size < 0x00800000u)", "bits");
    caught(doctor::PROBES, "signal", "green >= 1e-30", "green >= 0.0");
}

#[test]
fn a_shifted_level_is_caught() {
    caught(foveation::PROBES, "level_len", "(1u << level) - 1u) >> level", "(1u << level)) >> level");
    caught(foveation::PROBES, "level_coordinate", "(127u - level)", "(126u - level)");
    caught(foveation::PROBES, "block_sample", ">> block_sample_level(level)", ">> level");
}

#[test]
fn swapped_bilinear_fractions_are_caught() {
    caught(foveation::PROBES, "bilinear", "blend(top, bottom, fraction.y)", "blend(top, bottom, fraction.x)");
    caught(foveation::PROBES, "blend", "a + (b - a) * t", "b + (a - b) * t");
}

#[test]
fn a_wrong_border_is_caught() {
    caught(foveation::PROBES, "split", "0.0, f32(len - 1u)", "0.0, f32(len)");
    caught(foveation::PROBES, "block_center_px", "edge_px - 0.5, f32(len - 1u)", "edge_px - 0.5, f32(len)");
}

#[test]
fn a_wrong_sample_is_caught() {
    caught(lattice::PROBES, "between", "let low = distance >> level;", "let low = distance / (1 << level);");
    caught(lattice::PROBES, "between", "(127u - level)", "(126u - level)");
    caught(lattice::PROBES, "between", "i32(count) - 1", "i32(count)");
    caught(lattice::PROBES, "nearest_point", "((1i << level) >> 1u)", "(1i << level)");
    caught(lattice::PROBES, "point_offset_px", "(i32(px) - i32(first))", "(i32(first) - i32(px))");
    caught(lattice::PROBES, "place_weight", "offset_px.y * offset_px.y", "offset_px.x * offset_px.y");
    caught(lattice::PROBES, "point_weight", "point == 0u", "point == 1u");
    caught(lattice::PROBES, "add_sample", "if !usable {", "if false {");
    caught(lattice::PROBES, "add_geometry", "GEOMETRY_RELATIVE: f32 = 0.35", "GEOMETRY_RELATIVE: f32 = 0.36");
    caught(lattice::PROBES, "filled_geometry", "mean.weight == 0.0", "mean.weight <= 0.25");
    caught(lattice::PROBES, "sample_mean", "mean.sum * (1.0 / max(mean.weight, LEAST_WEIGHT))", "mean.sum");
}

#[test]
fn a_gaussian_of_another_width_is_caught() {
    caught(foveation::PROBES, "gauss_center", "exp(-0.5 / (s * s))", "exp(-0.50001 / (s * s))");
    caught(foveation::PROBES, "gauss_next", "tap.ratio * tap.ratio_step,", "tap.ratio * tap.ratio,");
    caught(foveation::PROBES, "gauss_radius", "u32(3.0 * sigma_px) + 1u", "u32(3.0 * sigma_px)");
    caught(foveation::PROBES, "blur_sigma_px", "0.5 * (exp2(", "0.50000006 * (exp2(");
    caught(foveation::PROBES, "blur_lod", "1.0 + 2.0 * sigma", "1.0 + sigma");
}

#[test]
fn a_surface_stored_or_read_wrongly_is_caught() {
    caught(surfaces::PROBES, "float14_bits", "+ ((a >> 14u) & 1u)", "+ 1u");
    caught(surfaces::PROBES, "float14_bits", "MAX_FLOAT14: f32 = 65472.0", "MAX_FLOAT14: f32 = 65504.0");
    caught(surfaces::PROBES, "float14_value", "0x1p-15", "0x1p-16");
    caught(surfaces::PROBES, "lod_code", "& 0x30u", "& 0x10u");
    caught(surfaces::PROBES, "surface_color", "float14_value(words.y & 0x3fffu)", "float14_value(words.x & 0x3fffu)");
    caught(surfaces::PROBES, "pack_surface", "* LOD_STEPS + 0.5", "* LOD_STEPS");
    caught(surfaces::PROBES, "unpack_surface", "code == EMPTY_LOD", "code > EMPTY_LOD");
    caught(surfaces::PROBES, "mip_texel", "vec4<f32>(s.color, 1.0)", "vec4<f32>(s.color, 0.0)");
    caught(surfaces::PROBES, "round_mip", "half_value(half_bits(v.w))", "v.w");
}

#[test]
fn a_wrong_tap_or_weight_is_caught() {
    caught(surfaces::PROBES, "taps_around", "catmull_rom(fraction.y)", "catmull_rom(fraction.x)");
    caught(surfaces::PROBES, "taps_of", "x.x, y.x", "x.x, y.y");
    caught(surfaces::PROBES, "sharp_sum", "around.sharp_y.w", "around.sharp_y.z");
    caught(surfaces::PROBES, "codes_between", "last - first + 1u", "last - first");
    caught(surfaces::PROBES, "tap_codes", "1.0f - TAP_RELATIVE, 1.0f", "1.0f, 1.0f");
    caught(surfaces::PROBES, "tap_codes_between", "- first.x + last.y", "- first.x");
    caught(surfaces::PROBES, "has_code", "< codes.y", "<= codes.y");
    caught(
        surfaces::PROBES,
        "surface_tap",
        "select(has_code(words.y, codes), code != EMPTY_LOD, any_code)",
        "any_code",
    );
    caught(surfaces::PROBES, "nothing_gathered", "vec3<f32>(0.0), 0.0, 0.0, true", "vec3<f32>(0.0), 0.1, 0.0, true");
    caught(surfaces::PROBES, "catmull_rom", "2.0 - 1.5 * t", "2.0 - 1.51 * t");
    caught(surfaces::PROBES, "second_corner", "select(2u, 1u, along_x)", "select(1u, 2u, along_x)");
    caught(surfaces::PROBES, "corner_weight", "corner >= 2u", "corner > 2u");
    caught(surfaces::PROBES, "gather", "b.color * inner.x", "b.color * four.linear_x.x");
    caught(surfaces::PROBES, "resolve", "g.complete);", "true);");
    caught(surfaces::PROBES, "resolve", "if g.smooth_sum < 0.01 {", "if g.smooth_sum < 0.0 {");
}

#[test]
fn a_wrong_match_is_caught() {
    caught(matching::PROBES, "smooth_step", "3.0 - 2.0 * t", "3.0 - 2.01 * t");
    caught(matching::PROBES, "root_difference", "luma * luma + 0.5 * chroma", "luma * luma + chroma");
    caught(matching::PROBES, "moves_alike", "abs(other.y - own.y) <= within", "abs(other.y - own.x) <= within");
    caught(
        matching::PROBES,
        "reuse_weight",
        "(history_lod - lod) / COARSER_WIDTH",
        "(lod - history_lod) / COARSER_WIDTH",
    );
    caught(
        matching::PROBES,
        "gain",
        "(observed + DARK) / (predicted + DARK)",
        "(predicted + DARK) / (observed + DARK)",
    );
    caught(matching::PROBES, "decide", "if relit < unlit *", "if relit > unlit *");
    caught(matching::PROBES, "decide", "missed * finer + k * e.history", "k * e.history");
    caught(matching::PROBES, "decide", "abs(ln(mean) * LOG2_E)", "0.0");
    caught(matching::PROBES, "decide", "let fit = 1.0 -", "let fit = 0.99 -");
    caught(matching::PROBES, "mip_mean", "(a + b + c + d)", "(a + b + c + c)");
    caught(matching::PROBES, "mip_bilinear", "(b - t) * fraction.y", "(b - t) * fraction.x");
}

#[test]
fn a_wrong_lens_is_caught() {
    caught(lens::PROBES, "is_visible", "f32(x) - f32(y)", "f32(y) - f32(x)");
    caught(lens::PROBES, "is_visible", "along >= lowest", "along > lowest");
    caught(lens::PROBES, "is_visible", "along <= highest", "along < highest");
}

#[test]
fn a_wrong_repair_is_caught() {
    caught(repair::PROBES, "priority", "RINGS - 1u", "RINGS");
    caught(repair::PROBES, "priority", "lod < WANTED_LOD", "lod <= WANTED_LOD");
    caught(repair::PROBES, "asked_px", "i ^ frame_low ^ x ^ y", "i ^ x ^ y");
    caught(repair::PROBES, "quad_key", "~key", "key");
    caught(repair::PROBES, "quad_key", "32u - HASH_BITS", "HASH_BITS");
}

#[test]
fn a_wrong_size_is_caught() {
    caught(surfaces::PROBES, "old_position", "* ratio - 0.5", "* ratio");
    caught(surfaces::PROBES, "resized_lod", "lod + shift", "lod - shift");
}

#[test]
fn a_wrong_antialiasing_is_caught() {
    let caught = |name, right, wrong| caught(upsampling::PROBES, name, right, wrong);
    caught("to_ycocg", "0.5 * (r.x - r.z)", "0.5 * (r.z - r.x)");
    caught("root_luma", "to_ycocg(c).x", "to_ycocg(c).z");
    caught("roots_of_ycocg", "outer - y.y", "outer + y.z");
    caught("clip_to_box", "if inside < 1.0", "if inside < 0.5");
    caught("confidence_of", "NO_CONFIDENCE_LOD - lod", "7.0 - lod");
    caught("lod_of", "2.0 * sqrt(confidence)", "2.01 * sqrt(confidence)");
    caught("confidence_limit", "max(x, y)", "x");
    caught("settled", "(1.0f / SETTLED), 0.0", "(1.0f / SETTLED), 0.5");
    caught("agreeing", "squares * count - sum * sum", "squares * count");
    caught("candidate_share", "1.0 - trusted)", "0.0)");
    caught("box_sigmas", "(still - moving)", "still");
    caught("blend_clipped", "(roots(candidate) - clipped) * alpha", "(roots(candidate) - clipped) * (1.01 * alpha)");
}

#[test]
fn a_wrong_upsampling_is_caught() {
    let caught = |name, right, wrong| caught(upsampling::PROBES, name, right, wrong);
    caught("lobe", "max(1.0 - squared, 0.0)", "(1.0 - squared)");
    caught("tail", "(1.0f - LEAST_TAIL)", "1.0f");
    caught("sample_weights", "(127u - level)", "(128u - level)");
    caught("add_around", "(sampled - centre) * weights.y", "(sampled - centre) * weights.x");
    caught("upsampled", "1.0 / a.weights.y", "1.0 / a.weights.x");
    caught("accumulate", "a.squares * a.count", "a.squares * 9.0");
    caught("narrowing", "NARROWING: f32 = 0.4", "NARROWING: f32 = 0.41");
    caught("accumulate", "vec2<f32>(1.5, 5.0)", "vec2<f32>(1.52, 5.0)");
    caught("accumulate", "past + clip * strength", "past + clip");
    caught("accumulate", "const CLIP_COST: f32 = 10.0;", "const CLIP_COST: f32 = 10.1;");
    caught("accumulate", "a.weights.y), 1.0 - trusted)", "a.weights.y), 0.0)");
}

#[test]
fn a_wrong_turn_or_draw_of_a_path_is_caught() {
    caught(mathematics::PROBES, "sin_cos_turns", "return vec2<f32>(c, -s);", "return vec2<f32>(c, s);");
    caught(
        state::PROBES,
        "path_draws",
        "vec4<u32>(pixel, sample, dimension, key)",
        "vec4<u32>(sample, pixel, dimension, key)",
    );
}

#[test]
fn planted_errors_in_the_reconstruction_are_caught() {
    caught(sparse::PROBES, "pack_color", "rough + (multiple(largest, rough, up) >> 9u)", "rough");
    caught(sparse::PROBES, "unpack_color", "(SMALLEST_EXPONENT - 8u)", "(SMALLEST_EXPONENT - 9u)");
    caught(sparse::PROBES, "pack_kept", "min((code + 2u) >> 2u, 0x3ffeu)", "min(code >> 2u, 0x3ffeu)");
    caught(sparse::PROBES, "unpack_kept", "unpack_place(words.y >> 26u)", "unpack_place(words.y >> 20u)");
    caught(sparse::PROBES, "is_empty", "== EMPTY_KEPT", "> EMPTY_KEPT");
    caught(sparse::PROBES, "code_word", "0xfffc0000u", "0xffff0000u");
    caught(sparse::PROBES, "unpack_full", "(words.y & 63u) * (1.0f", "(words.y & 31u) * (1.0f");
    caught(sparse::PROBES, "moved_kept", "select(max(lod, 1.0), lod, near)", "lod");
    caught(sparse::PROBES, "kept_weight", "const SOFTEN_PX2: f32 = 0.03;", "const SOFTEN_PX2: f32 = 0.0301;");
    caught(sparse::PROBES, "add_kept", "wx * place.y, wy", "wx * place.x, wy");
    caught(sparse::PROBES, "add_kept", "if cost < a.cost {", "if cost > a.cost {");
    caught(sparse::PROBES, "interpolate", "a.square.y * a.weight - a.place.x", "a.square.y * a.weight - a.place.y");
    caught(sparse::PROBES, "stands_in", "a.weight >= STAND_IN", "a.weight >= 0.0");
    caught(sparse::PROBES, "interpolate", "distance <= EXACT_PX", "distance < 0.0");
    caught(sparse::PROBES, "candidate_level", "1.0 + 2.0 * px", "1.0 + 2.01 * px");
    caught(sparse::PROBES, "expected_error", "by_motion + CONTRAST_ERROR * coarse", "by_motion + CONTRAST_ERROR");
    caught(sparse::PROBES, "agreement", "own.error + other.error", "own.error + own.error");
    let standard_error =
        ["(sqrt(l.squared) * inverse)) * RELIGHT_ERRORS", "(sqrt(l.weight) * inverse)) * RELIGHT_ERRORS"];
    caught(sparse::PROBES, "relight", standard_error[0], standard_error[1]);
    caught(sparse::PROBES, "fit", "1.0 - sure * smooth_step(FIT_ERRORS.x", "1.0 - smooth_step(FIT_ERRORS.x");
    caught(sparse::PROBES, "mean_fit", "sqrt(l.squared) * inverse)) * MEAN_ERRORS", "inverse)) * MEAN_ERRORS");
    caught(
        sparse::PROBES,
        "noisy_lod_confidence",
        "max(lod_confidence(lod), noise",
        "max(0.0 * lod_confidence(lod), noise",
    );
    caught(sparse::PROBES, "own_fit", "own.sure);", "1.0);");
    caught(sparse::PROBES, "pack_lit", "l.fit * 256.0 + 0.5", "l.fit * 256.0");
    caught(sparse::PROBES, "unpack_lit", "(words.y & 512u) != 0u", "(words.y & 1024u) != 0u");
    caught(sparse::PROBES, "reconstruct", "share >= KEEP_SHARE && near", "share >= KEEP_SHARE");
    caught(sparse::PROBES, "reconstruct", "select(WORN.y, WORN.x, r.moved)", "WORN.x");
    caught(sparse::PROBES, "accumulate", "near && share >= STAY_SHARE", "share >= STAY_SHARE");
    caught(sparse::PROBES, "accumulate", "BLURRED_FRAMES * now.samples", "BLURRED_FRAMES * candidate.samples");
    caught(sparse::PROBES, "accumulate", "* certain;", ";");
    caught(sparse::PROBES, "accumulate", "1.0 - blurred * sharp", "1.0 - blurred");
    caught(
        noise::PROBES,
        "expected_noise",
        "1.0 / candidate.samples + 1.0 / max(history.samples, 1.0);\n    return root_slope(around) * sqrt(pooled",
        "1.0 / candidate.samples;\n    return root_slope(around) * sqrt(pooled",
    );
    caught(noise::PROBES, "add_noise", "(weight * weight) / n.samples", "weight / n.samples");
    caught(noise::PROBES, "mean_noise", "sum.weight * sum.weight", "sum.weight");
    caught(sparse::PROBES, "relit", "highest + (highest - lowest)", "highest + highest");
}
