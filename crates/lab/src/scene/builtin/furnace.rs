//! The white furnace test: an object that reflects all incident light is invisible in a uniform environment.

use super::patch::direction;
use super::still::{look_at, still};
use crate::scene::{Material, Scene, Triangles};
use glam::Vec3;

/// A ball of eight white sectors, each with another lobe of the BSDF, in a uniform environment of radiance 1. Where
/// energy is conserved the ball is invisible: every pixel is 1 except for noise, at any path depth of 1 or more.
pub fn furnace() -> Scene {
    let white = Material::default();
    let metal = Material { metallic: 1.0, ..white.clone() };
    furnace_of(vec![
        Material { name: "Lambert".into(), specular: 0.0, ..white.clone() },
        Material { name: "rough dielectric, retro-reflecting".into(), roughness: 1.0, ..white.clone() },
        Material { name: "smooth dielectric".into(), roughness: 0.2, ..white.clone() },
        Material { name: "smooth metal".into(), roughness: 0.1, ..metal.clone() },
        Material { name: "rough metal".into(), roughness: 0.9, ..metal.clone() },
        Material { name: "brushed metal".into(), roughness: 0.5, anisotropy: 0.8, ..metal.clone() },
        Material { name: "coat over metal".into(), roughness: 0.6, clearcoat: 1.0, clearcoat_roughness: 0.1, ..metal },
        Material { name: "sheen".into(), sheen_color: [1.0; 3], sheen_roughness: 0.5, ..white },
    ])
}

/// A ball of radius 1 m with a sector for each of `materials`, in a uniform environment of radiance 1, seen from 4 m.
/// It is shaded flat, so that shading and geometric normals agree.
pub fn furnace_of(materials: Vec<Material>) -> Scene {
    let mut t = Triangles::default();
    let sectors = materials.len().max(1) as u32;
    let columns = (64 / sectors).max(2) * sectors;
    let rows = 32;
    for column in 0..columns {
        for row in 0..rows {
            let at = |i: u32, j: u32| direction(i as f32 / columns as f32, j as f32 / rows as f32);
            let [a, b, c, d] = [at(column, row), at(column + 1, row), at(column + 1, row + 1), at(column, row + 1)];
            let material = column * sectors / columns;
            if row > 0 {
                t.push_flat([a, b, c], material);
            }
            if row + 1 < rows {
                t.push_flat([a, c, d], material);
            }
        }
    }
    // Snap the poles, which are off by the rounded sine of pi.
    for corners in &mut t.positions {
        for p in corners {
            if p.y.abs() > 1.0 - 1e-6 {
                *p = Vec3::Y * p.y.signum();
            }
        }
    }
    let camera = look_at([0.0, 0.0, 4.0], [0.0, 0.0, 0.0], 40.0);
    still("furnace", materials, t, camera, vec![], [1.0; 3])
}
