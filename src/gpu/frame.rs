//! Inputs and outputs of one frame on a GPU.

use super::{Afterimage, MAX_VIEWS};
use crate::frame::{Gaze, ViewFrame};
use crate::warning::Warning;
use wgpu::{Buffer, QuerySet, Texture};

/// A frame whose inputs are textures; fields and an example are at [`Frame`](crate::Frame).
///
/// All textures have the context's size, one array layer for each view (a plain 2D texture for one view), one sample a
/// pixel, and the usage `TEXTURE_BINDING`.
pub type Frame<'a> = crate::Frame<'a, Afterimage>;

/// Outputs of [`record`](Afterimage::record): a texture, and optionally counters and timestamps. `record` also accepts
/// the texture alone.
///
/// ```
/// # use afterimage::wgpu;
/// # fn example<'a>(output: &'a wgpu::Texture, counters: &'a wgpu::Buffer) {
/// use afterimage::gpu::Target;
///
/// let target = Target { counters: Some(counters), ..Target::new(output) };
/// # let _ = target;
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Target<'a> {
    /// Output frame: a texture of the context's size, layers and output format, with the usage `STORAGE_BINDING`. Color
    /// is linear, as the input's; alpha is 1.
    pub output: &'a Texture,
    /// Buffer for pixel counters, which [`FrameStats::from_counters`](crate::FrameStats::from_counters) reads: at least
    /// [`COUNTERS_BYTES`](crate::COUNTERS_BYTES), usages `STORAGE` and `COPY_DST` (and `COPY_SRC`, to read it back).
    /// `None`: nothing is counted, at no cost.
    pub counters: Option<&'a Buffer>,
    /// Timestamp queries around the passes. Needs `Features::TIMESTAMP_QUERY`.
    pub timestamps: Option<Timestamps<'a>>,
}

impl<'a> Target<'a> {
    /// An output texture without counters and timestamps.
    pub fn new(output: &'a Texture) -> Self {
        Self { output, counters: None, timestamps: None }
    }
}

impl<'a> From<&'a Texture> for Target<'a> {
    fn from(output: &'a Texture) -> Self {
        Self::new(output)
    }
}

/// Timestamp queries around the passes of a frame.
///
/// ```
/// # use afterimage::wgpu;
/// # fn example<'a>(output: &'a wgpu::Texture, queries: &'a wgpu::QuerySet) {
/// use afterimage::gpu::{Target, Timestamps};
///
/// let target = Target { timestamps: Some(Timestamps { queries, begin: 0, end: 1 }), ..Target::new(output) };
/// # let _ = target;
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Timestamps<'a> {
    /// Query set of `QueryType::Timestamp`.
    pub queries: &'a QuerySet,
    /// Index of the query written when the passes begin.
    pub begin: u32,
    /// Index of the query written when the passes end.
    pub end: u32,
}

impl<'a> Timestamps<'a> {
    /// Timestamps for a pass descriptor.
    pub(crate) fn writes(self) -> wgpu::ComputePassTimestampWrites<'a> {
        wgpu::ComputePassTimestampWrites {
            query_set: self.queries,
            beginning_of_pass_write_index: Some(self.begin),
            end_of_pass_write_index: Some(self.end),
        }
    }
}

/// Result of recording a frame: warnings about its description, which may be ignored. Warnings about pixels are in
/// [`FrameStats::warnings`](crate::FrameStats::warnings). Example: [`Afterimage::record_view`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Recorded {
    gaze: [Option<Warning>; MAX_VIEWS],
}

impl Recorded {
    /// Warnings about the gaze, view by view.
    pub fn warnings(&self) -> impl Iterator<Item = Warning> + use<> {
        self.gaze.into_iter().flatten()
    }

    /// Notes a warning about the gaze of view `view`, if any. `held`: last known position.
    pub(super) fn note_gaze(&mut self, view: usize, frame: &ViewFrame, held: Option<[f32; 2]>) {
        let size = frame.geometry.size_px().map(|s| s as f32);
        self.gaze[view] = match frame.gaze {
            Gaze::At { px } if px.iter().all(|v| v.is_finite()) => {
                let inside = |i: usize| (-0.5..size[i] - 0.5).contains(&px[i]);
                (!(inside(0) && inside(1))).then_some(Warning::GazeOffScreen { view })
            }
            _ if held.is_some() => Some(Warning::GazeHeld { view }),
            _ => Some(Warning::GazeUnknown { view }),
        };
    }
}
