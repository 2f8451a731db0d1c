//! Color: sRGB transfer, exposure and differences of square roots, from linear Rec. 709.

use super::sanitize::MAX_HALF;
use glam::Vec3;

/// Added to linear values to keep ratios and slopes of dark colors finite.
pub(super) const DARK: f32 = 0.002;
/// Rounding of the square roots of stored colors: 9 bits of mantissa. It is tolerated, because samples without
/// variance, as in the chroma of a grey picture, would otherwise reject history.
pub const ROUNDING: f32 = 5e-4;

/// Cube root; negative for negative `x`. Error at most 2 ulp for |x| in \[1e-30, 1e30\]; exact at 0 and +-1.
///
/// A guess `y` of the inverse root from the bits (a third of the exponent, negated) has an error of at most 3.4 %. With
/// `d = x y^2` and `e = 1 - x y^3` the root is `d (1 - e)^(-2/3)`, by a polynomial, without a division.
#[inline(always)]
pub fn cbrt(x: f32) -> f32 {
    let a = x.abs();
    if a < 1e-30 {
        return 0.0;
    }
    let y = f32::from_bits(0x54a1_f800 - (a.to_bits() as i32 as f32 * (1.0 / 3.0)) as u32);
    let d = (a * y) * y;
    let e = 1.0 - d * y;
    let p = (((0.427_228_66 * e + 0.457_919_3) * e + 0.493_816_17) * e + 0.555_541_9) * e + 0.666_666_7;
    let r = d + d * (e * p);
    if x < 0.0 { -r } else { r }
}

/// Fifth root of `x` >= 0. Relative error below 3e-7 in \[1e-25, 1e25\].
#[inline(always)]
fn fifth_root(x: f32) -> f32 {
    if x < 1e-25 {
        return 0.0;
    }
    let mut r = f32::from_bits(x.to_bits() / 5 + 0x32c9_af22);
    for _ in 0..3 {
        let r4 = (r * r) * (r * r);
        r -= (r4 * r - x) / (5.0 * r4);
    }
    r
}

/// sRGB encoding of one linear channel (IEC 61966-2-1). Relative error below 6e-7 in \[0, 1\]. Values above 1 follow
/// the same curve; negative ones its mirror image.
///
/// `x^(1/2.4) = c * sqrt(sqrt(c))` with `c = cbrt(x)`.
#[inline(always)]
pub fn srgb_encode(linear: f32) -> f32 {
    let a = linear.abs();
    let encoded = if a <= 0.003_130_8 {
        12.92 * a
    } else {
        let c = cbrt(a);
        (1.055 * c) * c.sqrt().sqrt() - 0.055
    };
    if linear < 0.0 { -encoded } else { encoded }
}

/// Linear value of one sRGB-encoded channel. Relative error below 7e-7 in \[0, 1\]. Values above 1 follow the same
/// curve; negative ones its mirror image.
///
/// `x^2.4 = x^2 * fifth_root(x)^2`.
#[inline(always)]
pub fn srgb_decode(encoded: f32) -> f32 {
    let a = encoded.abs();
    let linear = if a <= 0.040_45 {
        a * (1.0 / 12.92)
    } else {
        let t = (a + 0.055) * (1.0 / 1.055);
        let r = fifth_root(t);
        (t * t) * (r * r)
    };
    if encoded < 0.0 { -linear } else { linear }
}

/// Rec. 709 weighted sum of (R, G, B): luminance of a linear color, luma of an encoded one.
#[inline(always)]
pub fn luma(c: Vec3) -> f32 {
    0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z
}

/// Stored color scaled to this frame's exposure: times `ratio`, clamped to halves. `ratio` is limited to 2^-40 to 2^40:
/// beyond this range every half overflows or underflows, and within it no float product does.
#[inline]
pub fn expose(stored: Vec3, ratio: f32) -> Vec3 {
    (stored * ratio).clamp(Vec3::splat(-MAX_HALF), Vec3::splat(MAX_HALF))
}

/// Difference of two linear colors, 100 between black and white: Euclidean distance in YCoCg of the square roots,
/// squared chroma at half weight. Exactly 0 for equal colors. Cheaper than Delta E, which needs cube roots.
#[inline(always)]
pub fn root_difference(x: Vec3, y: Vec3) -> f32 {
    distance_of_roots(roots(x), roots(y))
}

/// [`root_difference`] from the square roots of two colors.
#[inline(always)]
pub fn distance_of_roots(x: Vec3, y: Vec3) -> f32 {
    let d = x - y;
    let outer = 0.25 * (d.x + d.z);
    let inner = 0.5 * d.y;
    let luma = outer + inner;
    let orange = 0.5 * (d.x - d.z);
    let green = inner - outer;
    let chroma = orange * orange + green * green;
    100.0 * (luma * luma + 0.5 * chroma).sqrt()
}

/// Square roots of a color's channels; 0 for negative ones.
#[inline(always)]
pub fn roots(c: Vec3) -> Vec3 {
    past_roots(c.max(Vec3::ZERO))
}

/// Square roots of the channels of history, which is at least 0.
#[inline(always)]
pub fn past_roots(c: Vec3) -> Vec3 {
    Vec3::new(c.x.sqrt(), c.y.sqrt(), c.z.sqrt())
}

/// YCoCg of the square roots of a linear color.
#[inline]
pub fn to_ycocg(c: Vec3) -> Vec3 {
    let r = roots(c);
    let outer = 0.25 * (r.x + r.z);
    let inner = 0.5 * r.y;
    Vec3::new(outer + inner, 0.5 * (r.x - r.z), inner - outer)
}

/// Square roots of RGB from YCoCg, at least 0.
#[inline]
pub fn roots_of_ycocg(y: Vec3) -> Vec3 {
    let outer = y.x - y.z;
    Vec3::new((outer + y.y).max(0.0), (y.x + y.z).max(0.0), (outer - y.y).max(0.0))
}

/// Clips `history` along the line to `mean` to the box of half width `extent` around `mean` (Karis 2014; the box of
/// variances is Salvi's, 2016).
#[inline]
pub fn clip_to_box(history: Vec3, mean: Vec3, extent: Vec3) -> Vec3 {
    let d = history - mean;
    let x = extent.x / d.x.abs().max(1e-6);
    let y = extent.y / d.y.abs().max(1e-6);
    let z = extent.z / d.z.abs().max(1e-6);
    let inside = x.min(y).min(z);
    if inside < 1.0 { mean + d * inside } else { history }
}
