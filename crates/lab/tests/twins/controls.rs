//! Planted errors in the shaders: each must be caught by the comparison of its function.

use super::probe::caught;
use super::{facets, lighting, scattering, scattering_lobes, triangles};

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
    caught(scattering::PROBES, "power_heuristic", "return 1.0 / (r * r + 1.0);", "return 1.0 / (r + 1.0);");
    caught(facets::PROBES, "vndf_sample", "(1.0 - u.y) * (1.0 + s.z)", "(1.0 - u.y) + s.z");
    caught(scattering::PROBES, "phong_sample", "/ (1.0 - probability)", "");
}

#[test]
fn a_wrong_lobe_is_caught() {
    caught(
        scattering_lobes::PROBES,
        "eval",
        "pdf += layers.probabilities.y * density;",
        "pdf += layers.probabilities.y * shape;",
    );
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
fn a_wrong_normal_or_texel_is_caught() {
    caught(lighting::PROBES, "mapped_normal", "cross(normal, along) * sign", "cross(normal, along)");
    caught(lighting::PROBES, "visible_normal", "GRAZING - seen", "GRAZING");
    caught(lighting::PROBES, "hue", "if y > 1e-6", "if y > 1e-5");
    caught(lighting::PROBES, "wrap_coordinate", "2.0 * floor(u * 0.5)", "floor(u)");
    caught(lighting::PROBES, "wrap_texel", "2 * n - 1 - i", "2 * n - i");
    caught(lighting::PROBES, "texel_value", "1.0f / 255.0", "0.003921568");
}
