//! CIE Lab and the Delta E 94 difference, from linear Rec. 709.

use super::color::cbrt;
use glam::Vec3;

/// Below this, Lab's f(t) is a line (CIE 15: (6/29)^3).
const LAB_EPSILON: f32 = 216.0 / 24389.0;
/// Slope of that line (CIE 15: (29/6)^2 / 3), and its value at 0.
const LAB_SLOPE: f32 = 841.0 / 108.0;
const LAB_OFFSET: f32 = 16.0 / 116.0;

#[inline(always)]
fn lab_f(t: f32) -> f32 {
    if t > LAB_EPSILON { cbrt(t) } else { LAB_SLOPE * t + LAB_OFFSET }
}

/// CIE L\*a\*b\* (white: D65 at linear 1) of a linear Rec. 709 color in the half-float range. L\* exceeds 100 for
/// colors above white and is negative for negative ones.
#[inline(always)]
pub fn lab(c: Vec3) -> Vec3 {
    // Rows of the Rec. 709 -> XYZ matrix (primaries of BT.709, white x = 0.3127, y = 0.3290), each divided by the white
    // point's X, Y or Z, so that it sums to 1.
    let fx = lab_f(0.433_887_35 * c.x + 0.376_224 * c.y + 0.189_888_65 * c.z);
    let fy = lab_f(0.212_639 * c.x + 0.715_168_7 * c.y + 0.072_192_3 * c.z);
    let fz = lab_f(0.017_750_04 * c.x + 0.109_447_62 * c.y + 0.872_802_3 * c.z);
    Vec3::new(116.0 * fy - 16.0, 500.0 * (fx - fy), 200.0 * (fy - fz))
}

/// Delta E 94 (CIE 116, graphic arts: kL = 1, K1 = 0.045, K2 = 0.015) of two Lab colors; `reference` sets the weights,
/// so the function is not symmetric. At least 0, exactly 0 for equal colors; may exceed 100.
#[inline(always)]
pub fn delta_e94(reference: Vec3, sample: Vec3) -> f32 {
    let d = reference - sample;
    let c1 = (reference.y * reference.y + reference.z * reference.z).sqrt();
    let c2 = (sample.y * sample.y + sample.z * sample.z).sqrt();
    let dc = c1 - c2;
    // Rounding makes this negative for half of all pairs of the same hue.
    let dh2 = (d.y * d.y + d.z * d.z - dc * dc).max(0.0);
    let sc = 1.0 + 0.045 * c1;
    let sh = 1.0 + 0.015 * c1;
    (d.x * d.x + (dc * dc) / (sc * sc) + dh2 / (sh * sh)).sqrt()
}
