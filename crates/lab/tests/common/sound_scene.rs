//! What every scene that was read has to be.

use afterimage_lab::scene::{Scene, Triangles};
use glam::{Vec2, Vec3, Vec4};

/// Checks what a tracer relies on: complete, finite, unit vectors, indices that exist.
#[track_caller]
pub fn assert_sound(scene: &Scene) {
    for time_s in [0.0, 0.37, 1e9, -2.5, f64::NAN, f64::INFINITY] {
        let pose = scene.pose(time_s);
        assert_eq!(pose.moving.len(), scene.pose(0.0).moving.len());
        assert_triangles_sound(&pose.moving, scene);
        for light in &pose.lights {
            assert!(light.position.is_finite() && (light.direction.length() - 1.0).abs() < 1e-5, "{light:?}");
            assert!(light.intensity.iter().all(|c| c.is_finite() && *c >= 0.0) && light.range > 0.0, "{light:?}");
        }
        for camera in &pose.cameras {
            let m = camera.world_from_camera;
            assert!(m.is_finite() && (m.determinant() - 1.0).abs() < 1e-9, "{camera:?}");
            assert!(camera.vfov_deg > 0.0 && camera.vfov_deg < 180.0);
        }
    }
    assert_triangles_sound(scene.still(), scene);
    for material in &scene.materials {
        let slots = [
            material.base_color_texture,
            material.metallic_roughness_texture,
            material.normal_texture,
            material.emissive_texture,
            material.clearcoat_texture,
        ];
        for slot in slots.into_iter().flatten() {
            assert!((slot.texture as usize) < scene.textures.len());
        }
        let unit = |x: f32| (0.0..=1.0).contains(&x);
        assert!(material.base_color.iter().all(|&c| unit(c)) && unit(material.metallic) && unit(material.roughness));
        assert!(material.emissive.iter().all(|c| c.is_finite() && *c >= 0.0) && material.ior >= 1.0);
        assert!(material.absorption.iter().all(|c| c.is_finite() && *c >= 0.0));
    }
    for texture in &scene.textures {
        assert_eq!(texture.texels.len(), texture.size[0] as usize * texture.size[1] as usize);
        assert!(!texture.texels.is_empty());
    }
    assert!(scene.framing_camera(1.5).world_from_camera.is_finite());
}

/// The same of triangles.
#[track_caller]
pub fn assert_triangles_sound(triangles: &Triangles, scene: &Scene) {
    let n = triangles.len();
    let lengths = [
        triangles.normals.len(),
        triangles.uvs.len(),
        triangles.tangents.len(),
        triangles.colors.len(),
        triangles.materials.len(),
    ];
    assert_eq!(lengths, [n; 5]);
    assert!(triangles.positions.iter().flatten().all(|p| p.is_finite()));
    assert!(triangles.normals.iter().flatten().all(|v: &Vec3| (v.length() - 1.0).abs() < 1e-4));
    assert!(triangles.uvs.iter().flatten().all(|v: &Vec2| v.is_finite()));
    for (tangents, normals) in triangles.tangents.iter().zip(&triangles.normals) {
        for (t, n) in tangents.iter().zip(normals) {
            let direction = t.truncate();
            assert!(
                (direction.length() - 1.0).abs() < 1e-4 && direction.dot(*n).abs() < 1e-3 && t.w.abs() == 1.0,
                "{t} {n}"
            );
        }
    }
    assert!(triangles.colors.iter().flatten().all(|c: &Vec4| c.min_element() >= 0.0 && c.max_element() <= 1.0));
    assert!(triangles.materials.iter().all(|&m| (m as usize) < scene.materials.len()));
}
