//! Simulators on a GPU, recorded into the caller's command encoder. Twins of `Foveation::render` and
//! `Foveation::lod_map`, bit-equal to them on software Vulkan.

mod mip_chain;
pub(crate) mod uniforms;

use crate::context::ContextDesc;
use crate::error::{CreateError, FrameError};
use crate::foveation::FoveationKind;
use crate::frame::Exposure;
use crate::gpu::buffer::filled;
use crate::gpu::compute::{ComputeShader, Sources};
use crate::gpu::plane::{Plane, PlaneDesc, array_view};
use crate::gpu::{Timestamps, check_readable, check_texture, texel, validate};
use crate::kernel::foveate::block_sample_level;
use crate::uniforms::ViewState;
use crate::view::ViewFrame;
use mip_chain::MipChain;
use uniforms::FoveationUniforms;
use wgpu::{
    BindingResource, BufferUsages, CommandEncoder, ComputePassDescriptor, Device, Texture, TextureFormat, TextureUsages,
};

/// Inputs and outputs of a simulated frame. Example: [`Simulator`](crate::levels::Simulator).
///
/// All textures have the context's size, one array layer for each view (a plain 2D texture for one view), and one
/// sample a pixel.
#[derive(Clone, Copy, Debug)]
pub struct SimulatorFrame<'a> {
    /// Input: the frame at full rate. Linear color, any float format, usage `TEXTURE_BINDING`.
    pub full: &'a Texture,
    /// Output: the foveated frame. The simulator's output format, usage `STORAGE_BINDING`. Pixels of level 0 are copied
    /// bit for bit if `full` has the same format.
    pub output: &'a Texture,
    /// Output: level of detail of each pixel (log2 of the block edge in pixels), for
    /// [`FrameInputs::lod`](crate::levels::FrameInputs::lod). `R32Float`, usage `STORAGE_BINDING`. `None`: not written.
    pub lod: Option<&'a Texture>,
    /// Descriptions of the views, one for each view of the context; only geometry and gaze are used.
    pub views: &'a [ViewFrame],
    /// Timestamp queries around the passes. Needs `Features::TIMESTAMP_QUERY`.
    pub timestamps: Option<Timestamps<'a>>,
}

impl<'a> SimulatorFrame<'a> {
    /// A frame without levels of detail and timestamps.
    pub fn new(full: &'a Texture, output: &'a Texture, views: &'a [ViewFrame]) -> Self {
        Self { full, output, lod: None, views, timestamps: None }
    }
}

/// Passes of [`Simulator`](crate::levels::Simulator).
#[derive(Debug)]
pub struct GpuSimulator {
    desc: ContextDesc,
    output_format: TextureFormat,
    steps: Steps,
    state: Vec<ViewState>,
    /// Placeholder for frames without levels of detail; not written.
    no_lod: Plane,
}

/// Passes of a filter, and their intermediate textures.
#[derive(Debug)]
enum Steps {
    Levels { mip_chain: MipChain, show: ComputeShader },
    Axes { across: ComputeShader, between: Plane, down: ComputeShader },
}

impl GpuSimulator {
    /// A simulator of the foveation `desc.settings.foveation`, for frames of the size and number of views of `desc`,
    /// and outputs of `output_format`, as for contexts. Creates shader modules; pipelines are compiled at the first
    /// frame that needs them.
    ///
    /// # Errors
    /// [`CreateError`] if the description is out of range, the output format is not supported, or a limit of the device
    /// is too low.
    pub fn new(device: &Device, desc: &ContextDesc, output_format: TextureFormat) -> Result<Self, CreateError> {
        Self::with_sources(device, desc, output_format, &Sources::default())
    }

    /// A simulator with other texts of its passes, for tests that plant errors.
    #[doc(hidden)]
    pub fn with_sources(
        device: &Device,
        desc: &ContextDesc,
        output_format: TextureFormat,
        sources: &Sources,
    ) -> Result<Self, CreateError> {
        validate(device, desc, output_format)?;
        let texel = texel(device, output_format)?;
        // In WGSL the texel format of a storage texture is part of its type.
        let writing = |name, texel| sources.shader_of(device, name, &sources.text(name).replace("rgba16float", texel));
        let plane = |format, size, layers| PlaneDesc::new("afterimage foveation", format, size, layers).create(device);
        let levels = |coarsest, name| Steps::Levels {
            mip_chain: MipChain::new(device, desc, coarsest, sources),
            show: writing(name, texel),
        };
        let foveation = desc.settings.foveation;
        let steps = match foveation.kind {
            FoveationKind::Mip => levels(foveation.max_level(), "mip_show"),
            FoveationKind::Block => levels(block_sample_level(foveation.max_level()), "block_show"),
            // Blocks of one pixel copy the full-rate frame: the post-process reads only the samples of a planned frame.
            FoveationKind::Off | FoveationKind::Quads => levels(0, "block_show"),
            FoveationKind::Gauss => Steps::Axes {
                across: writing("gauss_axis", "rgba32float"),
                between: plane(TextureFormat::Rgba32Float, desc.size_px, desc.view_count),
                down: writing("gauss_axis", texel),
            },
        };
        Ok(Self {
            desc: *desc,
            output_format,
            steps,
            state: vec![ViewState::default(); desc.view_count as usize],
            no_lod: plane(TextureFormat::R32Float, [1, 1], 1),
        })
    }

