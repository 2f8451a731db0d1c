//! The wgpu executor: the post-process as a compute pass, recorded into the caller's command encoder.
//!
//! The caller owns device, queue, encoder, every input and output texture, and submission; [`Afterimage`] owns nothing but
//! history and constants. [`Afterimage::record`] never submits, polls, maps or waits.

mod bindings;
mod buffer;
mod candidates;
mod chain;
mod desc;
mod frame;
mod history;
mod input;
mod pipeline;
// Public for the tests, which compare struct layouts.
#[doc(hidden)]
pub mod types;

pub use desc::GpuDesc;
pub use frame::{Frame, Recorded, Timestamps};
pub use types::MAX_VIEWS;

#[doc(hidden)]
pub use buffer::filled;
#[doc(hidden)]
pub use history::array_view;
pub(crate) use input::{check_readable, check_texture};

use crate::error::{CreateError, FrameError, SettingsError};
use crate::frame::{Reset, check_size};
use crate::kernel::debug_view::DebugView;
use crate::settings::{HistoryLayout, Method, Settings};
use crate::shader::SHADERS;
use crate::stats::COUNTERS_BYTES;
use bindings::Bindings;
use candidates::CandidatePass;
use chain::{ChainKind, ChainPass};
use history::History;
#[doc(hidden)]
pub use pipeline::pass_name;
use pipeline::{Pipelines, Variant};
use types::{FrameConstants, ViewConstants};
use wgpu::{CommandEncoder, Device, Texture};

/// Width of a workgroup: rows of 64 pixels. Also in the shaders.
#[doc(hidden)]
pub const WORKGROUP_WIDTH: u32 = 64;

/// The post-process on the GPU.
#[derive(Debug)]
pub struct Afterimage {
    desc: GpuDesc,
    passes: Passes,
    history: History,
}

/// What a method runs.
#[derive(Debug)]
struct Passes {
    method: Method,
    bindings: Bindings,
    pipelines: Pipelines,
    chain: Option<ChainPass>,
    candidates: Option<CandidatePass>,
}

impl Passes {
    fn new(device: &Device, desc: &GpuDesc, source: &str) -> Result<Self, CreateError> {
        let bindings = Bindings::new(device, desc.output_format, desc.settings.history_layout());
        Ok(Self {
            method: desc.settings.method,
            pipelines: Pipelines::new(device, desc, &bindings, source)?,
            bindings,
            chain: (desc.settings.method == Method::Smr).then(|| ChainPass::new(device, ChainKind::Surfaces)),
            candidates: None,
        })
    }

    fn history(&mut self, device: &Device, desc: &GpuDesc) -> History {
        let layout = desc.settings.history_layout();
        if matches!(layout, HistoryLayout::Surfaces { noisy: true, .. }) {
            self.candidates.get_or_insert_with(|| CandidatePass::new(device));
        }
        History::new(device, &desc.context, layout, self.chain.as_ref(), self.candidates.as_ref())
    }
}

/// What a frame comes to before any pixel is looked at.
struct Prepared {
    constants: FrameConstants,
    /// Where the eyes are taken to look; to be held from then on.
    gaze_px: Vec<Option<[f32; 2]>>,
    recorded: Recorded,
}

impl Afterimage {
    /// A context with an empty history. Makes the shader; pipelines are made at the first frame that needs them.
    ///
    /// # Errors
    /// If a setting or fact is out of range, or the device cannot do it.
    pub fn new(device: &Device, desc: &GpuDesc) -> Result<Self, CreateError> {
        Self::from_shader(device, desc, &SHADERS.compose(pass_name(desc.settings.method)).source)
    }

    /// With another text of the pass: for this package's tests, which plant errors in it.
    #[doc(hidden)]
    pub fn from_shader(device: &Device, desc: &GpuDesc, source: &str) -> Result<Self, CreateError> {
        desc.validate(&device.limits())?;
        let mut passes = Passes::new(device, desc, source)?;
        Ok(Self { desc: *desc, history: passes.history(device, desc), passes })
    }

    /// What it was made for.
    pub fn desc(&self) -> &GpuDesc {
        &self.desc
    }

