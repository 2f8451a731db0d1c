//! The pipeline on a device. A frame is uploaded or rendered once; foveation and all methods then run on the device.
//! `run`, `view` and `bench` share this code.

use super::needs_lod;
use crate::device::Headless;
use crate::frame::{ComposedFrame, DeviceFrame, DeviceSamples, SourceFrame};
use crate::shader::SHADERS;
use afterimage::gpu::compute::{ComputeShader, float_texture, storage_texture, uniform};
use afterimage::gpu::{Afterimage, Frame, Recorded, Target, Timestamps, array_view, filled};
use afterimage::simulator::{GpuSimulator, SimulatorFrame};
use afterimage::{ContextDesc, CreateError, DebugView, FrameError, FrameStats, Image, Reset, ViewFrame};
use std::sync::Arc;
use wgpu::{BindingResource, Buffer, BufferUsages, CommandEncoder, Texture, TextureFormat, TextureUsages};

/// Formats of a pipeline's textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeviceFormats {
    /// Format of the full-rate frame, the foveated frame and outputs: `Rgba32Float` or `Rgba16Float`.
    pub color: TextureFormat,
    /// Format of motion vectors: `Rg32Float` or `Rg16Float`.
    pub motion: TextureFormat,
}

impl DeviceFormats {
    /// 32-bit floats: exactly the values of frames in memory.
    pub const EXACT: Self = Self { color: TextureFormat::Rgba32Float, motion: TextureFormat::Rg32Float };
    /// 16-bit floats, as engines use.
    pub const ENGINE: Self = Self { color: TextureFormat::Rgba16Float, motion: TextureFormat::Rg16Float };
}

const WRITTEN: TextureUsages =
    TextureUsages::TEXTURE_BINDING.union(TextureUsages::STORAGE_BINDING).union(TextureUsages::COPY_SRC);

/// Inputs of the methods on a device: the full-rate frame, and the foveated frame that a simulator computes from it.
#[derive(Debug)]
pub struct DeviceInputs {
    gpu: Arc<Headless>,
    formats: DeviceFormats,
    full: Texture,
    depth: Texture,
    motion: Texture,
    /// Motion vectors of zero, for a repeated frame.
    no_motion: Texture,
    trust: Texture,
    lod: Texture,
    noise: Texture,
    foveated: Texture,
    simulator: GpuSimulator,
    import: Option<ComputeShader>,
    /// Samples of the last sparse frame that its source rendered.
    atlas: Option<Atlas>,
    /// The last frame that was composed of quad views.
    composed: Option<ComposedFrame>,
    given: Given,
}

/// Color, depth and motion of samples, in an atlas or at their pixels.
#[derive(Debug)]
struct Atlas {
    color: Texture,
    depth: Texture,
    motion: Texture,
    /// Of samples at their pixels.
    noise: Option<Texture>,
}

/// Inputs that the current frame has.
#[derive(Clone, Copy, Debug, Default)]
struct Given {
    depth: bool,
    motion: bool,
    trust: bool,
    lod: bool,
    noise: bool,
    rendered: Option<RenderedAs>,
    /// Whether depth and motion, too, are those that the source rendered.
    rendered_geometry: bool,
}

/// Where the color of a frame is that its source foveated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RenderedAs {
    Atlas,
    Composed,
}

impl DeviceInputs {
    /// Creates textures of `desc`'s size and a simulator of the foveation in its settings.
    ///
    /// # Errors
    /// [`CreateError`] if a setting is out of range or the device does not support it.
    pub fn new(gpu: &Arc<Headless>, desc: &ContextDesc, formats: DeviceFormats) -> Result<Self, CreateError> {
        let texture = |format, usage| gpu.texture(desc.size_px, 1, format, usage);
        let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST | TextureUsages::COPY_SRC;
        Ok(Self {
            formats,
            full: texture(formats.color, read | TextureUsages::STORAGE_BINDING),
            depth: texture(TextureFormat::R32Float, read | TextureUsages::STORAGE_BINDING),
            motion: texture(formats.motion, read),
            no_motion: texture(formats.motion, read),
            trust: texture(TextureFormat::R32Float, read),
            lod: texture(TextureFormat::R32Float, read | TextureUsages::STORAGE_BINDING),
            noise: texture(TextureFormat::Rg32Float, read),
            foveated: texture(formats.color, WRITTEN | TextureUsages::COPY_DST),
            simulator: GpuSimulator::new(&gpu.device, desc, formats.color)?,
            import: None,
            atlas: None,
            composed: None,
            given: Given::default(),
            gpu: gpu.clone(),
        })
    }

