//! Counters of a frame.

use crate::kernel::reproject::Verdict;
use crate::warning::Warning;

/// Pixel counters of one frame, over all views.
///
/// The CPU executor returns them; from a GPU they are read back, if the frame had a buffer for them:
///
/// ```
/// use afterimage::{FrameStats, Verdict};
///
/// // Bytes of `Target::counters`, read back; here a frame of 100 pixels, all with valid history.
/// let mut bytes = vec![0; FrameStats::COUNTERS_BYTES as usize];
/// let valid = 4 * (4 + Verdict::Valid as usize);
/// bytes[valid..valid + 4].copy_from_slice(&100_u32.to_le_bytes());
///
/// let stats = FrameStats::from_counters(&bytes).expect("COUNTERS_BYTES bytes");
/// assert_eq!((stats.pixels, stats.valid(), stats.rejected()), (100, 100, 0));
/// assert_eq!(stats.verdicts[Verdict::Valid as usize], 100);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameStats {
    /// All pixels.
    pub pixels: u64,
    /// Pixels whose color was NaN or infinite.
    pub nonfinite: u64,
    /// Pixels whose depth was NaN or a distance that is not positive; 0 without a depth input.
    pub bad_depth: u64,
    /// Pixels whose trust or reactive mask was NaN or infinite; 0 without such a mask.
    pub bad_trust: u64,
    /// Pixels with valid history whose sample the candidate replaced.
    pub replaced: u64,
    /// Pixels by verdict on their history; index with a [`Verdict`] as `usize`.
    pub verdicts: [u64; Verdict::COUNT],
}

impl FrameStats {
    /// Size in bytes of the counters' buffer of the GPU executor (`gpu::Target::counters`): little-endian words of 32
    /// bits, which [`from_counters`](Self::from_counters) reads.
    pub const COUNTERS_BYTES: u64 = 4 * (4 + Verdict::COUNT as u64);

    /// Counters from the bytes that a GPU wrote. Reads the first [`COUNTERS_BYTES`](Self::COUNTERS_BYTES) bytes; `None`
    /// if there are fewer.
    pub fn from_counters(bytes: &[u8]) -> Option<Self> {
        let counts: Vec<u64> = bytes
            .get(..Self::COUNTERS_BYTES as usize)?
            .chunks_exact(4)
            .map(|b| u64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])))
            .collect();
        // In the order of the COUNT_* constants in shaders/shared/inputs.wgsl. Each pixel has one verdict.
        let mut stats = Self {
            nonfinite: counts[0],
            bad_depth: counts[1],
            bad_trust: counts[2],
            replaced: counts[3],
            ..Self::default()
        };
        stats.verdicts.copy_from_slice(&counts[4..]);
        stats.pixels = stats.verdicts.iter().sum();
        Some(stats)
    }

    /// Pixels whose history was rejected: bad motion, off screen, disoccluded, distrusted.
    pub fn rejected(&self) -> u64 {
        Verdict::REJECTED.iter().map(|&v| self.verdicts[v as usize]).sum()
    }

    /// Pixels whose history was valid.
    pub fn valid(&self) -> u64 {
        self.verdicts[Verdict::Valid as usize]
    }

    /// Warnings about pixels: unusable colors, motion vectors, depths and trust values.
    pub fn warnings(&self) -> impl Iterator<Item = Warning> + use<> {
        let bad_motion = self.verdicts[Verdict::BadMotion as usize];
        let list = [
            (self.nonfinite, Warning::NonfiniteColor { pixels: self.nonfinite }),
            (bad_motion, Warning::BadMotion { pixels: bad_motion }),
            (self.bad_depth, Warning::BadDepth { pixels: self.bad_depth }),
            (self.bad_trust, Warning::BadTrust { pixels: self.bad_trust }),
        ];
        list.into_iter().filter(|(pixels, _)| *pixels > 0).map(|(_, warning)| warning)
    }

    #[cfg(feature = "cpu")]
    pub(crate) fn add(mut self, other: Self) -> Self {
        self.pixels += other.pixels;
        self.nonfinite += other.nonfinite;
        self.bad_depth += other.bad_depth;
        self.bad_trust += other.bad_trust;
        self.replaced += other.replaced;
        for (sum, v) in self.verdicts.iter_mut().zip(other.verdicts) {
            *sum += v;
        }
        self
    }
}
