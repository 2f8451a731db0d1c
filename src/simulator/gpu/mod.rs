//! The simulators on a GPU: of a full-rate frame they make what a foveating renderer would have delivered, recorded into the caller's
//! command encoder. Twins of [`Foveation::render`](crate::foveation::Foveation::render) and [`lod_map`](crate::foveation::Foveation::lod_map), bit-equal to
//! them on software Vulkan.
//!
//! The caller owns device, queue, encoder, every input and output texture, and submission, as with [`Afterimage`](crate::gpu::Afterimage),
//! and describes both by one [`GpuDesc`]. Kept on the device: for the mip levels of [`Filter::Mip`] 5.4 bytes a pixel, of
//! [`Filter::Block`] 5; between the axes of [`Filter::Gauss`] 16.

mod mip_chain;
mod pass;
// Public for this package's own tests, which compare struct layouts.
#[doc(hidden)]
pub mod types;

use crate::error::{CreateError, FrameError};
use crate::foveation::Filter;
use crate::frame::ViewFrame;
use crate::gpu::{GpuDesc, Timestamps, array_view, check_readable, check_texture, filled};
use crate::kernel::foveate::block_sample_level;
use crate::shader::SHADERS;
use mip_chain::MipChain;
use pass::{Pass, sampled, storage, uniform};
use types::{FoveationConstants, ViewConstants};
use wgpu::{
    BindingResource, CommandEncoder, ComputePassTimestampWrites, Device, Texture, TextureFormat, TextureUsages,
    TextureView,
};

/// One frame. All textures have the size of the context, one array layer a view (mono frames are plain 2D textures), and one sample a
/// pixel.
#[derive(Clone, Copy, Debug)]
pub struct FoveationFrame<'a> {
    /// The frame at full rate: linear color, any float format, usage `TEXTURE_BINDING`.
    pub full: &'a Texture,
    /// The foveated frame: the context's output format, usage `STORAGE_BINDING`. Pixels of level 0 are copied bit for bit if `full` has
    /// the same format.
    pub output: &'a Texture,
    /// Where to write each pixel's level of detail (log2 of the block edge in pixels), for
    /// [`Frame::lod`](crate::gpu::Frame::lod): `R32Float`, usage `STORAGE_BINDING`. `None`: nowhere.
    pub lod: Option<&'a Texture>,
    /// One entry a view; its geometry and gaze matter here.
    pub views: &'a [ViewFrame],
    /// Where the device writes when the passes begin and end, if the caller wants to time them. Needs
    /// `Features::TIMESTAMP_QUERY`.
    pub timestamps: Option<Timestamps<'a>>,
}

impl<'a> FoveationFrame<'a> {
    /// A frame without optional outputs.
    pub fn new(full: &'a Texture, output: &'a Texture, views: &'a [ViewFrame]) -> Self {
        Self { full, output, lod: None, views, timestamps: None }
    }
}

/// A foveation simulator on the GPU.
#[derive(Debug)]
pub struct GpuFoveation {
    desc: GpuDesc,
    steps: Steps,
    held_gaze: Vec<Option<[f32; 2]>>,
    /// Bound where no levels of detail are wanted; not written.
    no_lod: TextureView,
}

/// What a filter does, and keeps between its passes.
#[derive(Debug)]
enum Steps {
    Levels { chain: MipChain, show: Pass },
    Axes { across: Pass, between: TextureView, down: Pass },
}

impl GpuFoveation {
    /// A simulator of `desc.settings.foveation` for frames of `desc.context` (of which size and number of views matter here) and
    /// `desc.output_format`. Makes shaders; pipelines are made at the first frame that needs them.
    ///
    /// # Errors
    /// If a setting or fact is out of range, or the device cannot do it.
    pub fn new(device: &Device, desc: &GpuDesc) -> Result<Self, CreateError> {
        Self::with_shaders(device, desc, |name| SHADERS.compose(name).source)
    }

    /// The same with shaders from elsewhere: this package's own tests plant errors in them.
    #[doc(hidden)]
    pub fn with_shaders(device: &Device, desc: &GpuDesc, source: impl Fn(&str) -> String) -> Result<Self, CreateError> {
        desc.validate(&device.limits())?;
        let texel = desc.output_texel()?;
        // The texel format of a storage texture is part of the text in WGSL.
        let writing = |name, texel| source(name).replace("rgba16float", texel);
        let context = &desc.context;
        let foveation = desc.settings.foveation;
        let output = storage(desc.output_format);
        let lod = storage(TextureFormat::R32Float);
        let levels = |coarsest, name| Steps::Levels {
            chain: MipChain::new(device, context, coarsest, source("mip_level")),
            show: Pass::new(device, name, writing(name, texel), &[uniform(), sampled(), sampled(), output, lod], &[]),
        };
        let steps = match foveation.filter {
            Filter::Mip => levels(foveation.max_level(), "mip_show"),
            Filter::Block => levels(block_sample_level(foveation.max_level()), "block_show"),
            // Blocks of one pixel.
            Filter::Off => levels(0, "block_show"),
            Filter::Gauss => {
                let format = TextureFormat::Rgba32Float;
                let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::STORAGE_BINDING;
                let axis = |texel, output, constants| {
                    let types = [uniform(), sampled(), output, lod];
                    Pass::new(device, "gauss_axis", writing("gauss_axis", texel), &types, constants)
                };
                Steps::Axes {
                    across: axis("rgba32float", storage(format), &[("AXIS", 0.0)]),
                    between: array_view(&texture(device, context.size_px, context.view_count, 1, format, usage)),
                    down: axis(texel, output, &[("AXIS", 1.0)]),
                }
            }
        };
        let no_lod = texture(device, [1, 1], 1, 1, TextureFormat::R32Float, TextureUsages::STORAGE_BINDING);
        Ok(Self { desc: *desc, steps, held_gaze: vec![None; context.view_count as usize], no_lod: array_view(&no_lod) })
    }

