//! A pixel of the methods that store surfaces.

use crate::kernel::debug_view::PixelTrace;
use crate::notes::Notes;
use crate::stats::FrameStats;
use glam::Vec3;

pub(super) struct Pixel {
    pub output: Vec3,
    pub surface: [u32; 2],
    /// Packed noise of the surface; stored only for noisy candidates.
    pub noise: u32,
    /// Alpha to show, and alpha to store with the surface; of frames with alpha.
    pub alpha: [f32; 2],
    /// Packed albedo of the surface; of frames with albedo.
    pub albedo: u32,
    pub trace: PixelTrace,
}

/// A pass that computes one pixel at a time.
pub(super) trait ProcessPixel: Sync {
    /// Processes pixel (x, y), counts it in `stats` and takes `notes`. Always inlined into the loop over a row, which
    /// is compiled for several instruction sets.
    fn process(&self, x: u32, y: u32, stats: &mut FrameStats, notes: &mut impl Notes) -> Pixel;
}
