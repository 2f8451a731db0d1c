//! Loops over rows and pixels, on all cores and with the widest vector instructions of the processor. On WebAssembly
//! one core computes the same results.

use crate::stats::FrameStats;
#[cfg(not(target_family = "wasm"))]
use pulp::{Arch, Simd, WithSimd};
#[cfg(not(target_family = "wasm"))]
use rayon::prelude::*;

/// A pass over the rows of an image.
pub(crate) trait ProcessRow<R>: Sync {
    /// Processes row `y`. Implementations are inlined, so that they are compiled for each instruction set.
    fn process(&self, y: u32, row: &mut R) -> FrameStats;
}

/// Processes all rows.
pub(crate) fn process_rows<R: Send>(rows: &mut [R], pass: &impl ProcessRow<R>) -> FrameStats {
    #[cfg(not(target_family = "wasm"))]
    {
        let arch = Arch::new();
        rows.par_iter_mut()
            .enumerate()
            .map(|(y, row)| arch.dispatch(Dispatched { pass, y: y as u32, row }))
            .reduce(FrameStats::default, FrameStats::add)
    }
    #[cfg(target_family = "wasm")]
    rows.iter_mut().enumerate().map(|(y, row)| pass.process(y as u32, row)).fold(FrameStats::default(), FrameStats::add)
}

#[cfg(not(target_family = "wasm"))]
struct Dispatched<'a, P, R> {
    pass: &'a P,
    y: u32,
    row: &'a mut R,
}

#[cfg(not(target_family = "wasm"))]
impl<R, P: ProcessRow<R>> WithSimd for Dispatched<'_, P, R> {
    type Output = FrameStats;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> FrameStats {
        self.pass.process(self.y, self.row)
    }
}

/// Calls `f(y, row)` for the rows of an image with `width` pixels a row.
pub(crate) fn for_rows<T: Send>(pixels: &mut [T], width: usize, f: impl Fn(usize, &mut [T]) + Sync) {
    #[cfg(not(target_family = "wasm"))]
    pixels.par_chunks_mut(width).enumerate().for_each(|(y, row)| f(y, row));
    #[cfg(target_family = "wasm")]
    pixels.chunks_mut(width).enumerate().for_each(|(y, row)| f(y, row));
}

/// The results of `f` for 0 to `len - 1`.
pub(crate) fn collect<T: Send>(len: u32, f: impl Fn(u32) -> T + Sync + Send) -> Vec<T> {
    #[cfg(not(target_family = "wasm"))]
    return (0..len).into_par_iter().map(f).collect();
    #[cfg(target_family = "wasm")]
    (0..len).map(f).collect()
}
