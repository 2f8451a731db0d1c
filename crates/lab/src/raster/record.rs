//! Recording of a frame's passes.

use super::frame::FrameUniforms;
use super::lighting::LightingRecord;
use super::vertices::{AlphaKind, STRIDE};
use super::{Raster, VertexSet};
use crate::trace::view::View;
use afterimage::gpu::filled;
use std::ops::Range;
use wgpu::{
    BindGroup, Buffer, BufferUsages, Color, CommandEncoder, Device, IndexFormat, LoadOp, Operations, RenderPass,
    StoreOp,
};

/// Index range of blended triangles with one material.
struct Run {
    is_moving: bool,
    material: u32,
    indices: Range<u32>,
}

impl Raster {
    /// Records a frame for camera `view` and previous camera `previous`, both of the targets' size. Several frames may
    /// be recorded into one encoder; each has its own uniforms.
    pub fn record(&mut self, device: &Device, encoder: &mut CommandEncoder, view: &View, previous: &View) {
        self.upload(device, encoder);
        let frame = FrameUniforms::new(view, previous, self.near);
        let lights = self.lighting.record(&self.lights, self.last_level, self.shadow_side);
        let group = self.frame_group(device, &frame, &lights);
        if self.has_sun && self.is_shadow_stale {
            self.sun_pass(encoder, &group);
            self.is_shadow_stale = false;
        }
        self.surface_pass(encoder, &group);
        self.color_pass(device, encoder, &group, view);
    }

    /// Uploads vertices that moved since the last frame.
    fn upload(&mut self, device: &Device, encoder: &mut CommandEncoder) {
        let Some([now, before]) = self.pending.take() else { return };
        for (to, vertices) in [(&self.moving.buffer, now), (&self.previous, before)] {
            let from = filled(device, "raster frame", bytemuck::cast_slice(&vertices), BufferUsages::COPY_SRC);
            encoder.copy_buffer_to_buffer(&from, 0, to, 0, STRIDE * vertices.len() as u64);
        }
    }

