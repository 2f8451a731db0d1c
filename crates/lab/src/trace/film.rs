//! Where samples are averaged, and how far their mean can be trusted.

use afterimage::Image;
use afterimage::kernel::color::luma;
use glam::Vec3;

/// Running mean and squared deviations of one pixel's samples (Welford 1962): no cancellation, whatever the number of samples.
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
    /// Takes one more sample into account.
    #[inline]
    pub fn add(&mut self, sample: Vec3) {
        self.count += 1;
        let off = sample - self.mean;
        self.mean += off / self.count as f32;
        self.squares += off * (sample - self.mean);
    }

    /// Variance of the mean; infinite below two samples.
    pub fn variance_of_mean(&self) -> Vec3 {
        match self.count {
            0 | 1 => Vec3::INFINITY,
            n => self.squares / (n as f32 * (n - 1) as f32),
        }
    }
}

/// An image that is being sampled, or a window of it.
#[derive(Clone, Debug)]
pub struct Film {
    /// One entry a pixel of the window.
    pub moments: Image<Moments>,
    first: [u32; 2],
    /// Samples that were not finite and count as black.
    pub nonfinite: u64,
    /// Rays traced, of all kinds.
    pub rays: u64,
}

impl Film {
    /// An empty film of `size` pixels.
    pub fn new(size: [u32; 2]) -> Self {
        Self::window([0; 2], size)
    }

    /// An empty film of `size` pixels of an image, the top left of them pixel `first`: all that is sampled must lie in it.
    pub fn window(first: [u32; 2], size: [u32; 2]) -> Self {
        Self { moments: Image::filled(size, Moments::default()), first, nonfinite: 0, rays: 0 }
    }

    /// What is known of a pixel of the image: outside the window, nothing.
    #[inline]
    pub fn at(&self, [x, y]: [u32; 2]) -> Moments {
        // Left of the window wraps to a number beyond it.
        let [x, y] = [x.wrapping_sub(self.first[0]), y.wrapping_sub(self.first[1])];
        let [width, height] = self.moments.size();
        if x < width && y < height { self.moments.at(x as usize, y as usize) } else { Moments::default() }
    }

    /// What to take from y * width + x to find a pixel of the image in `moments`.
    pub(super) fn base(&self) -> u32 {
        self.first[1] * self.moments.size()[0] + self.first[0]
    }

    /// Mean radiance; black where there is no sample.
    pub fn color(&self) -> Image<[f32; 3]> {
        self.moments.map(|m| m.mean.to_array())
    }

    /// Variance of each mean; infinite below two samples.
    pub fn variance(&self) -> Image<[f32; 3]> {
        self.moments.map(|m| m.variance_of_mean().to_array())
    }

    /// Noise of a pixel's mean: the standard error of its luma, and its number of samples (0 where there is none). Of a single sample
    /// the error is how far its neighbours scatter, which counts their detail as noise, too.
    pub fn noise_at(&self, pixel: [u32; 2]) -> [f32; 2] {
        let own = self.at(pixel);
        let error = match own.count {
            0 => return [0.0; 2],
            1 => self.scatter(pixel),
            // As if the channels' noise were one and the same: never too small.
            _ => luma(own.variance_of_mean().map(f32::sqrt)),
        };
        [error, own.count as f32]
    }

    /// Standard deviation of the lumas of 3x3 pixels.
    fn scatter(&self, [x, y]: [u32; 2]) -> f32 {
        let mut lumas = Moments::default();
        for (dx, dy) in (0..9).map(|i| (i % 3, i / 3)) {
            // Left of the image wraps to a pixel that no film has.
            let near = self.at([x.wrapping_add(dx).wrapping_sub(1), y.wrapping_add(dy).wrapping_sub(1)]);
            if near.count > 0 {
                lumas.add(Vec3::splat(luma(near.mean)));
            }
        }
        // A pixel alone is as uncertain as it is bright.
        if lumas.count < 2 { lumas.mean.x } else { (lumas.squares.x / (lumas.count - 1) as f32).sqrt() }
    }
}
