//! `mirror-room`: weakly emissive mirror walls, so that every path continues to the largest depth.

use super::shapes::{self, Ellipsoid};
use crate::scene::{Camera, Material, Phong, Scene, Triangles};
use glam::{DVec3, Quat, Vec3};

const MIRROR: u32 = 0;
const RED: u32 = 1;
const BLUE: u32 = 2;

/// A closed room of 6 x 3 x 6 m, lit by its walls alone.
pub(super) fn scene() -> Scene {
    let mut still = Triangles::default();
    shapes::push_box(Vec3::new(-3.0, 0.0, -3.0), Vec3::new(3.0, 3.0, 3.0), true, MIRROR, &mut still);
    for (x, z, radius, material) in [(-1.2, -0.8, 0.6, RED), (1.1, -1.4, 0.45, BLUE), (0.3, 0.4, 0.3, RED)] {
        let center = Vec3::new(x, radius + 0.05, z);
        let (radii, rotation) = (Vec3::splat(radius), Quat::IDENTITY);
        Ellipsoid { center, radii, rotation, around: 32, rings: 17 }.push(material, &mut still);
    }
    shapes::push_box(Vec3::new(1.2, 0.05, 0.2), Vec3::new(1.8, 0.65, 0.8), false, BLUE, &mut still);
    let mirror = Material {
        name: "glowing mirror".into(),
        base_color: [0.9, 0.92, 0.9],
        metallic: 1.0,
        roughness: 0.0,
        emissive: [0.06, 0.06, 0.065],
        double_sided: false,
        phong: Some(Phong { specular: [0.9, 0.92, 0.9], exponent: 10_000.0 }),
        ..Material::default()
    };
    let materials = vec![
        mirror,
        shapes::glossy("red", [0.7, 0.12, 0.1], 0.4, 40.0),
        shapes::glossy("blue", [0.12, 0.2, 0.7], 0.4, 40.0),
    ];
    let camera = Camera::look_at(DVec3::new(0.0, 1.5, 2.7), DVec3::new(0.0, 0.9, -1.0), 60.0);
    super::still::still("mirror-room", materials, still, camera, vec![], [0.0; 3])
}
