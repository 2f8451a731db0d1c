//! Lamps: a pendant over the table, one at the ceiling, one on the floor, and two strips below the wall units.

use super::cupboards::WALL_BOTTOM_M;
use super::furniture::TABLE_XZ_M;
use super::materials::{DOME, METAL, PENDANT, SHADE, STRIPS, WHITE};
use super::rig::Rig;
use super::size::{HALF_WIDTH_M, HEIGHT_M};
use super::solids::{Rod, block, surface, wire};
use crate::scene::Triangles;
use crate::scene::builtin::shapes::Ellipsoid;
use glam::{Quat, Vec3};
use std::f32::consts::TAU;

/// Height of the pendant's lower edge, metres.
const PENDANT_M: f32 = 1.8;
/// Middle of the dome at the ceiling, metres.
const CEILING_LAMP_M: [f32; 3] = [-0.4, HEIGHT_M, 1.4];

/// Appends all lamps.
pub(super) fn push(out: &mut Triangles) {
    push_pendant(out);
    let radii = Vec3::new(0.16, 0.07, 0.16);
    let center = Vec3::from(CEILING_LAMP_M);
    Ellipsoid { center, radii, rotation: Quat::IDENTITY, around: 48, rings: 24 }.push(DOME, out);
    push_floor_lamp([-1.95, -2.75], out);
    for (strip, z) in STRIPS.into_iter().zip([-0.4, 1.6]) {
        let x = HALF_WIDTH_M - 0.2;
        block([x, WALL_BOTTOM_M - 0.012, z - 0.3], [x + 0.03, WALL_BOTTOM_M, z + 0.3], strip, out);
    }
}

/// Adds the light of the pendant and of the lamp at the ceiling, as points below them: their glow alone lights little.
pub(super) fn shine(rig: &mut Rig) {
    let [x, z] = TABLE_XZ_M;
    rig.lamp(Vec3::new(x, PENDANT_M - 0.03, z), [2.2, 1.8, 1.3]);
    rig.lamp(Vec3::from(CEILING_LAMP_M) - Vec3::Y * 0.25, [5.0, 4.4, 3.6]);
}

/// A cone over a glowing disk that shines down.
fn push_pendant(out: &mut Triangles) {
    let [x, z] = TABLE_XZ_M;
    let bottom = Vec3::new(x, PENDANT_M, z);
    let top = bottom + Vec3::Y * 0.16;
    Rod { from: bottom, to: top, radii_m: [0.2, 0.04] }.push_side(64, WHITE, out);
    wire(top, Vec3::new(x, HEIGHT_M, z), 0.003, METAL, out);
    surface(out, [48, 1], PENDANT, |u, v| {
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
