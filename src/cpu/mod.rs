//! CPU executor: the post-process on images in memory, for machines without a GPU and as the reference of the GPU
//! executor.
//!
//! Rows of pixels are processed in parallel; the result does not depend on the number of threads.

mod doctor;
mod doctor_pass;
mod explain;
mod frame;
pub(crate) mod history;
mod input_notes;
mod inputs;
mod levels;
mod pass;
mod pixel;
mod planned;
mod quads;
mod resize;

// For this workspace's other crates, as `CpuAfterimage::process_traced`.
#[doc(hidden)]
pub use crate::kernel::debug_view::PixelTrace;
pub use doctor::Doctor;
pub use frame::Frame;

use crate::context::{ContextDesc, check_size};
use crate::error::{FrameError, SettingsError};
use crate::gaze::Gaze;
use crate::geometry::ViewGeometry;
use crate::image::Image;
use crate::method::{Algorithm, HistoryLayout, Stage};
use crate::notes::PixelNotes;
use crate::resize::Resize;
use crate::settings::Settings;
use crate::stats::FrameStats;
use frame::{check_geometry, check_inputs, check_sizes};
use history::History;
use levels::{fill, none_pass, smr_pass, surface_pass, taa_pass, taau_pass, wrs_pass};
use pass::{Alpha, Pass};
use planned::Planned;

/// The post-process on the CPU: a context with its settings and history.
///
/// ```
/// use afterimage::cpu::{CpuAfterimage, Frame};
/// use afterimage::internal::{ContextDesc, ViewFrame};
/// use afterimage::{Gaze, Image, ViewGeometry};
///
/// let size = [64, 36];
/// let mut post = CpuAfterimage::new(&ContextDesc::new(size))?;
/// let foveated = Image::filled(size, [0.5, 0.25, 0.125]);
/// let views = [ViewFrame::new(ViewGeometry::flat(size, 70.0)?, Gaze::At { px: [40.0, 18.0] })];
/// let mut shown = [Image::filled(size, [0.0; 3])];
/// post.process(&Frame::new(&[&foveated], &views, 0), &mut shown)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct CpuAfterimage {
    desc: ContextDesc,
    history: History,
    planned: Option<Planned>,
}

// For tests and the lab.
#[doc(hidden)]
impl CpuAfterimage {
    /// Processes a planned frame as [`process_traced`](Self::process_traced) does, with alpha: the twin of what
    /// a GPU does with [`ContextDesc::keep_alpha`]. `alpha`: of the colors; `shown_alpha`: of the output;
    /// one image of the context's size a view each.
    ///
    /// # Errors
    /// As for [`process`](Self::process).
    ///
    /// # Panics
    /// With another method or foveation.
    pub fn process_alpha(
        &mut self,
        frame: &Frame<'_>,
        alpha: &[&Image<f32>],
        output: &mut [Image<[f32; 3]>],
        shown_alpha: &mut [Image<f32>],
        traces: Option<&mut [Image<PixelTrace>]>,
    ) -> Result<FrameStats, FrameError> {
        assert_eq!(self.desc.settings.algorithm(), Algorithm::Reconstruction);
        check_sizes(&self.desc, "alpha", alpha, self.desc.size_px)?;
        check_sizes(&self.desc, "alpha", shown_alpha, self.desc.size_px)?;
        self.history.keep_alpha();
        self.run(frame, output, Some(Alpha { given: alpha, output: shown_alpha }), traces, None)
    }

    /// History.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Overwrites history with packed reservoirs ([`stored_reservoir`](crate::kernel::stored_reservoir)), for tests
    /// that start from a known state.
    ///
    /// # Panics
    /// If `words` and the history differ in length.
    pub fn restore_history(&mut self, words: &[[u32; 3]]) {
        self.history.restore(words);
    }

    /// Processes one frame as [`process_traced`](Self::process_traced) does, and notes all that is known of one pixel.
    ///
    /// # Errors
    /// As for `process`.
    pub fn process_noted(
        &mut self,
        frame: &Frame<'_>,
        output: &mut [Image<[f32; 3]>],
        traces: Option<&mut [Image<PixelTrace>]>,
        pixel: &mut PixelNotes,
    ) -> Result<FrameStats, FrameError> {
        self.run(frame, output, None, traces, Some(pixel))
    }
}

impl CpuAfterimage {
    /// A context without history.
    ///
    /// # Errors
    /// [`SettingsError`] if the description is out of range: a setting, the depth convention, the size or the number of
    /// views.
    pub fn new(desc: &ContextDesc) -> Result<Self, SettingsError> {
        desc.validate()?;
        Ok(Self { desc: *desc, history: History::new(desc), planned: None })
    }

    /// Description of the context, with its current size and settings.
    pub fn desc(&self) -> &ContextDesc {
        &self.desc
    }

