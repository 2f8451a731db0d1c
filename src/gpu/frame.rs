//! What the caller hands over for one frame, and what it hears back at once.

use super::MAX_VIEWS;
use crate::frame::{Exposure, Gaze, Reset, ViewFrame};
use crate::warning::Warning;
use wgpu::{Buffer, QuerySet, Texture};

/// One frame. All textures have the size of the context, one array layer a view (mono frames are plain 2D textures), one sample a
/// pixel, and the usage `TEXTURE_BINDING`.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// The foveated frame: linear color, any float format.
    pub color: &'a Texture,
    /// Depth in the context's convention: a depth format or `R32Float`. `None` switches the depth test off.
    pub depth: Option<&'a Texture>,
    /// Motion in the context's convention: `Rg16Float`, `Rg32Float` or wider. `None`: nothing moves.
    pub motion: Option<&'a Texture>,
    /// How far history may be believed: 1 as usual, 0 not at all, for what moves without vectors (video panels, particles,
    /// reflections). Any float or normalised format. `None`: 1 everywhere.
    pub trust: Option<&'a Texture>,
    /// Level of detail of the foveated frame: log2 of the block edge in pixels, any float format. `None`: as
    /// [`Settings::foveation`](crate::Settings::foveation) has it, whose `rate_far` must be the coarsest in either case: history is not
    /// matched at coarser levels.
    pub lod: Option<&'a Texture>,
    /// Noise of the color: the standard error of its luma, linear, and the number of samples that it is a mean of, at its level of
    /// detail; `Rg16Float`, `Rg32Float` or wider. Where, and only where, [`Settings::noisy`](crate::Settings::noisy) says so.
    pub noise: Option<&'a Texture>,
    /// What the user will see: the context's output format, usage `STORAGE_BINDING`.
    pub output: &'a Texture,
    /// One entry a view.
    pub views: &'a [ViewFrame],
    /// Frame counter; the random numbers follow it.
    pub index: u64,
    /// Whether the history still holds.
    pub reset: Reset,
    /// How bright its numbers are against the previous frame's.
    pub exposure: Exposure,
    /// Where the device counts what becomes of the pixels, if the caller wants to know: at least
    /// [`COUNTERS_BYTES`](crate::stats::COUNTERS_BYTES), usages `STORAGE` and `COPY_DST` (and `COPY_SRC`, to read it back).
    /// [`FrameStats::from_counters`](crate::stats::FrameStats::from_counters) reads the bytes. `None`: nothing is counted.
    pub counters: Option<&'a Buffer>,
    /// Where the device writes when the pass begins and ends, if the caller wants to time it. Needs
    /// `Features::TIMESTAMP_QUERY`.
    pub timestamps: Option<Timestamps<'a>>,
}

impl<'a> Frame<'a> {
    /// A frame that goes on from the previous one, without optional inputs.
    pub fn new(color: &'a Texture, output: &'a Texture, views: &'a [ViewFrame], index: u64) -> Self {
        Self {
            color,
            depth: None,
            motion: None,
            trust: None,
            lod: None,
            noise: None,
            output,
            views,
            index,
            reset: Reset::None,
            exposure: Exposure::Same,
            counters: None,
            timestamps: None,
        }
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

/// What is known of a frame as soon as it is recorded. Free to ignore; what only the pixels know is in
/// [`FrameStats::warnings`](crate::stats::FrameStats::warnings).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Recorded {
    gaze: [Option<Warning>; MAX_VIEWS],
}

impl Recorded {
    /// What is odd about the frame's description, view by view.
    pub fn warnings(&self) -> impl Iterator<Item = Warning> + use<> {
        self.gaze.into_iter().flatten()
    }

    /// What there is to say about the gaze of view `view`; `held` is the one from before.
    pub(super) fn note(&mut self, view: usize, facts: &ViewFrame, held: Option<[f32; 2]>) {
        let size = facts.geometry.size_px().map(|s| s as f32);
        self.gaze[view] = match facts.gaze {
            Gaze::At { px } if px.iter().all(|v| v.is_finite()) => {
                let inside = |i: usize| (-0.5..size[i] - 0.5).contains(&px[i]);
                (!(inside(0) && inside(1))).then_some(Warning::GazeOffScreen { view })
            }
            _ if held.is_some() => Some(Warning::GazeHeld { view }),
            _ => Some(Warning::GazeUnknown { view }),
        };
    }
}
