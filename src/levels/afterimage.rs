//! The context for full-size frames with levels of detail, on a GPU.

use super::{Desc, Settings};
use crate::error::{CreateError, FrameError, SettingsError};
use crate::gaze::Gaze;
use crate::geometry::ViewGeometry;
use crate::gpu::frame::Frame;
use crate::gpu::{self, Recorded, Target};
use crate::kernel::debug_view::DebugView;
use wgpu::{CommandEncoder, Device, Limits};

/// The post-process for full-size frames with levels of detail, on a GPU: a context with its settings, history and
/// pipelines. The [module's page](super) has an example; `examples/07_levels.rs` is the smallest program.
///
/// Several frames can be recorded into one encoder; they are processed in that order. Submit recorded frames once, in
/// the order in which they were recorded. A frame may also be dropped with its encoder, if the surface is outdated, for
/// example: the device knows which frame its history is of, and the frame after a dropped one starts without history,
/// as after [`Reset::All`](super::Reset::All).
#[derive(Debug)]
pub struct Afterimage {
    device: Device,
    desc: Desc,
    post: gpu::Afterimage,
}

impl Afterimage {
    /// A context without history on `device`, which it keeps a handle of. Creates shader modules; pipelines are
    /// compiled by [`prewarm`](Self::prewarm), or at the first frame that needs them.
    ///
    /// # Errors
    /// [`CreateError`] if the description is out of range, the output format is not supported, a limit of the device is
    /// too low, or its backend cannot store history. Then nothing was made.
    pub fn new(device: &Device, desc: &Desc) -> Result<Self, CreateError> {
        let post = gpu::Afterimage::new(device, &desc.passes(), desc.output)?;
        Ok(Self { device: device.clone(), desc: *desc, post })
    }

    /// Limits that a device needs at least for a context of this size: those of small devices
    /// (`Limits::downlevel_defaults`), with textures as large as the context's. Request them together with what the
    /// rest of the program needs, such as WebGPU's defaults, and with those of the largest size if the size changes.
    ///
    /// ```
    /// use afterimage::levels::{Afterimage, Desc};
    /// use afterimage::wgpu;
    ///
    /// let least = Afterimage::required_limits(&Desc::new([1920, 1080], wgpu::TextureFormat::Rgba16Float));
    /// assert_eq!(least.max_texture_dimension_2d, 1920);
    /// let both = least.or_better_values_from(&wgpu::Limits::default());
    /// assert_eq!(both, wgpu::Limits::default());
    /// ```
    pub fn required_limits(desc: &Desc) -> Limits {
        gpu::Afterimage::required_limits(&desc.passes())
    }

    /// Description of the context, with its current size and settings.
    pub fn desc(&self) -> &Desc {
        &self.desc
    }

    /// Changes the settings from the next frame on.
    ///
    /// History survives, unless its layout changes: with another [`method`](Settings::method), with
    /// [`noisy`](Settings::noisy), for wrs with its [`sampler`](super::Wrs::sampler) and the scale of its
    /// [`gate`](super::Wrs::gate), and for smr with `rate_far` and `filter` of the [`foveation`](Settings::foveation).
    ///
    /// # Errors
    /// [`SettingsError`] if a setting is out of range, or if a limit of the device is too low for the settings at the
    /// context's size; then nothing changes.
    pub fn set_settings(&mut self, settings: Settings) -> Result<(), SettingsError> {
        self.post.set_settings(&self.device, settings.passes())?;
        self.desc.settings = settings;
        Ok(())
    }

    /// Changes the size of the views, and discards history even if the size is the same;
    /// [`resize_keeping_history`](Self::resize_keeping_history) keeps it.
    ///
    /// # Errors
    /// [`FrameError::Extent`] if a side is 0, above 16384, or more than the device allows,
    /// [`FrameError::Limit`] if another limit of the device is too low for the size; then nothing changes.
    pub fn resize(&mut self, size_px: [u32; 2]) -> Result<(), FrameError> {
        self.post.resize(&self.device, size_px)?;
        self.desc.size_px = size_px;
        Ok(())
    }

    /// Changes the size of the views and resamples history to it, for dynamic resolution. The view directions at the
    /// edges should stay the same. Reservoirs of wrs are taken from the nearest pixel, surfaces of taa and smr are
    /// filtered. Levels of detail follow the scale.
    ///
    /// Records a pass into `encoder`. The first call compiles its pipeline. Without history it records nothing. If
    /// `encoder` is dropped, the next frame has no history.
    ///
    /// # Errors
    /// As for [`resize`](Self::resize).
    pub fn resize_keeping_history(
        &mut self,
        encoder: &mut CommandEncoder,
        size_px: [u32; 2],
    ) -> Result<(), FrameError> {
        self.post.resize_keeping_history(&self.device, encoder, size_px)?;
        self.desc.size_px = size_px;
        Ok(())
    }

    /// Discards history and held gaze positions: the next frame is processed like the first one. For another scene or
    /// another user; no frame need follow. [`Reset::All`](super::Reset::All) does the same as part of a frame, but
    /// keeps the gaze. What was discarded never comes back, even if the next recorded frame is never submitted.
    pub fn forget(&mut self) {
        self.post.forget();
    }

