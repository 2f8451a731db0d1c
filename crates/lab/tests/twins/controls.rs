//! Planted errors in the shaders, one a module: each must be caught by the comparison of its function.

use super::probe::caught;

#[test]
fn a_planted_error_in_each_module_is_caught() {
    caught(&[
        ("triangle::intersect", "min(e0, min(e1, e2)) < 0.0", "min(e0, min(e1, e2)) <= 0.0"),
        ("octahedral::encode_direction", "x * DIRECTION_STEPS + 0.5", "x * DIRECTION_STEPS"),
        ("sampling::power_heuristic", "return 1.0 / (r * r + 1.0);", "return 1.0 / (r + 1.0);"),
        ("microfacet::vndf_sample", "(1.0 - u.y) * (1.0 + s.z)", "(1.0 - u.y) + s.z"),
        ("phong::phong_sample", "/ (1.0 - probability)", ""),
        ("layers::layers", "1.0 - coat_albedo", "1.0 - coat"),
        ("albedo::glass_albedo", "select(e.zw, e.xy, entering)", "e.xy"),
        ("light::map_pdf", "MAP_AREA: f32 = 19.739208", "MAP_AREA: f32 = 19.73921"),
        ("shading::mapped_normal", "cross(normal, along) * handedness", "cross(normal, along)"),
        ("texel::wrap_texel", "2 * n - 1 - i", "2 * n - i"),
    ]);
}
