//! Lattices of samples: the order in which a block's pixels are sampled, and the samples around a pixel. `docs/method.md`
//! explains sparse frames.

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

/// The two samples around a pixel along one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Between {
    /// Numbers of the samples; equal at the lattice's ends.
    pub points: [u32; 2],
    /// Distance from the first sample, in steps: in \[0, 1).
    pub fraction: f32,
}

/// Samples around pixel `px` of `count` ones at `first + i * 2^level`; `count` is at least 1.
#[inline]
pub fn between(px: u32, first: u32, level: u32, count: u32) -> Between {
    let last = count as i32 - 1;
    // The shift of a signed number rounds down.
    let distance = px as i32 - first as i32;
    let low = distance >> level;
    let fraction = (distance - (low << level)) as f32 * f32::from_bits((127 - level) << 23);
    Between { points: [low.clamp(0, last) as u32, (low + 1).clamp(0, last) as u32], fraction }
}
