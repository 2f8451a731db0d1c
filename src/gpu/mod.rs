//! The wgpu executor: the post-process as a compute pass, recorded into the caller's command encoder.
//!
//! The caller owns device, queue, encoder, every input and output texture, and submission; [`Afterimage`] owns nothing but
//! history and constants. [`Afterimage::record`] never submits, polls, maps or waits.

mod desc;
mod history;
mod input;
mod pipeline;
// Public for this package's own tests, which compose and validate every shader and compare struct layouts.
#[doc(hidden)]
pub mod shader;
#[doc(hidden)]
pub mod types;

pub use desc::GpuDesc;
pub use types::MAX_VIEWS;

use crate::error::{CreateError, FrameError, SettingsError};
use crate::frame::{Exposure, Reset, ViewFrame, check_size};
use crate::settings::{Method, Settings};
use history::{History, array_view};
use pipeline::{Pipelines, Variant};
use types::{FrameConstants, ViewConstants};
use wgpu::util::DeviceExt;
use wgpu::{BindGroupDescriptor, BindGroupEntry, BindingResource, CommandEncoder, Device, Texture, TextureView};

/// Width of a workgroup: rows of 64 pixels. Also in `shaders/pass/wrs_pass.wgsl`.
const WORKGROUP_WIDTH: u32 = 64;

/// One frame. All textures have the size of the context, one array layer a view (mono frames are plain 2D textures), one sample a
/// pixel, and the usage `TEXTURE_BINDING`.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// The foveated frame: linear colour, any float format.
    pub color: &'a Texture,
    /// Depth in the context's convention: a depth format or `R32Float`. `None` switches the depth test off.
    pub depth: Option<&'a Texture>,
    /// Motion in the context's convention: `Rg16Float`, `Rg32Float` or wider. `None`: nothing moves.
    pub motion: Option<&'a Texture>,
    /// How far history may be believed: 1 as usual, 0 not at all, for what moves without vectors (video panels, particles,
    /// reflections). Any float or normalised format. `None`: 1 everywhere.
    pub trust: Option<&'a Texture>,
    /// Level of detail of the foveated frame: log2 of the block edge in pixels, any float format. `None`: as
    /// [`Settings::foveation`] has it.
    pub lod: Option<&'a Texture>,
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
            output,
            views,
            index,
            reset: Reset::None,
            exposure: Exposure::Same,
            timestamps: None,
        }
    }
}

/// Two queries of a set of the caller's that the device writes its clock to.
#[derive(Clone, Copy, Debug)]
pub struct Timestamps<'a> {
    /// A set of `QueryType::Timestamp`.
    pub queries: &'a wgpu::QuerySet,
    /// Index of the query written when the pass begins.
    pub begin: u32,
    /// Index of the query written when it ends.
    pub end: u32,
}

/// The post-process on the GPU.
#[derive(Debug)]
pub struct Afterimage {
    desc: GpuDesc,
    pipelines: Pipelines,
    history: History,
    dummies: Dummies,
}

/// What is bound where there is no input: 1x1 textures that no specialised shader reads.
#[derive(Debug)]
struct Dummies {
    float: TextureView,
    key_out: TextureView,
}

impl Afterimage {
    /// A context with an empty history. Makes the shader; pipelines are made at the first frame that needs them.
    ///
    /// # Errors
    /// If a setting or fact is out of range, or the device cannot do it.
    pub fn new(device: &Device, desc: &GpuDesc) -> Result<Self, CreateError> {
        desc.validate(&device.limits())?;
        Ok(Self {
            desc: *desc,
            pipelines: Pipelines::new(device, desc)?,
            history: History::new(device, &desc.context, desc.settings.uses_keys()),
            dummies: Dummies::new(device),
        })
    }

    /// What it was made for.
    pub fn desc(&self) -> &GpuDesc {
        &self.desc
    }

    /// Changes the tunables from the next frame on. History survives, unless the sampler changes.
    ///
    /// # Errors
    /// If a setting is out of range; then the old ones stay.
    pub fn set_settings(&mut self, device: &Device, settings: Settings) -> Result<(), SettingsError> {
        settings.validate()?;
        if settings.uses_keys() != self.desc.settings.uses_keys() {
            self.history = History::new(device, &self.desc.context, settings.uses_keys());
        }
        self.desc.settings = settings;
        Ok(())
    }

