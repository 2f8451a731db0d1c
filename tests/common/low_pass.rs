//! A foveated renderer in f64.

use afterimage::Image;

/// Mip levels of an image in f64, with trilinear lookup: a second implementation, from the definition of the foveation.
pub struct LowPass(pub Vec<Image<[f64; 3]>>);

impl LowPass {
    pub fn new(full: &Image<[f32; 3]>, count: usize) -> Self {
        let mut levels = vec![full.map(|c| c.map(f64::from))];
        for l in 0..count {
            let finer = &levels[l];
            let [w, h] = finer.size();
            let level = Image::from_fn([w.div_ceil(2), h.div_ceil(2)], |[x, y]| {
                let corners = [(0, 0), (1, 0), (0, 1), (1, 1)];
                let taps =
                    corners.map(|(i, j)| finer.at((2 * x + i).min(w - 1) as usize, (2 * y + j).min(h - 1) as usize));
                [0, 1, 2].map(|c| taps.iter().map(|t| t[c]).sum::<f64>() / 4.0)
            });
            levels.push(level);
        }
        Self(levels)
    }

    pub fn bilinear(&self, at: [f64; 2], level: usize) -> [f64; 3] {
        let image = &self.0[level];
        let axis = |i: usize| {
            let len = image.size()[i] as usize;
            let v = ((at[i] + 0.5) / f64::from(1 << level) - 0.5).clamp(0.0, (len - 1) as f64);
            (v as usize, (v as usize + 1).min(len - 1), v.fract())
        };
        let ((x0, x1, fx), (y0, y1, fy)) = (axis(0), axis(1));
        [0, 1, 2].map(|c| {
            let top = image.at(x0, y0)[c] * (1.0 - fx) + image.at(x1, y0)[c] * fx;
            let bottom = image.at(x0, y1)[c] * (1.0 - fx) + image.at(x1, y1)[c] * fx;
            top * (1.0 - fy) + bottom * fy
        })
    }

    pub fn at(&self, at: [f64; 2], lod: f32) -> [f32; 3] {
        let level = lod as usize;
        let (fine, coarse) = (self.bilinear(at, level), self.bilinear(at, level + 1));
        let t = f64::from(lod).fract();
        [0, 1, 2].map(|c| (fine[c] + (coarse[c] - fine[c]) * t) as f32)
    }

    /// The image as a foveating renderer would deliver it.
    pub fn render(&self, lods: &Image<f32>) -> Image<[f32; 3]> {
        Image::from_fn(lods.size(), |[x, y]| self.at([f64::from(x), f64::from(y)], lods.at(x as usize, y as usize)))
    }
}
