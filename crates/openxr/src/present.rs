//! Linear color to a swapchain's image. Its format encodes sRGB, which compute shaders cannot write, so this is a draw.
//! It also writes depth, for runtimes that take it.

use crate::targets::layer;
use wgpu_30::{
    BindGroupDescriptor, BindGroupEntry, BindingResource, Color, CommandEncoder, CompareFunction, DepthStencilState,
    Device, FragmentState, LoadOp, Operations, RenderPassColorAttachment, RenderPassDepthStencilAttachment,
    RenderPassDescriptor, RenderPipeline, RenderPipelineDescriptor, StoreOp, Texture, TextureFormat, VertexState,
    include_wgsl,
};

#[derive(Debug)]
pub(crate) struct Present(RenderPipeline);

impl Present {
    /// `depth`: format of the depth image, if there is one.
    pub fn new(device: &Device, color: TextureFormat, depth: Option<TextureFormat>) -> Self {
        let module = device.create_shader_module(include_wgsl!("present.wgsl"));
        let depth_stencil = depth.map(|format| DepthStencilState {
            format,
            depth_write_enabled: Some(true),
            depth_compare: Some(CompareFunction::Always),
            stencil: Default::default(),
            bias: Default::default(),
        });
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
            depth_stencil,
            multisample: Default::default(),
            fragment: Some(FragmentState {
                module: &module,
                entry_point: Some(if depth.is_some() { "color_and_depth" } else { "color" }),
                compilation_options: Default::default(),
                targets: &[Some(color.into())],
            }),
            multiview_mask: None,
            cache: None,
        }))
    }

    /// Both layers of `from`, color and depth, to those of `color` and `depth`, which is there if this was made for it.
    pub fn record(
        &self,
        device: &Device,
        encoder: &mut CommandEncoder,
        from: [&Texture; 2],
        color: &Texture,
        depth: Option<&Texture>,
    ) {
        for eye in 0..2 {
            let views = from.map(|texture| layer(texture, eye));
            let entry =
                |i: u32| BindGroupEntry { binding: i, resource: BindingResource::TextureView(&views[i as usize]) };
            let entries = [entry(0), entry(1)];
            let group = device.create_bind_group(&BindGroupDescriptor {
                label: None,
                layout: &self.0.get_bind_group_layout(0),
                entries: if depth.is_some() { &entries } else { &entries[..1] },
            });
            let (color, depth) = (layer(color, eye), depth.map(|depth| layer(depth, eye)));
            let ops = Operations { load: LoadOp::Clear(Color::BLACK), store: StoreOp::Store };
            let attachment = RenderPassColorAttachment { view: &color, depth_slice: None, resolve_target: None, ops };
            let depth_ops = Operations { load: LoadOp::Clear(0.0), store: StoreOp::Store };
            let depth_attachment =
                |view| RenderPassDepthStencilAttachment { view, depth_ops: Some(depth_ops), stencil_ops: None };
            let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
                label: Some("present"),
                color_attachments: &[Some(attachment)],
                depth_stencil_attachment: depth.as_ref().map(depth_attachment),
                ..Default::default()
            });
            pass.set_pipeline(&self.0);
            pass.set_bind_group(0, &group, &[]);
            pass.draw(0..3, 0..1);
        }
    }
}