    /// Replaces the simulator if the foveation in `desc`'s settings differs from its own.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn set_foveation(&mut self, desc: &ContextDesc) -> Result<(), CreateError> {
        if desc.settings.foveation != self.simulator.desc().settings.foveation {
            self.simulator = GpuSimulator::new(&self.gpu.device, desc, self.formats.color)?;
        }
        Ok(())
    }

    /// Uploads a full-rate frame, in [`DeviceFormats::EXACT`].
    pub fn upload(&mut self, frame: &SourceFrame) {
        self.gpu.write_rgb(&self.full, 0, &frame.color);
        self.upload_others(frame);
    }

    /// Imports a full-rate frame that was rendered on this device. The values equal those of a readback followed by
    /// [`upload`](Self::upload). Records into `encoder`.
    pub fn import(&mut self, encoder: &mut CommandEncoder, frame: &DeviceFrame) {
        self.import_to(encoder, frame, [&self.full.clone(), &self.depth.clone()]);
        let size = frame.motion.size();
        encoder.copy_texture_to_texture(frame.motion.as_image_copy(), self.motion.as_image_copy(), size);
        self.given = Given { depth: true, motion: true, ..Given::default() };
    }

    /// Imports `rendered`, the full-rate frame on a device, if that is this device; else uploads `frame`. Records into
    /// `encoder`.
    pub(super) fn import_or_upload(
        &mut self,
        encoder: &mut CommandEncoder,
        frame: &SourceFrame,
        rendered: Option<&DeviceFrame>,
    ) {
        match rendered.filter(|rendered| Arc::ptr_eq(&rendered.device, &self.gpu)) {
            Some(rendered) => self.import(encoder, rendered),
            None => self.upload(frame),
        }
    }

    /// Imports the samples of a sparse frame that was rendered on this device. `has_geometry`: with their depth and
    /// motion, instead of those of the full-rate frame that was imported or uploaded last. Records into `encoder`.
    pub fn import_atlas(&mut self, encoder: &mut CommandEncoder, atlas: &DeviceFrame, has_geometry: bool) {
        let size = [atlas.color.width(), atlas.color.height()];
        // Textures with noise are the source's.
        let fits = |held: &Atlas| [held.color.width(), held.color.height()] == size && held.noise.is_none();
        let held = self.atlas.take().filter(fits).unwrap_or_else(|| {
            let texture = |format| self.gpu.texture(size, 1, format, WRITTEN | TextureUsages::COPY_DST);
            let [color, depth] = [self.formats.color, TextureFormat::R32Float].map(texture);
            Atlas { color, depth, motion: atlas.motion.clone(), noise: None }
        });
        self.import_to(encoder, atlas, [&held.color, &held.depth]);
        self.atlas = Some(Atlas { motion: atlas.motion.clone(), ..held });
        (self.given.rendered, self.given.rendered_geometry) = (Some(RenderedAs::Atlas), has_geometry);
        (self.given.lod, self.given.noise) = (false, false);
    }

    /// Takes a frame that was composed on this device. `has_geometry`: with its depth and motion, instead of those of
    /// the full-rate frame that was imported or uploaded last. The frame must stay as it is until the methods have run.
    pub fn take_composed(&mut self, frame: &ComposedFrame, has_geometry: bool) {
        self.composed = Some(frame.clone());
        (self.given.rendered, self.given.rendered_geometry) = (Some(RenderedAs::Composed), has_geometry);
        (self.given.lod, self.given.noise) = (true, false);
    }

    /// Makes samples at their pixels on this device the foveated frame, without a copy. `has_geometry`: with their
    /// depth and motion, instead of those of the full-rate frame that was imported or uploaded last.
    pub fn set_samples(&mut self, samples: &DeviceSamples, has_geometry: bool) {
        let DeviceSamples { color, noise, depth, motion, .. } = samples.clone();
        self.atlas = Some(Atlas { color, depth, motion, noise: Some(noise) });
        (self.given.rendered, self.given.rendered_geometry) = (Some(RenderedAs::Atlas), has_geometry);
        (self.given.lod, self.given.noise) = (false, true);
    }

    /// Replaces the color of the atlas.
    #[cfg(feature = "ablation")]
    pub(super) fn write_atlas_color(&self, color: &Image<[f32; 3]>) {
        if let Some(atlas) = &self.atlas {
            self.gpu.write_rgb(&atlas.color, 0, color);
        }
    }

    /// Records the conversion of a rendered frame's color and depth.
    fn import_to(&mut self, encoder: &mut CommandEncoder, frame: &DeviceFrame, to: [&Texture; 2]) {
        let device = &self.gpu.device;
        let import = self.import.get_or_insert_with(|| {
            let types = [
                uniform(),
                float_texture(),
                float_texture(),
                storage_texture(self.formats.color),
                storage_texture(TextureFormat::R32Float),
            ];
            ComputeShader::new(device, "import", SHADERS.compose("import_pass").source, &types)
        });
        let near = filled(device, "near", &frame.near.to_ne_bytes(), BufferUsages::UNIFORM);
        let views = [&frame.color, &frame.depth, to[0], to[1]].map(array_view);
        let resources = std::iter::once(near.as_entire_binding()).chain(views.iter().map(BindingResource::TextureView));
        let group = import.group(device, resources);
        let mut pass = encoder.begin_compute_pass(&Default::default());
        import.dispatch(device, &mut pass, &[], &group, [frame.color.width(), frame.color.height()], 1);
    }

    /// Uploads a frame that its source foveated, with the depth, motion and trust of the full-rate frame `frame`.
    pub fn upload_foveated(
        &mut self,
        frame: &SourceFrame,
        color: &Image<[f32; 3]>,
        lod: Option<&Image<f32>>,
        noise: Option<&Image<[f32; 2]>>,
    ) {
        self.upload_others(frame);
        self.gpu.write_rgb(&self.foveated, 0, color);
        if let Some(lod) = lod {
            self.gpu.write(&self.lod, 0, lod);
        }
        if let Some(noise) = noise {
            self.gpu.write(&self.noise, 0, noise);
        }
        (self.given.lod, self.given.noise) = (lod.is_some(), noise.is_some());
    }

    /// Uploads what a frame has besides its color.
    pub(super) fn upload_others(&mut self, frame: &SourceFrame) {
        if let Some(depth) = &frame.depth {
            self.gpu.write(&self.depth, 0, depth);
        }
        if let Some(motion) = &frame.motion {
            self.gpu.write(&self.motion, 0, motion);
        }
        if let Some(trust) = &frame.trust {
            self.gpu.write(&self.trust, 0, trust);
        }
        self.given = Given {
            depth: frame.depth.is_some(),
            motion: frame.motion.is_some(),
            trust: frame.trust.is_some(),
            ..Given::default()
        };
    }

    /// Uploads texel bytes of color, depth and motion of a full-rate frame, in the formats of the textures.
    pub fn upload_bytes(&mut self, color: &[u8], depth: &[u8], motion: &[u8]) {
        for (texture, bytes) in [(&self.full, color), (&self.depth, depth), (&self.motion, motion)] {
            self.gpu.write_bytes(texture, 0, bytes);
        }
        self.given = Given { depth: true, motion: true, ..Given::default() };
    }

    /// Records the simulator, which foveates the full-rate frame for the gaze of `views`.
    ///
    /// # Errors
    /// [`FrameError`] if a view does not match the simulator's size or view count.
    pub fn foveate(
        &mut self,
        encoder: &mut CommandEncoder,
        views: &[ViewFrame],
        timestamps: Option<Timestamps<'_>>,
    ) -> Result<(), FrameError> {
        let needs_lod = needs_lod(self.simulator.desc().settings.foveation.filter);
        let lod = needs_lod.then_some(&self.lod);
        let frame = SimulatorFrame { lod, timestamps, ..SimulatorFrame::new(&self.full, &self.foveated, views) };
        self.simulator.record(&self.gpu.device, encoder, &frame)?;
        (self.given.lod, self.given.noise, self.given.rendered) = (needs_lod, false, None);
        self.given.rendered_geometry = false;
        Ok(())
    }

    /// The foveated frame as input of the methods. `use_trust`: include the trust mask, if the frame has one.
    pub fn frame<'a>(&'a self, views: &'a [ViewFrame], index: u64, reset: Reset, use_trust: bool) -> Frame<'a> {
        let given = self.given;
        let atlas = self.atlas.as_ref().filter(|_| given.rendered == Some(RenderedAs::Atlas));
        let noise = atlas.and_then(|atlas| atlas.noise.as_ref()).unwrap_or(&self.noise);
        let composed = self.composed.as_ref().filter(|_| given.rendered == Some(RenderedAs::Composed));
        let rendered = atlas.map(|atlas| [&atlas.color, &atlas.depth, &atlas.motion]);
        let rendered = rendered.or(composed.map(|frame| [&frame.color, &frame.distance, &frame.motion]));
        let [depth, motion] = match rendered.filter(|_| given.rendered_geometry) {
            Some([_, depth, motion]) => [Some(depth), Some(motion)],
            None => [given.depth.then_some(&self.depth), given.motion.then_some(&self.motion)],
        };
        Frame {
            depth: depth.map(Into::into),
            motion: motion.map(Into::into),
            trust: (given.trust && use_trust).then_some((&self.trust).into()),
            lod: given.lod.then_some(composed.map_or(&self.lod, |frame| &frame.lod).into()),
            noise: given.noise.then_some(noise.into()),
            reset,
            ..Frame::new(rendered.map_or(&self.foveated, |[color, ..]| color), views, index)
        }
    }

    /// `frame` repeated, with motion vectors of zero.
    pub fn again<'a>(&'a self, frame: Frame<'a>) -> Frame<'a> {
        Frame { motion: frame.motion.map(|_| (&self.no_motion).into()), ..frame }
    }

    /// The full-rate frame.
    pub fn full(&self) -> &Texture {
        &self.full
    }

    /// The foveated frame.
    pub fn foveated(&self) -> &Texture {
        &self.foveated
    }
}

