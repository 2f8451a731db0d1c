//! Box mip levels in linear light, right for odd sizes, and their bilinear and trilinear reading.

use crate::image::Image;
use glam::Vec3;
use rayon::prelude::*;

/// A full-rate frame and its coarser levels. Level l has `ceil(size / 2^l)` texels a side; texel i covers pixels `i * 2^l` to
/// `(i + 1) * 2^l - 1`, as far as they exist.
#[derive(Clone, Debug)]
pub struct Pyramid {
    levels: Vec<Image<[f32; 3]>>,
}

impl Pyramid {
    /// Builds levels 0 to `max_level`. Non-finite pixels count as black in coarser levels, so that one of them does not blacken
    /// or poison a whole block.
    pub fn new(full: Image<[f32; 3]>, max_level: u32) -> Self {
        let mut levels = vec![full];
        for _ in 0..max_level {
            let next = halve(&levels[levels.len() - 1], levels.len() == 1);
            levels.push(next);
        }
        Self { levels }
    }

    /// One level; 0 is the full-rate frame.
    ///
    /// # Panics
    /// If the level was not built.
    pub fn level(&self, level: usize) -> &Image<[f32; 3]> {
        &self.levels[level]
    }

    /// Bilinear reading of `level` at full-rate position `px` (pixel centres are integers), clamped at the borders.
    pub fn bilinear(&self, px: [f32; 2], level: usize) -> Vec3 {
        let image = &self.levels[level];
        let scale = 1.0 / (1_u32 << level) as f32;
        let [x, y] = px.map(|v| (v + 0.5) * scale - 0.5);
        let (x0, fx) = split(x, image.width());
        let (y0, fy) = split(y, image.height());
        let x1 = (x0 + 1).min(image.width() - 1);
        let y1 = (y0 + 1).min(image.height() - 1);
        let at = |x, y| Vec3::from(image.at(x, y));
        let top = mix(at(x0, y0), at(x1, y0), fx);
        let bottom = mix(at(x0, y1), at(x1, y1), fx);
        mix(top, bottom, fy)
    }

    /// Linear blend of the two levels around `lod`, each read bilinearly. Whole levels are returned without arithmetic on the
    /// other one, level 0 bit for bit.
    pub fn trilinear(&self, px: [f32; 2], lod: f32) -> [f32; 3] {
        let lod = lod.clamp(0.0, (self.levels.len() - 1) as f32);
        let level = lod.floor();
        let fraction = lod - level;
        let level = level as usize;
        let fine = if level == 0 {
            Vec3::from(self.levels[0].at(px[0] as usize, px[1] as usize))
        } else {
            self.bilinear(px, level)
        };
        if fraction == 0.0 {
            return fine.to_array();
        }
        mix(fine, self.bilinear(px, level + 1), fraction).to_array()
    }
}

/// Texel index and fraction of a continuous coordinate, clamped to the image.
fn split(v: f32, len: usize) -> (usize, f32) {
    let v = v.clamp(0.0, (len - 1) as f32);
    let i = v.floor();
    (i as usize, v - i)
}

fn mix(a: Vec3, b: Vec3, t: f32) -> Vec3 {
    a + (b - a) * t
}

/// The next level: means of 2x2 texels; at odd borders means of the texels that exist.
fn halve(image: &Image<[f32; 3]>, scrub: bool) -> Image<[f32; 3]> {
    let size = image.size().map(|s| s.div_ceil(2));
    let mut half = Image::filled(size, [0.0; 3]);
    let texel = |x: usize, y: usize| {
        let c = Vec3::from(image.at(x, y));
        if scrub { crate::kernel::scrub::color(c).0 } else { c }
    };
    half.pixels_mut().par_chunks_mut(size[0].max(1) as usize).enumerate().for_each(|(y, row)| {
        let (y0, y1) = (2 * y, (2 * y + 1).min(image.height() - 1));
        for (x, out) in row.iter_mut().enumerate() {
            // A missing texel is replaced by its neighbour, which leaves the mean of those that exist.
            let (x0, x1) = (2 * x, (2 * x + 1).min(image.width() - 1));
            let sum = texel(x0, y0) + texel(x1, y0) + texel(x0, y1) + texel(x1, y1);
            *out = (sum * 0.25).to_array();
        }
    });
    half
}
