//! Per-pixel sample statistics: mean, variance and noise estimates.

use afterimage::Image;
use afterimage::kernel::color::luma;
use glam::Vec3;

/// Running mean and squared deviations of one pixel's samples (Welford 1962), without cancellation for any number of
/// samples.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    /// Mean radiance.
    pub mean: Vec3,
    /// Sum of squared deviations from the mean.
    pub squares: Vec3,
    /// Number of samples.
    pub count: u32,
}

impl Moments {
    /// Adds a sample.
    #[inline]
    pub fn add(&mut self, sample: Vec3) {
        self.count += 1;
        let off = sample - self.mean;
        self.mean += off / self.count as f32;
        self.squares += off * (sample - self.mean);
    }

    /// Variance of the mean; infinite for fewer than two samples.
    pub fn variance_of_mean(&self) -> Vec3 {
        match self.count {
            0 | 1 => Vec3::INFINITY,
            n => self.squares / (n as f32 * (n - 1) as f32),
        }
    }
}

/// Sample statistics of an image, or of a window of it.
#[derive(Clone, Debug)]
pub struct Film {
    /// Statistics of each pixel of the window.
    pub moments: Image<Moments>,
    first: [u32; 2],
    /// Number of samples that were not finite; they count as black.
    pub nonfinite: u64,
    /// Number of rays traced, camera, scattered and shadow rays together.
    pub rays: u64,
}

impl Film {
    /// An empty film of `size` pixels.
    pub fn new(size: [u32; 2]) -> Self {
        Self::window([0; 2], size)
    }

    /// An empty film for a window of an image: `size` pixels with pixel `first` at the top left. Every sampled pixel
    /// must lie in it.
    pub fn window(first: [u32; 2], size: [u32; 2]) -> Self {
        Self { moments: Image::filled(size, Moments::default()), first, nonfinite: 0, rays: 0 }
    }

    /// Statistics of an image pixel; empty outside the window.
    #[inline]
    pub fn at(&self, pixel: [u32; 2]) -> Moments {
        self.of_window(&self.moments, pixel)
    }

    /// Value at an image pixel of `values`, which has the window's size; the default outside the window.
    #[inline]
    pub(super) fn of_window<T: Copy + Default>(&self, values: &Image<T>, [x, y]: [u32; 2]) -> T {
        // Coordinates left of or above the window wrap to large numbers, which lie outside it.
        let [x, y] = [x.wrapping_sub(self.first[0]), y.wrapping_sub(self.first[1])];
        let [width, height] = values.size();
        if x < width && y < height { values.at(x as usize, y as usize) } else { T::default() }
    }

    /// Offset to subtract from y * width + x to index `moments` by image pixel.
    pub(super) fn base(&self) -> u32 {
        Self::base_of(self.first, self.moments.size())
    }

    /// [`base`](Self::base) of a window.
    pub(super) fn base_of(first: [u32; 2], size: [u32; 2]) -> u32 {
        first[1] * size[0] + first[0]
    }

    /// Mean radiance; black for pixels without samples.
    pub fn color(&self) -> Image<[f32; 3]> {
        self.moments.map(|m| m.mean.to_array())
    }

    /// Variance of each mean; infinite for fewer than two samples.
    pub fn variance(&self) -> Image<[f32; 3]> {
        self.moments.map(|m| m.variance_of_mean().to_array())
    }

    /// Noise of a pixel's mean: standard error of its luma, and number of samples. For a single sample the error is the
    /// spread of the 3x3 neighbourhood, which also counts detail as noise.
    pub fn noise_at(&self, pixel: [u32; 2]) -> [f32; 2] {
        let own = self.at(pixel);
        let error = match own.count {
            0 => return [0.0; 2],
            1 => self.spread(pixel),
            // Assumes fully correlated channels, an upper bound.
            _ => luma(own.variance_of_mean().map(f32::sqrt)),
        };
        [error, own.count as f32]
    }

    /// [`noise_at`](Self::noise_at) of every pixel of the window.
    pub fn noise(&self) -> Image<[f32; 2]> {
        let [left, top] = self.first;
        Image::from_fn_parallel(self.moments.size(), |[x, y]| self.noise_at([left + x, top + y]))
    }

    /// Standard deviation of luma over the 3x3 neighbourhood.
    fn spread(&self, [x, y]: [u32; 2]) -> f32 {
        let mut lumas = Moments::default();
        for (dx, dy) in (0..9).map(|i| (i % 3, i / 3)) {
            // Coordinates left of or above the image wrap to pixels outside every film.
            let near = self.at([x.wrapping_add(dx).wrapping_sub(1), y.wrapping_add(dy).wrapping_sub(1)]);
            if near.count > 0 {
                lumas.add(Vec3::splat(luma(near.mean)));
            }
        }
        // Without neighbours, assume an error as large as the luma itself.
        if lumas.count < 2 { lumas.mean.x } else { (lumas.squares.x / (lumas.count - 1) as f32).sqrt() }
    }
}
