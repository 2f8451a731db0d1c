//! Planted errors in the shaders: each must be seen by the comparison that its function is held to.

use crate::probe::Probe;
use crate::{
    decisions, facets, foveation, gpu, lighting, matching, mathematics, scattering, scattering_lobes, state, surfaces,
    triangles,
};

#[track_caller]
fn caught(probes: &[Probe], name: &str, right: &str, wrong: &str) {
    let probe = probes.iter().find(|p| p.name == name).unwrap();
    let source = probe.source();
    assert_eq!(source.matches(right).count(), 1, "'{right}' in the source of {name}");
    let Some((device, queue)) = gpu::device() else { return };
    let (count, lines) = probe.differences(&device, &queue, &source.replace(right, wrong));
    println!("{name}, '{right}' -> '{wrong}': {} of {count} rows differ", lines.len());
    assert!(!lines.is_empty(), "planted error not caught: {name}, '{right}' -> '{wrong}'");
}

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
fn trust_after_the_fact_and_a_forgotten_limit_are_caught() {
    caught(decisions::PROBES, "believe", "a_es_decay(past.log_key, share)", "past.log_key");
    caught(state::PROBES, "trust", "return 1.0;", "return t;");
    caught(
        decisions::PROBES,
        "expose",
        "clamp(stored_color * ratio, vec3<f32>(-MAX_HALF), vec3<f32>(MAX_HALF))",
        "stored_color * ratio",
    );
}

#[test]
fn a_wrong_colour_of_a_decision_is_caught() {
    caught(decisions::PROBES, "view_color", "srgb_decode(encoded.x)", "encoded.x");
    caught(decisions::PROBES, "motion_color", "clamp(-motion.x", "clamp(motion.x");
}

#[test]
fn draws_without_the_shift_are_caught() {
    caught(state::PROBES, "unit_draw", "f32(bits >> 8u) * (1.0 / 16777216.0)", "f32(bits) * (1.0 / 4294967296.0)");
    caught(state::PROBES, "bits", "v = v ^ (v >> vec4<u32>(16u));", "");
}

