//! Which pixels a headset's lens shows: an octagon around the visible area, by bounds along both axes and both
//! diagonals.

use glam::Vec4;

/// Whether pixel (`x`, `y`) lies in the octagon: x, y, x + y and x - y are within `lowest` and `highest`, in pixels.
#[inline]
pub fn is_visible(x: u32, y: u32, lowest: Vec4, highest: Vec4) -> bool {
    let (x, y) = (x as f32, y as f32);
    let along = Vec4::new(x, y, x + y, x - y);
    along.cmpge(lowest).all() && along.cmple(highest).all()
}
