//! `bunny-low` and `bunny-high`: a rabbit of ellipsoids. It is not derived from the Stanford bunny, but has as many
//! triangles as the thesis' two decimations of that model: 292 and 4,968.

use super::shapes::{self, Ellipsoid};
use crate::scene::{Camera, PunctualLight, Scene, Triangles};
use glam::{DVec3, Quat, Vec3};

/// Tessellation of each body part: faces around, and rings.
struct Detail {
    body: [u32; 2],
    head: [u32; 2],
    ear: [u32; 2],
    foot: [u32; 2],
    tail: [u32; 2],
}

/// `bunny-low`: 292 triangles.
pub(super) fn low() -> Scene {
    scene("bunny-low", &Detail { body: [8, 6], head: [8, 5], ear: [6, 4], foot: [5, 4], tail: [4, 3] })
}

/// `bunny-high`: 4,968 triangles.
pub(super) fn high() -> Scene {
    scene("bunny-high", &Detail { body: [36, 21], head: [30, 19], ear: [24, 15], foot: [18, 11], tail: [16, 13] })
}

fn scene(name: &str, detail: &Detail) -> Scene {
    let mut still = Triangles::default();
    let mut part = |center: [f32; 3], radii: [f32; 3], rotation: Quat, [around, rings]: [u32; 2], material: u32| {
        let (center, radii) = (Vec3::from_array(center), Vec3::from_array(radii));
        Ellipsoid { center, radii, rotation, around, rings }.push(material, &mut still);
    };
    // Metres; it sits on y = 0 and looks along +z.
    let upright = Quat::IDENTITY;
    part([0.0, 0.36, -0.1], [0.3, 0.36, 0.4], upright, detail.body, FUR);
    part([0.0, 0.78, 0.24], [0.19, 0.2, 0.24], upright, detail.head, FUR);
    for side in [-1.0, 1.0] {
        let ear = Quat::from_rotation_z(-0.25 * side) * Quat::from_rotation_x(-0.3);
        part([0.13 * side, 1.12, 0.1], [0.065, 0.26, 0.04], ear, detail.ear, SKIN);
        part([0.2 * side, 0.08, 0.22], [0.09, 0.08, 0.2], upright, detail.foot, FUR);
    }
    part([0.0, 0.28, -0.52], [0.11, 0.11, 0.11], upright, detail.tail, SKIN);
    let sun = PunctualLight::sun(Vec3::new(-0.5, -1.0, -0.6), [2.0, 1.9, 1.7]);
    let materials =
        vec![shapes::glossy("fur", [0.55, 0.4, 0.28], 0.8, 8.0), shapes::glossy("skin", [0.75, 0.55, 0.5], 0.5, 30.0)];
    let camera = Camera::look_at(DVec3::new(0.9, 0.9, 1.7), DVec3::new(0.0, 0.6, 0.0), 45.0);
    super::still::still(name, materials, still, camera, vec![sun], [0.35, 0.45, 0.6])
}

const FUR: u32 = 0;
const SKIN: u32 = 1;
