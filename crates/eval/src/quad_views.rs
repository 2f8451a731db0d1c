//! Quad views: foveation as headset runtimes draw it. Each region of the frame is a view of its own at a lower
//! resolution, enlarged and laid over the coarser ones. Pixels do not move from frame to frame.

use afterimage::ViewGeometry;
use afterimage::internal::Foveation;

/// Depth and motion of a frame of quad views. Default: [`Full`](Self::Full).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Geometry {
    /// At every pixel: a visibility buffer, a prepass, or shading-rate hardware.
    #[default]
    Full,
    /// Those of the nearest pixel of a view: small views.
    Samples,
}

/// A view of a rectangle of the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuadView {
    /// Side of its pixels in pixels of the full-rate frame, at least 1; need not be whole.
    pub step: f32,
    /// Its top-left pixel, in a grid of such pixels that begins at the frame's corner. The grid stands still when the
    /// gaze moves.
    pub first: [u32; 2],
    /// Width and height in its own pixels.
    pub points: [u32; 2],
    /// Texel of its top-left pixel in an atlas.
    pub atlas_texel: [u32; 2],
    /// Rectangle of the frame in which this view hides coarser views: first pixel, and pixel after the last.
    pub opaque_px: [[u32; 2]; 2],
    /// Width of the linear fade-out around that rectangle, in pixels of the frame.
    pub blend_px: f32,
}

impl QuadView {
    /// The view whose pixels cover the rectangle `[low, high)` of the frame, and hide coarser views in `opaque_px`.
    fn covering(step: f32, [low, high]: [[u32; 2]; 2], opaque_px: [[u32; 2]; 2], blend_px: f32) -> Self {
        let first = low.map(|v| (v as f32 / step) as u32);
        let end = high.map(|v| (v as f32 / step).ceil() as u32);
        let points = [0, 1].map(|i| (end[i] - first[i]).max(1));
        Self { step, first, points, atlas_texel: [0; 2], opaque_px, blend_px }
    }

    /// Centre of its pixel (i, j) in the frame; centres of the frame's pixels are at integers.
    pub fn center_px(&self, point: [u32; 2]) -> [f32; 2] {
        [0, 1].map(|i| ((self.first[i] + point[i]) as f32 + 0.5) * self.step - 0.5)
    }

    /// Level of detail: log2 of the step.
    pub fn lod(&self) -> f32 {
        self.step.log2()
    }
}

/// The quad views of a frame, finest first. The last one covers the frame.
#[derive(Clone, Debug, PartialEq)]
pub struct QuadViews(Vec<QuadView>);

impl QuadViews {
    /// Largest number of views.
    pub const MAX: usize = 3;

    /// The views of a frame.
    pub fn as_slice(&self) -> &[QuadView] {
        &self.0
    }

    /// These views, at other places in an atlas.
    #[must_use]
    pub fn with(&self, placed: Vec<QuadView>) -> Self {
        Self(placed)
    }

    /// Number of pixels of all views.
    pub fn pixels(&self) -> u64 {
        self.0.iter().map(|view| view.points.iter().map(|&n| u64::from(n)).product::<u64>()).sum()
    }
}

/// Layout of the quad views of frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum QuadViewLayout {
    /// One view a region of the foveation: rectangles around the regions and their blend.
    Regions,
    /// One view of the whole frame whose pixels have sides of `step` pixels, at least 1.
    Uniform {
        /// Side of a pixel in pixels of the full-rate frame.
        step: f32,
    },
}

