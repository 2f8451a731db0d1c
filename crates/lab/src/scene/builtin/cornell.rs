//! The Cornell box.

use super::still::{look_at, still};
use crate::scene::{Material, Scene, Triangles};
use glam::Vec3;

/// A room of 5.55 m with an open front, two blocks, and an area light in the ceiling. All surfaces are Lambertian.
///
/// | object | position, metres | reflectance |
/// |---|---|---|
/// | floor, ceiling, back wall | 0..5.55 in x, y, z; the front (z = 0) is open | 0.73 |
/// | left wall as seen (x = 5.55) | | 0.65, 0.05, 0.05 |
/// | right wall as seen (x = 0) | | 0.12, 0.45, 0.15 |
/// | tall block | 1.65 x 3.30 x 1.65, turned by 15 degrees about y, moved by (2.65, 0, 2.95) | 0.73 |
/// | low block | 1.65 x 1.65 x 1.65, turned by -18 degrees about y, moved by (1.30, 0, 0.65) | 0.73 |
/// | lamp | x 2.13..3.43, z 2.27..3.32, y 5.54; radiance 15 downwards | 0 |
///
/// The camera is at (2.78, 2.78, -8), looks along +z, and has a vertical field of view of 40 degrees. The environment
/// is black. Dimensions are those of Shirley's "Ray Tracing: The Next Week", which rounds the Cornell measurements.
pub fn cornell() -> Scene {
    let lambert =
        |name: &str, base_color| Material { name: name.into(), base_color, specular: 0.0, ..Material::default() };
    let [white, red, green, lamp] = [0, 1, 2, 3];
    let materials = vec![
        lambert("white", [0.73; 3]),
        lambert("red", [0.65, 0.05, 0.05]),
        lambert("green", [0.12, 0.45, 0.15]),
        Material { emissive: [15.0; 3], double_sided: false, ..lambert("lamp", [0.0; 3]) },
    ];
    let mut t = Triangles::default();
    let s = 5.55;
    let corner = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    // Fronts face inwards.
    t.push_quad([corner(0., 0., 0.), corner(0., 0., s), corner(s, 0., s), corner(s, 0., 0.)], white);
    t.push_quad([corner(0., s, 0.), corner(s, s, 0.), corner(s, s, s), corner(0., s, s)], white);
    t.push_quad([corner(0., 0., s), corner(0., s, s), corner(s, s, s), corner(s, 0., s)], white);
    t.push_quad([corner(s, 0., 0.), corner(s, 0., s), corner(s, s, s), corner(s, s, 0.)], red);
    t.push_quad([corner(0., 0., 0.), corner(0., s, 0.), corner(0., s, s), corner(0., 0., s)], green);
    let [x0, x1, z0, z1, y] = [2.13, 3.43, 2.27, 3.32, 5.54];
    t.push_quad([corner(x0, y, z0), corner(x1, y, z0), corner(x1, y, z1), corner(x0, y, z1)], lamp);
    block(&mut t, Vec3::new(1.65, 3.30, 1.65), 15.0, Vec3::new(2.65, 0.0, 2.95), white);
    block(&mut t, Vec3::splat(1.65), -18.0, Vec3::new(1.30, 0.0, 0.65), white);
    let camera = look_at([2.78, 2.78, -8.0], [2.78, 2.78, 0.0], 40.0);
    still("cornell", materials, t, camera, vec![], [0.0; 3])
}

/// Appends the 12 triangles of a box with a corner at the origin, rotated by `turn_deg` about y, then translated by
/// `moved`. Fronts face outwards.
fn block(to: &mut Triangles, size: Vec3, turn_deg: f32, moved: Vec3, material: u32) {
    let turn = glam::Quat::from_rotation_y(turn_deg.to_radians());
    let corner = |x: u32, y: u32, z: u32| turn * (size * Vec3::new(x as f32, y as f32, z as f32)) + moved;
    for face in [
        [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]],
        [[1, 0, 0], [0, 0, 0], [0, 1, 0], [1, 1, 0]],
        [[1, 0, 1], [1, 0, 0], [1, 1, 0], [1, 1, 1]],
        [[0, 0, 0], [0, 0, 1], [0, 1, 1], [0, 1, 0]],
        [[0, 1, 1], [1, 1, 1], [1, 1, 0], [0, 1, 0]],
        [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]],
    ] {
        to.push_quad(face.map(|[x, y, z]| corner(x, y, z)), material);
    }
}
