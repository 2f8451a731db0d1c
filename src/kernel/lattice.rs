//! Places of samples: the order in which a block's pixels are sampled, and the weight of a sample beside a pixel.

use glam::Vec2;

/// Position of the sample in a block of `step` x `step` pixels (a power of two) in frame `index`: each pixel once in
/// `step * step` frames, in the order of Bayer's matrix, so that every prefix is spread evenly (Bayer 1973).
#[inline]
pub fn offset_px(index: u64, step: u32) -> [u32; 2] {
    let mut rest = index;
    let mut half = step / 2;
    let mut offset = [0, 0];
    while half > 0 {
        // Corners of a square in the order of diagonals: (0, 0), (1, 1), (1, 0), (0, 1).
        let corner = (rest & 3) as u32;
        offset[0] += half * ((corner & 1) ^ (corner >> 1));
        offset[1] += half * (corner & 1);
        rest >>= 2;
        half /= 2;
    }
    offset
}

/// Jitter of the projection in frame `index`, in pixels, each in \[-0.5, 0.5): Halton's sequence of bases 3 and 5. A
/// pixel of an even pattern is sampled every `step * step` frames, or half as often: a power of two. The sequence has
/// low discrepancy over these frames, too, because its bases are odd. The common base 2 would place all of these
/// samples in the same half of the pixel.
pub fn jitter_px(index: u64) -> [f32; 2] {
    [3, 5].map(|base| {
        let (mut rest, mut digit, mut value) = (index, 1.0, 0.0);
        while rest > 0 {
            digit /= base as f64;
            value += (rest % base) as f64 * digit;
            rest /= base;
        }
        (value - 0.5) as f32
    })
}

/// Largest exponent of [`place_weight`], so that products with weights of the eccentricity stay normal.
const LEAST_PLACE_EXPONENT: u32 = 40;

/// Weight of a pixel's candidate by the offset of its nearest sample in whole pixels: 1 at the sample's own pixel,
/// 2^-12 beside it, and about `(1 + 8 d^2)^-4` at `d` pixels. A reservoir then keeps the sample that fell on its own
/// pixel. Weights are powers of two, so that products are exact in any order.
#[inline]
pub fn place_weight(offset_px: Vec2) -> f32 {
    let inverse = 1.0 + 8.0 * (offset_px.x * offset_px.x + offset_px.y * offset_px.y);
    let exponent = 4 * ((inverse.to_bits() >> 23) - 127);
    f32::from_bits((127 - exponent.min(LEAST_PLACE_EXPONENT)) << 23)
}
