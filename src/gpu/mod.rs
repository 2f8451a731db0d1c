//! GPU executor: the post-process as compute passes in the caller's wgpu command encoder. Inputs and outputs of both
//! doors, [`Afterimage`](crate::Afterimage) and [`levels::Afterimage`](crate::levels::Afterimage), and the doctor.
//!
//! The caller owns device, queue, encoder, submission, and every input and output texture. A context owns its history
//! and pipelines. It never submits, polls, maps or waits.
//!
//! No device features are needed, and no limits beyond WebGPU's defaults except for frames larger than 8192 pixels;
//! `required_limits` says what a context needs at least. Any number of contexts can share a device. wgpu's GL backend
//! cannot store history, and is refused.

pub(crate) mod binding;
pub(crate) mod buffer;
pub(crate) mod compute;
mod doctor;
mod dump;
pub(crate) mod frame;
mod groups;
mod history;
mod input;
mod levels;
mod method_pass;
mod output;
pub(crate) mod plane;
mod planned;
mod quads;
mod recorder;
mod requirements;
mod resize;
mod stage;
mod stages;
mod textures;
pub(crate) mod uniforms;

pub use doctor::Doctor;
#[doc(hidden)]
pub use frame::Frame;
pub use frame::{DebugTarget, Recorded, Target, Timestamps};
pub(crate) use input::{check_readable, check_texture};
pub(crate) use output::texel;
#[doc(hidden)]
pub use planned::prime::Prime;
pub(crate) use requirements::validate;
pub use textures::{Region, Textures};

use crate::context::ContextDesc;
use crate::error::{CreateError, FrameError, FrameValue, SettingsError};
use crate::foveation::FoveationKind;
use crate::frame::Reset;
use crate::gaze::Gaze;
use crate::geometry::ViewGeometry;
use crate::kernel::debug_view::DebugView;
use crate::method::{HistoryLayout, PassShader};
use crate::resize::Resize;
use crate::settings::Settings;
use crate::stats::FrameStats;
use crate::uniforms::ViewState;
use binding::Binding;
use compute::Sources;
use history::History;
use planned::quad_plan::{Planned, QuadPasses};
use recorder::Recorder;
use resize::ResizePass;
use stage::{Job, Specialization};
use stages::Stages;
use uniforms::FrameUniforms;
use wgpu::{Buffer, CommandEncoder, ComputePassDescriptor, Device, Limits, Texture, TextureFormat, TextureUsages};

/// The post-process on a GPU, with every combination of options: a context with its settings, history and pipelines.
/// Both doors stand on it, and this workspace's other crates use it.
///
/// Several frames can be recorded into one encoder; they are processed in that order. Submit recorded frames once, in
/// the order in which they were recorded. A frame may also be dropped with its encoder, if the surface is outdated, for
/// example: the device knows which frame its history is of, and the frame after a dropped one starts without history,
/// as after [`Reset::All`].
#[doc(hidden)]
#[derive(Debug)]
pub struct Afterimage {
    desc: ContextDesc,
    output_format: TextureFormat,
    pass_shader: PassShader,
    stages: Stages,
    history: History,
    recorder: Recorder,
    /// Number of the settings, which increases with each change.
    generation: u64,
    /// Pass that resamples history; created at the first change of size that keeps history.
    resize: Option<ResizePass>,
    /// Passes that plan frames shaded by quads, if frames are.
    quads: Option<QuadPasses>,
}

// For tests, the lab and benchmarks.
#[doc(hidden)]
impl Afterimage {
    /// A context with other texts of its passes: for tests that plant errors, and for benchmarks.
    pub fn with_sources(
        device: &Device,
        desc: &ContextDesc,
        output_format: TextureFormat,
        sources: Sources,
    ) -> Result<Self, CreateError> {
        validate(device, desc, output_format)?;
        requirements::check_history(device)?;
        let mut context = Self {
            desc: *desc,
            output_format,
            pass_shader: desc.settings.pass_shader(),
            stages: Stages::new(device, desc, output_format, sources),
            history: History::new(device, desc),
            recorder: Recorder::new(device, desc),
            generation: 0,
            resize: None,
            quads: None,
        };
        context.update_quads(device);
        Ok(context)
    }