    /// What it was made for.
    pub fn desc(&self) -> &GpuDesc {
        &self.desc
    }

    /// Records one frame into `encoder`. A lost gaze is held, as by the post-process.
    ///
    /// # Errors
    /// If a texture or number does not fit the context; then nothing was recorded and no state has moved.
    pub fn record(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        frame: &FoveationFrame<'_>,
    ) -> Result<(), FrameError> {
        self.check(frame)?;
        let constants = self.constants(frame.views);
        let (label, bytes) = ("afterimage foveation constants", bytemuck::bytes_of(&constants));
        let constants = filled(device, label, bytes, wgpu::BufferUsages::UNIFORM);
        let constants = constants.as_entire_binding();
        let view = BindingResource::TextureView;
        let (full, output) = (array_view(frame.full), array_view(frame.output));
        let lod = frame.lod.map_or_else(|| self.no_lod.clone(), array_view);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("afterimage foveation"),
            timestamp_writes: frame.timestamps.map(|t| ComputePassTimestampWrites {
                query_set: t.queries,
                beginning_of_pass_write_index: Some(t.begin),
                end_of_pass_write_index: Some(t.end),
            }),
        });
        let (size, views, write_lod) = (self.desc.context.size_px, self.desc.context.view_count, frame.lod.is_some());
        match &self.steps {
            Steps::Levels { chain, show } => {
                chain.record(device, &mut pass, &full);
                let resources = [constants, view(&full), view(&chain.levels), view(&output), view(&lod)];
                show.record(device, &mut pass, &resources, write_lod, size, views);
            }
            Steps::Axes { across, between, down } => {
                let resources = [constants.clone(), view(&full), view(between), view(&self.no_lod)];
                across.record(device, &mut pass, &resources, false, size, views);
                let resources = [constants, view(between), view(&output), view(&lod)];
                down.record(device, &mut pass, &resources, write_lod, size, views);
            }
        }
        Ok(())
    }

    fn check(&self, frame: &FoveationFrame<'_>) -> Result<(), FrameError> {
        let desc = &self.desc;
        let (found, expected) = (frame.views.len(), desc.context.view_count as usize);
        if found != expected {
            return Err(FrameError::ViewCount { found, expected });
        }
        for (i, view) in frame.views.iter().enumerate() {
            view.check(i, &desc.context)?;
        }
        check_texture(desc, "the full-rate frame", frame.full, TextureUsages::TEXTURE_BINDING)?;
        check_readable("the full-rate frame", frame.full, 3)?;
        let written = [
            ("output", Some(frame.output), desc.output_format, "the output format that the context was made for"),
            ("levels of detail", frame.lod, TextureFormat::R32Float, "R32Float"),
        ];
        for (input, texture, format, expected) in written {
            let Some(texture) = texture else { continue };
            check_texture(desc, input, texture, TextureUsages::STORAGE_BINDING)?;
            if texture.format() != format {
                let found = format!("{:?}", texture.format());
                return Err(FrameError::Texture {
                    input,
                    format: found,
                    problem: "not what is written".into(),
                    expected,
                });
            }
        }
        Ok(())
    }

    /// The frame's constants. Remembers where the eyes look.
    fn constants(&mut self, views: &[ViewFrame]) -> FoveationConstants {
        let size = self.desc.context.size_px;
        let mut constants = FoveationConstants::new(&self.desc.settings.foveation, size);
        for ((to, view), held) in constants.views.iter_mut().zip(views).zip(&mut self.held_gaze) {
            let gaze_px = view.gaze.resolve(*held, size);
            *held = Some(gaze_px);
            *to = ViewConstants::new(&view.geometry, gaze_px);
        }
        constants
    }
}

fn texture(
    device: &Device,
    size: [u32; 2],
    view_count: u32,
    mip_level_count: u32,
    format: TextureFormat,
    usage: TextureUsages,
) -> Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("afterimage foveation"),
        size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: view_count },
        mip_level_count,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}