    fn frame_group(&self, device: &Device, frame: &FrameUniforms, lights: &LightingRecord) -> BindGroup {
        let buffers = [
            filled(device, "raster frame", bytemuck::bytes_of(frame), BufferUsages::UNIFORM),
            filled(device, "raster frame", bytemuck::bytes_of(lights), BufferUsages::STORAGE),
        ];
        let entry =
            |binding: u32| wgpu::BindGroupEntry { binding, resource: buffers[binding as usize].as_entire_binding() };
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout: &self.layouts.frame,
            entries: &[entry(0), entry(1)],
        })
    }

    fn sun_pass(&self, encoder: &mut CommandEncoder, group: &BindGroup) {
        let mut pass = begin(encoder, "sun", None, &self.shadow, StoreOp::Store);
        pass.set_bind_group(0, group, &[]);
        self.for_each_draw(|set, is_moving, part| {
            // Transmissive and blended surfaces cast no shadow.
            if part.kind != AlphaKind::Blend {
                pass.set_pipeline(self.pipelines.sun(part.kind));
                self.draw(&mut pass, set, is_moving, part.material, part.vertices.clone());
            }
        });
    }

    fn surface_pass(&self, encoder: &mut CommandEncoder, group: &BindGroup) {
        let [_, depth, motion] = &self.targets.views;
        let color = wgpu::RenderPassColorAttachment {
            view: motion,
            depth_slice: None,
            resolve_target: None,
            ops: Operations { load: LoadOp::Clear(Color::TRANSPARENT), store: StoreOp::Store },
        };
        let mut pass = begin(encoder, "surfaces", Some(color), depth, StoreOp::Store);
        pass.set_bind_group(0, group, &[]);
        self.for_each_draw(|set, is_moving, part| {
            pass.set_pipeline(self.pipelines.motion(part.kind));
            self.draw(&mut pass, set, is_moving, part.material, part.vertices.clone());
        });
        pass.set_bind_group(1, &self.materials[0], &[]);
        pass.set_pipeline(&self.pipelines.motion_far);
        pass.draw(0..3, 0..1);
    }

    fn color_pass(&self, device: &Device, encoder: &mut CommandEncoder, group: &BindGroup, view: &View) {
        let [color, _, _] = &self.targets.views;
        let [samples, depth] = &self.targets.samples;
        let (indices, runs) = self.back_to_front(device, view);
        let color = wgpu::RenderPassColorAttachment {
            view: samples,
            depth_slice: None,
            resolve_target: Some(color),
            ops: Operations { load: LoadOp::Clear(Color::BLACK), store: StoreOp::Discard },
        };
        let mut pass = begin(encoder, "color", Some(color), depth, StoreOp::Discard);
        pass.set_bind_group(0, group, &[]);
        pass.set_bind_group(2, &self.lighting_maps, &[]);
        self.for_each_draw(|set, is_moving, part| {
            if part.kind != AlphaKind::Blend {
                pass.set_pipeline(self.pipelines.color(part.kind));
                self.draw(&mut pass, set, is_moving, part.material, part.vertices.clone());
            }
        });
        pass.set_bind_group(1, &self.materials[0], &[]);
        pass.set_pipeline(&self.pipelines.sky);
        pass.draw(0..3, 0..1);
        if let Some(indices) = &indices {
            pass.set_pipeline(self.pipelines.color(AlphaKind::Blend));
            pass.set_index_buffer(indices.slice(..), IndexFormat::Uint32);
            for run in runs {
                let set = if run.is_moving { &self.moving } else { &self.still };
                self.bind(&mut pass, set, run.is_moving, run.material);
                pass.draw_indexed(run.indices, 0, 0..1);
            }
        }
    }

    /// Calls `f` on the draw ranges of static and moving triangles, opaque ones first.
    fn for_each_draw(&self, mut f: impl FnMut(&VertexSet, bool, &super::vertices::DrawRange)) {
        let of = |set: &'_ VertexSet| set.grouped.parts.clone();
        let mut parts: Vec<_> = of(&self.still).into_iter().map(|p| (false, p)).collect();
        parts.extend(of(&self.moving).into_iter().map(|p| (true, p)));
        parts.sort_by_key(|(_, p)| p.kind);
        for (is_moving, part) in &parts {
            f(if *is_moving { &self.moving } else { &self.still }, *is_moving, part);
        }
    }

    fn bind(&self, pass: &mut RenderPass<'_>, set: &VertexSet, is_moving: bool, material: u32) {
        let material = self.materials.get(material as usize).unwrap_or(&self.materials[0]);
        pass.set_bind_group(1, material, &[]);
        pass.set_vertex_buffer(0, set.buffer.slice(..));
        pass.set_vertex_buffer(1, if is_moving { &self.previous } else { &set.buffer }.slice(..));
    }

    fn draw(&self, pass: &mut RenderPass<'_>, set: &VertexSet, is_moving: bool, material: u32, vertices: Range<u32>) {
        self.bind(pass, set, is_moving, material);
        pass.draw(vertices, 0..1);
    }

    /// Index buffer of the blended triangles and its draws. Groups of one material are ordered by the mean distance of
    /// their triangles' centroids along the view axis, farthest first; triangles within a group likewise. Sorting per
    /// group instead of per triangle allows one draw per group; interlocked groups may therefore blend in the wrong
    /// order.
    fn back_to_front(&self, device: &Device, view: &View) -> (Option<Buffer>, Vec<Run>) {
        let at = view.world_from_camera().w_axis.truncate().as_vec3();
        let ahead = -view.world_from_camera().z_axis.truncate().as_vec3();
        let mut groups = vec![];
        for (is_moving, set) in [(false, &self.still), (true, &self.moving)] {
            for blended in set.blended.chunk_by(|a, b| a.material == b.material) {
                let mut group: Vec<_> = blended.iter().map(|b| ((b.middle - at).dot(ahead), b.first)).collect();
                // Stable: triangles at the same distance keep their order in the file.
                group.sort_by(|a, b| b.0.total_cmp(&a.0));
                let mean = group.iter().map(|(far, _)| f64::from(*far)).sum::<f64>() / group.len() as f64;
                groups.push((mean, is_moving, blended[0].material, group));
            }
        }
        groups.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut indices: Vec<u32> = vec![];
        let mut runs = vec![];
        for (_, is_moving, material, group) in groups {
            let first = indices.len() as u32;
            indices.extend(group.iter().flat_map(|&(_, v)| [v, v + 1, v + 2]));
            runs.push(Run { is_moving, material, indices: first..indices.len() as u32 });
        }
        let buffer = (!indices.is_empty())
            .then(|| filled(device, "raster frame", bytemuck::cast_slice(&indices), BufferUsages::INDEX));
        (buffer, runs)
    }
}

fn begin<'e>(
    encoder: &'e mut CommandEncoder,
    label: &str,
    color: Option<wgpu::RenderPassColorAttachment<'_>>,
    depth: &wgpu::TextureView,
    keep_depth: StoreOp,
) -> RenderPass<'e> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: if color.is_some() { std::slice::from_ref(&color) } else { &[] },
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depth,
            depth_ops: Some(Operations { load: LoadOp::Clear(0.0), store: keep_depth }),
            stencil_ops: None,
        }),
        ..Default::default()
    })
}
