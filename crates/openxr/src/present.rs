//! Linear color to a swapchain's image. Its format encodes sRGB, which compute shaders cannot write, so this is a draw.

use crate::targets::layer;
use wgpu_30::{
    BindGroupDescriptor, BindGroupEntry, BindingResource, Color, CommandEncoder, Device, FragmentState, LoadOp,
    Operations, RenderPassColorAttachment, RenderPassDescriptor, RenderPipeline, RenderPipelineDescriptor, StoreOp,
    Texture, TextureFormat, VertexState, include_wgsl,
};

#[derive(Debug)]
pub(crate) struct Present(RenderPipeline);

impl Present {
    pub fn new(device: &Device, format: TextureFormat) -> Self {
        let module = device.create_shader_module(include_wgsl!("present.wgsl"));
        Self(device.create_render_pipeline(&RenderPipelineDescriptor {
            label: Some("present"),
            layout: None,
            vertex: VertexState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(FragmentState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                targets: &[Some(format.into())],
            }),
            multiview_mask: None,
            cache: None,
        }))
    }

    /// Both layers of `from` to those of `to`.
    pub fn record(&self, device: &Device, encoder: &mut CommandEncoder, from: &Texture, to: &Texture) {
        for eye in 0..2 {
            let group = device.create_bind_group(&BindGroupDescriptor {
                label: None,
                layout: &self.0.get_bind_group_layout(0),
                entries: &[BindGroupEntry { binding: 0, resource: BindingResource::TextureView(&layer(from, eye)) }],
            });
            let view = layer(to, eye);
            let ops = Operations { load: LoadOp::Clear(Color::BLACK), store: StoreOp::Store };
            let attachment = RenderPassColorAttachment { view: &view, depth_slice: None, resolve_target: None, ops };
            let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
                label: Some("present"),
                color_attachments: &[Some(attachment)],
                ..Default::default()
            });
            pass.set_pipeline(&self.0);
            pass.set_bind_group(0, &group, &[]);
            pass.draw(0..3, 0..1);
        }
    }
}