    /// Shader module and override values of each compiled pipeline, for tests and for tools that count instructions.
    pub fn pipelines(&self) -> Vec<(&'static str, Vec<(&'static str, u32)>)> {
        let resize = self.resize.as_ref().map(ResizePass::pipelines);
        let quads = self.quads.iter().flat_map(QuadPasses::pipelines);
        self.stages.pipelines().chain(resize.into_iter().flatten()).chain(quads).collect()
    }

    /// History textures of the last recorded frame, for tests and the lab; usages `COPY_SRC`, `COPY_DST`.
    ///
    /// For planned frames the packed samples ([`stored_sample`](crate::kernel::stored_sample), `Rg32Uint`).
    ///
    /// For wrs the packed reservoirs ([`stored_reservoir`](crate::kernel::stored_reservoir)): words 0 and 1
    /// (`Rg32Uint`), word 2 (`R32Uint`), and with A-ES the keys, or the gate's references (`R32Uint`). For taa and smr
    /// the packed surfaces ([`surface`](crate::kernel::surface), `Rg32Uint`); for smr also their mip chain
    /// (`Rgba16Float`), and for noisy candidates the packed noise ([`noise`](crate::kernel::noise), `R32Uint`).
    pub fn history_textures(&self) -> Vec<Texture> {
        self.history.split().0.planes.iter().map(|plane| plane.texture.clone()).collect()
    }

    /// Alphas of the stored samples of the last recorded frame, as floats (`R32Uint`), if the context keeps alpha and
    /// processes planned frames; usages as for [`history_textures`](Self::history_textures).
    pub fn alpha_texture(&self) -> Option<Texture> {
        self.extra_texture().filter(|_| !self.desc.has_albedo)
    }

    /// Packed albedos of these samples ([`demodulation`](crate::kernel::demodulation), `R32Uint`), if frames have
    /// albedo.
    pub fn albedo_texture(&self) -> Option<Texture> {
        self.extra_texture().filter(|_| self.desc.has_albedo)
    }

    fn extra_texture(&self) -> Option<Texture> {
        self.history.split().0.extra.as_ref().map(|plane| plane.texture.clone())
    }
}

impl Afterimage {
    /// Usage that every input texture needs.
    pub const INPUT_USAGE: TextureUsages = TextureUsages::TEXTURE_BINDING;
    /// Usage that output textures need.
    pub const OUTPUT_USAGE: TextureUsages = TextureUsages::STORAGE_BINDING;

    /// A context without history, for outputs of `output_format`: one with red, green and blue that compute shaders can
    /// write. These are `Rgba16Float`, `Rgba32Float`, `Rgba8Unorm` and `Rgba8Snorm`; `Bgra8Unorm`, `Rgba16Unorm` and
    /// `Rgba16Snorm` with their device features; `Rgb10a2Unorm` and `Rg11b10Ufloat` on adapters that can. Creates
    /// shader modules; pipelines are compiled by [`prewarm`](Self::prewarm), or at the first frame that needs them.
    ///
    /// # Errors
    /// [`CreateError`] if the description is out of range, the output format is not supported, a limit of the device is
    /// too low, or its backend cannot store history. Then nothing was made.
    pub fn new(device: &Device, desc: &ContextDesc, output_format: TextureFormat) -> Result<Self, CreateError> {
        Self::with_sources(device, desc, output_format, Sources::default())
    }

