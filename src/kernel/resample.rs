//! Reading history between texels.

/// Catmull-Rom weights of the four texels around a position that lies `t` in \[0, 1\] after the second; they sum to 1. At t = 0
/// the second has weight exactly 1 and the others exactly 0.
#[inline]
pub fn catmull_rom(t: f32) -> [f32; 4] {
    let t2 = t * t;
    [((1.0 - 0.5 * t) * t - 0.5) * t, (1.5 * t - 2.5) * t2 + 1.0, ((2.0 - 1.5 * t) * t + 0.5) * t, (0.5 * t - 0.5) * t2]
}

/// Whole texel below a coordinate and what is left of it, in \[0, 1).
#[inline]
pub fn split(v: f32) -> (i32, f32) {
    let whole = v.floor();
    (whole as i32, v - whole)
}