    /// Gaze position in pixels that [`process`](Self::process) would use for view `view` of the next frame: `gaze` if
    /// it is known, else the last known one, else the middle of the view. Renderers that foveate need it before that
    /// call.
    pub fn gaze_px(&self, view: usize, geometry: &ViewGeometry, gaze: Gaze) -> [f32; 2] {
        gaze.resolve(self.history.held_gaze_px(view), geometry)
    }

    /// Changes the settings from the next frame on.
    ///
    /// History survives, unless its layout changes: with another [`method`](Settings::method), with
    /// [`noisy`](Settings::noisy), for wrs with its [`sampler`](crate::internal::Wrs::sampler) and the scale of its
    /// [`gate`](crate::internal::Wrs::gate), and for smr with `rate_far` and `filter` of the
    /// [`foveation`](Settings::foveation).
    ///
    /// # Errors
    /// [`SettingsError`] if a setting is out of range; then the settings are unchanged.
    pub fn set_settings(&mut self, settings: Settings) -> Result<(), SettingsError> {
        settings.validate()?;
        self.desc.check_albedo(&settings)?;
        self.planned = None;
        let keeps_history = settings.keeps_history_of(&self.desc.settings);
        self.desc.settings = settings;
        if settings.history_layout() != self.history.layout() {
            self.history = History::new(&self.desc);
        } else if !keeps_history {
            self.history.forget();
        }
        Ok(())
    }

    /// Changes the size of the views, and discards history even if the size is the same;
    /// [`resize_keeping_history`](Self::resize_keeping_history) keeps it.
    ///
    /// # Errors
    /// [`FrameError::Extent`] if a side is 0 or above [`ContextDesc::MAX_SIDE`]; then nothing changes.
    pub fn resize(&mut self, size_px: [u32; 2]) -> Result<(), FrameError> {
        check_size(size_px)?;
        self.desc.size_px = size_px;
        self.planned = None;
        self.history = History::new(&self.desc);
        Ok(())
    }

    /// Changes the size of the views and resamples history to it, for dynamic resolution. The view directions at the
    /// edges should stay the same. Reservoirs of wrs, and stored samples of planned frames with their places, are taken
    /// from the nearest pixel. Surfaces of taa, taau and smr are filtered. Levels of detail follow the scale.
    ///
    /// # Errors
    /// As for [`resize`](Self::resize).
    pub fn resize_keeping_history(&mut self, size_px: [u32; 2]) -> Result<(), FrameError> {
        check_size(size_px)?;
        let resize = Resize::new(self.desc.size_px, size_px);
        self.desc.size_px = size_px;
        self.planned = None;
        self.history = self.history.resized(&resize, &self.desc);
        Ok(())
    }

    /// Discards history and held gaze positions: the next frame is processed like the first one.
    /// [`Reset::All`](crate::internal::Reset::All) does the same as part of a frame, but keeps the gaze.
    pub fn forget(&mut self) {
        self.planned = None;
        self.history.forget();
    }

    /// Size in bytes of the buffers that the context holds between frames. It is larger than on a GPU, because the CPU
    /// stores mip chains as floats, and a GPU stores them as halves.
    pub fn memory_bytes(&self) -> usize {
        self.history.memory_bytes()
    }

    /// Processes one frame into `output`: linear colors, one image of the context's size a view.
    ///
    /// # Errors
    /// [`FrameError`] if a size, a number of images or a value does not fit the context; then nothing is written and
    /// history is unchanged.
    pub fn process(&mut self, frame: &Frame<'_>, output: &mut [Image<[f32; 3]>]) -> Result<FrameStats, FrameError> {
        self.run(frame, output, None, None, None)
    }

    /// Processes one frame as [`process`](Self::process) does, and writes the decision at each pixel to `traces`, one
    /// image a view.
    ///
    /// # Errors
    /// As for `process`.
    #[doc(hidden)]
    pub fn process_traced(
        &mut self,
        frame: &Frame<'_>,
        output: &mut [Image<[f32; 3]>],
        traces: &mut [Image<PixelTrace>],
    ) -> Result<FrameStats, FrameError> {
        self.run(frame, output, None, Some(traces), None)
    }