    /// Description that the simulator was created with.
    pub fn desc(&self) -> &ContextDesc {
        &self.desc
    }

    /// Records one frame into `encoder`. For a lost gaze the last known position is used, as by the post-process.
    ///
    /// # Errors
    /// [`FrameError`] if a texture or value does not fit the description; then nothing was recorded and held gaze
    /// positions are unchanged.
    pub fn record(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        frame: &SimulatorFrame<'_>,
    ) -> Result<(), FrameError> {
        self.check(frame)?;
        let uniforms = self.uniforms(frame.views);
        let (label, bytes) = ("afterimage foveation uniforms", bytemuck::bytes_of(&uniforms));
        let uniforms = filled(device, label, bytes, BufferUsages::UNIFORM);
        let uniforms = || uniforms.as_entire_binding();
        let view = BindingResource::TextureView;
        let (full, output) = (array_view(frame.full), array_view(frame.output));
        let lod = frame.lod.map_or_else(|| self.no_lod.whole.clone(), array_view);
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor {
            label: Some("afterimage foveation"),
            timestamp_writes: frame.timestamps.map(Timestamps::writes),
        });
        let (size, layers) = (self.desc.size_px, self.desc.view_count);
        let write_lod = ("WRITE_LOD", u32::from(frame.lod.is_some()));
        match &self.steps {
            Steps::Levels { mip_chain, show } => {
                mip_chain.record(device, &mut pass, &full);
                let resources = [uniforms(), view(&full), view(&mip_chain.levels.whole), view(&output), view(&lod)];
                let group = show.group(device, resources);
                show.dispatch(device, &mut pass, &[write_lod], &group, size, layers);
            }
            Steps::Axes { across, between, down } => {
                let group =
                    across.group(device, [uniforms(), view(&full), view(&between.whole), view(&self.no_lod.whole)]);
                across.dispatch(device, &mut pass, &[("AXIS", 0), ("WRITE_LOD", 0)], &group, size, layers);
                let group = down.group(device, [uniforms(), view(&between.whole), view(&output), view(&lod)]);
                down.dispatch(device, &mut pass, &[("AXIS", 1), write_lod], &group, size, layers);
            }
        }
        Ok(())
    }

    fn check(&self, frame: &SimulatorFrame<'_>) -> Result<(), FrameError> {
        let desc = &self.desc;
        let (found, expected) = (frame.views.len(), desc.view_count as usize);
        if found != expected {
            return Err(FrameError::ViewCount { found, expected });
        }
        for (i, view) in frame.views.iter().enumerate() {
            view.check(i, desc)?;
        }
        check_texture(desc, "the full-rate frame", frame.full, TextureUsages::TEXTURE_BINDING)?;
        check_readable("the full-rate frame", frame.full, 3)?;
        let written = [
            ("output", Some(frame.output), self.output_format, "the output format given to the simulator"),
            ("levels of detail", frame.lod, TextureFormat::R32Float, "R32Float"),
        ];
        for (input, texture, format, expected) in written {
            let Some(texture) = texture else { continue };
            check_texture(desc, input, texture, TextureUsages::STORAGE_BINDING)?;
            if texture.format() != format {
                let found = format!("{:?}", texture.format());
                return Err(FrameError::Texture { input, format: found, problem: "the wrong format".into(), expected });
            }
        }
        Ok(())
    }

    /// Uniforms of a frame. Also stores its gaze positions, for later frames in which the gaze is lost.
    fn uniforms(&mut self, views: &[ViewFrame]) -> FoveationUniforms {
        for (view, state) in views.iter().zip(&mut self.state) {
            *state = state.with(view, Exposure::Same);
        }
        FoveationUniforms::new(&self.desc, views, &self.state)
    }
}
