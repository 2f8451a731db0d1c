//! Measured sharpness: the level of detail of a tile's pixels, independent of the description.

use super::observation::{Evidence, Tile};
use crate::foveation::{Foveation, FoveationKind};
use crate::kernel::doctor::{BENDS, BOUNDARIES, BROKEN, DECODED_BENDS, KINKS, SIGNAL, STEPS, TILE_PX, WIDE_BENDS};

/// Number of neighbours in a tile across boundaries of each class.
const STEP_COUNTS: [f64; BOUNDARIES as usize] = [256.0, 128.0, 64.0, 32.0, 32.0];
/// Number of second differences in a tile by class of the kink.
const BEND_COUNTS: [f64; KINKS as usize] = [256.0, 128.0, 64.0, 64.0];
/// Mean difference, as a share of the light, below which a tile is flat: noise and quantisation.
const FLAT: f64 = 4e-3;
/// Share of the largest class below which the differences of a class count as none.
const NONE: f64 = 0.1;
/// A tile is sharp if the ratio of its second differences over 1 and over 2 pixels is at least this. The ratio is 1/4
/// where a frame is smooth, about 1/2 at steps, and more in texture.
const SHARP: f64 = 0.38;

/// Measured detail of a tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Measured {
    /// Detail of single pixels.
    Fine,
    /// Interpolation between the middles of blocks of 2^lod pixels; a `lod` of 5 stands for 5 and more.
    Interpolated { lod: f64 },
    /// Blocks of 2^level pixels; a `level` of 4 stands for 4 and more.
    Blocks { level: u32 },
}

/// Means of the second differences by class, of the frame and of the decoded frame.
pub(super) fn bends(evidence: &Evidence<'_>) -> [[f64; KINKS as usize]; 2] {
    [BENDS, DECODED_BENDS].map(|from| std::array::from_fn(|i| evidence.sum(from + i as u32) / BEND_COUNTS[i]))
}

/// Whether differences over 8 pixels from a tile stay inside the frame.
pub(super) fn is_inside(tile: &Tile, size_px: [u32; 2]) -> bool {
    (0..2).all(|i| tile.origin_px[i] >= 8 && tile.origin_px[i] + TILE_PX + 8 <= size_px[i])
}

/// Sharpness of a tile; `None` if it is flat, broken, or smooth for another reason.
pub(super) fn measure(evidence: &Evidence<'_>) -> Option<Measured> {
    if evidence.word(BROKEN) > 0 {
        return None;
    }
    let pixels = f64::from(TILE_PX * TILE_PX);
    let flat = FLAT * (evidence.sum(SIGNAL) / pixels + 0.01);
    let steps: [f64; BOUNDARIES as usize] = std::array::from_fn(|i| evidence.sum(STEPS + i as u32) / STEP_COUNTS[i]);
    let most = steps.iter().copied().fold(0.0, f64::max);
    if most < flat {
        return None;
    }
    let level = steps.iter().position(|s| *s > 0.05 * most).unwrap_or(0) as u32;
    if level > 0 {
        return Some(Measured::Blocks { level });
    }
    let [bends, _] = bends(evidence);
    let most = bends.iter().copied().fold(0.0, f64::max);
    if most < 0.1 * flat {
        return None;
    }
    let is_there = |b: &f64| *b > NONE * most;
    let first = bends.iter().position(is_there).unwrap_or(0);
    let last = bends.iter().rposition(is_there).unwrap_or(0);
    if first > 0 || last + 1 < KINKS as usize {
        return Some(Measured::Interpolated { lod: 2.0 + 0.5 * (first + last) as f64 });
    }
    let near: f64 = (0..KINKS).map(|i| evidence.sum(BENDS + i)).sum();
    let over_two = evidence.sum(WIDE_BENDS);
    (near > SHARP * over_two).then_some(Measured::Fine)
}

/// Whether a foveation with levels of detail from `least` to `most` at the tile produces this measurement.
pub(super) fn agrees(measured: Measured, filter: FoveationKind, [least, most]: [f64; 2]) -> bool {
    match (measured, filter) {
        (Measured::Fine, FoveationKind::Off) => true,
        (Measured::Fine, FoveationKind::Block) => least < 1.2,
        (Measured::Fine, _) => least < 1.9,
        (Measured::Interpolated { lod }, FoveationKind::Mip) => lod >= least.min(4.5) - 0.6 && lod <= most + 0.6,
        (Measured::Blocks { level }, FoveationKind::Block) => {
            let level = f64::from(level);
            level >= (least + 1e-3).floor().min(4.0) && level <= (most + 0.3).floor()
        }
        _ => false,
    }
}

/// Least and largest level of detail that `foveation` has at eccentricities.
pub(super) fn range(foveation: &Foveation, ecc_deg: &[f32]) -> [f64; 2] {
    let lods = ecc_deg.iter().map(|e| f64::from(foveation.lod(*e)));
    lods.fold([f64::INFINITY, 0.0], |[least, most], lod| [least.min(lod), most.max(lod)])
}
