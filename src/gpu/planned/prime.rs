//! Depth or stencil of a frame shaded by quads: closed where nothing is to be shaded.

use crate::error::{FrameError, FrameValue};
use crate::gpu::binding::Binding;
use crate::gpu::buffer::filled;
use crate::gpu::compute::Sources;
use crate::gpu::dump::dump;
use std::collections::HashMap;
use wgpu::{
    BindGroupEntry, BindingResource, BufferUsages, CommandEncoder, CompareFunction, DepthStencilState, Device, LoadOp,
    Operations, RenderPassDepthStencilAttachment, RenderPassDescriptor, RenderPipeline, RenderPipelineDescriptor,
    ShaderModule, StencilFaceState, StencilOperation, StencilState, StoreOp, TextureFormat, TextureView,
};

/// What [`Afterimage::prime`](crate::gpu::Afterimage::prime) writes, and where.
///
/// ```
/// use afterimage::gpu::Prime;
/// use afterimage::wgpu::TextureView;
///
/// /// A depth buffer of the view's size, 1 at the near plane.
/// fn reversed(depth: &TextureView) -> Prime<'_> {
///     Prime { target: depth, origin_px: [0, 0], near_depth: 1.0, stencil: None, is_half: false }
/// }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Prime<'a> {
    /// Depth buffer of the prepass: a view of one mip level and layer, of any depth format and number of samples, with
    /// the usage `RENDER_ATTACHMENT`.
    pub target: &'a TextureView,
    /// First pixel of the view in the target.
    pub origin_px: [u32; 2],
    /// Depth at the near plane: 0, or 1 where depth is reversed. Every depth test but `Always`, `NotEqual` and those
    /// towards the far plane rejects what is drawn behind it.
    pub near_depth: f32,
    /// Writes this stencil value where nothing is to be shaded, 0 to 255, in place of depth, which stays as it is. For
    /// renderers whose pipelines test a stencil, and targets with one.
    pub stencil: Option<u8>,
    /// Whether quads that are shaded in part are drawn at half the size
    /// ([`Afterimage::is_quarter`](crate::gpu::Afterimage::is_quarter)): then they are closed, too. Otherwise their
    /// shaded pixels are open.
    pub is_half: bool,
}

/// Format, number of samples, bits of the near plane's depth, and whether a stencil is written.
type Key = (TextureFormat, u32, u32, bool);

#[derive(Debug)]
pub(crate) struct PrimePass {
    module: ShaderModule,
    pipelines: HashMap<Key, RenderPipeline>,
}

impl PrimePass {
    pub fn new(device: &Device, sources: &Sources) -> Self {
        let text = sources.text("quad_prime_pass");
        dump("quad_prime_pass", &text);
        let source = wgpu::ShaderSource::Wgsl(text);
        let label = Some("afterimage prime");
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label, source });
        Self { module, pipelines: HashMap::new() }
    }

    /// Compiles the pipeline for a target.
    ///
    /// # Errors
    /// As for [`record`](Self::record).
    pub fn prewarm(&mut self, device: &Device, size_px: [u32; 2], prime: &Prime<'_>) -> Result<(), FrameError> {
        check(0, size_px, prime)?;
        self.pipeline(device, prime);
        Ok(())
    }

    fn pipeline(&mut self, device: &Device, prime: &Prime<'_>) -> &RenderPipeline {
        let texture = prime.target.texture();
        let key = (texture.format(), texture.sample_count(), prime.near_depth.to_bits(), prime.stencil.is_some());
        let module = &self.module;
        self.pipelines.entry(key).or_insert_with(|| pipeline(device, module, key))
    }

    /// Records the pass for view `view` of `size_px`, whose shaded quads are in `mask`.
    ///
    /// # Errors
    /// [`FrameError`] if the target has no depth or stencil to write or is too small, or if the depth of the near plane
    /// is out of range.
    pub fn record(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        (view, size_px, mask): (u32, [u32; 2], &TextureView),
        prime: &Prime<'_>,
    ) -> Result<(), FrameError> {
        check(view, size_px, prime)?;
        let format = prime.target.texture().format();
        let pipeline = self.pipeline(device, prime);
        let [x, y] = prime.origin_px;
        let words = [x, y, size_px[0], size_px[1], view, u32::from(prime.is_half), 0, 0];
        let words = filled(device, "afterimage prime", bytemuck::bytes_of(&words), BufferUsages::UNIFORM);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("afterimage prime"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[
                BindGroupEntry { binding: 0, resource: words.as_entire_binding() },
                BindGroupEntry { binding: Binding::QuadMask as u32, resource: BindingResource::TextureView(mask) },
            ],
        });
        let depth_ops = format.has_depth_aspect().then_some(Operations { load: LoadOp::Load, store: StoreOp::Store });
        let stencil_ops =
            format.has_stencil_aspect().then_some(Operations { load: LoadOp::Load, store: StoreOp::Store });
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("afterimage prime"),
            depth_stencil_attachment: Some(RenderPassDepthStencilAttachment {
                view: prime.target,
                depth_ops,
                stencil_ops,
            }),
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.set_scissor_rect(x, y, size_px[0], size_px[1]);
        pass.set_stencil_reference(prime.stencil.unwrap_or(0).into());
        pass.draw(0..3, 0..1);
        Ok(())
    }
}