/// Run of a method on a device: context, output and counters.
#[derive(Debug)]
pub struct DeviceRun {
    gpu: Arc<Headless>,
    post: Afterimage,
    output: Texture,
    counters: Buffer,
    debug: Option<Texture>,
}

impl DeviceRun {
    /// Creates a run with `desc`'s settings; its output has the color format of `formats`.
    ///
    /// # Errors
    /// [`CreateError`] if a setting is out of range or the device does not support it.
    pub fn new(gpu: &Arc<Headless>, desc: &ContextDesc, formats: DeviceFormats) -> Result<Self, CreateError> {
        Ok(Self::of(gpu, Afterimage::new(&gpu.device, desc, formats.color)?, formats))
    }

    /// Creates a run with `source` as shader text of the method's pass.
    ///
    /// # Errors
    /// As for [`new`](Self::new).
    pub fn with_shader(
        gpu: &Arc<Headless>,
        desc: &ContextDesc,
        formats: DeviceFormats,
        source: &str,
    ) -> Result<Self, CreateError> {
        Ok(Self::of(gpu, Afterimage::with_shader(&gpu.device, desc, formats.color, source)?, formats))
    }

    fn of(gpu: &Arc<Headless>, post: Afterimage, formats: DeviceFormats) -> Self {
        let output = gpu.texture(post.desc().size_px, 1, formats.color, WRITTEN);
        Self { post, output, counters: gpu.counters(), debug: None, gpu: gpu.clone() }
    }

