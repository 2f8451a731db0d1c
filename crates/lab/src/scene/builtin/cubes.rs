//! `cubes`: 441 axis-aligned cubes on a grid of 21 x 21, at random heights and in random colors.

use super::shapes;
use crate::scene::{Camera, PunctualLight, Scene, Triangles};
use glam::{DVec3, Vec3};

/// Cubes along a side of the grid.
const SIDE: u32 = 21;
/// Edge of a cube in metres; the grid's step is 1.
const EDGE: f32 = 0.8;
const COLORS: [[f32; 3]; 7] = [
    [0.75, 0.15, 0.1],
    [0.8, 0.45, 0.1],
    [0.75, 0.7, 0.15],
    [0.2, 0.6, 0.2],
    [0.1, 0.5, 0.65],
    [0.2, 0.25, 0.7],
    [0.7, 0.7, 0.7],
];

/// 5,292 triangles under a sun and a sky.
pub(super) fn scene() -> Scene {
    let mut still = Triangles::default();
    let middle = (SIDE - 1) as f32 / 2.0;
    for i in 0..SIDE * SIDE {
        let (x, z) = ((i % SIDE) as f32 - middle, (i / SIDE) as f32 - middle);
        let hash = scatter(i);
        // Heights of 0 to 2 m in 16 steps.
        let y = (hash >> 28) as f32 / 7.5;
        let min = Vec3::new(x, y, z) - Vec3::new(EDGE / 2.0, 0.0, EDGE / 2.0);
        shapes::push_box(min, min + EDGE, false, hash % COLORS.len() as u32, &mut still);
    }
    let material = |(i, &color): (usize, &[f32; 3])| shapes::glossy(&format!("color {i}"), color, 0.5, 20.0);
    let materials = COLORS.iter().enumerate().map(material).collect();
    let sun = PunctualLight::sun(Vec3::new(0.4, -1.0, -0.3), [2.2, 2.1, 1.9]);
    let camera = Camera::look_at(DVec3::new(0.0, 7.0, 14.0), DVec3::new(0.0, 0.5, 0.0), 50.0);
    super::still::still("cubes", materials, still, camera, vec![sun], [0.4, 0.5, 0.65])
}

/// 32-bit hash (the finaliser of MurmurHash3).
fn scatter(i: u32) -> u32 {
    let mut h = i.wrapping_add(1).wrapping_mul(0x9e37_79b9);
    h = (h ^ (h >> 16)).wrapping_mul(0x85eb_ca6b);
    h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
    h ^ (h >> 16)
}
