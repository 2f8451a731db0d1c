//! Inputs of the methods on a device.

use super::{DeviceFormats, WRITTEN};
use crate::device::Headless;
use crate::frame::{ComposedFrame, Content, DeviceFrame, OnDevice, RenderedFrame, SourceFrame};
use crate::quad_views::Geometry;
use crate::shader::SHADERS;
use afterimage::gpu::{Frame, Timestamps};
use afterimage::internal::{ComputeShader, array_view, filled};
use afterimage::internal::{ContextDesc, GpuSimulator, Reset, SimulatorFrame, ViewFrame};
use afterimage::kernel::pack::half_bits;
use afterimage::{CreateError, FrameError, Image};
use afterimage_eval::pipeline::needs_lod;
use std::sync::Arc;
use wgpu::{BindingResource, BufferUsages, CommandEncoder, Texture, TextureFormat, TextureUsages};

/// Inputs of the methods on a device: the full-rate frame, and the foveated frame that its source rendered or a
/// simulator computes from it.
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
    /// Albedo; none before the first frame that has it.
    albedo: Option<Texture>,
    foveated: Texture,
    simulator: GpuSimulator,
    import: Option<ComputeShader>,
    /// Color and distance of the last surfaces.
    surfaces: Option<[Texture; 2]>,
    given: Given,
}

/// The textures of the current frame that the methods get.
#[derive(Clone, Debug)]
struct Given {
    color: Texture,
    depth: Option<Texture>,
    motion: Option<Texture>,
    trust: Option<Texture>,
    lod: Option<Texture>,
    noise: Option<Texture>,
    albedo: Option<Texture>,
}

impl Given {
    fn color(color: &Texture) -> Self {
        Self { color: color.clone(), depth: None, motion: None, trust: None, lod: None, noise: None, albedo: None }
    }
}

impl DeviceInputs {
    /// Creates textures of `desc`'s size and a simulator of the foveation in its settings.
    ///
    /// # Errors
    /// [`CreateError`] if a setting is out of range or the device does not support it.
    pub fn new(gpu: &Arc<Headless>, desc: &ContextDesc, formats: DeviceFormats) -> Result<Self, CreateError> {
        let texture = |format, usage| gpu.texture(desc.size_px, 1, format, usage);
        let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST | TextureUsages::COPY_SRC;
        let foveated = texture(formats.color, WRITTEN | TextureUsages::COPY_DST);
        Ok(Self {
            formats,
            full: texture(formats.color, read | TextureUsages::STORAGE_BINDING),
            depth: texture(TextureFormat::R32Float, read | TextureUsages::STORAGE_BINDING),
            motion: texture(formats.motion, read),
            no_motion: texture(formats.motion, read),
            trust: texture(TextureFormat::R32Float, read),
            lod: texture(TextureFormat::R32Float, read | TextureUsages::STORAGE_BINDING),
            noise: texture(TextureFormat::Rg32Float, read),
            albedo: None,
            simulator: GpuSimulator::new(&gpu.device, desc, formats.color)?,
            import: None,
            surfaces: None,
            given: Given::color(&foveated),
            foveated,
            gpu: gpu.clone(),
        })
    }