fn check(view: u32, size_px: [u32; 2], prime: &Prime<'_>) -> Result<(), FrameError> {
    let texture = prime.target.texture();
    let format = texture.format();
    let (has_it, expected) = match prime.stencil {
        Some(_) => (format.has_stencil_aspect(), "a format with a stencil"),
        None => (format.has_depth_aspect(), "a depth format"),
    };
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
    if !has_it || !texture.usage().contains(usage) {
        let problem = format!("usage {:?}", texture.usage());
        let expected = if has_it { "the usage RENDER_ATTACHMENT" } else { expected };
        return Err(FrameError::Texture { input: "target of prime", format: format!("{format:?}"), problem, expected });
    }
    if !(0.0..=1.0).contains(&prime.near_depth) {
        let (found, expected) = (format!("closed with a depth of {}", prime.near_depth), "near_depth from 0 to 1");
        return Err(FrameError::Value { value: FrameValue::Plan, view: view as usize, found, expected });
    }
    let found = [texture.width(), texture.height()];
    let fits = |i: usize| prime.origin_px[i].checked_add(size_px[i]).is_some_and(|end| end <= found[i]);
    if !(fits(0) && fits(1)) {
        let [x, y] = prime.origin_px;
        return Err(FrameError::Value {
            value: FrameValue::Region { input: "target of prime" },
            view: view as usize,
            found: format!("{}x{} pixels, with the view at {x}, {y}", found[0], found[1]),
            expected: "a target that contains the view",
        });
    }
    Ok(())
}

fn pipeline(device: &Device, module: &ShaderModule, key: Key) -> RenderPipeline {
    let (format, samples, near, is_stencil) = key;
    let face = match is_stencil {
        true => StencilFaceState { pass_op: StencilOperation::Replace, ..StencilFaceState::IGNORE },
        false => StencilFaceState::IGNORE,
    };
    let stencil = StencilState { front: face, back: face, read_mask: 0xff, write_mask: 0xff };
    let constants = [("NEAR", f64::from(f32::from_bits(near)))];
    let stage = wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
    device.create_render_pipeline(&RenderPipelineDescriptor {
        label: Some("afterimage prime"),
        layout: None,
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("corner"),
            compilation_options: stage.clone(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: Some(DepthStencilState {
            format,
            depth_write_enabled: format.has_depth_aspect().then_some(!is_stencil),
            depth_compare: format.has_depth_aspect().then_some(CompareFunction::Always),
            stencil: if is_stencil { stencil } else { StencilState::default() },
            bias: Default::default(),
        }),
        multisample: wgpu::MultisampleState { count: samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("close"),
            compilation_options: stage,
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    })
}