#[test]
fn swapped_colours_are_caught() {
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
    caught(state::PROBES, "unpack", "out_u(s.age);", "");
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
fn a_gaussian_of_another_width_is_caught() {
    caught(foveation::PROBES, "gauss_center", "exp(-0.5 / (s * s))", "exp(-0.50001 / (s * s))");
    caught(foveation::PROBES, "gauss_next", "tap.ratio * tap.ratio_step,", "tap.ratio * tap.ratio,");
    caught(foveation::PROBES, "gauss_radius", "u32(3.0 * sigma_px) + 1u", "u32(3.0 * sigma_px)");
    caught(foveation::PROBES, "blur_sigma_px", "0.5 * (exp2(", "0.50000006 * (exp2(");
    caught(foveation::PROBES, "blur_lod", "1.0 + 2.0 * sigma", "1.0 + sigma");
}

#[test]
fn a_surface_stored_or_read_wrongly_is_caught() {
    caught(surfaces::PROBES, "half14_bits", "(h + ((h >> 1u) & 1u)) >> 1u", "h >> 1u");
    caught(surfaces::PROBES, "half14_bits", ">> 1u, 0x3dffu)", ">> 1u, 0x3e00u)");
    caught(surfaces::PROBES, "pack_surface", "* LOD_STEPS + 0.5", "* LOD_STEPS");
    caught(surfaces::PROBES, "unpack_surface", "if lod == EMPTY_LOD", "if lod > EMPTY_LOD");
    caught(surfaces::PROBES, "chain_texel", "vec4<f32>(s.color, 1.0)", "vec4<f32>(s.color, 0.0)");
    caught(surfaces::PROBES, "round_chain", "half_value(half_bits(v.w))", "v.w");
}

#[test]
fn a_wrong_tap_or_weight_is_caught() {
    caught(surfaces::PROBES, "tap_at", "tap >= 10u", "tap > 10u");
    caught(surfaces::PROBES, "catmull_rom", "2.0 - 1.5 * t", "2.0 - 1.51 * t");
    caught(surfaces::PROBES, "linear_weights", "0.0, 1.0 - t, t, 0.0", "0.0, t, 1.0 - t, 0.0");
    caught(surfaces::PROBES, "gather", "tap.color * linear", "tap.color * sharp");
    caught(surfaces::PROBES, "resolve", "g.missing == 0u)", "g.missing <= 1u)");
    caught(surfaces::PROBES, "resolve", "if g.smooth_sum < 0.01 {", "if g.smooth_sum < 0.0 {");
}

#[test]
fn a_wrong_match_is_caught() {
    caught(matching::PROBES, "smooth_step", "3.0 - 2.0 * t", "3.0 - 2.01 * t");
    caught(matching::PROBES, "root_difference", "luma * luma + 0.5 * chroma", "luma * luma + chroma");
    caught(matching::PROBES, "moves_alike", "abs(other.y - own.y) <= within", "abs(other.y - own.x) <= within");
    caught(matching::PROBES, "wanted", "(history_lod - lod) / COARSER_WIDTH", "(lod - history_lod) / COARSER_WIDTH");
    caught(matching::PROBES, "gain", "(candidate + DARK) / (history + DARK)", "(history + DARK) / (candidate + DARK)");
    caught(matching::PROBES, "decide", "if relit < d {", "if relit > d {");
    caught(matching::PROBES, "decide", "let fit = 1.0 -", "let fit = 0.99 -");
    caught(matching::PROBES, "chain_mean", "(a + b + c + d)", "(a + b + c + c)");
    caught(matching::PROBES, "chain_bilinear", "(b - t) * fraction.y", "(b - t) * fraction.x");
}

#[test]
fn a_wrong_antialiasing_is_caught() {
    caught(surfaces::PROBES, "to_ycocg", "0.5 * (r.x - r.z)", "0.5 * (r.z - r.x)");
    caught(surfaces::PROBES, "roots_of_ycocg", "outer - y.y", "outer + y.z");
    caught(surfaces::PROBES, "clip_to_box", "if inside < 1.0", "if inside < 0.5");
    caught(surfaces::PROBES, "candidate_share", "max(resampled, 1.0 - trust)", "resampled");
    caught(
        surfaces::PROBES,
        "blend_clipped",
        "(roots(candidate) - clipped) * alpha",
        "(roots(candidate) - clipped) * (1.01 * alpha)",
    );
}

#[test]
fn a_flipped_edge_or_a_lax_one_is_caught() {
    caught(triangles::PROBES, "intersect", "edge(c, b)", "edge(b, c)");
    caught(triangles::PROBES, "intersect", "min(e0, min(e1, e2)) < 0.0", "min(e0, min(e1, e2)) <= 0.0");
    caught(
        triangles::PROBES,
        "intersect",
        "if low.x > 0.0 || high.x < 0.0 || low.y > 0.0 || high.y < 0.0 || high.z < 0.0",
        "if false",
    );
    caught(triangles::PROBES, "edge", "select(area, -area, swapped)", "area");
    caught(triangles::PROBES, "edge", "p.x * q.y - p.y * q.x", "p.x * q.y + p.y * q.x");
    caught(triangles::PROBES, "shear", "-(direction.y / direction.x)", "direction.y / direction.x");
    caught(triangles::PROBES, "offset_ray", "magnitude * ORIGIN_OFFSET", "ORIGIN_OFFSET");
}

#[test]
fn a_direction_folded_or_rounded_wrongly_is_caught() {
    caught(triangles::PROBES, "encode_direction", "x * DIRECTION_STEPS + 0.5", "x * DIRECTION_STEPS");
    caught(triangles::PROBES, "encode_direction", "if n.z < 0.0", "if n.z > 0.0");
    caught(triangles::PROBES, "decode_direction", "if z < 0.0", "if z > 0.5");
}

#[test]
fn a_wrong_direction_or_density_is_caught() {
    caught(scattering::PROBES, "sin_cos_turns", "return vec2<f32>(c, -s);", "return vec2<f32>(c, s);");
    caught(scattering::PROBES, "power_heuristic", "return 1.0 / (r * r + 1.0);", "return 1.0 / (r + 1.0);");
    caught(facets::PROBES, "vndf_sample", "(1.0 - u.y) * (1.0 + s.z)", "(1.0 - u.y) + s.z");
    caught(scattering::PROBES, "phong_sample", "/ (1.0 - chance)", "");
}

#[test]
fn a_wrong_lobe_is_caught() {
    caught(scattering_lobes::PROBES, "eval", "pdf += layers.chances.y * density;", "pdf += layers.chances.y * shape;");
    caught(
        scattering_lobes::PROBES,
        "eval",
        "jacobian = (vh * -lh) / (root * root);",
        "jacobian = vh / (root * root);",
    );
    caught(scattering_lobes::PROBES, "sample", "wi.z = -wi.z;", "wi = -wi;");
    caught(scattering_lobes::PROBES, "layers", "1.0 - coat_albedo", "1.0 - coat");
    caught(scattering_lobes::PROBES, "glass_albedo", "select(e.zw, e.xy, entering)", "e.xy");
}

#[test]
fn a_wrong_light_or_place_in_a_map_is_caught() {
    caught(lighting::PROBES, "distance_falloff", "1.0 - squared * squared", "1.0 - squared");
    caught(lighting::PROBES, "cone_falloff", "return t * t;", "return t;");
    caught(lighting::PROBES, "map_coordinates", "direction.x < 0.0)", "direction.x > 0.0)");
    caught(lighting::PROBES, "map_direction", "-(longitude.y * sine)", "longitude.y * sine");
    caught(lighting::PROBES, "map_pdf", "MAP_AREA: f32 = 19.739208", "MAP_AREA: f32 = 19.73921");
}

#[test]
fn a_wrong_normal_texel_or_draw_is_caught() {
    caught(lighting::PROBES, "mapped_normal", "cross(normal, along) * sign", "cross(normal, along)");
    caught(lighting::PROBES, "visible_normal", "GRAZING - seen", "GRAZING");
    caught(lighting::PROBES, "hue", "if y > 1e-6", "if y > 1e-5");
    caught(lighting::PROBES, "wrap_coordinate", "2.0 * floor(u * 0.5)", "floor(u)");
    caught(lighting::PROBES, "wrap_texel", "2 * n - 1 - i", "2 * n - i");
    caught(lighting::PROBES, "texel_value", "/ 255.0", "* 0.003921569");
    caught(
        lighting::PROBES,
        "path_draws",
        "vec4<u32>(pixel, sample, dimension, key)",
        "vec4<u32>(sample, pixel, dimension, key)",
    );
}
