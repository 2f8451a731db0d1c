//! Inputs and history of a view, for the loops over its samples and pixels.

use crate::context::ContextDesc;
use crate::cpu::frame::Frame;
use crate::cpu::inputs::Inputs;
use crate::image::Image;
use crate::kernel::depth::same_surface;
use crate::kernel::noise::Noise;
use crate::kernel::sanitize::is_finite;

/// Noise of candidates without a noise input.
pub(super) const NO_NOISE: Noise = Noise { samples: 1.0, variance: 0.0 };

/// Packed results for the samples of a view, at their pixels, row by row.
pub(super) type Samples = Vec<[u32; 2]>;

/// Alpha of a view's colors, and of its stored samples.
pub(super) struct GivenAlpha<'a> {
    pub given: &'a Image<f32>,
    pub past: &'a [f32],
}

/// Albedo of a view's pixels, and packed albedos of its stored samples.
pub(super) struct GivenAlbedo<'a> {
    pub given: &'a Image<[f32; 3]>,
    pub past: &'a [u32],
}

/// Inputs and history of one view of a frame.
pub(super) struct View<'a> {
    pub inputs: Inputs<'a>,
    pub words: &'a [[u32; 2]],
    /// Packed noise of the stored samples; empty unless candidates are noisy.
    pub noise: &'a [u32],
    /// `None` in frames without alpha, which is 1 then.
    pub alpha: Option<GivenAlpha<'a>>,
    /// `None` in frames without albedo.
    pub albedo: Option<GivenAlbedo<'a>>,
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
            alpha: None,
            albedo: None,
            accumulate: desc.settings.method.smr().accumulate,
            relights: crate::method::planned::relights(&desc.settings),
            is_noisy: desc.settings.noisy,
            antialiases: crate::method::planned::antialiases(&desc.settings),
            frame_low: frame.index as u32,
        }
    }
}

impl View<'_> {
    #[inline(always)]
    pub fn sample_noise(&self, [x, y]: [u32; 2]) -> Noise {
        self.inputs.noise(x, y).filter(|_| self.is_noisy).unwrap_or(NO_NOISE)
    }

    /// Alpha of a pixel's color: 1 where the renderer wrote none.
    #[inline(always)]
    pub fn alpha_at(&self, [x, y]: [u32; 2]) -> f32 {
        let given = self.alpha.as_ref().map(|alpha| alpha.given.at(x as usize, y as usize));
        given.filter(|&alpha| is_finite(alpha)).unwrap_or(1.0)
    }

    /// Whether two disparities of this frame can belong to one surface.
    #[inline(always)]
    pub fn alike(&self, a: f32, b: f32, relative: f32) -> bool {
        !self.inputs.tests_depth() || same_surface(a, b, relative, 0.0)
    }
}
