//! Planted errors in the shaders: each must be caught by the comparison of its function.

use super::probe::caught;

#[test]
fn a_flipped_edge_or_a_lax_one_is_caught() {
    caught(&[
        ("triangle::intersect", "edge(c, b)", "edge(b, c)"),
        ("triangle::intersect", "min(e0, min(e1, e2)) < 0.0", "min(e0, min(e1, e2)) <= 0.0"),
        (
            "triangle::intersect",
            "if low.x > 0.0 || high.x < 0.0 || low.y > 0.0 || high.y < 0.0 || high.z < 0.0",
            "if false",
        ),
        ("triangle::edge", "select(area, -area, swapped)", "area"),
        ("triangle::edge", "p.x * q.y - p.y * q.x", "p.x * q.y + p.y * q.x"),
        ("triangle::shear", "-(direction.y / direction.x)", "direction.y / direction.x"),
        ("triangle::offset_ray", "magnitude * ORIGIN_OFFSET", "ORIGIN_OFFSET"),
    ]);
}

#[test]
fn a_direction_folded_or_rounded_wrongly_is_caught() {
    caught(&[
        ("octahedral::encode_direction", "x * DIRECTION_STEPS + 0.5", "x * DIRECTION_STEPS"),
        ("octahedral::encode_direction", "if n.z < 0.0", "if n.z > 0.0"),
        ("octahedral::decode_direction", "if z < 0.0", "if z > 0.5"),
    ]);
}

#[test]
fn a_wrong_direction_or_density_is_caught() {
    caught(&[
        ("sampling::power_heuristic", "return 1.0 / (r * r + 1.0);", "return 1.0 / (r + 1.0);"),
        ("microfacet::vndf_sample", "(1.0 - u.y) * (1.0 + s.z)", "(1.0 - u.y) + s.z"),
        ("phong::phong_sample", "/ (1.0 - probability)", ""),
    ]);
}

#[test]
fn a_wrong_lobe_is_caught() {
    caught(&[
        ("bsdf::eval", "pdf += layers.probabilities.y * density;", "pdf += layers.probabilities.y * shape;"),
        ("bsdf::eval", "jacobian = (vh * -lh) / (root * root);", "jacobian = vh / (root * root);"),
        ("bsdf::sample", "wi.z = -wi.z;", "wi = -wi;"),
        ("layers::layers", "1.0 - coat_albedo", "1.0 - coat"),
        ("albedo::glass_albedo", "select(e.zw, e.xy, entering)", "e.xy"),
    ]);
}

#[test]
fn a_wrong_light_or_place_in_a_map_is_caught() {
    caught(&[
        ("light::distance_falloff", "1.0 - squared * squared", "1.0 - squared"),
        ("light::cone_falloff", "return t * t;", "return t;"),
        ("light::map_coordinates", "direction.x < 0.0)", "direction.x > 0.0)"),
        ("light::map_direction", "-(longitude.y * sine)", "longitude.y * sine"),
        ("light::map_pdf", "MAP_AREA: f32 = 19.739208", "MAP_AREA: f32 = 19.73921"),
    ]);
}

#[test]
fn a_wrong_normal_or_texel_is_caught() {
    caught(&[
        ("shading::mapped_normal", "cross(normal, along) * sign", "cross(normal, along)"),
        ("shading::visible_normal", "GRAZING - seen", "GRAZING"),
        ("shading::hue", "if y > 1e-6", "if y > 1e-5"),
        ("texel::wrap_coordinate", "2.0 * floor(u * 0.5)", "floor(u)"),
        ("texel::wrap_texel", "2 * n - 1 - i", "2 * n - i"),
        ("texel::texel_value", "1.0f / 255.0", "0.003921568"),
    ]);
}
