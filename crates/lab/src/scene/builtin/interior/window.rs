//! The window, its bars and blinds, and the sky behind it.

use super::materials::{BLIND, METAL, WHITE};
use super::size::HALF_DEPTH_M;
use super::solids::{block, wire};
use crate::scene::{Environment, Triangles};
use afterimage::Image;
use glam::{Quat, Vec3};
use std::f32::consts::{PI, TAU};

/// Half the window's width, metres.
pub(super) const HALF_SPAN_M: f32 = 1.3;
/// Heights of the sill and of the upper edge, metres.
pub(super) const BOTTOM_M: f32 = 0.85;
pub(super) const TOP_M: f32 = 2.3;

/// Distance of slats, their depth, and their tilt. They are as fine as a pixel of 320x180 from the middle of the room.
const SLAT_STEP_M: f32 = 0.03;
const SLAT_DEPTH_M: f32 = 0.03;
const SLAT_TILT_DEG: f32 = 45.0;

/// Appends frame, bars and two blinds, of which one is lowered farther.
pub(super) fn push(out: &mut Triangles) {
    push_frame(out);
    push_bars(out);
    push_blind([-HALF_SPAN_M + 0.05, -0.03], 1.25, out);
    push_blind([0.03, HALF_SPAN_M - 0.05], 1.8, out);
}

fn push_frame(out: &mut Triangles) {
    let (back, front) = (-HALF_DEPTH_M - 0.1, -HALF_DEPTH_M - 0.04);
    let rim = 0.05;
    for (min, max) in [
        ([-HALF_SPAN_M, BOTTOM_M], [-HALF_SPAN_M + rim, TOP_M]),
        ([HALF_SPAN_M - rim, BOTTOM_M], [HALF_SPAN_M, TOP_M]),
        ([-HALF_SPAN_M, BOTTOM_M], [HALF_SPAN_M, BOTTOM_M + rim]),
        ([-HALF_SPAN_M, TOP_M - rim], [HALF_SPAN_M, TOP_M]),
        ([-0.03, BOTTOM_M], [0.03, TOP_M]),
    ] {
        block([min[0], min[1], back], [max[0], max[1], front], WHITE, out);
    }
    block(
        [-HALF_SPAN_M - 0.05, BOTTOM_M - 0.03, -HALF_DEPTH_M],
        [HALF_SPAN_M + 0.05, BOTTOM_M, -HALF_DEPTH_M + 0.12],
        WHITE,
        out,
    );
}

/// Bars of 2 cm between the panes.
fn push_bars(out: &mut Triangles) {
    let (back, front) = (-HALF_DEPTH_M - 0.08, -HALF_DEPTH_M - 0.06);
    for k in 1..8 {
        let x = (k as f32 / 8.0 * 2.0 - 1.0) * HALF_SPAN_M;
        block([x - 0.01, BOTTOM_M, back], [x + 0.01, TOP_M, front], WHITE, out);
    }
    for k in 1..4 {
        let y = BOTTOM_M + (TOP_M - BOTTOM_M) * k as f32 / 4.0;
        block([-HALF_SPAN_M, y - 0.01, back], [HALF_SPAN_M, y + 0.01, front], WHITE, out);
    }
}

/// Appends the slats from `lowest_m` up, their cords, and the rail at the top.
fn push_blind([left, right]: [f32; 2], lowest_m: f32, out: &mut Triangles) {
    let z = -HALF_DEPTH_M - 0.015;
    let count = ((TOP_M - 0.06 - lowest_m) / SLAT_STEP_M) as u32;
    for k in 0..count {
        push_slat([left, right], Vec3::new(0.0, lowest_m + k as f32 * SLAT_STEP_M, z), out);
    }
    block([left, TOP_M - 0.05, z - 0.02], [right, TOP_M, z + 0.02], WHITE, out);
    for share in [0.15, 0.85] {
        let x = left + (right - left) * share;
        wire(Vec3::new(x, lowest_m, z + 0.013), Vec3::new(x, TOP_M, z + 0.013), 0.001, METAL, out);
    }
}

fn push_slat([left, right]: [f32; 2], middle: Vec3, out: &mut Triangles) {
    let tilt = Quat::from_rotation_x(SLAT_TILT_DEG.to_radians());
    let at = |x: f32, side: f32| middle + Vec3::X * x + tilt * Vec3::new(0.0, 0.0, 0.5 * side * SLAT_DEPTH_M);
    out.push_quad([at(left, 1.0), at(right, 1.0), at(right, -1.0), at(left, -1.0)], BLIND);
}

/// Radiance of the sky: a garden under a bright sky behind the window, and elsewhere what a room reflects on average,
/// because the rasterizer's light of the sky passes walls.
pub(super) fn environment() -> Environment {
    let size = [128, 64];
    let texels = (0..size[0] * size[1]).map(|i| {
        let (x, y) = ((i % size[0]) as f32 + 0.5, (i / size[0]) as f32 + 0.5);
        let (longitude, polar) = ((x / size[0] as f32 - 0.5) * TAU, y / size[1] as f32 * PI);
        radiance(Vec3::new(longitude.sin() * polar.sin(), polar.cos(), -longitude.cos() * polar.sin()))
    });
    Environment::Map(Image::from_pixels(size, texels.collect()).expect("a radiance for each texel"))
}

fn radiance(direction: Vec3) -> [f32; 3] {
    let room = Vec3::new(0.13, 0.12, 0.115);
    let sky = Vec3::new(1.9, 2.0, 2.1).lerp(Vec3::new(0.7, 1.2, 2.1), direction.y.max(0.0).sqrt());
    // Hills of two heights, whose outline is not level.
    let longitude = direction.x.atan2(-direction.z);
    let hill = 0.03 + 0.05 * (longitude * 5.0).sin() + 0.02 * (longitude * 23.0).sin();
    let garden = Vec3::new(0.55, 0.7, 0.3) * (1.0 + 0.3 * (longitude * 40.0).sin());
    let view = if direction.y > hill { sky } else { garden };
    // The window as seen from the middle of the room, with a soft edge. More than that would whiten what is glossy.
    let inside = |offset: f32, half: f32| ((half + 0.15 - offset.abs()) / 0.15).clamp(0.0, 1.0);
    let is_ahead = direction.z < 0.0;
    let share = if is_ahead { inside(direction.x, 0.5) * inside(direction.y, 0.33) } else { 0.0 };
    room.lerp(view, share).to_array()
}
