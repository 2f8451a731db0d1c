//! The CPU executor: the post-process on machines without a GPU, and the oracle of the GPU's passes.
//!
//! A pass is a loop over pixels plus calls into [`kernel`](crate::kernel). Rows run in parallel; the result does not depend on
//! the number of threads.

mod chain;
mod history;
mod inputs;
mod remembered;
mod smr_pass;
mod surface_pass;
mod taa_pass;
mod wrs_pass;

pub use history::History;

use crate::error::{FrameError, SettingsError};
use crate::frame::{ContextDesc, Exposure, Reset, ViewFrame, check_size};
use crate::image::Image;
use crate::kernel::debug_view::PixelTrace;
use crate::kernel::reproject::Verdict;
use crate::kernel::scrub;
use crate::settings::{Method, Settings};
use crate::stats::FrameStats;
use glam::Vec3;

/// Inputs of one view of one frame.
#[derive(Clone, Copy, Debug)]
pub struct CpuView<'a> {
    /// Geometry, gaze and camera motion.
    pub facts: ViewFrame,
    /// The foveated frame: linear color in Rec. 709 primaries. Non-finite pixels are dropped and counted.
    pub color: &'a Image<[f32; 3]>,
    /// Depth in the context's convention. `None` switches the depth test off.
    pub depth: Option<&'a Image<f32>>,
    /// Motion in the context's convention. `None`: nothing moves.
    pub motion: Option<&'a Image<[f32; 2]>>,
    /// How far history may be believed: 1 as usual, 0 not at all, for what moves without vectors (video panels, particles,
    /// reflections). `None`: 1 everywhere.
    pub trust: Option<&'a Image<f32>>,
    /// Level of detail of the foveated frame: log2 of the block edge in pixels. `None`: as [`Settings::foveation`] has it,
    /// whose `rate_far` must be the coarsest in either case: history is not matched at coarser levels.
    pub lod: Option<&'a Image<f32>>,
    /// Noise of the color: the standard error of its luma, linear, and the number of samples that it is a mean of, at its level of
    /// detail. Where, and only where, [`Settings::noisy`] says so.
    pub noise: Option<&'a Image<[f32; 2]>>,
}

impl<'a> CpuView<'a> {
    /// A view without optional inputs.
    pub fn new(facts: ViewFrame, color: &'a Image<[f32; 3]>) -> Self {
        Self { facts, color, depth: None, motion: None, trust: None, lod: None, noise: None }
    }
}

/// One frame.
#[derive(Clone, Copy, Debug)]
pub struct CpuFrame<'a> {
    /// One entry a view.
    pub views: &'a [CpuView<'a>],
    /// Frame counter; the random numbers follow it.
    pub index: u64,
    /// Whether the history still holds.
    pub reset: Reset,
    /// How bright its numbers are against the previous frame's.
    pub exposure: Exposure,
}

impl<'a> CpuFrame<'a> {
    /// A frame that goes on from the previous one.
    pub fn new(views: &'a [CpuView<'a>], index: u64) -> Self {
        Self { views, index, reset: Reset::None, exposure: Exposure::Same }
    }
}

/// The post-process on the CPU. Owns nothing but settings and history.
#[derive(Clone, Debug)]
pub struct CpuAfterimage {
    desc: ContextDesc,
    settings: Settings,
    history: History,
}

impl CpuAfterimage {
    /// A context with an empty history.
    ///
    /// # Errors
    /// If a setting or the depth convention is out of range, or the size is empty or beyond [`ContextDesc::MAX_SIDE`].
    pub fn new(desc: ContextDesc, settings: Settings) -> Result<Self, SettingsError> {
        settings.validate()?;
        desc.validate()?;
        let history = History::new(desc.size_px, desc.view_count, settings.history_layout());
        Ok(Self { desc, settings, history })
    }

    /// What it was made for.
    pub fn desc(&self) -> &ContextDesc {
        &self.desc
    }

    /// The tunables in force.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Changes the tunables from the next frame on. History survives, unless the sampler or the method changes.
    ///
    /// # Errors
    /// If a setting is out of range; then the old ones stay.
    pub fn set_settings(&mut self, settings: Settings) -> Result<(), SettingsError> {
        settings.validate()?;
        if settings.history_layout() != self.history.layout() {
            self.history = History::new(self.desc.size_px, self.desc.view_count, settings.history_layout());
        } else if settings.method != self.settings.method {
            self.history.forget();
        }
        self.settings = settings;
        Ok(())
    }

    /// Changes the size of the views. The history starts afresh, even if the size is the same.
    ///
    /// # Errors
    /// [`FrameError::Extent`]; then nothing changes.
    pub fn resize(&mut self, size_px: [u32; 2]) -> Result<(), FrameError> {
        check_size(size_px)?;
        self.desc.size_px = size_px;
        self.history = History::new(size_px, self.desc.view_count, self.settings.history_layout());
        Ok(())
    }