    /// Pixels to shade of a [planned frame](crate::internal::FoveationKind::Quads), one mask a view: quads of 2x2
    /// pixels, or [single pixels](crate::internal::Foveation::single_pixels). Give the frame to
    /// [`process`](Self::process) with a color of the context's size, in which these pixels are shaded. Without history
    /// the plan is a quarter of the pixels ([`is_quarter`](Self::is_quarter)), unless the foveation shades more.
    ///
    /// All quads of the fovea are chosen, an even pattern outside it that visits every quad in turn, and at most the
    /// share [`Foveation::budget`](crate::internal::Foveation::budget) of a view's quads where history lacks most.
    ///
    /// Give it the frame that will be processed, with the parts that are known before shading: views, depth, motion,
    /// trust or reactive mask, index and reset. Its colors and noise are not read, and the colors may be an empty
    /// slice. History is unchanged: the same call gives the same masks.
    ///
    /// ```
    /// use afterimage::cpu::{CpuAfterimage, Frame};
    /// use afterimage::internal::{ContextDesc, Foveation, ViewFrame};
    /// use afterimage::{Gaze, Image, ViewGeometry};
    ///
    /// let size = [64, 36];
    /// let mut desc = ContextDesc::new(size);
    /// desc.settings.foveation = Foveation::quads();
    /// let mut post = CpuAfterimage::new(&desc)?;
    /// let views = [ViewFrame::new(ViewGeometry::flat(size, 70.0)?, Gaze::At { px: [40.0, 18.0] })];
    /// let masks = post.plan(&Frame::new(&[], &views, 0))?;
    /// // Here the renderer shades the pixels of the mask.
    /// let shaded = Image::filled(size, [0.5; 3]);
    /// let mut shown = [Image::filled(size, [0.0; 3])];
    /// post.process(&Frame::new(&[&shaded], &views, 0), &mut shown)?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`FrameError`] if the foveation is not [`Quads`](crate::internal::FoveationKind::Quads), and as for `process`.
    pub fn plan(&mut self, frame: &Frame<'_>) -> Result<&[Image<bool>], FrameError> {
        frame.check_plan(&self.desc)?;
        check_geometry(&self.desc, frame)?;
        Ok(&self.planned.insert(Planned::new(&self.desc, &self.history, frame)).masks)
    }

    /// Number of paths to trace at each pixel of the last [`plan`](Self::plan), one image a view: 0 where no path is
    /// traced, at most 16; empty without a plan. With [`noisy`](crate::internal::Settings::noisy) a chosen pixel
    /// outside the fovea has as many as take more off its squared error, history included, than others; the
    /// [`budget`](crate::internal::Foveation::budget) counts all of them but the even pattern's first. Otherwise each
    /// chosen pixel has one.
    pub fn paths(&self) -> &[Image<u8>] {
        self.planned.as_ref().map_or(&[], |planned| &planned.paths)
    }

    /// Whether the last [`plan`](Self::plan) chose one pixel of each quad outside the fovea, because nothing was known:
    /// in the first frame and after a reset. These pixels can be drawn at half the width and height
    /// ([`ViewGeometry::half`](crate::ViewGeometry::half)), and given so
    /// ([`half`](crate::internal::FrameInputs::half)).
    pub fn is_quarter(&self) -> bool {
        self.planned.as_ref().is_some_and(|planned| planned.is_quarter)
    }

    fn run(
        &mut self,
        frame: &Frame<'_>,
        output: &mut [Image<[f32; 3]>],
        alpha: Option<Alpha<'_>>,
        traces: Option<&mut [Image<PixelTrace>]>,
        mut noted: Option<&mut PixelNotes>,
    ) -> Result<FrameStats, FrameError> {
        check_inputs(&self.desc, frame)?;
        frame.check_planned(&self.desc, self.planned.as_ref().map(|planned| planned.index))?;
        let given = frame.mask.map(|masks| planned::given_quads(&self.desc, masks));
        let planned = self.planned.as_ref().map(|planned| &planned.quads);
        let quads = given.as_ref().or(planned).map_or(&[][..], |quads| quads);
        check_sizes(&self.desc, "output", output, self.desc.size_px)?;
        traces.as_deref().map_or(Ok(()), |traces| check_sizes(&self.desc, "traces", traces, self.desc.size_px))?;
        let fills = self.desc.settings.stages().contains(&Stage::Fill);
        let filled = if fills { fill::filled(frame, self.desc.size_px, quads) } else { vec![] };
        let filled: Vec<_> = filled.iter().collect();
        let whole = match filled.is_empty() {
            true => *frame,
            false => Frame { half: None, ..frame.with_color(&filled) },
        };
        let (given, frame, history) = (frame, &whole, &mut self.history);
        if let Some(pixel) = &mut noted {
            pixel.notes.clear();
            input_notes::note_inputs(&self.desc, given, frame, history, quads, pixel);
        }
        let pass = Pass { desc: &self.desc, history, frame, quads, output, alpha, traces, noted: noted.as_deref_mut() };
        let stats = match self.desc.settings.algorithm() {
            Algorithm::None => none_pass::run(pass),
            Algorithm::Taa => surface_pass::run(pass, &taa_pass::Taa),
            Algorithm::Taau => surface_pass::run(pass, &taau_pass::Taau),
            Algorithm::Smr => surface_pass::run(pass, &smr_pass::Smr::new(&self.desc.settings)),
            Algorithm::Reconstruction => planned::run(pass),
            Algorithm::Wrs => wrs_pass::run(pass),
        };
        if let Some(pixel) = noted {
            pixel.notes.sort_by_key(|note| note.stage);
        }
        self.planned = None;
        if self.history.layout() == HistoryLayout::Nothing {
            for i in 0..frame.views.len() {
                self.history.advance(i, frame);
            }
        } else {
            self.history.swap();
        }
        Ok(stats)
    }
}