    /// Changes the size of the views. The history starts afresh, even if the size is the same.
    ///
    /// # Errors
    /// [`FrameError::Extent`]; then nothing changes.
    pub fn resize(&mut self, device: &Device, size_px: [u32; 2]) -> Result<(), FrameError> {
        check_size(size_px)?;
        self.desc.context.size_px = size_px;
        self.history = History::new(device, &self.desc.context, self.desc.settings.uses_keys());
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

    /// Textures with the packed reservoirs of the last recorded frame ([`pack`](crate::kernel::pack)): words 0 and 1
    /// (`Rg32Uint`), word 2 (`R32Uint`), and with A-ES the keys (`R32Float`). For tests and tools; usages `COPY_SRC`, `COPY_DST`.
    pub fn history_textures(&self) -> &[Texture] {
        &self.history.split().0.textures
    }

    /// Records one frame into `encoder`.
    ///
    /// # Errors
    /// If a texture or number does not fit the context; then nothing was recorded and no state has moved.
    pub fn record(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        frame: &Frame<'_>,
    ) -> Result<(), FrameError> {
        let variant = Variant::new(&self.desc.settings, frame);
        self.record_variant(device, encoder, frame, variant)
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
    ) -> Result<(), FrameError> {
        if frame.depth.is_none() || frame.motion.is_none() {
            return Err(FrameError::Value {
                what: "depth or motion",
                view: 0,
                found: "None".into(),
                expected: "both, to move all bytes",
            });
        }
        let variant = Variant::copy(&self.desc.settings, frame);
        self.record_variant(device, encoder, frame, variant)
    }

    fn record_variant(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        frame: &Frame<'_>,
        variant: Variant,
    ) -> Result<(), FrameError> {
        input::check(&self.desc, frame)?;
        let constants = self.constants(frame);
        let buffer = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("afterimage constants"),
            contents: bytemuck::bytes_of(&constants),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let color = array_view(frame.color);
        let depth = frame.depth.map_or_else(|| self.dummies.float.clone(), array_view);
        let motion = frame.motion.map_or_else(|| self.dummies.float.clone(), array_view);
        let trust = frame.trust.map_or_else(|| self.dummies.float.clone(), array_view);
        let output = array_view(frame.output);
        let (past, next) = self.history.split();
        let views = [
            &color,
            &depth,
            &motion,
            &trust,
            &past.views[0],
            &past.views[1],
            past.views.get(2).unwrap_or(&self.dummies.float),
            &next.views[0],
            &next.views[1],
            next.views.get(2).unwrap_or(&self.dummies.key_out),
            &output,
        ];
        let mut entries = vec![BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }];
        entries.extend(
            views.into_iter().enumerate().map(|(i, view)| BindGroupEntry {
                binding: i as u32 + 1,
                resource: BindingResource::TextureView(view),
            }),
        );
        let group = device.create_bind_group(&BindGroupDescriptor {
            label: Some("afterimage wrs"),
            layout: &self.pipelines.bindings,
            entries: &entries,
        });
        let mut pass = encoder
            .begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some("afterimage wrs"), timestamp_writes: None });
        pass.set_pipeline(self.pipelines.get(device, variant));
        pass.set_bind_group(0, &group, &[]);
        let [width, height] = self.desc.context.size_px;
        pass.dispatch_workgroups(width.div_ceil(WORKGROUP_WIDTH), height, self.desc.context.view_count);
        drop(pass);
        if self.desc.settings.method == Method::None {
            self.history.forget();
        } else {
            self.history.swap();
        }
        Ok(())
    }

    /// The frame's constants. Remembers where the eyes look.
    fn constants(&mut self, frame: &Frame<'_>) -> FrameConstants {
        let settings = &self.desc.settings;
        let params = settings.wrs_params();
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
            ..FrameConstants::default()
        };
        for (i, (view, held)) in frame.views.iter().zip(&mut self.history.held_gaze).enumerate() {
            let prepared = view.constants(*held, settings, i, frame.index);
            *held = Some(prepared.gaze_px);
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
        constants
    }
}

impl Dummies {
    fn new(device: &Device) -> Self {
        let texture = |format, usage| {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("afterimage absent input"),
                size: wgpu::Extent3d::default(),
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            });
            array_view(&texture)
        };
        Self {
            float: texture(wgpu::TextureFormat::R32Float, wgpu::TextureUsages::TEXTURE_BINDING),
            key_out: texture(wgpu::TextureFormat::R32Float, wgpu::TextureUsages::STORAGE_BINDING),
        }
    }
}
