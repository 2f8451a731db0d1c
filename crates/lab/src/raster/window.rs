//! Windows: the part of the full-rate frame that a target shows, and the triangles in it.

use super::pixels::Pixels;
use super::vertices::AlphaKind;
use crate::quad_views::{QuadView, QuadViews};
use crate::view::View;
use glam::DVec3;
use std::ops::Range;

/// Layout of quad views in their atlas.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AtlasLayout {
    /// Views lie below each other, in an atlas that is as small as possible. Depth and color of the full-rate view
    /// differ from those of the full-rate frame by rounding: rasterizers interpolate relative to the target's corner.
    #[default]
    Compact,
    /// The full-rate view at its own pixels of an atlas as large as the frame, the others below that: the full-rate
    /// frame's viewport and a scissor. Depth, motion and color are the full-rate frame's, bit for bit. Costs the memory
    /// of full-rate targets.
    InPlace,
}

impl AtlasLayout {
    /// `views` in an atlas, finest first, and the atlas's size in texels. `size`: the full-rate frame's, in pixels.
    pub fn place_views(self, views: &QuadViews, size: [u32; 2]) -> (QuadViews, [u32; 2]) {
        let mut placed = views.as_slice().to_vec();
        let mut used = self.start(size);
        for view in &mut placed {
            let full_rate = (view.step == 1.0).then_some(view.first);
            view.atlas_texel = self.next(&mut used, full_rate, view.points);
        }
        (views.with(placed), used)
    }

    /// Texels of the atlas that are used before anything is placed.
    fn start(self, size: [u32; 2]) -> [u32; 2] {
        if self == Self::InPlace { size } else { [0; 2] }
    }

    /// Corner of the next view. `full_rate`: its first pixel, if it is at full rate.
    fn next(self, used: &mut [u32; 2], full_rate: Option<[u32; 2]>, points: [u32; 2]) -> [u32; 2] {
        let corner = match (self, full_rate) {
            (Self::InPlace, Some(first)) => first,
            // Pixels form the same quads of 2 x 2 as in the full-rate frame, for the same derivatives.
            (Self::Compact, Some(first)) => [first[0] % 2, used[1] + first[1] % 2],
            _ => [0, used[1]],
        };
        *used = [0, 1].map(|i| used[i].max(corner[i] + points[i]));
        corner
    }
}

/// Part of a target, and the pixels of the full-rate frame that it shows: `first_px + step * (i, j)`.
#[derive(Clone, Debug)]
pub(super) struct Window {
    /// Viewport in pixels of the target. It may extend beyond the target.
    pub origin: [f32; 2],
    pub size: [u32; 2],
    /// Rectangle of the target that is drawn to: corner and size.
    pub scissor: [[u32; 2]; 2],
    /// Pixel of the full-rate frame at the viewport's corner.
    pub first_px: [f32; 2],
    pub step: f32,
    /// Whether pixels are pixels of the full-rate frame: they have one sample each, and textures have the full-rate
    /// frame's level of detail. Otherwise pixels have four samples, and textures the level of detail of the window's
    /// own resolution.
    pub is_point: bool,
    /// Rectangle of the full-rate frame that is visible, pixel centres at integers.
    visible_px: [[f64; 2]; 2],
}

impl Window {
    /// The full-rate frame.
    pub fn full(size: [u32; 2]) -> Self {
        Self {
            origin: [0.0; 2],
            size,
            scissor: [[0; 2], size],
            first_px: [0.0; 2],
            step: 1.0,
            is_point: false,
            visible_px: [[-0.5; 2], size.map(|s| f64::from(s) - 0.5)],
        }
    }

    /// The same, with one sample a pixel.
    pub fn with_points(self) -> Self {
        Self { is_point: true, ..self }
    }

