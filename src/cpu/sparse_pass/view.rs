//! Inputs, history and lattices of a view, for the loops over its samples and pixels.

use super::quads::Quads;
use crate::context::ContextDesc;
use crate::cpu::Frame;
use crate::cpu::inputs::Inputs;
use crate::kernel::depth::same_surface;
use crate::kernel::noise::Noise;
use crate::kernel::sanitize;
use crate::parallel::collect;
use crate::uniforms::{LatticeUniforms, ViewLattices};
use glam::Vec3;

/// Noise of candidates without a noise input.
pub(super) const NO_NOISE: Noise = Noise { samples: 1.0, variance: 0.0 };

/// Packed results for the samples of a lattice, row by row.
pub(super) type Samples = Vec<[u32; 2]>;

/// Inputs, history and lattices of one view of a frame.
pub(super) struct View<'a> {
    pub inputs: Inputs<'a>,
    pub words: &'a [[u32; 2]],
    /// Packed noise of the stored samples; empty unless candidates are noisy.
    pub noise: &'a [u32],
    pub lattices: ViewLattices,
    pub accumulate: f32,
    pub relights: bool,
    /// Whether candidates are noisy.
    pub is_noisy: bool,
    /// Whether frames are jittered and history stores means of samples.
    pub antialiases: bool,
    /// Low word of the frame counter.
    pub frame_low: u32,
    /// Shaded quads, of a frame shaded by quads. Such a frame has no lattices.
    pub quads: Option<&'a Quads>,
}

impl<'a> View<'a> {
    /// View `index` of a frame with its inputs, and history's samples and their noise.
    pub fn new(
        desc: &ContextDesc,
        frame: &Frame<'_>,
        index: usize,
        inputs: Inputs<'a>,
        words: &'a [[u32; 2]],
        noise: &'a [u32],
    ) -> Self {
        Self {
            inputs,
            words,
            noise,
            lattices: LatticeUniforms::of_view_or_full(frame.views[index].lattices.as_ref(), desc.size_px),
            accumulate: desc.settings.method.smr().accumulate,
            relights: crate::method::smr_sparse_relights(&desc.settings),
            is_noisy: desc.settings.noisy,
            antialiases: crate::method::smr_sparse_antialiases(&desc.settings),
            frame_low: frame.index as u32,
            quads: None,
        }
    }
}

impl View<'_> {
    /// Results of `f` for each sample of each lattice of step 2 and more.
    pub fn for_samples(&self, f: impl Fn(usize, [u32; 2]) -> [u32; 2] + Sync) -> Vec<Samples> {
        let of = |(index, lattice): (usize, &LatticeUniforms)| {
            let [columns, rows] = if lattice.level == 0 { [0, 0] } else { lattice.points };
            collect(columns * rows, |i| f(index, [i % columns, i / columns]))
        };
        self.lattices.iter().enumerate().map(of).collect()
    }

    /// Color of a sample, and whether it is usable.
    #[inline(always)]
    pub fn sampled(&self, lattice: &LatticeUniforms, point: [u32; 2]) -> (Vec3, bool) {
        sanitize::color(self.inputs.color_at(lattice.texel_of(point)))
    }

    #[inline(always)]
    pub fn sample_noise(&self, [x, y]: [u32; 2]) -> Noise {
        self.inputs.noise(x, y).filter(|_| self.is_noisy).unwrap_or(NO_NOISE)
    }

    /// log2 of the distance of samples in pixels, where a pixel lies.
    #[inline(always)]
    pub fn level_at(&self, px: [u32; 2]) -> u32 {
        match self.quads {
            Some(quads) => quads.level_at(px),
            None => self.lattices[LatticeUniforms::index_at(&self.lattices, px)].level,
        }
    }

    /// Whether two disparities of this frame can belong to one surface.
    #[inline(always)]
    pub fn alike(&self, a: f32, b: f32, relative: f32) -> bool {
        !self.inputs.tests_depth() || same_surface(a, b, relative, 0.0)
    }
}
