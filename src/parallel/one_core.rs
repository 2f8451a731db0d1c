//! The loops on one core, with the interface of `all_cores`.

use super::ProcessRow;
use crate::stats::FrameStats;

pub(crate) fn process_rows<R: Send>(rows: &mut [R], pass: &impl ProcessRow<R>) -> FrameStats {
    rows.iter_mut().enumerate().map(|(y, row)| pass.process(y as u32, row)).fold(FrameStats::default(), FrameStats::add)
}

pub(crate) fn for_rows<T: Send>(pixels: &mut [T], width: usize, f: impl Fn(usize, &mut [T]) + Sync) {
    pixels.chunks_mut(width).enumerate().for_each(|(y, row)| f(y, row));
}

pub(crate) fn collect<T: Send>(len: u32, f: impl Fn(u32) -> T + Sync + Send) -> Vec<T> {
    (0..len).map(f).collect()
}