impl QuadViewLayout {
    /// Views of a frame. Regions outside the frame, and regions of 0 degrees, are left out.
    pub fn views(self, foveation: &Foveation, geometry: &ViewGeometry, gaze_px: [f32; 2]) -> QuadViews {
        let size = geometry.size_px();
        let whole = [[0; 2], size];
        let mut views: Vec<QuadView> = vec![];
        let far = match self {
            Self::Uniform { step } => step,
            Self::Regions => {
                let deg_per_px = geometry.eccentricity_deg([gaze_px[0] + 1.0, gaze_px[1]], gaze_px);
                let blend_px = foveation.blend_deg / deg_per_px;
                let wide = blend_px.ceil() as u32;
                for (step, diameter_deg) in [(1, foveation.fovea_deg), (foveation.rate_mid, foveation.mid_deg)] {
                    let opaque = foveation.region_px(geometry, gaze_px, 0.5 * diameter_deg);
                    let [low, high] = opaque;
                    let is_seen = diameter_deg > 0.0 && (0..2).all(|i| low[i] < high[i]);
                    if is_seen && step < foveation.rate_far && views.iter().all(|view| view.step < step as f32) {
                        let low = low.map(|v| v.saturating_sub(wide));
                        let high = [0, 1].map(|i| high[i].saturating_add(wide).min(size[i]));
                        views.push(QuadView::covering(step as f32, [low, high], opaque, blend_px));
                    }
                }
                foveation.rate_far as f32
            }
        };
        views.push(QuadView::covering(far, whole, whole, 0.0));
        QuadViews(views)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat() -> ViewGeometry {
        ViewGeometry::flat([200, 100], 70.0).unwrap()
    }

    #[test]
    fn pixels_are_centred_on_their_blocks_and_stand_still() {
        let foveation = Foveation { rate_mid: 2, rate_far: 8, ..Foveation::default() };
        for gaze in [[100.0, 50.0], [101.3, 49.2], [3.0, 99.0], [-30.0, 50.0]] {
            let views = QuadViewLayout::Regions.views(&foveation, &flat(), gaze);
            for view in views.as_slice() {
                for point in [[0; 2], view.points.map(|n| n - 1)] {
                    let corner = view.center_px(point).map(|v| (v + 0.5) / view.step - 0.5);
                    assert_eq!(corner.map(f32::fract), [0.0; 2], "{view:?}");
                }
                // A view covers the rectangle in which it hides coarser views.
                let [low, high] = view.opaque_px;
                for i in 0..2 {
                    let begin = view.first[i] as f32 * view.step;
                    assert!(begin <= low[i] as f32 && begin + view.points[i] as f32 * view.step >= high[i] as f32);
                }
            }
            assert_eq!(views.as_slice().last().unwrap().points, [25, 13]);
        }
    }

    #[test]
    fn a_uniform_frame_has_one_view_of_any_step() {
        for (step, points) in [(1.0, [200, 100]), (1.5, [134, 67]), (2.0, [100, 50]), (3.0, [67, 34])] {
            let views = QuadViewLayout::Uniform { step }.views(&Foveation::default(), &flat(), [0.0; 2]);
            let [view] = views.as_slice() else { panic!("{views:?}") };
            assert_eq!((view.first, view.points, view.opaque_px), ([0; 2], points, [[0; 2], [200, 100]]));
            assert_eq!(view.center_px([0; 2]), [0.5 * step - 0.5; 2]);
        }
    }

    #[test]
    fn regions_of_no_size_or_of_the_next_ones_step_are_left_out() {
        let steps = |foveation: Foveation| {
            let views = QuadViewLayout::Regions.views(&foveation, &flat(), [100.0, 50.0]);
            views.as_slice().iter().map(|view| view.step).collect::<Vec<_>>()
        };
        let foveation = Foveation { rate_mid: 2, rate_far: 4, ..Foveation::default() };
        assert_eq!(steps(foveation), [1.0, 2.0, 4.0]);
        assert_eq!(steps(Foveation { fovea_deg: 0.0, ..foveation }), [2.0, 4.0]);
        assert_eq!(steps(Foveation { rate_far: 2, ..foveation }), [1.0, 2.0]);
        assert_eq!(steps(Foveation { rate_mid: 1, ..foveation }), [1.0, 4.0]);
    }
}
