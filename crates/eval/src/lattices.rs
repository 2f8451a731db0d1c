//! Sparse frames: the order in which their pixels are sampled, their geometry and levels of detail.

use afterimage::kernel::lattice::offset_px;
use afterimage::{Foveation, Image, Lattice, Lattices, ViewGeometry};
use rayon::prelude::*;

/// Depth and motion of a sparse frame. Default: [`Full`](Self::Full).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SparseGeometry {
    /// At every pixel: a visibility buffer, a prepass, or shading-rate hardware.
    #[default]
    Full,
    /// At the samples alone ([`Lattices::with_geometry_at_samples`]): small views.
    Samples,
}

impl SparseGeometry {
    /// Lattices of a frame with such geometry.
    pub fn of(self, lattices: Lattices) -> Lattices {
        match self {
            Self::Full => lattices,
            Self::Samples => lattices.with_geometry_at_samples(),
        }
    }
}

/// Order in which the pixels of a block are sampled. Default: [`Bayer`](Self::Bayer).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SampleOrder {
    /// Bayer's matrix: the order of [`Foveation::lattices`].
    #[default]
    Bayer,
    /// Row by row.
    Scanline,
    /// The (0,2)-sequence of Sobol: any power of two of successive frames has as many samples in all columns, rows and
    /// boxes of a size.
    Sobol,
}

impl SampleOrder {
    /// All orders.
    pub const ALL: [Self; 3] = [Self::Bayer, Self::Scanline, Self::Sobol];

    /// Position of the sample in a block of `step` x `step` pixels (a power of two, at most 256) in frame `index`.
    pub fn offset_px(self, index: u64, step: u32) -> [u32; 2] {
        let turn = (index % u64::from(step * step)) as u32;
        match self {
            Self::Bayer => offset_px(index, step),
            Self::Scanline => [turn % step, turn / step],
            Self::Sobol => {
                let mut direction = 1 << 31;
                let mut second = 0;
                for bit in 0..u32::BITS {
                    second ^= if turn >> bit & 1 == 1 { direction } else { 0 };
                    direction ^= direction >> 1;
                }
                // The highest log2(step) bits.
                [turn.reverse_bits(), second].map(|v| ((u64::from(v) * u64::from(step)) >> 32) as u32)
            }
        }
    }

    /// [`Foveation::lattices`] with samples in this order.
    ///
    /// # Panics
    /// Never: the stack differs from a valid one in the offsets alone.
    pub fn lattices(self, foveation: &Foveation, geometry: &ViewGeometry, gaze_px: [f32; 2], index: u64) -> Lattices {
        let stack = foveation.lattices(geometry, gaze_px, index);
        let size = geometry.size_px();
        let moved = |lattice: &Lattice| {
            let ([low, _], offset) = (lattice.covered_px(), self.offset_px(index, lattice.step));
            Lattice { first_px: [0, 1].map(|i| low[i] + offset[i] % size[i]), ..*lattice }
        };
        // As in the default order, a lattice whose samples all lie beyond the view's edge is left out.
        let has_samples = |lattice: &Lattice| (0..2).all(|i| lattice.first_px[i] < size[i]);
        let moved: Vec<_> = stack.as_slice().iter().map(moved).filter(has_samples).collect();
        Lattices::new(&moved).expect("only the offsets are new")
    }
}

/// Level of detail of every pixel: log2 of the step of its lattice, 0 for pixels outside all lattices.
pub fn levels(lattices: &Lattices, size_px: [u32; 2]) -> Image<f32> {
    let mut levels = Image::filled(size_px, 0.0);
    let rows = levels.pixels_mut().par_chunks_mut(size_px[0].max(1) as usize);
    rows.zip(0..size_px[1]).for_each(|(row, y)| {
        // Finer lattices hide coarser ones.
        for lattice in lattices.as_slice().iter().rev() {
            let [low, high] = lattice.covered_px();
            if (low[1]..high[1]).contains(&y) {
                let [left, right] = [low, high].map(|corner| corner[0].min(size_px[0]) as usize);
                row[left..right].fill(lattice.step.ilog2() as f32);
            }
        }
    });
    levels
}
