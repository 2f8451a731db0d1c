//! Lamps: a pendant over the table, a floor lamp, and two strips below the wall units.

use super::cupboards::WALL_BOTTOM_M;
use super::furniture::TABLE_XZ_M;
use super::materials::{METAL, PENDANT, SHADE, STRIPS, WHITE};
use super::solids::{Rod, block, wire};
use super::{HALF_WIDTH_M, HEIGHT_M};
use crate::scene::Triangles;
use crate::scene::builtin::patch::patch;
use glam::Vec3;
use std::f32::consts::TAU;

/// Appends all lamps.
pub(super) fn push(out: &mut Triangles) {
    push_pendant(out);
    push_floor_lamp([-1.95, -2.75], out);
    for (strip, z) in STRIPS.into_iter().zip([-0.4, 1.6]) {
        let x = HALF_WIDTH_M - 0.2;
        block([x, WALL_BOTTOM_M - 0.012, z - 0.3], [x + 0.03, WALL_BOTTOM_M, z + 0.3], strip, out);
    }
}

/// A cone over a glowing disk that shines down.
fn push_pendant(out: &mut Triangles) {
    let [x, z] = TABLE_XZ_M;
    let bottom = Vec3::new(x, 1.8, z);
    let top = bottom + Vec3::Y * 0.16;
    Rod { from: bottom, to: top, radii_m: [0.2, 0.04] }.push_side(64, WHITE, out);
    wire(top, Vec3::new(x, HEIGHT_M, z), 0.003, METAL, out);
    patch(out, [48, 1], PENDANT, |u, v| {
        let (sin, cos) = (u * TAU).sin_cos();
        bottom + Vec3::Y * 0.02 + Vec3::new(sin, 0.0, cos) * (0.12 * v)
    });
}

fn push_floor_lamp([x, z]: [f32; 2], out: &mut Triangles) {
    Rod::even([x, 0.0, z], [x, 0.02, z], 0.14).push(48, METAL, out);
    Rod::even([x, 0.02, z], [x, 1.4, z], 0.01).push(16, METAL, out);
    let shade = Vec3::new(x, 1.35, z);
    Rod { from: shade, to: shade + Vec3::Y * 0.3, radii_m: [0.2, 0.14] }.push_side(64, SHADE, out);
}
