//! Resampling of stored surfaces at positions between texels.

use super::surface::Surface;
use glam::Vec3;

/// Relative difference of disparity within which texels are filtered together: wide enough for slopes, narrow enough
/// for silhouettes.
pub const TAP_RELATIVE: f32 = 0.1;

/// Least bilinear weight of a texel that stands in for the nearest one, if that shows another surface: so that history
/// moves by less than a pixel, but edges do not lose it wherever they are rounded away.
pub const STAND_IN_WEIGHT: f32 = 0.1;

/// Number of taps: 4x4 texels without the corners, whose weights are close to 0.
pub const TAPS: u32 = 12;

/// Column and row, 0 to 3, of tap number `tap`.
#[inline]
pub fn tap_at(tap: u32) -> [u32; 2] {
    [((tap + 2) & 3) + u32::from(tap >= 10) - u32::from(tap < 2), (tap + 2) >> 2]
}

/// Number of the texel (as for [`corner_weight`]) that has the second largest bilinear weight at the fractions of a
/// position: across the axis along which the position lies nearer to the middle.
#[inline]
pub fn second_corner(fraction: [f32; 2]) -> u32 {
    let nearest = u32::from(fraction[0] >= 0.5) + 2 * u32::from(fraction[1] >= 0.5);
    let along_x = (fraction[0] - 0.5).abs() <= (fraction[1] - 0.5).abs();
    nearest ^ if along_x { 1 } else { 2 }
}

/// Bilinear weight of texel number `corner` (top left, top right, bottom left, bottom right) at the fractions of a
/// position.
#[inline]
pub fn corner_weight(corner: u32, fraction: [f32; 2]) -> f32 {
    let x = if corner & 1 == 1 { fraction[0] } else { 1.0 - fraction[0] };
    let y = if corner >= 2 { fraction[1] } else { 1.0 - fraction[1] };
    x * y
}

/// Catmull-Rom weights of four texels around a position at distance `t` in \[0, 1) after the second. At t = 0 the
/// second weight is exactly 1 and the others are exactly 0.
#[inline]
pub fn catmull_rom(t: f32) -> [f32; 4] {
    let t2 = t * t;
    [((1.0 - 0.5 * t) * t - 0.5) * t, (1.5 * t - 2.5) * t2 + 1.0, ((2.0 - 1.5 * t) * t + 0.5) * t, (0.5 * t - 0.5) * t2]
}

/// Linear weights of four texels around a position at distance `t` in \[0, 1) after the second.
#[inline]
pub fn linear_weights(t: f32) -> [f32; 4] {
    [0.0, 1.0 - t, t, 0.0]
}

/// Sums over the taps around a position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gathered {
    /// Colors times Catmull-Rom weights.
    pub sharp: Vec3,
    /// Catmull-Rom weights.
    pub sharp_sum: f32,
    /// Colors times bilinear weights.
    pub smooth: Vec3,
    /// Bilinear weights.
    pub smooth_sum: f32,
    /// Levels of detail times bilinear weights.
    pub lod: f32,
    /// Number of taps on other surfaces.
    pub missing: u32,
}

/// Adds a tap with its Catmull-Rom and bilinear weights if it is on the `same` surface; otherwise counts it as missing.
#[inline]
pub fn gather(g: Gathered, tap: Surface, same: bool, sharp: f32, linear: f32) -> Gathered {
    if !same {
        return Gathered { missing: g.missing + 1, ..g };
    }
    Gathered {
        sharp: g.sharp + tap.color * sharp,
        sharp_sum: g.sharp_sum + sharp,
        smooth: g.smooth + tap.color * linear,
        smooth_sum: g.smooth_sum + linear,
        lod: g.lod + tap.lod * linear,
        missing: g.missing,
    }
}

/// History resampled at a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resampled {
    /// Color by Catmull-Rom weights.
    pub sharp: Vec3,
    /// Color by bilinear weights.
    pub smooth: Vec3,
    /// Level of detail.
    pub lod: f32,
}

/// Result of the sums: Catmull-Rom where all taps are on the surface, bilinear over those that are elsewhere, and the
/// `nearest` texel where their weights are close to 0.
#[inline]
pub fn resolve(g: Gathered, nearest: Surface) -> Resampled {
    if g.smooth_sum < 0.01 {
        return Resampled { sharp: nearest.color, smooth: nearest.color, lod: nearest.lod };
    }
    let inverse = 1.0 / g.smooth_sum;
    let smooth = g.smooth * inverse;
    let sharp = if g.missing == 0 { (g.sharp * (1.0 / g.sharp_sum)).max(Vec3::ZERO) } else { smooth };
    Resampled { sharp, smooth, lod: g.lod * inverse }
}
