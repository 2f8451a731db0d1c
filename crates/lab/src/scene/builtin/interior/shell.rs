//! Floor, ceiling and walls. They are thick, so that the sun's shadow map has no leaks at their edges.

use super::materials::{FLOOR, PAINT, PLASTER, WALLPAPER, WHITE};
use super::size::{HALF_DEPTH_M as D, HALF_WIDTH_M as W, HEIGHT_M as H};
use super::solids::block;
use super::window::{BOTTOM_M, HALF_SPAN_M, TOP_M};
use crate::scene::Triangles;

/// Thickness of floor, ceiling and walls, metres.
const THICK_M: f32 = 0.15;

/// Appends the room, with an opening for the window.
pub(super) fn push(out: &mut Triangles) {
    let (x, z) = (W + THICK_M, D + THICK_M);
    block([-x, -THICK_M, -z], [x, 0.0, z], FLOOR, out);
    block([-x, H, -z], [x, H + THICK_M, z], PLASTER, out);
    block([-x, 0.0, -z], [-W, H, z], WALLPAPER, out);
    block([W, 0.0, -z], [x, H, z], PAINT, out);
    block([-W, 0.0, D], [W, H, z], PLASTER, out);
    push_window_wall(out);
    push_skirting(out);
}

fn push_window_wall(out: &mut Triangles) {
    let (outside, inside) = (-D - THICK_M, -D);
    block([-W, 0.0, outside], [-HALF_SPAN_M, H, inside], PAINT, out);
    block([HALF_SPAN_M, 0.0, outside], [W, H, inside], PAINT, out);
    block([-HALF_SPAN_M, 0.0, outside], [HALF_SPAN_M, BOTTOM_M, inside], PAINT, out);
    block([-HALF_SPAN_M, TOP_M, outside], [HALF_SPAN_M, H, inside], PAINT, out);
}

fn push_skirting(out: &mut Triangles) {
    let [high, deep] = [0.08, 0.015];
    block([-W, 0.0, -D], [-W + deep, high, D], WHITE, out);
    block([-W, 0.0, -D], [W, high, -D + deep], WHITE, out);
    block([-W, 0.0, D - deep], [W, high, D], WHITE, out);
}
