//! Regular lattices of sample points on a frame.

/// A lattice of points, and the area that each point's samples cover.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    /// Distance between neighbouring points in pixels.
    pub step: u32,
    /// Position of point (0, 0) in pixels.
    pub first_px: [f32; 2],
    /// Number of points along x and y.
    pub points: [u32; 2],
    /// Edge length in pixels of the square around a point that its samples are jittered over.
    pub footprint_px: f32,
}

impl Lattice {
    /// Blocks of `step` x `step` pixels from the frame's corner; samples cover the whole block.
    pub fn blocks(step: u32, size_px: [u32; 2]) -> Self {
        let step = step.max(1);
        let half = (step - 1) as f32 * 0.5;
        let points = size_px.map(|s| s.div_ceil(step));
        Self { step, first_px: [half; 2], points, footprint_px: step as f32 }
    }

    /// Every `step`-th pixel, aligned so that one point lies under the gaze. The gaze must be finite.
    pub fn through(step: u32, gaze_px: [f32; 2], size_px: [u32; 2]) -> Self {
        let step = step.max(1);
        let mut first_px = [0.0; 2];
        let mut points = [0; 2];
        for axis in 0..2 {
            let last = size_px[axis].saturating_sub(1) as f32;
            // A gaze off the frame also aligns the lattice.
            let first = gaze_px[axis].round().rem_euclid(step as f32);
            first_px[axis] = first;
            points[axis] = ((last - first).max(0.0) / step as f32).floor() as u32 + 1;
        }
        Self { step, first_px, points, footprint_px: 1.0 }
    }

    /// Position of a point in pixels.
    pub fn px(&self, point: [u32; 2]) -> [f32; 2] {
        [0, 1].map(|i| self.first_px[i] + (point[i] * self.step) as f32)
    }

    /// Lattice coordinate of a pixel.
    pub fn coordinate(&self, px: [f32; 2]) -> [f32; 2] {
        [0, 1].map(|i| (px[i] - self.first_px[i]) / self.step as f32)
    }
}
