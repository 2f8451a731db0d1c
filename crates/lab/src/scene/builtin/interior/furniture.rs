//! Table, chairs, shelf, picture and rug.

use super::materials::{BOOKS, FIRST_BOOK, GLAZE, PICTURE, RUG, TABLE, WHITE, WOOD};
use super::size::HALF_WIDTH_M;
use super::solids::{Rod, block};
use super::textures;
use crate::scene::Triangles;
use glam::{Quat, Vec3};

/// Middle of the table, metres.
pub(super) const TABLE_XZ_M: [f32; 2] = [0.0, -0.5];

/// Appends all of it.
pub(super) fn push(out: &mut Triangles) {
    let [x, z] = TABLE_XZ_M;
    block([x - 1.2, 0.0, z - 0.75], [x + 1.2, 0.008, z + 0.75], RUG, out);
    push_table(out);
    for (from_table, turn_deg) in
        [([1.0, 0.0], 0.0), ([-1.0, 0.05], 170.0), ([0.1, 0.75], -80.0), ([-0.1, -0.72], 95.0)]
    {
        let at = Vec3::new(x + from_table[0], 0.0, z + from_table[1]);
        push_chair(at, f32::to_radians(turn_deg), out);
    }
    push_shelf(out);
    block([-HALF_WIDTH_M, 1.2, -2.4], [-HALF_WIDTH_M + 0.03, 1.9, -1.5], WOOD, out);
    block([-HALF_WIDTH_M, 1.24, -2.36], [-HALF_WIDTH_M + 0.035, 1.86, -1.54], PICTURE, out);
}

fn push_table(out: &mut Triangles) {
    let [x, z] = TABLE_XZ_M;
    block([x - 0.7, 0.71, z - 0.4], [x + 0.7, 0.74, z + 0.4], TABLE, out);
    block([x - 0.62, 0.64, z - 0.33], [x + 0.62, 0.71, z + 0.33], WOOD, out);
    for [a, b] in [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]] {
        let (from, to) = (Vec3::new(x + 0.62 * a, 0.0, z + 0.33 * b), Vec3::new(x + 0.6 * a, 0.64, z + 0.31 * b));
        Rod { from, to, radii_m: [0.018, 0.03] }.push(20, WOOD, out);
    }
    let bowl = Vec3::new(x - 0.1, 0.74, z);
    Rod { from: bowl, to: bowl + Vec3::Y * 0.08, radii_m: [0.06, 0.14] }.push(48, GLAZE, out);
    let cup = Vec3::new(x + 0.4, 0.74, z + 0.2);
    Rod { from: cup, to: cup + Vec3::Y * 0.09, radii_m: [0.03, 0.04] }.push(32, WHITE, out);
}

/// A chair whose back is at +x before it turns about the vertical by `turn`.
fn push_chair(at: Vec3, turn: f32, out: &mut Triangles) {
    let place = |x: f32, y: f32, z: f32| at + Quat::from_rotation_y(turn) * Vec3::new(x, y, z);
    let mut rod = |from: Vec3, to: Vec3, radius_m: f32, sides: u32| {
        Rod { from, to, radii_m: [radius_m; 2] }.push(sides, WOOD, out);
    };
    for side in [-1.0, 1.0] {
        rod(place(-0.2, 0.0, 0.19 * side), place(-0.18, 0.45, 0.17 * side), 0.012, 12);
        rod(place(0.22, 0.0, 0.19 * side), place(0.18, 0.45, 0.17 * side), 0.012, 12);
        rod(place(0.18, 0.45, 0.17 * side), place(0.24, 0.9, 0.17 * side), 0.012, 12);
        rod(place(-0.19, 0.2, 0.18 * side), place(0.2, 0.2, 0.18 * side), 0.007, 8);
    }
    // The seat: a flat cylinder; the back: a rail with bars.
    rod(place(0.0, 0.44, 0.0), place(0.0, 0.465, 0.0), 0.22, 40);
    rod(place(0.24, 0.9, -0.19), place(0.24, 0.9, 0.19), 0.015, 12);
    for bar in -2..=2 {
        let z = 0.055 * bar as f32;
        rod(place(0.185, 0.46, z), place(0.24, 0.9, z), 0.005, 8);
    }
}

/// A shelf with five boards of books at the wall at -x.
fn push_shelf(out: &mut Triangles) {
    let (back, front) = (-HALF_WIDTH_M, -HALF_WIDTH_M + 0.28);
    let (from, to) = (-1.1, 1.3);
    for level in 0..6 {
        let y = 0.1 + 0.36 * level as f32;
        block([back, y - 0.02, from], [front, y, to], WOOD, out);
    }
    for z in [from, 0.1, to - 0.02] {
        block([back, 0.0, z], [front, 1.9, z + 0.02], WOOD, out);
    }
    for level in 0..5 {
        push_books([front - 0.03, 0.1 + 0.36 * level as f32], [from + 0.03, to - 0.05], level, out);
    }
}

/// Books side by side along z, whose spines stand back from `front`.
fn push_books([front, y]: [f32; 2], [from, to]: [f32; 2], level: u32, out: &mut Triangles) {
    let mut z = from;
    for book in 0.. {
        let random = |salt| textures::noise([book, salt], 50 + level);
        let thick = 0.012 + 0.035 * random(0);
        if z + thick > to {
            break;
        }
        let high = 0.2 + 0.12 * random(1);
        let material = FIRST_BOOK + (random(2) * BOOKS as f32) as u32;
        // One in twelve is out on loan.
        if random(3) > 0.08 {
            block([-HALF_WIDTH_M, y, z], [front - 0.04 * random(4), y + high, z + thick], material, out);
        }
        z += thick + 0.002;
    }
}