    /// Limits that a device needs at least for a context of this size: those of small devices
    /// (`Limits::downlevel_defaults`), with textures as large as the context's. Request them together with what the
    /// rest of the program needs, such as WebGPU's defaults, and with those of the largest size if the size changes.
    pub fn required_limits(desc: &ContextDesc) -> Limits {
        requirements::required_limits(desc)
    }

    /// Description of the context, with its current size and settings.
    pub fn desc(&self) -> &ContextDesc {
        &self.desc
    }

    /// Changes the settings from the next frame on.
    ///
    /// History survives, unless its layout changes: with another [`method`](Settings::method), with
    /// [`noisy`](Settings::noisy), for wrs with its [`sampler`](crate::internal::Wrs::sampler) and the scale of its
    /// [`gate`](crate::internal::Wrs::gate), and for smr with `rate_far` and `filter` of the
    /// [`foveation`](Settings::foveation).
    ///
    /// # Errors
    /// [`SettingsError`] if a setting is out of range, or if a limit of the device is too low for the settings at the
    /// context's size; then nothing changes.
    pub fn set_settings(&mut self, device: &Device, settings: Settings) -> Result<(), SettingsError> {
        requirements::check_settings(device, &self.desc, &settings)?;
        if settings.differs_in_uniforms(&self.desc.settings) {
            // Each frame uploads these. No object is made, and no pipeline compiled.
            self.desc.settings = settings;
            self.unplan();
            return Ok(());
        }
        let has_same_pass = settings.pass_shader() == self.pass_shader;
        let keeps_history = settings.keeps_history_of(&self.desc.settings);
        (self.desc.settings, self.pass_shader) = (settings, settings.pass_shader());
        self.stages.update(device, &self.desc, has_same_pass);
        self.generation += 1;
        self.recorder.clear();
        if !keeps_history {
            self.history = History::new(device, &self.desc);
        }
        self.update_quads(device);
        Ok(())
    }

    /// Changes the size of the views, and discards history even if the size is the same;
    /// [`resize_keeping_history`](Self::resize_keeping_history) keeps it.
    ///
    /// # Errors
    /// [`FrameError::Extent`] if a side is 0 or above [`ContextDesc::MAX_SIDE`] or what the device allows,
    /// [`FrameError::Limit`] if another limit of the device is too low for the size; then nothing changes.
    pub fn resize(&mut self, device: &Device, size_px: [u32; 2]) -> Result<(), FrameError> {
        requirements::check_resize(device, &self.desc, size_px)?;
        self.set_size(device, size_px);
        self.history = History::new(device, &self.desc);
        Ok(())
    }

    /// Changes the size of the views and resamples history to it, for dynamic resolution. The view directions at the
    /// edges should stay the same. Reservoirs of wrs, and stored samples of planned frames with their places, are taken
    /// from the nearest pixel. Surfaces of taa, taau and smr are filtered. Levels of detail follow the scale.
    ///
    /// Records a pass into `encoder`. The first call compiles its pipeline. Without history it records nothing. If
    /// `encoder` is dropped, the next frame has no history.
    ///
    /// # Errors
    /// As for [`resize`](Self::resize).
    pub fn resize_keeping_history(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        size_px: [u32; 2],
    ) -> Result<(), FrameError> {
        requirements::check_resize(device, &self.desc, size_px)?;
        let resize = Resize::new(self.desc.size_px, size_px);
        self.set_size(device, size_px);
        let mut history = History::new(device, &self.desc);
        history.state = self.history.state.iter().map(|state| resize.state(*state)).collect();
        if self.history.is_filled() {
            let layout = history.layout();
            if self.resize.as_ref().is_none_or(|pass| pass.layout() != layout) {
                self.resize = ResizePass::new(device, layout, self.desc.has_extra_history(), self.stages.sources());
            }
            let recorder = &mut self.recorder;
            recorder.begin(0);
            if let Some(pass) = &self.resize {
                let planes = [self.history.split().0, history.split().1];
                pass.record(device, recorder, &resize, self.desc.view_count, planes);
            }
            self.stages.complete(device, recorder, &history);
            let label = Some("afterimage resize");
            recorder.record(&mut encoder.begin_compute_pass(&ComputePassDescriptor { label, ..Default::default() }));
            recorder.clear();
            history.finish_resampled(encoder, &self.history);
        }
        self.history = history;
        Ok(())
    }

