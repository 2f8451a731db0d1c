//! A row of cupboards along the wall at +x. The gaps between their fronts are about as wide as a pixel.

use super::materials::{CARCASS, COUNTER, FRONT, GLAZE, METAL, TILES};
use super::size::HALF_WIDTH_M;
use super::solids::{Rod, block};
use super::textures;
use crate::scene::Triangles;

/// Width of the gaps between fronts: from 1.3 m, 1 px of 320x180 and 2 px of 640x360.
const GAP_M: f32 = 0.008;
/// Width of a unit along z, the row's start, and the number of units.
const UNIT_M: f32 = 0.5;
const START_M: f32 = -1.4;
const UNITS: u32 = 8;
const END_M: f32 = START_M + UNIT_M * UNITS as f32;
/// Thickness of a front.
const FRONT_M: f32 = 0.018;

/// Side of the base and wall units that faces the room, along x.
const BASE_X_M: f32 = HALF_WIDTH_M - 0.6;
const WALL_X_M: f32 = HALF_WIDTH_M - 0.35;
/// Lower edge of the wall units; lamps hang below it.
pub(super) const WALL_BOTTOM_M: f32 = 1.42;

/// Appends base units, counter, tiles, wall units, and things on the counter.
pub(super) fn push(out: &mut Triangles) {
    block([BASE_X_M + 0.06, 0.0, START_M], [HALF_WIDTH_M, 0.1, END_M], CARCASS, out);
    block([BASE_X_M + FRONT_M, 0.1, START_M], [HALF_WIDTH_M, 0.86, END_M], CARCASS, out);
    block([BASE_X_M - 0.03, 0.86, START_M], [HALF_WIDTH_M, 0.9, END_M], COUNTER, out);
    block([HALF_WIDTH_M - 0.01, 0.9, START_M], [HALF_WIDTH_M, WALL_BOTTOM_M, END_M], TILES, out);
    block([WALL_X_M + FRONT_M, WALL_BOTTOM_M, START_M], [HALF_WIDTH_M, 2.2, END_M], CARCASS, out);
    for unit in 0..UNITS {
        let z = START_M + UNIT_M * unit as f32;
        if unit % 3 == 1 {
            push_drawers(z, out);
        } else {
            push_doors(BASE_X_M, [0.1, 0.86], z, 0.74, out);
        }
        push_doors(WALL_X_M, [WALL_BOTTOM_M, 2.2], z, 1.54, out);
    }
    push_jars(out);
}

/// Two doors of half a unit each, with handles that meet in the middle around the height `handle_y`.
fn push_doors(x: f32, [bottom, top]: [f32; 2], z: f32, handle_y: f32, out: &mut Triangles) {
    let middle = z + UNIT_M / 2.0;
    for [from, to] in [[z, middle], [middle, z + UNIT_M]] {
        push_front(x, [bottom, top], [from, to], out);
    }
    for side in [-1.0, 1.0] {
        let z = middle + side * 0.035;
        push_handle([x, handle_y - 0.06, z], [x, handle_y + 0.06, z], out);
    }
}

fn push_drawers(z: f32, out: &mut Triangles) {
    for [bottom, top] in [[0.1, 0.38], [0.38, 0.62], [0.62, 0.74], [0.74, 0.86]] {
        push_front(BASE_X_M, [bottom, top], [z, z + UNIT_M], out);
        let (y, middle) = (0.5 * (bottom + top), z + UNIT_M / 2.0);
        push_handle([BASE_X_M, y, middle - 0.09], [BASE_X_M, y, middle + 0.09], out);
    }
}

/// A front that leaves half a gap to each neighbour.
fn push_front(x: f32, [bottom, top]: [f32; 2], [from, to]: [f32; 2], out: &mut Triangles) {
    let half = GAP_M / 2.0;
    block([x, bottom + half, from + half], [x + FRONT_M, top - half, to - half], FRONT, out);
}

/// A bar on two posts before a front, between two points of it.
fn push_handle(from: [f32; 3], to: [f32; 3], out: &mut Triangles) {
    let ahead = |[x, y, z]: [f32; 3]| [x - 0.03, y, z];
    Rod::even(ahead(from), ahead(to), 0.005).push(12, METAL, out);
    for end in [from, to] {
        Rod::even(end, ahead(end), 0.004).push_side(8, METAL, out);
    }
}

fn push_jars(out: &mut Triangles) {
    for jar in 0..14 {
        let random = |salt| textures::noise([jar, salt], 40);
        let z = START_M + 0.2 + 0.27 * jar as f32;
        let x = HALF_WIDTH_M - 0.12 - 0.15 * random(0);
        let (radius, high) = (0.03 + 0.04 * random(1), 0.1 + 0.15 * random(2));
        let material = if jar % 3 == 0 { METAL } else { GLAZE };
        Rod::even([x, 0.9, z], [x, 0.9 + high, z], radius).push(32, material, out);
        Rod::even([x, 0.9 + high, z], [x, 0.93 + high, z], 0.4 * radius).push(24, METAL, out);
    }
}
