//! Loops on all cores, with the widest vector instructions of the processor.

use super::ProcessRow;
use crate::stats::FrameStats;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// Processes all rows.
pub(crate) fn process_rows<R: Send>(rows: &mut [R], pass: &impl ProcessRow<R>) -> FrameStats {
    let arch = Arch::new();
    rows.par_iter_mut()
        .enumerate()
        .map(|(y, row)| arch.dispatch(Dispatched { pass, y: y as u32, row }))
        .reduce(FrameStats::default, FrameStats::add)
}

struct Dispatched<'a, P, R> {
    pass: &'a P,
    y: u32,
    row: &'a mut R,
}

impl<R, P: ProcessRow<R>> WithSimd for Dispatched<'_, P, R> {
    type Output = FrameStats;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> FrameStats {
        self.pass.process(self.y, self.row)
    }
}

/// Calls `f(y, row)` for the rows of an image with `width` pixels a row.
pub(crate) fn for_rows<T: Send>(pixels: &mut [T], width: usize, f: impl Fn(usize, &mut [T]) + Sync) {
    pixels.par_chunks_mut(width).enumerate().for_each(|(y, row)| f(y, row));
}

/// The results of `f` for 0 to `len - 1`.
pub(crate) fn collect<T: Send>(len: u32, f: impl Fn(u32) -> T + Sync + Send) -> Vec<T> {
    (0..len).into_par_iter().map(f).collect()
}