    fn set_size(&mut self, device: &Device, size_px: [u32; 2]) {
        self.desc.size_px = size_px;
        self.stages.resize(device, &self.desc);
        self.recorder.clear();
        self.update_quads(device);
    }

    /// Follows a change of settings or size.
    fn update_quads(&mut self, device: &Device) {
        let by_quads = self.desc.settings.foveation.kind == FoveationKind::Quads;
        match &mut self.quads {
            Some(quads) if by_quads => quads.update(device, &self.desc),
            quads => *quads = by_quads.then(|| QuadPasses::new(device, &self.desc, self.stages.sources())),
        }
    }

    /// Discards history and held gaze positions: the next frame is processed like the first one. For another scene or
    /// another user; no frame need follow. [`Reset::All`] does the same as part of a frame, but
    /// keeps the gaze. What was discarded never comes back, even if the next recorded frame is never submitted.
    pub fn forget(&mut self) {
        self.unplan();
        self.recorder.clear();
        self.history.forget();
    }

    /// Gaze position in pixels that [`record`](Self::record) would use for view `view` of the next frame: `gaze` if it
    /// is known, else the last known one, else the middle of the view. Renderers that foveate need it before that call.
    pub fn gaze_px(&self, view: usize, geometry: &ViewGeometry, gaze: Gaze) -> [f32; 2] {
        gaze.resolve(self.history.state.get(view).and_then(|state| state.gaze_px), geometry)
    }