    /// Size and foveation of the simulator.
    pub fn desc(&self) -> &ContextDesc {
        self.simulator.desc()
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

    /// Makes `frame` the current one. Images on this device are used directly if the methods can read them, and
    /// imported otherwise; they must stay until the methods have run. Other images are uploaded. Values are the same in
    /// each case. A full-rate frame waits for [`foveate`](Self::foveate). Records into `encoder`.
    pub fn set(&mut self, encoder: &mut CommandEncoder, frame: &RenderedFrame) {
        match &frame.content {
            Content::FullRate => {
                if self.set_reference(encoder, frame).is_none() {
                    self.write_rgb(&self.full, &frame.reference.color);
                }
            }
            Content::Jittered(jittered) => {
                self.given = self.upload_geometry(jittered);
                self.write_rgb(&self.full, &jittered.color);
            }
            Content::Foveated(foveated) => {
                self.given = self.upload_geometry(&frame.reference);
                self.write_rgb(&self.foveated, &foveated.color);
                self.given.lod = Some(self.uploaded(&self.lod, &foveated.lod));
                self.given.noise = foveated.noise.as_ref().map(|noise| self.uploaded(&self.noise, noise));
            }
            Content::Surfaces => self.given = self.upload_geometry(&frame.reference),
            content @ Content::OnDevice(_) => {
                let content = OnDevice::of(content).expect("this crate has no other frames on devices");
                let has_geometry = frame.geometry == Geometry::Samples || matches!(content, OnDevice::Surfaces(_));
                let content = self.take(encoder, content);
                self.given = if has_geometry {
                    content
                } else {
                    self.set_reference(encoder, frame);
                    Given { color: content.color, lod: content.lod, noise: content.noise, ..self.given.clone() }
                };
            }
        }
        self.given.albedo = frame.albedo.as_ref().map(|albedo| self.upload_albedo(albedo));
    }

    fn upload_albedo(&mut self, albedo: &Image<[f32; 3]>) -> Texture {
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        let new = || self.gpu.texture(albedo.size(), 1, TextureFormat::Rgba32Float, usage);
        let texture = self.albedo.get_or_insert_with(new).clone();
        self.gpu.write_rgb(&texture, 0, albedo);
        texture
    }

    /// Takes depth, motion and trust of the full-rate frame, and its color if that is on this device.
    fn set_reference(&mut self, encoder: &mut CommandEncoder, frame: &RenderedFrame) -> Option<()> {
        let rendered = frame.reference_on_device.as_ref().and_then(|on| on.downcast_ref::<DeviceFrame>());
        let rendered = rendered.filter(|on| Arc::ptr_eq(&on.device, &self.gpu));
        let Some(rendered) = rendered else {
            self.given = self.upload_geometry(&frame.reference);
            return None;
        };
        self.import(encoder, rendered, [&self.full.clone(), &self.depth.clone()]);
        let size = rendered.motion.size();
        encoder.copy_texture_to_texture(rendered.motion.as_image_copy(), self.motion.as_image_copy(), size);
        let (depth, motion) = (Some(self.depth.clone()), Some(self.motion.clone()));
        self.given = Given { depth, motion, ..Given::color(&self.foveated) };
        Some(())
    }

    /// A frame that its source foveated on this device, with its own depth and motion.
    fn take(&mut self, encoder: &mut CommandEncoder, content: &OnDevice) -> Given {
        match content {
            // The color of surfaces is replaced when pixels are shaded.
            OnDevice::Surfaces(surfaces) => {
                let [color, depth] = self.import_surfaces(encoder, surfaces);
                Given { depth: Some(depth), motion: Some(surfaces.motion.clone()), ..Given::color(&color) }
            }
            OnDevice::Composed(ComposedFrame { color, distance, motion, lod, .. }) => {
                let (depth, motion) = (Some(distance.clone()), Some(motion.clone()));
                Given { depth, motion, lod: Some(lod.clone()), ..Given::color(color) }
            }
        }
    }

    /// Imports surfaces; their color and distance.
    fn import_surfaces(&mut self, encoder: &mut CommandEncoder, surfaces: &DeviceFrame) -> [Texture; 2] {
        let size = [surfaces.color.width(), surfaces.color.height()];
        let fits = |[color, _]: &[Texture; 2]| [color.width(), color.height()] == size;
        let held = self.surfaces.take().filter(fits).unwrap_or_else(|| {
            let texture = |format| self.gpu.texture(size, 1, format, WRITTEN | TextureUsages::COPY_DST);
            [self.formats.color, TextureFormat::R32Float].map(texture)
        });
        let [color, depth] = &held;
        self.import(encoder, surfaces, [color, depth]);
        self.surfaces.insert(held).clone()
    }

    /// Records the conversion of a rasterized frame's color and depth.
    fn import(&mut self, encoder: &mut CommandEncoder, frame: &DeviceFrame, to: [&Texture; 2]) {
        let device = &self.gpu.device;
        let import = self
            .import
            .get_or_insert_with(|| ComputeShader::new(device, "import", &SHADERS.compose("import_pass").source));
        let near = filled(device, "near", &frame.near.to_ne_bytes(), BufferUsages::UNIFORM);
        let views = [&frame.color, &frame.depth, to[0], to[1]].map(array_view);
        let resources = std::iter::once(near.as_entire_binding()).chain(views.iter().map(BindingResource::TextureView));
        let group = import.group(device, resources);
        let mut pass = encoder.begin_compute_pass(&Default::default());
        import.dispatch(device, &mut pass, &[], &group, [frame.color.width(), frame.color.height()], 1);
    }

    /// Uploads all images of a frame except its color.
    fn upload_geometry(&self, frame: &SourceFrame) -> Given {
        let upload_motion = |motion: &Image<[f32; 2]>| {
            match self.formats.motion {
                TextureFormat::Rg16Float => self.gpu.write(&self.motion, 0, &motion.map(|v| v.map(half))),
                _ => self.gpu.write(&self.motion, 0, motion),
            }
            self.motion.clone()
        };
        Given {
            depth: frame.depth.as_ref().map(|depth| self.uploaded(&self.depth, depth)),
            motion: frame.motion.as_ref().map(upload_motion),
            trust: frame.trust.as_ref().map(|trust| self.uploaded(&self.trust, trust)),
            ..Given::color(&self.foveated)
        }
    }

    fn uploaded<T: bytemuck::NoUninit>(&self, texture: &Texture, image: &Image<T>) -> Texture {
        self.gpu.write(texture, 0, image);
        texture.clone()
    }

    fn write_rgb(&self, texture: &Texture, color: &Image<[f32; 3]>) {
        match self.formats.color {
            TextureFormat::Rgba16Float => {
                self.gpu.write(texture, 0, &color.map(|[r, g, b]| [r, g, b, 1.0].map(half)));
            }
            _ => self.gpu.write_rgb(texture, 0, color),
        }
    }

    /// Uploads shaded pixels to the texture of the full-rate frame, which planned frames do not use.
    pub(super) fn upload_shaded(&self, color: &Image<[f32; 3]>) -> &Texture {
        self.write_rgb(&self.full, color);
        &self.full
    }

    /// Uploads the noise of shaded pixels.
    pub(super) fn upload_noise(&self, noise: &Image<[f32; 2]>) -> &Texture {
        self.gpu.write(&self.noise, 0, noise);
        &self.noise
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
        let lod = needs_lod(self.simulator.desc().settings.foveation.kind).then_some(&self.lod);
        let frame = SimulatorFrame { lod, timestamps, ..SimulatorFrame::new(&self.full, &self.foveated, views) };
        self.simulator.record(&self.gpu.device, encoder, &frame)?;
        self.given = Given { lod: lod.cloned(), ..self.given.clone() };
        Ok(())
    }

    /// Albedo of every pixel of the frame, for methods that take it.
    pub(super) fn albedo(&self) -> Option<&Texture> {
        self.given.albedo.as_ref()
    }

    /// The foveated frame as input of the methods, without albedo. `use_trust`: include the trust mask, if the frame
    /// has one.
    pub fn frame<'a>(&'a self, views: &'a [ViewFrame], index: u64, reset: Reset, use_trust: bool) -> Frame<'a> {
        let Given { color, depth, motion, trust, lod, noise, .. } = &self.given;
        Frame {
            depth: depth.as_ref().map(Into::into),
            motion: motion.as_ref().map(Into::into),
            trust: trust.as_ref().filter(|_| use_trust).map(Into::into),
            lod: lod.as_ref().map(Into::into),
            noise: noise.as_ref().map(Into::into),
            reset,
            ..Frame::new(color, views, index)
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
}

fn half(value: f32) -> u16 {
    half_bits(value) as u16
}
