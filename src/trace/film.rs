//! Where samples are averaged, and how far their mean can be trusted.

use crate::image::Image;
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
}
