//! Resampling of stored surfaces at positions between texels.

use super::lod::{EMPTY_LOD, lod_value};
use super::pack::has_code;
use super::surface::{Surface, lod_code, surface_color};
use glam::Vec3;

/// Least bilinear weight of the texel that replaces the nearest texel, where the nearest texel shows another surface.
/// The limit keeps the shift of history below a pixel. The replacement keeps history at edges, where the nearest texel
/// may lie on the wrong side.
pub const STAND_IN_WEIGHT: f32 = 0.1;

/// Rounds of four taps: 4x4 texels without the corners, whose weights are close to 0. The rounds are the second row,
/// the third row, and the middle texels of the first and the last row.
pub const ROUNDS: u32 = 3;

/// Number of the texel (as for [`corner_weight`]) that has the second largest bilinear weight at the fractions of a
/// position: the neighbour of the nearest texel along the axis on which the position lies closer to the middle between
/// texels.
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

/// Shared values of the taps around a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TapsAround {
    /// The texel before the position.
    pub texel: [i32; 2],
    /// Last texel of the image.
    pub last: [i32; 2],
    /// From that texel to the position, in \[0, 1).
    pub fraction: [f32; 2],
    /// Catmull-Rom weights of the columns.
    pub sharp_x: [f32; 4],
    /// Catmull-Rom weights of the rows.
    pub sharp_y: [f32; 4],
}

/// The taps around a position: a `fraction` of a texel, in \[0, 1), after `texel`.
#[inline]
pub fn taps_around(texel: [i32; 2], fraction: [f32; 2], size: [u32; 2]) -> TapsAround {
    let [sharp_x, sharp_y] = fraction.map(catmull_rom);
    TapsAround { texel, last: size.map(|s| s as i32 - 1), fraction, sharp_x, sharp_y }
}

/// Sum of the taps' Catmull-Rom weights, the corners left out.
#[inline]
pub fn sharp_sum(around: &TapsAround) -> f32 {
    1.0 - (around.sharp_x[0] + around.sharp_x[3]) * (around.sharp_y[0] + around.sharp_y[3])
}

/// Four taps. Weights are products of a column's and a row's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FourTaps {
    /// Column and row of each texel.
    pub texels: [[i32; 2]; 4],
    /// Catmull-Rom weights of the columns.
    pub sharp_x: [f32; 4],
    /// Catmull-Rom weights of two rows: the first two taps' and the last two taps'.
    pub sharp_rows: [f32; 2],
    /// Linear weights of the second and the third tap's columns. The other taps have a linear weight of 0.
    pub linear_x: [f32; 2],
    /// Linear weight of the second and the third tap's row.
    pub linear_row: f32,
}

/// The taps of round `index`.
#[inline]
pub fn taps_of(around: &TapsAround, index: u32) -> FourTaps {
    let (columns, rows) = match index {
        2 => ([1, 2, 1, 2], [0, 0, 3, 3]),
        index => ([0, 1, 2, 3], [1 + index as usize; 4]),
    };
    let texel = |tap: usize| {
        let [x, y] = [columns[tap], rows[tap]].map(|i| i as i32 - 1);
        [(around.texel[0] + x).clamp(0, around.last[0]), (around.texel[1] + y).clamp(0, around.last[1])]
    };
    let [fx, fy] = around.fraction;
    FourTaps {
        texels: [0, 1, 2, 3].map(texel),
        sharp_x: columns.map(|x| around.sharp_x[x]),
        sharp_rows: [around.sharp_y[rows[0]], around.sharp_y[rows[3]]],
        linear_x: [1.0 - fx, fx],
        linear_row: [1.0 - fy, fy, 0.0][index as usize],
    }
}

/// A tap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tap {
    /// Stored color.
    pub color: Vec3,
    /// Stored level of detail.
    pub lod: f32,
    /// Whether it shows the surface.
    pub same: bool,
}

/// Tap of a packed surface. It shows the surface if its disparity is one of `codes`. With `any_code`, every tap that is
/// not empty shows the surface.
#[inline]
pub fn surface_tap(words: [u32; 2], codes: [u32; 2], any_code: bool) -> Tap {
    let lod = lod_code(words);
    let same = if any_code { lod != EMPTY_LOD } else { has_code(words[1], codes) };
    Tap { color: surface_color(words), lod: lod_value(lod), same }
}

/// Sums over the taps around a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gathered {
    /// Colors times Catmull-Rom weights, regardless of the surface.
    pub sharp: Vec3,
    /// Colors times linear weights.
    pub smooth: Vec3,
    /// Linear weights.
    pub smooth_sum: f32,
    /// Levels of detail times linear weights.
    pub lod: f32,
    /// Whether all taps show the surface.
    pub complete: bool,
}

/// Sums over no taps.
#[inline]
pub fn nothing_gathered() -> Gathered {
    Gathered { sharp: Vec3::ZERO, smooth: Vec3::ZERO, smooth_sum: 0.0, lod: 0.0, complete: true }
}

/// Adds four taps with their weights. Linear weights are added only for taps on the surface.
#[inline]
pub fn gather(g: Gathered, [a, b, c, d]: [Tap; 4], four: &FourTaps) -> Gathered {
    let x = four.sharp_x;
    let first = a.color * x[0] + b.color * x[1];
    let last = c.color * x[2] + d.color * x[3];
    let inner = [if b.same { four.linear_x[0] } else { 0.0 }, if c.same { four.linear_x[1] } else { 0.0 }];
    Gathered {
        sharp: first * four.sharp_rows[0] + (last * four.sharp_rows[1] + g.sharp),
        smooth: g.smooth + (b.color * inner[0] + c.color * inner[1]) * four.linear_row,
        smooth_sum: g.smooth_sum + (inner[0] + inner[1]) * four.linear_row,
        lod: g.lod + (b.lod * inner[0] + c.lod * inner[1]) * four.linear_row,
        complete: g.complete && a.same && b.same && c.same && d.same,
    }
}

/// Reads `tap` at the texels of all rounds.
#[inline(always)]
pub fn gather_around(taps: &TapsAround, mut tap: impl FnMut([i32; 2]) -> Tap) -> Gathered {
    (0..ROUNDS).fold(nothing_gathered(), |gathered, round| {
        let four = taps_of(taps, round);
        gather(gathered, four.texels.map(&mut tap), &four)
    })
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

/// Result of the sums. If all taps are on the surface, it is the Catmull-Rom color. Otherwise it is bilinear over the
/// taps that are on the surface, or the `nearest` texel where their weights are close to 0. `weights`: their
/// [`sharp_sum`].
#[inline]
pub fn resolve(g: Gathered, weights: f32, nearest: Surface) -> Resampled {
    if g.smooth_sum < 0.01 {
        return Resampled { sharp: nearest.color, smooth: nearest.color, lod: nearest.lod };
    }
    let inverse = 1.0 / g.smooth_sum;
    let smooth = g.smooth * inverse;
    let sharp = if g.complete { (g.sharp * (1.0 / weights)).max(Vec3::ZERO) } else { smooth };
    Resampled { sharp, smooth, lod: g.lod * inverse }
}