    /// Compiles the pipelines for frames that have the same inputs and outputs as `frame` and `target`, so that
    /// [`record`](Self::record) does not have to: while loading, and again after [`set_settings`](Self::set_settings).
    /// Each combination of inputs has its own pipelines; the contents of the textures do not matter.
    ///
    /// Drivers may finish compilation at the first dispatch (software Vulkan does): record a frame while loading to
    /// force that, too.
    pub fn prewarm<'t>(&self, device: &Device, frame: &Frame<'_>, target: impl Into<Target<'t>>) {
        let special = Specialization::of(frame, &target.into(), None, self.generation);
        // Planned frames of whole quads, and those that begin with a quarter.
        let is_planned = self.quads.is_some();
        if !(is_planned && self.desc.settings.foveation.single_pixels) {
            self.stages.prewarm(device, &self.desc, special);
        }
        if let Some(quads) = &self.quads {
            self.stages.prewarm(device, &self.desc, special.partial(true));
            let plan = Specialization::of_plan(frame, self.generation);
            quads.prewarm(device, &self.desc, plan);
        }
    }

    /// Size in bytes of the textures that the context holds between frames.
    pub fn memory_bytes(&self) -> u64 {
        Self::memory_bytes_of(&self.desc)
    }

    /// Size in bytes of the textures that a context of this description would hold between frames.
    pub fn memory_bytes_of(desc: &ContextDesc) -> u64 {
        let by_quads = desc.settings.foveation.kind == FoveationKind::Quads;
        let quads = if by_quads { quads::memory_bytes(desc) } else { 0 };
        history::memory_bytes(desc) + stages::memory_bytes_of(desc) + quads
    }

    /// Records one frame into `encoder`: reads the frame's inputs and the history, and writes `target` (an output
    /// texture, or a [`Target`]) and the history. Recoverable problems are returned as warnings, which may be ignored.
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
        device: &Device,
        encoder: &mut CommandEncoder,
        frame: &Frame<'_>,
        target: impl Into<Target<'a>>,
    ) -> Result<Recorded, FrameError> {
        let target = target.into();
        self.check(device, frame, &target)?;
        let (recorded, state, upload) = self.dispatch(device, encoder, frame, &target, None)?;
        self.unplan();
        self.history.state = state;
        if self.desc.settings.history_layout() != HistoryLayout::Nothing {
            self.history.finish(encoder, &upload);
        }
        Ok(recorded)
    }

    /// Records, into `encoder`, the choice of the quads of 2x2 pixels to shade of a frame [shaded by
    /// quads](crate::internal::FoveationKind::Quads). The renderer reads it from [`quad_mask`](Self::quad_mask) or
    /// [`quad_list`](Self::quad_list), shades these quads at full rate, and gives a color of the context's size with
    /// them to [`record`](Self::record) of the same frame.
    ///
    /// All quads of the fovea are chosen, an even pattern outside it that visits every quad in turn, and at most the
    /// share [`Foveation::budget`](crate::internal::Foveation::budget) of a view's quads where history lacks most.
    ///
    /// Give it the frame that will be recorded, with the parts that are known before shading: views, depth, motion,
    /// trust or reactive mask, index and reset. Its colors and noise are not read. History is unchanged. If its encoder
    /// is never submitted, plan again before `record`.
    ///
    /// ```no_run
    /// # use afterimage::internal::ViewFrame;
    /// # use afterimage::wgpu;
    /// # fn example(
    /// #     post: &mut afterimage::gpu::Afterimage, device: &wgpu::Device, encoder: &mut wgpu::CommandEncoder,
    /// #     [color, depth, motion, output]: [&wgpu::Texture; 4], views: &[ViewFrame], index: u64,
    /// # ) -> Result<(), afterimage::FrameError> {
    /// use afterimage::gpu::Frame;
    ///
    /// let frame = Frame { depth: Some(depth.into()), motion: Some(motion.into()), ..Frame::new(color, views, index) };
    /// post.plan(device, encoder, &frame)?;
    /// // Here the renderer shades the chosen quads into `color`.
    /// post.record(device, encoder, &frame, output)?;
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// [`FrameError`] if the foveation is not [`Quads`](crate::internal::FoveationKind::Quads), and as for `record`;
    /// then nothing was recorded.
    pub fn plan(&mut self, device: &Device, encoder: &mut CommandEncoder, frame: &Frame<'_>) -> Result<(), FrameError> {
        frame.check_plan(&self.desc)?;
        input::check_geometry(&self.desc, frame)?;
        let is_quarter = self.starts_with_quarter(frame);
        let (uniforms, ..) = self.prepare(frame, is_quarter);
        let special = Specialization::of_plan(frame, self.generation);
        self.recorder.begin(0);
        let mut job = Job {
            device,
            desc: &self.desc,
            textures: frame.textures(),
            counters: None,
            special,
            uniforms,
            history: &self.history,
            rectified: None,
            quads: None,
            recorder: &mut self.recorder,
        };
        if let Some(quads) = &self.quads {
            quads.record(&mut job, false);
        }
        let upload = self.recorder.upload(device)?;
        if let Some(quads) = &mut self.quads {
            quads.begin(encoder, &upload);
            quads.planned = Some(Planned { index: frame.index, is_quarter });
        }
        self.recorder.copy(encoder, &upload);
        let label = Some("afterimage plan");
        self.recorder.record(&mut encoder.begin_compute_pass(&ComputePassDescriptor { label, ..Default::default() }));
        Ok(())
    }

    /// Whether the last [`plan`](Self::plan) chose one pixel of each quad outside the fovea, because nothing was known:
    /// in the first frame and after a reset. Draw these pixels at half the width and height ([`ViewGeometry::half`]),
    /// and give them so ([`half`](crate::levels::FrameInputs::half)): rasterisers cannot shade single pixels of a quad,
    /// and would shade all. The fovea is drawn as in other frames.
    pub fn is_quarter(&self) -> bool {
        self.quads.as_ref().and_then(|quads| quads.planned).is_some_and(|planned| planned.is_quarter)
    }

    /// Whether a frame shades one pixel of each quad, as far as is known before the device has processed its
    /// predecessor.
    fn starts_with_quarter(&self, frame: &Frame<'_>) -> bool {
        let starts = frame.reset != Reset::None || !self.history.is_filled();
        let settings = &self.desc.settings;
        let has_memory = matches!(settings.history_layout(), HistoryLayout::Sparse { .. });
        starts && has_memory && settings.foveation.takes_quarter()
    }

    /// Records a pass, after [`plan`](Self::plan), that closes the depth buffer of view `view` wherever no quad was
    /// chosen: it writes the near plane there, so that the depth test rejects what the renderer draws, before it is
    /// shaded. Chosen quads keep their depth. Copy the depth of the prepass first, if something else reads it.
    ///
    /// # Errors
    /// [`FrameError`] if there is no plan of the frame that comes next, or if the target does not fit. Then nothing was
    /// recorded.
    pub fn prime(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        view: usize,
        prime: &Prime<'_>,
    ) -> Result<(), FrameError> {
        let size_px = self.desc.size_px;
        match &mut self.quads {
            Some(quads) if quads.planned.is_some() && view < quads.quads.views.len() => {
                quads.prime.record(device, encoder, (view as u32, size_px, &quads.quads.mask.whole), prime)
            }
            _ => Err(FrameError::Value {
                value: FrameValue::Plan,
                view,
                found: "missing".into(),
                expected: "a plan of the same frame before prime",
            }),
        }
    }

    /// Compiles the pipeline of [`prime`](Self::prime) for the format, samples and near plane of a target, in place of
    /// the first frame. No effect with kinds other than [`FoveationKind::Quads`].
    ///
    /// # Errors
    /// [`FrameError`] if the target does not fit, as for `prime`.
    pub fn prewarm_prime(&mut self, device: &Device, prime: &Prime<'_>) -> Result<(), FrameError> {
        if let Some(quads) = &mut self.quads {
            quads.prime.prewarm(device, self.desc.size_px, prime)?;
        }
        Ok(())
    }

    /// The pixels that the last [`plan`](Self::plan) of a frame [shaded by
    /// quads](crate::internal::FoveationKind::Quads) chose: an `R32Uint` texture with a texel for each quad of 2x2
    /// pixels, whose bits 0 to 3 say which of its pixels are shaded, row by row, and bits 8 to 12 how many paths each
    /// of them gets, as in [`CpuAfterimage::paths`](crate::cpu::CpuAfterimage::paths), with an array layer for each
    /// view; usages `TEXTURE_BINDING` and `COPY_SRC`. `None` with another kind. Changes of size and settings replace
    /// it.
    pub fn quad_mask(&self) -> Option<&Texture> {
        self.quads.as_ref().map(|quads| &quads.quads.mask.texture)
    }

    /// The quads of a view that the last [`plan`](Self::plan) chose, as a list on the device; usages `STORAGE`,
    /// `INDIRECT` and `COPY_SRC`. 32-bit words: at byte 0 the arguments of `draw_indirect` with 6 vertices and an
    /// instance for each quad, at byte 16 those of `dispatch_workgroups_indirect` with 64 invocations a workgroup and
    /// one for each quad, at byte 28 the number of quads, from byte 32 on the quads, x + 65536 y in quads, in no
    /// particular order. `None` with another kind than [`Quads`](crate::internal::FoveationKind::Quads). Changes of
    /// size and settings replace it.
    pub fn quad_list(&self, view: usize) -> Option<&Buffer> {
        self.quads.as_ref().and_then(|quads| quads.quads.views.get(view)).map(|view| &view.list)
    }

    /// Records a debug view of the decisions that [`record`](Self::record) of the same frame will make, as linear
    /// color, into the target's output. Counters, if any, are those of `record`. History is unchanged: call it before
    /// `record`, with another output, for any number of views. A [`DebugTarget`] is faster: it needs no pass of its
    /// own.
    ///
    /// # Errors
    /// As for `record`.
    pub fn record_view<'a>(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        frame: &Frame<'_>,
        target: impl Into<Target<'a>>,
        view: DebugView,
    ) -> Result<Recorded, FrameError> {
        let target = Target { debug: None, ..target.into() };
        self.check(device, frame, &target)?;
        let (recorded, ..) = self.dispatch(device, encoder, frame, &target, Some(view))?;
        Ok(recorded)
    }

    /// Records the passes of a frame. Returns its warnings, the state of the views that is held for the next frame, and
    /// the values that were uploaded.
    fn dispatch(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        frame: &Frame<'_>,
        target: &Target<'_>,
        view: Option<DebugView>,
    ) -> Result<(Recorded, Vec<ViewState>, Buffer), FrameError> {
        let is_given = frame.mask.is_some();
        let is_partial = is_given || self.is_quarter() || self.desc.settings.foveation.single_pixels;
        let (uniforms, state, recorded) = self.prepare(frame, self.is_quarter() && !is_given);
        let mut textures = frame.textures();
        textures[Binding::Output as usize] = Some(target.output);
        textures[Binding::Debug as usize] = target.debug.map(|debug| debug.output);
        self.recorder.begin(self.history.next_number());
        let mut job = Job {
            device,
            desc: &self.desc,
            textures,
            counters: target.counters,
            special: Specialization::of(frame, target, view, self.generation).partial(is_partial),
            uniforms,
            history: &self.history,
            rectified: None,
            quads: self.quads.as_ref().map(|quads| &quads.quads),
            recorder: &mut self.recorder,
        };
        let given = self.quads.as_ref().filter(|_| is_given);
        if let Some(quads) = given {
            quads.record(&mut job, true);
        }
        self.stages.record(&mut job);
        let upload = self.recorder.upload(device)?;
        if let Some(quads) = given {
            quads.begin(encoder, &upload);
        }
        if let Some(counters) = target.counters {
            encoder.clear_buffer(counters, 0, Some(FrameStats::COUNTERS_BYTES));
        }
        self.recorder.copy(encoder, &upload);
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor {
            label: Some("afterimage"),
            timestamp_writes: target.timestamps.map(|t| t.writes()),
        });
        self.recorder.record(&mut pass);
        drop(pass);
        Ok((recorded, state, upload))
    }

    fn check(&self, device: &Device, frame: &Frame<'_>, target: &Target<'_>) -> Result<(), FrameError> {
        input::check(device, &self.desc, self.output_format, frame, target)?;
        frame
            .check_planned(&self.desc, self.quads.as_ref().and_then(|quads| quads.planned).map(|planned| planned.index))
    }

    /// Discards the last plan.
    fn unplan(&mut self) {
        if let Some(quads) = &mut self.quads {
            quads.planned = None;
        }
    }

    /// Uniforms of a frame, the state of the views after it, and its warnings.
    fn prepare(&self, frame: &Frame<'_>, is_quarter: bool) -> (FrameUniforms, Vec<ViewState>, Recorded) {
        let mut recorded = Recorded::default();
        let mut after = vec![];
        for (i, (view, state)) in frame.views.iter().zip(&self.history.state).enumerate() {
            after.push(state.with(view, frame.exposure));
            recorded.note_gaze(i, view, state.gaze_px);
        }
        let foveation = self.desc.settings.foveation;
        let foveation = if is_quarter { foveation.after_cut() } else { foveation };
        let uniforms = FrameUniforms::new(&self.desc, frame, &after, self.history.past_frame(), &foveation);
        let largest_shown = output::largest(self.output_format);
        (FrameUniforms { largest_shown, ..uniforms }, after, recorded)
    }
}