    /// Changes the tunables from the next frame on. History survives, unless the method or what it remembers changes.
    ///
    /// # Errors
    /// If a setting is out of range; then the old ones stay.
    pub fn set_settings(&mut self, device: &Device, settings: Settings) -> Result<(), SettingsError> {
        settings.validate()?;
        self.desc.settings = settings;
        if settings.method != self.passes.method {
            let source = SHADERS.compose(pass_name(settings.method)).source;
            self.passes = Passes::new(device, &self.desc, &source).expect("the output format was checked");
            self.history = self.passes.history(device, &self.desc);
        } else if settings.history_layout() != self.history.layout() {
            self.history = self.passes.history(device, &self.desc);
        }
        Ok(())
    }

    /// Changes the size of the views. The history starts afresh, even if the size is the same.
    ///
    /// # Errors
    /// [`FrameError::Extent`]; then nothing changes.
    pub fn resize(&mut self, device: &Device, size_px: [u32; 2]) -> Result<(), FrameError> {
        check_size(size_px)?;
        self.desc.context.size_px = size_px;
        self.history = self.passes.history(device, &self.desc);
        Ok(())
    }

    /// Forgets the history: the next frame starts afresh.
    pub fn forget(&mut self) {
        self.history.forget();
    }

    /// Bytes of textures held between frames.
    pub fn memory_bytes(&self) -> u64 {
        self.history.memory_bytes()
    }

    /// What was remembered of the last recorded frame, for tests and tools; usages `COPY_SRC`, `COPY_DST`. Of wrs the packed
    /// reservoirs ([`pack`](crate::kernel::pack)): words 0 and 1 (`Rg32Uint`), word 2 (`R32Uint`), and with A-ES the keys
    /// (`R32Float`). Of taa and smr the packed surfaces ([`surface`](crate::kernel::surface), `Rg32Uint`), and of smr their coarser
    /// levels (`Rgba16Float`), and where candidates are noisy the packed noise ([`noise`](crate::kernel::noise), `R32Uint`).
    pub fn history_textures(&self) -> &[Texture] {
        &self.history.split().0.textures
    }

    /// Records one frame into `encoder`. What is odd about it, and no error, comes back; it may be ignored.
    ///
    /// # Errors
    /// If a texture, buffer or number does not fit the context; then nothing was recorded and no state has moved.
    pub fn record(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        frame: &Frame<'_>,
    ) -> Result<Recorded, FrameError> {
        self.record_and_keep(device, encoder, frame, Variant::new(&self.desc.settings, frame))
    }

    /// Records a picture of what [`record`](Self::record) of the same frame would decide, in linear light, into the frame's output.
    /// Counters, if given, count what `record` would. No state moves: call it before `record`, with another output.
    ///
    /// # Errors
    /// As for `record`.
    pub fn record_view(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        frame: &Frame<'_>,
        view: DebugView,
    ) -> Result<Recorded, FrameError> {
        input::check(&self.desc, frame)?;
        let prepared = self.prepare(frame);
        self.dispatch(device, encoder, frame, Variant::view(&self.desc.settings, frame, view), &prepared.constants);
        Ok(prepared.recorded)
    }

    /// Records a pass that reads and writes what [`record`](Self::record) would with depth and motion, and computes nothing:
    /// what the method's time is held against. The history is worthless afterwards.
    ///
    /// # Errors
    /// As for `record`, and if depth or motion is absent.
    pub fn record_copy(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        frame: &Frame<'_>,
    ) -> Result<Recorded, FrameError> {
        if self.desc.settings.method != Method::Wrs {
            return Err(FrameError::Value {
                what: "method",
                view: 0,
                found: format!("{:?}", self.desc.settings.method),
                expected: "Wrs, whose bytes are moved",
            });
        }
        if frame.depth.is_none() || frame.motion.is_none() {
            return Err(FrameError::Value {
                what: "depth or motion",
                view: 0,
                found: "None".into(),
                expected: "both, to move all bytes",
            });
        }
        self.record_and_keep(device, encoder, frame, Variant::copy(&self.desc.settings, frame))
    }