    /// Gaze position in pixels that [`record`](Self::record) would use for view `view` of the next frame: `gaze` if it
    /// is known, else the last known one, else the middle of the view. The renderer foveates by it.
    pub fn gaze_px(&self, view: usize, geometry: &ViewGeometry, gaze: Gaze) -> [f32; 2] {
        self.post.gaze_px(view, geometry, gaze)
    }

    /// Compiles the pipelines for frames that have the same inputs and outputs as `frame` and `target`, so that
    /// [`record`](Self::record) does not have to: while loading, and again after [`set_settings`](Self::set_settings).
    /// Each combination of inputs has its own pipelines; the contents of the textures do not matter.
    ///
    /// Drivers may finish compilation at the first dispatch (software Vulkan does): record a frame while loading to
    /// force that, too.
    ///
    /// ```no_run
    /// # use afterimage::wgpu::Texture;
    /// # use afterimage::levels::{Afterimage, Frame};
    /// # fn example(post: &Afterimage, [depth, motion, output]: [&Texture; 3], frame: &Frame<'_>) {
    /// // While loading. Depth and motion are missing in the first frame after a cut.
    /// post.prewarm(frame, output);
    /// post.prewarm(&Frame { depth: Some(depth.into()), motion: Some(motion.into()), ..*frame }, output);
    /// # }
    /// ```
    pub fn prewarm<'t>(&self, frame: &Frame<'_>, target: impl Into<Target<'t>>) {
        self.post.prewarm(&self.device, frame, target);
    }

    /// Size in bytes of the textures that the context holds between frames.
    pub fn memory_bytes(&self) -> u64 {
        self.post.memory_bytes()
    }

    /// Size in bytes of the textures that a context of this description would hold between frames.
    ///
    /// ```
    /// use afterimage::levels::{Afterimage, Desc};
    /// use afterimage::wgpu::TextureFormat;
    ///
    /// let bytes = Afterimage::memory_bytes_of(&Desc::new([1920, 1080], TextureFormat::Rgba16Float));
    /// assert_eq!(bytes / (1920 * 1080), 21);
    /// ```
    pub fn memory_bytes_of(desc: &Desc) -> u64 {
        gpu::Afterimage::memory_bytes_of(&desc.passes())
    }

    /// Records one frame into `encoder`: reads the frame's inputs and the history, and writes `target` (an output
    /// texture, or a [`Target`]) and the history. Recoverable problems are returned as warnings, which may be ignored.
    /// It never submits, polls, maps or waits.
    ///
    /// From then on this is the previous frame. If `encoder` is dropped, or submitted after a later frame, the next
    /// frame has no history; nothing else has to be done.
    ///
    /// # Errors
    /// [`FrameError`] if a texture, buffer or value does not fit the context, or if an output shares a layer of a
    /// texture with an input; [`FrameError::DeviceLost`] if the device was lost, which wgpu does not know in a browser.
    /// Then nothing was recorded and history is unchanged.
    pub fn record<'a>(
        &mut self,
        encoder: &mut CommandEncoder,
        frame: &Frame<'_>,
        target: impl Into<Target<'a>>,
    ) -> Result<Recorded, FrameError> {
        self.post.record(&self.device, encoder, frame, target)
    }

    /// A doctor that finds mistakes in the frames of view `view`, and the line of code that mends each. Its
    /// [`record`](gpu::Doctor::record) takes the same frames.
    ///
    /// # Errors
    /// [`CreateError`] if there is no such view, or a limit of the device is too low.
    pub fn doctor(&self, view: usize) -> Result<gpu::Doctor, CreateError> {
        gpu::Doctor::new(&self.device, &self.desc.passes(), view)
    }

    /// Records a debug view of the decisions that [`record`](Self::record) of the same frame will make, as linear
    /// color, into the target's output. Counters, if any, are those of `record`. History is unchanged: call it before
    /// `record`, with another output, for any number of views. A [`DebugTarget`](gpu::DebugTarget) is faster: it needs
    /// no pass of its own.
    ///
    /// ```no_run
    /// # use afterimage::levels::{Afterimage, Frame};
    /// # use afterimage::wgpu::{CommandEncoder, Texture};
    /// # fn example(
    /// #     post: &mut Afterimage, encoder: &mut CommandEncoder, frame: &Frame<'_>, [view, output]: [&Texture; 2],
    /// # ) -> Result<(), afterimage::FrameError> {
    /// use afterimage::DebugView;
    ///
    /// post.record_view(encoder, frame, view, DebugView::Rejection)?;
    /// let recorded = post.record(encoder, frame, output)?;
    /// for warning in recorded.warnings() {
    ///     eprintln!("{warning}");
    /// }
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// As for `record`.
    pub fn record_view<'a>(
        &mut self,
        encoder: &mut CommandEncoder,
        frame: &Frame<'_>,
        target: impl Into<Target<'a>>,
        view: DebugView,
    ) -> Result<Recorded, FrameError> {
        self.post.record_view(&self.device, encoder, frame, target, view)
    }
}