    /// Forgets the history: the next frame starts afresh.
    pub fn forget(&mut self) {
        self.history.forget();
    }

    /// The state between frames.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Overwrites the history with packed reservoirs ([`pack`](crate::kernel::pack)), to start from a known state.
    ///
    /// # Panics
    /// If `words` has another length than the history's.
    pub fn restore_history(&mut self, words: &[[u32; 3]]) {
        self.history.restore(words);
    }

    /// Bytes that the pass reads and writes a pixel for such inputs, were they stored as engines store them: half-float color
    /// (8), half-float motion (4), depth (4), trust (1). The depth test's extra taps are not counted: they are neighbours', and few.
    pub fn traffic_bytes_per_pixel(&self, view: &CpuView<'_>) -> u32 {
        let given = [view.depth.is_some(), view.motion.is_some(), view.trust.is_some()];
        self.settings.traffic_bytes_per_pixel(given)
    }

    /// Bytes held between frames.
    pub fn memory_bytes(&self) -> usize {
        self.history.memory_bytes()
    }

    /// Processes one frame into `output`, one image of the context's size a view. `trace`, if given, receives what was decided
    /// at each pixel (one image a view), which [`view_color`](crate::kernel::debug_view::view_color) makes visible.
    ///
    /// # Errors
    /// If sizes or counts do not match the context; then nothing is written and the history is as before.
    pub fn process(
        &mut self,
        frame: &CpuFrame<'_>,
        output: &mut [Image<[f32; 3]>],
        trace: Option<&mut [Image<PixelTrace>]>,
    ) -> Result<FrameStats, FrameError> {
        self.check(frame, output, trace.as_deref())?;
        match self.settings.method {
            Method::None => {
                self.history.forget();
                Ok(pass_through(&self.desc, frame, output, trace))
            }
            Method::Taa | Method::Smr => {
                let stats = surface_pass::run(&self.desc, &self.settings, &mut self.history, frame, output, trace);
                self.history.swap();
                Ok(stats)
            }
            Method::Wrs => {
                let stats = wrs_pass::run(&self.desc, &self.settings, &mut self.history, frame, output, trace);
                self.history.swap();
                Ok(stats)
            }
        }
    }

    fn check(
        &self,
        frame: &CpuFrame<'_>,
        output: &[Image<[f32; 3]>],
        trace: Option<&[Image<PixelTrace>]>,
    ) -> Result<(), FrameError> {
        let expected = self.desc.view_count as usize;
        let trace_count = trace.map_or(expected, <[_]>::len);
        for found in [frame.views.len(), output.len(), trace_count] {
            if found != expected {
                return Err(FrameError::ViewCount { found, expected });
            }
        }
        for (i, view) in frame.views.iter().enumerate() {
            let sizes = [
                ("color", Some(view.color.size())),
                ("depth", view.depth.map(Image::size)),
                ("motion", view.motion.map(Image::size)),
                ("trust", view.trust.map(Image::size)),
                ("lod", view.lod.map(Image::size)),
                ("noise", view.noise.map(Image::size)),
                ("output", Some(output[i].size())),
                ("trace", trace.map(|t| t[i].size())),
            ];
            for (input, size) in sizes {
                if let Some(found) = size.filter(|&s| s != self.desc.size_px) {
                    return Err(FrameError::Size { input, view: i, found, expected: self.desc.size_px });
                }
            }
            view.facts.check(i, &self.desc)?;
            self.settings.check_noise(i, view.noise.is_some())?;
        }
        frame.exposure.check()
    }
}

/// Method `none`: what came, scrubbed.
fn pass_through(
    desc: &ContextDesc,
    frame: &CpuFrame<'_>,
    output: &mut [Image<[f32; 3]>],
    mut trace: Option<&mut [Image<PixelTrace>]>,
) -> FrameStats {
    let mut stats = FrameStats::default();
    let [sx, sy] = desc.motion.to_internal(desc.size_px);
    for (i, (view, out)) in frame.views.iter().zip(output).enumerate() {
        for (src, dst) in view.color.pixels().iter().zip(out.pixels_mut()) {
            let (color, valid) = scrub::color(Vec3::from(*src));
            *dst = color.to_array();
            stats.nonfinite += u64::from(!valid);
        }
        if let Some(trace) = &mut trace {
            trace[i] = match view.motion {
                Some(motion) => motion.map(|m| PixelTrace { motion: [m[0] * sx, m[1] * sy], ..PixelTrace::default() }),
                None => Image::filled(desc.size_px, PixelTrace::default()),
            };
        }
        stats.pixels += view.color.pixels().len() as u64;
    }
    stats.verdicts[Verdict::Reset as usize] = stats.pixels;
    stats
}