    fn record_and_keep(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        frame: &Frame<'_>,
        variant: Variant,
    ) -> Result<Recorded, FrameError> {
        input::check(&self.desc, frame)?;
        let prepared = self.prepare(frame);
        self.dispatch(device, encoder, frame, variant, &prepared.constants);
        if self.desc.settings.method == Method::None {
            self.history.forget();
        } else {
            self.history.held_gaze = prepared.gaze_px;
            self.history.swap();
        }
        Ok(prepared.recorded)
    }

    fn dispatch(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        frame: &Frame<'_>,
        variant: Variant,
        constants: &FrameConstants,
    ) {
        if let Some(counters) = frame.counters {
            encoder.clear_buffer(counters, 0, Some(COUNTERS_BYTES));
        }
        let group = self.passes.bindings.group(device, frame, constants, &self.history);
        // smr takes blocks of 2x2 pixels.
        let side = if variant.takes_blocks() { 2 } else { 1 };
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("afterimage"),
            timestamp_writes: frame.timestamps.map(|t| wgpu::ComputePassTimestampWrites {
                query_set: t.queries,
                beginning_of_pass_write_index: Some(t.begin),
                end_of_pass_write_index: Some(t.end),
            }),
        });
        if let (Some(passes), Some(candidates)) = (&self.passes.candidates, self.history.candidates()) {
            passes.record(device, &mut pass, frame, candidates);
        }
        pass.set_pipeline(self.passes.pipelines.get(device, variant));
        pass.set_bind_group(0, &group, &[]);
        let [width, height] = self.desc.context.size_px.map(|s| s.div_ceil(side));
        pass.dispatch_workgroups(width.div_ceil(WORKGROUP_WIDTH), height, self.desc.context.view_count);
        if let (Some(chain), false) = (&self.passes.chain, variant.is_view()) {
            chain.record(&mut pass, &self.history.split().1.chain);
        }
    }

    /// What a frame comes to before any pixel is looked at.
    fn prepare(&self, frame: &Frame<'_>) -> Prepared {
        let settings = &self.desc.settings;
        let params = settings.wrs_params();
        let smr = settings.smr_params();
        let [coarse_mid, coarse_far] = settings.foveation.coarseness();
        let disparity = self.desc.context.depth.disparity_map();
        let test = settings.depth_test.unwrap_or_default();
        let reset = frame.reset == Reset::All || !self.history.is_filled();
        let mut constants = FrameConstants {
            size: self.desc.context.size_px,
            reset: u32::from(reset),
            frame_low: frame.index as u32,
            fovea_radius_deg: 0.5 * settings.foveation.fovea_deg,
            inv_density_at_fovea: settings.inv_density_at_fovea(),
            exponential_survival: params.exponential_survival,
            gate_offset: params.gate_offset,
            inv_gate_divisor: params.inv_gate_divisor,
            depth_relative: test.relative,
            depth_slope_px: test.slope_px,
            disparity_a: disparity.a,
            motion_scale: self.desc.context.motion.to_internal(self.desc.context.size_px),
            disparity_b: disparity.b,
            disparity_flags: u32::from(disparity.invert) | u32::from(disparity.clamp) << 1,
            exposure: frame.exposure.factor().unwrap_or(1.0),
            mid_radius_deg: 0.5 * settings.foveation.mid_deg,
            blend_deg: settings.foveation.blend_deg,
            coarse_mid,
            coarse_far,
            smr_accumulate: smr.accumulate,
            smr_accumulate_tolerance: smr.accumulate_tolerance,
            smr_tolerance: smr.tolerance,
            ..FrameConstants::default()
        };
        let mut recorded = Recorded::default();
        let mut gaze_px = vec![];
        for (i, (view, held)) in frame.views.iter().zip(&self.history.held_gaze).enumerate() {
            let prepared = view.constants(*held, settings, i, frame.index);
            recorded.note(i, view, *held);
            gaze_px.push(Some(prepared.gaze_px));
            let (ray_scale, ray_offset) = view.geometry.scale_offset();
            constants.views[i] = ViewConstants {
                ray_scale,
                ray_offset,
                gaze_ray: prepared.gaze_ray.extend(0.0).to_array(),
                depth_row: prepared.depth_row,
                key: prepared.key,
                unused: [0; 3],
            };
        }
        Prepared { constants, gaze_px, recorded }
    }
}