    /// The frame of `size` pixels at half the width and height, rounded up, with one sample a pixel: its pixel (x, y)
    /// shows pixel (2x, 2y) + `place_px`.
    pub fn half(size: [u32; 2], place_px: [u32; 2]) -> Self {
        let half = size.map(|side| side.div_ceil(2));
        let first = place_px.map(|v| v as f32);
        let low = first.map(|v| f64::from(v) - 1.0);
        Self {
            size: half,
            scissor: [[0; 2], half],
            first_px: first,
            step: 2.0,
            is_point: true,
            visible_px: [low, [0, 1].map(|i| low[i] + 2.0 * f64::from(half[i]))],
            ..Self::full(size)
        }
    }

    /// A quad view in an atlas, of frames of `size` pixels.
    pub fn of_quad_view(view: &QuadView, size: [u32; 2]) -> Self {
        let &QuadView { step, first, points, atlas_texel, .. } = view;
        if step == 1.0 {
            // The full-rate frame's viewport, moved by whole pixels, so that its vertices get that frame's positions.
            let low = first.map(|v| f64::from(v) - 0.5);
            return Self {
                origin: [0, 1].map(|i| atlas_texel[i] as f32 - first[i] as f32),
                scissor: [atlas_texel, points],
                visible_px: [low, [0, 1].map(|i| low[i] + f64::from(points[i]))],
                ..Self::full(size)
            };
        }
        let low = first.map(|v| f64::from(v) * f64::from(step) - 0.5);
        Self {
            origin: atlas_texel.map(|v| v as f32),
            size: points,
            scissor: [atlas_texel, points],
            first_px: view.center_px([0; 2]),
            step,
            is_point: false,
            visible_px: [low, [0, 1].map(|i| low[i] + f64::from(points[i]) * f64::from(step))],
        }
    }
}

/// Planes around the volume that a window shows: directions `n` with `n . (point - eye) >= 0` inside.
pub(super) struct Frustum {
    eye: DVec3,
    planes: [DVec3; 5],
}

impl Frustum {
    /// Frustum of a window of `view`, a sample spacing wider on each side to allow for rounding.
    pub fn new(view: &View, window: &Window) -> Self {
        let [x, y, along] = Pixels::of(view).rows;
        let margin = f64::from(window.step);
        let [low, high] = window.visible_px;
        let [low, high] = [low.map(|v| v - margin), high.map(|v| v + margin)];
        Self {
            eye: view.world_from_camera().w_axis.truncate(),
            planes: [x - along * low[0], along * high[0] - x, y - along * low[1], along * high[1] - y, along],
        }
    }

    /// Whether a part of the box may be visible. Boxes that are not finite may be.
    pub fn meets(&self, [low, high]: [DVec3; 2]) -> bool {
        let (middle, half) = (0.5 * (low + high) - self.eye, 0.5 * (high - low));
        !self.planes.iter().any(|n| n.dot(middle) + n.abs().dot(half) < 0.0)
    }
}

/// Draw calls of a window, opaque surfaces first.
#[derive(Clone, Debug)]
pub(super) struct DrawCall {
    pub kind: AlphaKind,
    pub material: u32,
    pub is_moving: bool,
    pub vertices: Range<u32>,
}

impl DrawCall {
    /// Whether `next` draws the same part's triangles that follow.
    pub fn is_continued_by(&self, next: &Self) -> bool {
        let part = |call: &Self| (call.kind, call.material, call.is_moving);
        part(self) == part(next) && self.vertices.end == next.vertices.start
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_the_frame_shows_one_pixel_of_each_quad() {
        let window = Window::half([101, 90], [1, 0]);
        assert_eq!(window.size, [51, 45]);
        for (point, i) in [([0, 0], 0), ([0, 0], 1), ([7, 3], 0), ([7, 3], 1)] {
            let px = window.first_px[i] + (point[i] as f32 - window.origin[i]) * window.step;
            assert_eq!(px, ([1, 0][i] + 2 * point[i]) as f32);
        }
    }
}
