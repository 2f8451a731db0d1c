//! Inputs and history of a view, for the loops over its samples and pixels.

use crate::context::ContextDesc;
use crate::cpu::Frame;
use crate::cpu::inputs::Inputs;
use crate::kernel::depth::same_surface;
use crate::kernel::noise::Noise;

/// Noise of candidates without a noise input.
pub(super) const NO_NOISE: Noise = Noise { samples: 1.0, variance: 0.0 };

/// Packed results for the samples of a view, at their pixels, row by row.
pub(super) type Samples = Vec<[u32; 2]>;

/// Inputs and history of one view of a frame.
pub(super) struct View<'a> {
    pub inputs: Inputs<'a>,
    pub words: &'a [[u32; 2]],
    /// Packed noise of the stored samples; empty unless candidates are noisy.
    pub noise: &'a [u32],
    pub accumulate: f32,
    pub relights: bool,
    /// Whether candidates are noisy.
    pub is_noisy: bool,
    /// Whether frames are jittered and history stores means of samples.
    pub antialiases: bool,
    /// Low word of the frame counter.
    pub frame_low: u32,
}

impl<'a> View<'a> {
    /// A view of a frame with its inputs, and history's samples and their noise.
    pub fn new(
        desc: &ContextDesc,
        frame: &Frame<'_>,
        inputs: Inputs<'a>,
        words: &'a [[u32; 2]],
        noise: &'a [u32],
    ) -> Self {
        Self {
            inputs,
            words,
            noise,
            accumulate: desc.settings.method.smr().accumulate,
            relights: crate::method::smr_sparse_relights(&desc.settings),
            is_noisy: desc.settings.noisy,
            antialiases: crate::method::smr_sparse_antialiases(&desc.settings),
            frame_low: frame.index as u32,
        }
    }
}

impl View<'_> {
    #[inline(always)]
    pub fn sample_noise(&self, [x, y]: [u32; 2]) -> Noise {
        self.inputs.noise(x, y).filter(|_| self.is_noisy).unwrap_or(NO_NOISE)
    }

    /// Whether two disparities of this frame can belong to one surface.
    #[inline(always)]
    pub fn alike(&self, a: f32, b: f32, relative: f32) -> bool {
        !self.inputs.tests_depth() || same_surface(a, b, relative, 0.0)
    }
}
