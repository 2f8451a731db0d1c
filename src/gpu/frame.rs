//! Inputs and outputs of one frame on a GPU.

use super::Textures;
use super::binding::INPUTS;
use crate::frame::{FrameInputs, Images, Input};
use crate::kernel::debug_view::DebugView;
use crate::uniforms::{MAX_VIEWS, ORIGINS};
use crate::view::ViewFrame;
use crate::warning::Warning;
use wgpu::{Buffer, QuerySet, Texture};

/// A frame whose inputs are textures; fields and an example are at [`FrameInputs`].
///
/// Textures have one sample a pixel and the usage `TEXTURE_BINDING`. [`Textures`] describes where the views lie in
/// them.
pub type Frame<'a> = FrameInputs<'a, Textures<'a>, Textures<'a>, Textures<'a>>;

impl<'a> Frame<'a> {
    /// A frame without optional inputs, which continues the previous frame: no reset, unchanged exposure.
    pub fn new(color: impl Into<Textures<'a>>, views: &'a [ViewFrame], index: u64) -> Self {
        Self::of_color(color.into(), views, index)
    }

    /// Inputs, by the numbers of their bindings.
    pub(super) fn textures(&self) -> [Option<Textures<'a>>; ORIGINS] {
        let mut all = [None; ORIGINS];
        for Input { name, images, .. } in self.inputs() {
            let input = INPUTS.iter().find(|input| input.name == name).expect("every input has a binding");
            all[input.binding as usize] = images.map(Images::textures);
        }
        all
    }

    /// Optional inputs of which the shaders know whether a frame has them: a set of [bits](Binding::bit).
    pub(super) fn present(&self) -> u32 {
        let textures = self.textures();
        let given = INPUTS.iter().filter(|input| input.has.is_some() && textures[input.binding as usize].is_some());
        given.map(|input| input.binding.bit()).sum()
    }

    /// Whether an input consists of regions.
    pub(super) fn has_regions(&self) -> bool {
        self.textures().iter().flatten().any(Textures::is_regions)
    }
}

impl<'a> Images<Textures<'a>, Textures<'a>, Textures<'a>> {
    pub(super) fn textures(self) -> Textures<'a> {
        match self {
            Self::Colors(textures) | Self::HalfColors(textures) => textures,
            Self::Scalars(textures) | Self::Vectors(textures) => textures,
        }
    }
}

/// Outputs of a frame, for `show` or `record` of either door: the picture, and optionally a debug view, counters and
/// timestamps. Both also accept a texture alone.
///
/// ```
/// # use afterimage::wgpu;
/// # fn example<'a>(output: &'a wgpu::Texture, view: &'a wgpu::Texture, counters: &'a wgpu::Buffer) {
/// use afterimage::DebugView;
/// use afterimage::gpu::{DebugTarget, Target};
///
/// let debug = Some(DebugTarget { view: DebugView::Rejection, output: view.into() });
/// let target = Target { debug, counters: Some(counters), ..Target::new(output) };
/// # let _ = target;
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Target<'a> {
    /// Output frame, of the context's output format, with the usage `STORAGE_BINDING`. Its color is linear, like the
    /// input's. Its alpha is the input's, or 1 (`keep_alpha` of the description).
    pub output: Textures<'a>,
    /// Debug view of the frame's decisions, drawn by the same pass. `None`: no view, at no cost.
    pub debug: Option<DebugTarget<'a>>,
    /// Buffer for pixel counters, which [`FrameStats::from_counters`](crate::FrameStats::from_counters) reads: at least
    /// [`FrameStats::COUNTERS_BYTES`](crate::FrameStats::COUNTERS_BYTES), usages `STORAGE` and `COPY_DST` (and
    /// `COPY_SRC`, to read it back). `None`: nothing is counted, at no cost.
    pub counters: Option<&'a Buffer>,
    /// Timestamp queries around the passes. Needs `Features::TIMESTAMP_QUERY`.
    pub timestamps: Option<Timestamps<'a>>,
}

/// Debug view beside the output frame. Example: [`Target`].
///
/// The device needs the limit `max_storage_textures_per_shader_stage` of 5.
/// [`levels::Afterimage::record_view`](crate::levels::Afterimage::record_view) needs 4.
#[derive(Clone, Copy, Debug)]
pub struct DebugTarget<'a> {
    /// View to draw.
    pub view: DebugView,
    /// Where to draw it: `Rgba16Float`, with the usage `STORAGE_BINDING`. Linear color.
    pub output: Textures<'a>,
}

impl<'a> Target<'a> {
    /// An output frame without debug view, counters and timestamps.
    pub fn new(output: impl Into<Textures<'a>>) -> Self {
        Self { output: output.into(), debug: None, counters: None, timestamps: None }
    }

    /// Whether an output consists of regions.
    pub(super) fn has_regions(&self) -> bool {
        self.output.is_regions() || self.debug.is_some_and(|d| d.output.is_regions())
    }
}

impl<'a> From<&'a Texture> for Target<'a> {
    fn from(output: &'a Texture) -> Self {
        Self::new(output)
    }
}

impl<'a> From<Textures<'a>> for Target<'a> {
    fn from(output: Textures<'a>) -> Self {
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
/// [`FrameStats::warnings`](crate::FrameStats::warnings). Example:
/// [`levels::Afterimage::record_view`](crate::levels::Afterimage::record_view).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Recorded {
    gaze: [Option<Warning>; MAX_VIEWS],
}

impl Recorded {
    /// Warnings about the gaze, view by view.
    pub fn warnings(&self) -> impl Iterator<Item = Warning> + use<> {
        self.gaze.into_iter().flatten()
    }

    /// Notes a warning about the gaze of view `view`, if any. `last_px`: last known position.
    pub(super) fn note_gaze(&mut self, view: usize, frame: &ViewFrame, last_px: Option<[f32; 2]>) {
        let size = frame.geometry.size_px().map(|s| s as f32);
        self.gaze[view] = match frame.gaze.known_px(&frame.geometry) {
            Some(px) => {
                let inside = |i: usize| (-0.5..size[i] - 0.5).contains(&px[i]);
                (!(inside(0) && inside(1))).then_some(Warning::GazeOffScreen { view })
            }
            _ if last_px.is_some() => Some(Warning::GazeHeld { view }),
            _ => Some(Warning::GazeUnknown { view }),
        };
    }
}
