//! Loops on all cores, with the widest vector instructions of the processor. Bodies are called through pointers, one
//! call a row or a run of elements: `rayon` is compiled for each type of rows, and not for each body, of which tests
//! have hundreds.

use super::ProcessRow;
use crate::stats::FrameStats;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use std::ops::Range;

/// Elements that one call of a body of `collect` makes, at most: fewer if there are less than 256 times as many.
const LONGEST_RUN: u32 = 64;

/// Processes all rows.
pub(crate) fn process_rows<R: Send>(rows: &mut [R], pass: &impl ProcessRow<R>) -> FrameStats {
    let arch = Arch::new();
    sum_of_rows(rows, &|y, row| arch.dispatch(Dispatched { pass, y: y as u32, row }))
}

fn sum_of_rows<R: Send>(rows: &mut [R], f: &(dyn Fn(usize, &mut R) -> FrameStats + Sync)) -> FrameStats {
    rows.par_iter_mut().enumerate().map(|(y, row)| f(y, row)).reduce(FrameStats::default, FrameStats::add)
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
    for_rows_of(pixels, width, &f);
}

fn for_rows_of<T: Send>(pixels: &mut [T], width: usize, f: &(dyn Fn(usize, &mut [T]) + Sync)) {
    pixels.par_chunks_mut(width).enumerate().for_each(|(y, row)| f(y, row));
}

/// The results of `f` for 0 to `len - 1`.
pub(crate) fn collect<T: Send>(len: u32, f: impl Fn(u32) -> T + Sync) -> Vec<T> {
    runs_of(len, &|run| run.map(&f).collect())
}

fn runs_of<T: Send>(len: u32, f: &(dyn Fn(Range<u32>) -> Vec<T> + Sync)) -> Vec<T> {
    let of_run = (len / 256).clamp(1, LONGEST_RUN);
    let run = |i: u32| f(of_run * i..(of_run * (i + 1)).min(len));
    let runs: Vec<_> = (0..len.div_ceil(of_run)).into_par_iter().map(run).collect();
    let mut all = Vec::with_capacity(len as usize);
    runs.into_iter().for_each(|run| all.extend(run));
    all
}
