//! What the caller hands over for one frame, and what it hears back at once.

use super::{Afterimage, MAX_VIEWS};
use crate::frame::{Gaze, ViewFrame};
use crate::warning::Warning;
use wgpu::{Buffer, QuerySet, Texture};

/// One frame. All textures have the size of the context, one array layer a view (mono frames are plain 2D textures), one sample a
/// pixel, and the usage `TEXTURE_BINDING`.
pub type Frame<'a> = crate::Frame<'a, Afterimage>;

/// Where [`record`](Afterimage::record) writes. A texture alone makes one: `(&output).into()`.
///
/// ```
/// # fn example<'a>(output: &'a wgpu::Texture, counters: &'a wgpu::Buffer) {
/// use afterimage::gpu::Target;
///
/// let target = Target { counters: Some(counters), ..Target::new(output) };
/// # let _ = target;
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Target<'a> {
    /// The frame that the user sees: the context's size, layers and output format, usage `STORAGE_BINDING`. Alpha is 1.
    pub output: &'a Texture,
    /// Counters, if the caller wants to know what became of the pixels: at least [`COUNTERS_BYTES`](crate::COUNTERS_BYTES), usages
    /// `STORAGE` and `COPY_DST` (and `COPY_SRC`, to read them back). [`FrameStats::from_counters`](crate::FrameStats::from_counters)
    /// reads the bytes. `None`: nothing is counted, which costs nothing.
    pub counters: Option<&'a Buffer>,
    /// Timestamps of the pass, if the caller wants to time it. Needs `Features::TIMESTAMP_QUERY`.
    pub timestamps: Option<Timestamps<'a>>,
}

impl<'a> Target<'a> {
    /// Without counters and timestamps.
    pub fn new(output: &'a Texture) -> Self {
        Self { output, counters: None, timestamps: None }
    }
}

impl<'a> From<&'a Texture> for Target<'a> {
    fn from(output: &'a Texture) -> Self {
        Self::new(output)
    }
}

/// Two queries of a set of the caller's that the device writes its clock to.
#[derive(Clone, Copy, Debug)]
pub struct Timestamps<'a> {
    /// A set of `QueryType::Timestamp`.
    pub queries: &'a QuerySet,
    /// Index of the query written when the pass begins.
    pub begin: u32,
    /// Index of the query written when it ends.
    pub end: u32,
}

impl<'a> Timestamps<'a> {
    /// As a pass descriptor takes them.
    pub(crate) fn writes(self) -> wgpu::ComputePassTimestampWrites<'a> {
        wgpu::ComputePassTimestampWrites {
            query_set: self.queries,
            beginning_of_pass_write_index: Some(self.begin),
            end_of_pass_write_index: Some(self.end),
        }
    }
}

/// Warnings that are known as soon as a frame is recorded. Free to ignore; those that only the pixels know are in
/// [`FrameStats::warnings`](crate::FrameStats::warnings).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Recorded {
    gaze: [Option<Warning>; MAX_VIEWS],
}

impl Recorded {
    /// Warnings about the frame's description, view by view.
    pub fn warnings(&self) -> impl Iterator<Item = Warning> + use<> {
        self.gaze.into_iter().flatten()
    }

    /// Notes the gaze of view `view`; `held` is the position from before.
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
