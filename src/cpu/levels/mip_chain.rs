//! Mip chains of stored surfaces and of noisy candidates: means of 2x2 texels, as in the foveation's mip levels, so
//! that a level of history can be compared with a candidate of the same level of detail.

use crate::image::Image;
use crate::kernel::foveate::{level_coordinate, level_len, split};
use crate::kernel::mip_noise::{candidate_bilinear, candidate_mean};
use crate::kernel::smr::{mip_bilinear, mip_mean};
use crate::kernel::surface::{mip_texel, round_mip};
use crate::parallel::for_rows;
use glam::{Vec3, Vec4};

/// Levels 1 to n of one view; level l at index l - 1. Texels are rounded to halves. For surfaces: color times coverage,
/// and coverage; for candidates: color, and the variance of a pixel's luma.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MipChain {
    size: [u32; 2],
    levels: Vec<Image<[f32; 4]>>,
}

impl MipChain {
    /// An empty mip chain of `count` levels of a view of `size` pixels.
    pub fn new(size: [u32; 2], count: u32) -> Self {
        let levels = (1..=count).map(|l| Image::filled(size.map(|s| level_len(s, l)), [0.0; 4])).collect();
        Self { size, levels }
    }

    /// Bytes held: four floats a texel.
    pub fn memory_bytes(&self) -> usize {
        self.levels.iter().map(|l| size_of_val(l.pixels())).sum()
    }

    /// Fills all levels from the packed surfaces of the view.
    pub fn build(&mut self, words: &[[u32; 2]]) {
        let width = self.size[0];
        self.fill(|x, y| mip_texel(words[(y * width + x) as usize]), mip_mean);
    }

    /// Fills all levels from the texels of the view's candidates.
    pub fn build_candidates(&mut self, candidate: impl Fn(u32, u32) -> Vec4 + Sync) {
        self.fill(candidate, candidate_mean);
    }

    fn fill(&mut self, texel: impl Fn(u32, u32) -> Vec4 + Sync, mean: fn(Vec4, Vec4, Vec4, Vec4) -> Vec4) {
        let [width, height] = self.size;
        let base = |x: u32, y: u32| texel(x.min(width - 1), y.min(height - 1));
        for l in 0..self.levels.len() {
            let (finer, level) = self.levels.split_at_mut(l);
            let (finer, level) = (finer.last(), &mut level[0]);
            let row_len = level.width();
            for_rows(level.pixels_mut(), row_len, |y, row| {
                for (x, out) in row.iter_mut().enumerate() {
                    let (x0, y0) = (2 * x as u32, 2 * y as u32);
                    let at = |x: u32, y: u32| match finer {
                        None => base(x, y),
                        Some(f) => {
                            let (w, h) = (f.width() as u32, f.height() as u32);
                            Vec4::from(f.at(x.min(w - 1) as usize, y.min(h - 1) as usize))
                        }
                    };
                    let mean = mean(at(x0, y0), at(x0 + 1, y0), at(x0, y0 + 1), at(x0 + 1, y0 + 1));
                    *out = round_mip(mean).to_array();
                }
            });
        }
    }

    /// Four texels of a level around a position, and the position's fractions between them.
    #[inline(always)]
    fn around(&self, at: [f32; 2], level: u32) -> ([Vec4; 4], [f32; 2]) {
        let image = &self.levels[level as usize - 1];
        let (w, h) = (image.width() as u32, image.height() as u32);
        let (x0, fx) = split(level_coordinate(at[0], level), w);
        let (y0, fy) = split(level_coordinate(at[1], level), h);
        let (x1, y1) = ((x0 + 1).min(w - 1), (y0 + 1).min(h - 1));
        let texel = |x: u32, y: u32| Vec4::from(image.at(x as usize, y as usize));
        ([texel(x0, y0), texel(x1, y0), texel(x0, y1), texel(x1, y1)], [fx, fy])
    }

    pub fn last_level(&self) -> u32 {
        self.levels.len() as u32
    }

    /// Color at a position in pixels, of `level` from 1.
    #[inline(always)]
    pub fn bilinear(&self, at: [f32; 2], level: u32) -> Vec3 {
        let ([a, b, c, d], fraction) = self.around(at, level);
        mip_bilinear([a, b], [c, d], fraction)
    }

    #[inline(always)]
    fn bilinear_candidate(&self, at: [f32; 2], level: u32) -> Vec4 {
        let ([a, b, c, d], fraction) = self.around(at, level);
        candidate_bilinear([a, b], [c, d], fraction)
    }

    /// Color and variance of candidates at a position in pixels: at level of detail `lod` of at least 1, and at the
    /// next whole level.
    #[inline(always)]
    pub fn read_candidates(&self, at: [f32; 2], lod: f32) -> [Vec4; 2] {
        let last = self.levels.len() as u32;
        let lod = lod.min(last as f32);
        let whole = lod.floor();
        let first = self.bilinear_candidate(at, whole as u32);
        let second = self.bilinear_candidate(at, (whole as u32 + 1).min(last));
        [first + (second - first) * (lod - whole), second]
    }

    /// History at a position in pixels: at level of detail `lod`, and at the two whole levels around it. `smooth`:
    /// history at level 0.
    #[inline(always)]
    pub fn read(&self, at: [f32; 2], lod: f32, smooth: Vec3) -> [Vec3; 3] {
        let last = self.levels.len() as u32;
        let lod = lod.min(last as f32);
        let whole = lod.floor();
        let fraction = lod - whole;
        let level = whole as u32;
        let at_level = |l: u32| if l == 0 { smooth } else { self.bilinear(at, l.min(last)) };
        let [first, second] = [at_level(level), at_level(level + 1)];
        [first + (second - first) * fraction, first, second]
    }
}
