//! Counts of a frame, by either executor.

use crate::kernel::reproject::Verdict;
use crate::warning::Warning;

/// Bytes of the counters that [`Frame::counters`](crate::gpu::Frame::counters) of the GPU executor adds up: words of 32 bits, little
/// endian, for [`FrameStats::from_counters`].
pub const COUNTERS_BYTES: u64 = 4 * (4 + Verdict::COUNT as u64);

/// Counts of one frame over all views.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameStats {
    /// Pixels processed.
    pub pixels: u64,
    /// Pixels whose color was NaN or infinite.
    pub nonfinite: u64,
    /// Pixels whose depth, if given, was NaN or a distance that is not positive.
    pub bad_depth: u64,
    /// Pixels whose trust, if given, was NaN or infinite.
    pub bad_trust: u64,
    /// Pixels with a valid history whose sample the candidate replaced.
    pub replaced: u64,
    /// Pixels by what became of their history, indexed by [`Verdict`].
    pub verdicts: [u64; Verdict::COUNT],
}

impl FrameStats {
    /// What a GPU counted: the first [`COUNTERS_BYTES`] of the counters, read back. `None` if there are fewer.
    pub fn from_counters(bytes: &[u8]) -> Option<Self> {
        let words: Vec<u64> = bytes
            .get(..COUNTERS_BYTES as usize)?
            .chunks_exact(4)
            .map(|b| u64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])))
            .collect();
        // In the order of shaders/pass/wrs_pass.wgsl. Each pixel has one verdict.
        let mut stats = Self {
            nonfinite: words[0],
            bad_depth: words[1],
            bad_trust: words[2],
            replaced: words[3],
            ..Self::default()
        };
        stats.verdicts.copy_from_slice(&words[4..]);
        stats.pixels = stats.verdicts.iter().sum();
        Some(stats)
    }

    /// Pixels whose history was rejected: bad motion, off screen, disoccluded, distrusted.
    pub fn rejected(&self) -> u64 {
        Verdict::REJECTED.iter().map(|&v| self.verdicts[v as usize]).sum()
    }

    /// Pixels that kept their history, to combine it with the candidate.
    pub fn valid(&self) -> u64 {
        self.verdicts[Verdict::Valid as usize]
    }

    /// What only the pixels know to be odd.
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