    /// Context of the post-process.
    pub fn post(&self) -> &Afterimage {
        &self.post
    }

    /// Context of the post-process, to change its settings or to empty its history.
    pub fn post_mut(&mut self) -> &mut Afterimage {
        &mut self.post
    }

    /// Records the method's pass.
    ///
    /// # Errors
    /// [`FrameError`] if the frame does not match the context.
    pub fn record(
        &mut self,
        encoder: &mut CommandEncoder,
        frame: &Frame<'_>,
        timestamps: Option<Timestamps<'_>>,
    ) -> Result<Recorded, FrameError> {
        let target = Target { timestamps, ..Target::new(&self.output) };
        self.post.record(&self.gpu.device, encoder, frame, target)
    }

    /// Records a debug view of the decisions that [`record`](Self::record) of this frame makes, and counts them for
    /// [`stats`](Self::stats). Call it before `record`, which replaces the history. Counting is separate because it
    /// would make `record` a fifth slower.
    ///
    /// # Errors
    /// As for `record`.
    pub fn record_view(
        &mut self,
        encoder: &mut CommandEncoder,
        frame: &Frame<'_>,
        view: DebugView,
    ) -> Result<Recorded, FrameError> {
        let (gpu, size, format) = (&self.gpu, self.post.desc().size_px, self.output.format());
        let debug = &*self.debug.get_or_insert_with(|| gpu.texture(size, 1, format, WRITTEN));
        let target = Target { counters: Some(&self.counters), ..Target::new(debug) };
        self.post.record_view(&gpu.device, encoder, frame, target, view)
    }

    /// Output of the last [`record`](Self::record).
    pub fn output(&self) -> &Texture {
        &self.output
    }

    /// Debug view of the last [`record_view`](Self::record_view).
    pub fn debug(&self) -> Option<&Texture> {
        self.debug.as_ref()
    }

    /// Waits for submitted work and reads the counters of the last [`record_view`](Self::record_view).
    pub fn stats(&self) -> FrameStats {
        self.gpu.read_counters(&self.counters)
    }
}
