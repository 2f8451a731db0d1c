//! Pass that draws a frame to a camera's main texture, where compute shaders cannot write that: cameras without `Hdr`
//! have an sRGB-encoded one.

use afterimage::wgpu;
use bevy::platform::collections::HashMap;
use bevy::prelude::Resource;
use wgpu::{Device, TextureFormat};

/// Its pipelines, by the format of what they draw to.
#[derive(Resource, Debug, Default)]
pub(crate) struct BlitPass(HashMap<TextureFormat, wgpu::RenderPipeline>);

fn pipeline(device: &Device, format: TextureFormat) -> wgpu::RenderPipeline {
    let source = wgpu::ShaderSource::Wgsl(include_str!("blit.wgsl").into());
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("blit"), source });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("blit"),
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

impl BlitPass {
    /// Draws `frame` to `output` from the pixel `origin_px` on.
    pub fn record(
        &mut self,
        device: &Device,
        encoder: &mut wgpu::CommandEncoder,
        frame: &wgpu::Texture,
        output: &wgpu::TextureView,
        origin_px: [u32; 2],
    ) {
        let pipeline = self.0.entry(output.texture().format()).or_insert_with_key(|&format| pipeline(device, format));
        let view = frame.create_view(&Default::default());
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) }],
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("blit"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: output,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        let ([x, y], [w, h]) = (origin_px, [frame.width(), frame.height()]);
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.set_viewport(x as f32, y as f32, w as f32, h as f32, 0.0, 1.0);
        pass.set_scissor_rect(x, y, w, h);
        pass.draw(0..3, 0..1);
    }
}
