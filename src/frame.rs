//! Facts of a frame that CPU and GPU share: gaze, view, reset.

use crate::display::ViewGeometry;

/// Where one eye looks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Gaze {
    /// At this position of its view: pixels, (0, 0) is the centre of the top-left pixel, y down. May lie outside the view.
    At {
        /// Position in pixels.
        px: [f32; 2],
    },
    /// Not known in this frame (blink, lost tracking): the last known position is held; before the first one, the middle of
    /// the view.
    #[default]
    Lost,
}

impl Gaze {
    /// The position to use: this one if it is known and finite, else `held`, else the middle of a view of `size_px`. Limited to
    /// a million pixels either way, so that angles stay finite.
    pub fn resolve(self, held: Option<[f32; 2]>, size_px: [u32; 2]) -> [f32; 2] {
        let middle = size_px.map(|s| 0.5 * s as f32 - 0.5);
        match self {
            Self::At { px } if px[0].is_finite() && px[1].is_finite() => px.map(|v| v.clamp(-1e6, 1e6)),
            _ => held.unwrap_or(middle),
        }
    }
}

/// Facts of one view of one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewFrame {
    /// How its pixels map to rays.
    pub geometry: ViewGeometry,
    /// Where its eye looks.
    pub gaze: Gaze,
    /// Camera motion: takes a point from this frame's view space (x right, y down, z forward) to the previous frame's.
    /// Row-major, for column vectors. With it, driving towards a wall does not look like disocclusion. `None`: distances are
    /// expected to stay as they are.
    pub previous_from_current: Option<[[f32; 4]; 4]>,
}

/// What of the history is still true.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reset {
    /// Everything.
    #[default]
    None,
    /// Nothing: a cut, a teleport, a pause. This frame starts afresh.
    All,
}

/// Facts that hold from creation on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContextDesc {
    /// Width and height of each view in pixels, at least 1x1.
    pub size_px: [u32; 2],
    /// Number of views; 2 for stereo.
    pub view_count: u32,
    /// What motion vectors mean.
    pub motion: crate::convention::MotionConvention,
    /// What depth values mean.
    pub depth: crate::convention::DepthConvention,
}

impl ContextDesc {
    /// Largest accepted side of a view, in pixels.
    pub const MAX_SIDE: u32 = 16384;

    /// One view of `size_px` with the default conventions: motion as previous minus current in pixels with y down, depth as
    /// linear distance.
    pub fn new(size_px: [u32; 2]) -> Self {
        Self { size_px, view_count: 1, motion: Default::default(), depth: Default::default() }
    }
}
