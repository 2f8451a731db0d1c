//! Generated tangents.

use super::builder::{Gltf, png};
use glam::{Vec3, Vec4};
use serde_json::json;

/// A square with a normal map and the given texture coordinates.
fn mapped(uvs: &[[f32; 2]; 4], normals: bool) -> Gltf {
    let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    let mut file = with_map(&square, uvs, 5);
    if normals {
        file.set("NORMAL", &[[0.0, 0.0, 1.0]; 4]);
    }
    file
}

/// A primitive of this mode with a normal map.
fn with_map(positions: &[[f32; 3]], uvs: &[[f32; 2]], mode: u32) -> Gltf {
    let mut file = Gltf::with_material(json!({"normalTexture": {"index": 0}}));
    file.texture(&png([2, 2], |_, _| [128, 128, 255, 255]));
    file.set("POSITION", positions);
    file.set("TEXCOORD_0", uvs);
    file.primitive()["mode"] = json!(mode);
    file
}

#[test]
fn tangents_point_along_growing_u_and_green_up_in_the_image() {
    // u to the right; the image upright (its top at v = 0, so v falls with y), upside down, and rotated.
    let upright = [[0.0, 1.0], [1.0, 1.0], [0.0, 0.0], [1.0, 0.0]];
    let flipped = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    let turned = [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]];
    for normals in [true, false] {
        for (uvs, tangent, green) in
            [(upright, Vec3::X, Vec3::Y), (flipped, Vec3::X, -Vec3::Y), (turned, Vec3::Y, -Vec3::X)]
        {
            let scene = mapped(&uvs, normals).open();
            for (t, n) in scene.still().tangents.iter().flatten().zip(scene.still().normals.iter().flatten()) {
                assert!(t.truncate().abs_diff_eq(tangent, 1e-6), "{t}");
                assert!((n.cross(t.truncate()) * t.w).abs_diff_eq(green, 1e-6), "{t}");
            }
        }
    }
}

#[test]
fn anisotropy_turns_the_tangents() {
    let mut file = mapped(&[[0.0, 1.0], [1.0, 1.0], [0.0, 0.0], [1.0, 0.0]], true);
    let turn = std::f32::consts::FRAC_PI_2;
    file.json["materials"][0] =
        json!({"extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 1.0, "anisotropyRotation": turn}}});
    let scene = file.open();
    // From the tangent towards the bitangent, which is up.
    assert!(scene.still().tangents.iter().flatten().all(|t| t.truncate().abs_diff_eq(Vec3::Y, 1e-6)));
}

#[test]
fn vertices_that_a_thousand_triangles_share_take_no_square_time() {
    let n = 100_000;
    let rim = (0..n).map(|i| (i as f32 / n as f32 * std::f32::consts::TAU).sin_cos());
    let positions: Vec<[f32; 3]> = [[0.0; 3]].into_iter().chain(rim.map(|(y, x)| [x, y, 0.0])).collect();
    let uvs: Vec<[f32; 2]> = positions.iter().map(|p| [p[0], -p[1]]).collect();
    let scene = with_map(&positions, &uvs, 6).open();
    assert_eq!(scene.still().len(), n - 1);
    // Edges of 6e-5 from coordinates rounded to 6e-8: the direction is accurate to a few thousandths.
    for t in scene.still().tangents.iter().flatten() {
        assert!(t.abs_diff_eq(Vec4::new(1.0, 0.0, 0.0, 1.0), 0.02), "{t}");
    }
}
