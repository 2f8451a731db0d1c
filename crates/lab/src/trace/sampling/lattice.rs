//! Points on a frame at equal distances.

use std::ops::Range;

/// A lattice of points over a frame, and how far around each its samples lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    /// Pixels from point to point.
    pub step: u32,
    /// Pixel of point (0, 0).
    pub first_px: [f32; 2],
    /// Points along x and y.
    pub points: [u32; 2],
    /// Edge of the square around a point that its samples are spread over, in pixels.
    pub footprint_px: f32,
}

impl Lattice {
    /// Blocks of `step` x `step` pixels from the corner on, sampled all over.
    pub fn blocks(step: u32, size_px: [u32; 2]) -> Self {
        let step = step.max(1);
        let half = (step - 1) as f32 * 0.5;
        let points = size_px.map(|s| s.div_ceil(step));
        Self { step, first_px: [half; 2], points, footprint_px: step as f32 }
    }

    /// Single pixels, every `step`-th, one of them under the gaze, which is finite.
    pub fn through(step: u32, gaze_px: [f32; 2], size_px: [u32; 2]) -> Self {
        let step = step.max(1);
        let mut first_px = [0.0; 2];
        let mut points = [0; 2];
        for axis in 0..2 {
            let last = size_px[axis].saturating_sub(1) as f32;
            // A gaze off the frame shifts the lattice all the same.
            let first = gaze_px[axis].round().rem_euclid(step as f32);
            first_px[axis] = first;
            points[axis] = ((last - first).max(0.0) / step as f32).floor() as u32 + 1;
        }
        Self { step, first_px, points, footprint_px: 1.0 }
    }

    /// Pixel of a point.
    pub fn px(&self, point: [u32; 2]) -> [f32; 2] {
        [0, 1].map(|i| self.first_px[i] + (point[i] * self.step) as f32)
    }

    /// Where a pixel lies between points.
    pub fn coordinate(&self, px: [f32; 2]) -> [f32; 2] {
        [0, 1].map(|i| (px[i] - self.first_px[i]) / self.step as f32)
    }
    /// Pixels that a point stands for: the square of its step around it, as far as it lies on a frame of `size_px`.
    pub fn cell(&self, point: [u32; 2], size_px: [u32; 2]) -> [Range<u32>; 2] {
        let half = (self.step - 1) as f32 * 0.5;
        let px = self.px(point);
        [0, 1].map(|i| {
            let first = (px[i] - half).ceil();
            first.max(0.0) as u32..((first + self.step as f32).max(0.0) as u32).min(size_px[i])
        })
    }
}
