//! Depth by which a camera's main passes shade chosen quads of 2x2 pixels and nothing else.

use afterimage::wgpu;
use bevy::core_pipeline::core_3d::CORE_3D_DEPTH_FORMAT;
use wgpu::util::DeviceExt;
use wgpu::{BindingType, CommandEncoder, Device, LoadOp, ShaderStages, StoreOp, TextureView};

/// Bevy's depth of the near plane. Nothing passes the test against it.
const NEAR: f32 = 1.0;

/// Passes over a camera's depth.
#[derive(Debug)]
pub(crate) struct DepthPasses {
    layout: wgpu::BindGroupLayout,
    quads: wgpu::RenderPipeline,
    all: wgpu::RenderPipeline,
}

/// Depth of a camera, and what its prepass has drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Depths<'a> {
    /// Against which main passes test.
    pub tested: &'a TextureView,
    /// Copy after the prepass, of the same size.
    pub prepass: &'a TextureView,
}

impl DepthPasses {
    pub fn new(device: &Device) -> Self {
        let entry = |binding, visibility, ty| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None };
        let depth = BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Depth,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let buffer = |ty| BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
        let list = buffer(wgpu::BufferBindingType::Storage { read_only: true });
        let size = buffer(wgpu::BufferBindingType::Uniform);
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("prime"),
            entries: &[
                entry(0, ShaderStages::FRAGMENT, depth),
                entry(1, ShaderStages::VERTEX, list),
                entry(2, ShaderStages::VERTEX, size),
            ],
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("prime"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let source = wgpu::ShaderSource::Wgsl(include_str!("prime.wgsl").into());
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some("prime"), source });
        let pipeline = |entry_point| {
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some("prime"),
                layout: Some(&pipeline_layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some(entry_point),
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                primitive: Default::default(),
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: CORE_3D_DEPTH_FORMAT,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(wgpu::CompareFunction::Always),
                    stencil: Default::default(),
                    bias: Default::default(),
                }),
                multisample: Default::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: None,
                    compilation_options: Default::default(),
                    targets: &[],
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        let [quads, all] = ["quad", "all"].map(pipeline);
        Self { layout, quads, all }
    }

    /// Closes the depth of every pixel but those of the quads of `list`, in the viewport of `size_px` at `origin_px`.
    pub fn close(
        &self,
        device: &Device,
        encoder: &mut CommandEncoder,
        depths: Depths<'_>,
        list: &wgpu::Buffer,
        [origin_px, size_px]: [[u32; 2]; 2],
    ) {
        let ([x, y], [w, h]) = (origin_px, size_px);
        let group = self.group(device, depths, list, size_px);
        let mut pass = begin(encoder, depths, LoadOp::Clear(NEAR));
        pass.set_pipeline(&self.quads);
        pass.set_bind_group(0, &group, &[]);
        pass.set_viewport(x as f32, y as f32, w as f32, h as f32, 0.0, 1.0);
        pass.set_scissor_rect(x, y, w, h);
        pass.draw_indirect(list, 0);
    }

    /// Makes depth that of the prepass again: of the whole target, which other cameras may share.
    pub fn open(&self, device: &Device, encoder: &mut CommandEncoder, depths: Depths<'_>, list: &wgpu::Buffer) {
        let group = self.group(device, depths, list, [0, 0]);
        let mut pass = begin(encoder, depths, LoadOp::Load);
        pass.set_pipeline(&self.all);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }

    fn group(&self, device: &Device, depths: Depths<'_>, list: &wgpu::Buffer, size_px: [u32; 2]) -> wgpu::BindGroup {
        let contents: Vec<u8> = [size_px, [0, 0]].as_flattened().iter().flat_map(|word| word.to_ne_bytes()).collect();
        let usage = wgpu::BufferUsages::UNIFORM;
        let descriptor = wgpu::util::BufferInitDescriptor { label: Some("prime"), contents: &contents, usage };
        let size = device.create_buffer_init(&descriptor);
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("prime"),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(depths.prepass) },
                wgpu::BindGroupEntry { binding: 1, resource: list.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 2, resource: size.as_entire_binding() },
            ],
        })
    }
}

fn begin<'e>(encoder: &'e mut CommandEncoder, depths: Depths<'_>, load: LoadOp<f32>) -> wgpu::RenderPass<'e> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("prime"),
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depths.tested,
            depth_ops: Some(wgpu::Operations { load, store: StoreOp::Store }),
            stencil_ops: None,
        }),
        ..Default::default()
    })
}
