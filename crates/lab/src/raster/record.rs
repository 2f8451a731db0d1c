//! Recording of a frame's passes.

use super::Raster;
use super::chosen_quads::{ChosenQuads, ChunkTest};
use super::frame::FrameUniforms;
use super::pipelines::ColorPipelines;
use super::targets::{FoveatedTargets, Targets};
use super::vertices::{AlphaKind, STRIDE};
use super::window::{DrawCall, Frustum, Window};
use crate::device::bind_group;
use crate::quad_views::QuadViews;
use crate::view::View;
use afterimage::internal::filled;
use glam::DVec3;
use std::ops::Range;
use wgpu::{
    BindGroup, Buffer, BufferUsages, Color, CommandEncoder, Device, IndexFormat, LoadOp, Operations, RenderPass,
    RenderPassColorAttachment, StoreOp, TextureView,
};

/// Reversed depth of the near and the far plane.
pub(super) const FAR_PLANE: f32 = 0.0;
pub(super) const NEAR_PLANE: f32 = 1.0;

/// Index range of blended triangles with one material.
pub(super) struct Run {
    is_moving: bool,
    material: u32,
    indices: Range<u32>,
}

/// Index buffer of the blended triangles, and its draws.
pub(super) type BackToFront = (Option<Buffer>, Vec<Run>);

/// A window with its uniforms and draw calls.
pub(super) struct Section {
    window: Window,
    pub group: BindGroup,
    pub calls: Vec<DrawCall>,
    /// The quads of 2x2 pixels that are drawn to, if not all.
    quads: Option<ChosenQuads>,
}

impl Section {
    pub fn set_up(&self, pass: &mut RenderPass<'_>) {
        let Window { origin: [x, y], size, scissor: [corner, extent], .. } = self.window;
        let [w, h] = size.map(|v| v as f32);
        pass.set_viewport(x, y, w, h, 0.0, 1.0);
        pass.set_scissor_rect(corner[0], corner[1], extent[0], extent[1]);
        pass.set_bind_group(0, &self.group, &[]);
    }
}

impl Raster {
    /// Records a frame for camera `view` and previous camera `previous`, both of the targets' size. Several frames may
    /// be recorded into one encoder; each has its own uniforms.
    pub fn record(&mut self, device: &Device, encoder: &mut CommandEncoder, view: &View, previous: &View) {
        self.upload(device, encoder);
        let window = Window::full(view.geometry().size_px());
        let section = self.section(device, [view, previous], window);
        self.shadows(encoder, &section.group);
        let sections = [section];
        let Targets { views: [color, depth, motion], samples, .. } = &self.targets;
        self.surface_pass(encoder, [depth, motion], &sections);
        let blended = self.back_to_front(device, view);
        let [samples, depth] = samples;
        let target = target(samples, Some(color), LoadOp::Clear(Color::BLACK));
        self.color_pass(encoder, target, depth, &self.pipelines.color, &sections, &blended);
    }

    /// Records a full-rate frame with one sample per pixel, at its centre, in `targets`.
    pub fn record_points(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        views: [&View; 2],
        targets: &FoveatedTargets,
    ) {
        if self.deferred.is_some() {
            self.record_surfaces(device, encoder, views, Some(targets));
            return self.record_light(device, encoder, views, None, targets);
        }
        let window = Window::full(views[0].geometry().size_px()).with_points();
        self.record_windows(device, encoder, views, std::iter::once(window), targets);
    }

    /// Records the color of one pixel of each quad of 2x2 pixels, with one sample, into the color of `targets` of half
    /// the width and height. `place_px`: the pixel's place in its quad. `surfaces`: targets of
    /// [`record_surfaces`](Self::record_surfaces) of the same frame, if there are any; deferred frames without blended
    /// surfaces are lit from them.
    pub fn record_half(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        [view, previous]: [&View; 2],
        place_px: [u32; 2],
        (targets, surfaces): (&FoveatedTargets, Option<&FoveatedTargets>),
    ) {
        self.upload(device, encoder);
        let window = Window::half(view.geometry().size_px(), place_px);
        if let (true, Some(surfaces)) = (self.deferred.is_some() && !self.has_blended, surfaces) {
            let group = self.frame_uniforms(device, [view, previous], &window);
            self.shadows(encoder, &group);
            return self.light_pass(device, encoder, &group, None, (surfaces, &targets.atlas.views[0]));
        }
        let section = self.section(device, [view, previous], window);
        self.shadows(encoder, &section.group);
        let blended = self.back_to_front(device, view);
        let FoveatedTargets { atlas: Targets { views: [color, ..], .. }, point_depth_view, .. } = targets;
        let target = target(color, None, LoadOp::Clear(Color::BLACK));
        let pipelines = self.point_pipelines(device);
        self.color_pass(encoder, target, point_depth_view, pipelines, &[section], &blended);
    }

    /// Records quad views, which lie in an atlas ([`AtlasLayout::place_views`](super::AtlasLayout::place_views)), in
    /// `targets`: four samples per pixel, textures filtered for the view's own resolution, motion in pixels of the
    /// full-rate frame. `view` and `previous` are those of the full-rate frame.
    ///
    /// # Panics
    /// If the atlas is larger than `targets`.
    pub fn record_quad_views(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        [view, previous]: [&View; 2],
        views: &QuadViews,
        targets: &FoveatedTargets,
    ) {
        let size = view.geometry().size_px();
        let windows = views.as_slice().iter().map(|quad| Window::of_quad_view(quad, size));
        self.record_windows(device, encoder, [view, previous], windows, targets);
    }

    /// Records windows, those with several samples per pixel first.
    fn record_windows(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        [view, previous]: [&View; 2],
        windows: impl Iterator<Item = Window>,
        targets: &FoveatedTargets,
    ) {
        self.upload(device, encoder);
        if self.has_sun && self.is_shadow_stale {
            let full = self.section(device, [view, previous], Window::full(view.geometry().size_px()));
            self.shadows(encoder, &full.group);
        }
        let sections: Vec<Section> = windows.map(|w| self.section(device, [view, previous], w)).collect();
        let (full, points) = sections.split_at(sections.partition_point(|s| !s.window.is_point));
        let FoveatedTargets { atlas, point_depth_view, .. } = targets;
        let Targets { views: [color, depth, motion], samples: [samples, sample_depth], .. } = atlas;
        self.surface_pass(encoder, [depth, motion], &sections);
        let blended = self.back_to_front(device, view);
        let mut load = LoadOp::Clear(Color::BLACK);
        if !full.is_empty() {
            let target = target(samples, Some(color), load);
            self.color_pass(encoder, target, sample_depth, &self.pipelines.color, full, &blended);
            load = LoadOp::Load;
        }
        if points.is_empty() {
            return;
        }
        let point_pipelines = self.point_pipelines(device);
        self.color_pass(encoder, target(color, None, load), point_depth_view, point_pipelines, points, &blended);
    }

    /// Records the color of some quads of 2x2 pixels of the full-rate frame, with one sample per pixel, into the color
    /// of `targets`. Other pixels are black. `list`: the quads, in the form of `gpu::Afterimage::quad_list`. Deferred
    /// frames are lit from the surfaces of the same frame, which [`record_surfaces`](Self::record_surfaces) left in
    /// `targets`.
    pub fn record_quads(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        [view, previous]: [&View; 2],
        list: &Buffer,
        targets: &FoveatedTargets,
    ) {
        if self.deferred.is_some() {
            return self.record_light(device, encoder, [view, previous], Some(list), targets);
        }
        self.upload(device, encoder);
        let window = Window::full(view.geometry().size_px()).with_points();
        let calls = self.chunk_calls(Some(&Frustum::new(view, &window)));
        let test = self.chunk_test.get_or_init(|| ChunkTest::new(device));
        let quads = test.record(device, encoder, view, &calls, (list, &self.layouts.quads));
        let calls = calls.into_iter().map(|(call, _)| call).collect();
        let group = self.frame_uniforms(device, [view, previous], &window);
        let section = Section { window, group, calls, quads: Some(quads) };
        self.shadows(encoder, &section.group);
        let blended = self.back_to_front(device, view);
        let FoveatedTargets { atlas: Targets { views: [color, ..], .. }, point_depth_view, .. } = targets;
        let target = target(color, None, LoadOp::Clear(Color::BLACK));
        let pipelines = self.point_pipelines(device);
        self.color_pass(encoder, target, point_depth_view, pipelines, &[section], &blended);
    }

    /// Records the albedo of every pixel of the full-rate frame, with one sample at its centre, into the albedo
    /// of `targets`: the share of uniform light that its surface returns, 0 in the sky. Blended surfaces have theirs by
    /// their opacity. Deferred frames read the surfaces of the same frame, which
    /// [`record_surfaces`](Self::record_surfaces) left in `targets`.
    pub fn record_albedo(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        [view, previous]: [&View; 2],
        targets: &FoveatedTargets,
    ) {
        self.upload(device, encoder);
        let window = Window::full(view.geometry().size_px()).with_points();
        if self.deferred.is_some() {
            return self.deferred_albedo(device, encoder, [view, previous], window, targets);
        }
        let section = self.section(device, [view, previous], window);
        let blended = self.back_to_front(device, view);
        let target = target(targets.albedo_view(device), None, LoadOp::Clear(Color::BLACK));
        let pipelines = self.albedo_pipelines(device);
        self.color_pass(encoder, target, &targets.point_depth_view, pipelines, &[section], &blended);
    }

    pub(super) fn albedo_pipelines(&self, device: &Device) -> &ColorPipelines {
        self.albedo_pipelines.get_or_init(|| ColorPipelines::albedo(device, &self.layouts, self.effects))
    }

    pub(super) fn point_pipelines(&self, device: &Device) -> &ColorPipelines {
        let new = || ColorPipelines::new(device, &self.layouts, self.effects, self.has_sun, 1);
        self.point_pipelines.get_or_init(new)
    }

    /// Records depth and motion of a full-rate frame, without its color, in `targets` or, if that is `None`, in those
    /// of full-rate frames. Deferred frames keep in `targets` what lighting needs of the surfaces.
    pub fn record_surfaces(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        [view, previous]: [&View; 2],
        targets: Option<&FoveatedTargets>,
    ) {
        self.upload(device, encoder);
        let window = Window::full(view.geometry().size_px());
        let window = if targets.is_some() { window.with_points() } else { window };
        let section = self.section(device, [view, previous], window);
        if let (Some(deferred), Some(targets)) = (&self.deferred, targets) {
            return self.g_buffer_pass(deferred, device, encoder, &section, targets);
        }
        let Targets { views: [_, depth, motion], .. } = targets.map_or(&self.targets, |targets| &targets.atlas);
        self.surface_pass(encoder, [depth, motion], &[section]);
    }

    /// Uniforms and draw calls of a window.
    fn section(&self, device: &Device, [view, previous]: [&View; 2], window: Window) -> Section {
        let calls = self.calls(Some(&Frustum::new(view, &window)));
        Section { group: self.frame_uniforms(device, [view, previous], &window), calls, window, quads: None }
    }

    /// A window without draw calls.
    pub(super) fn empty_section(&self, device: &Device, views: [&View; 2], window: Window) -> Section {
        Section { group: self.frame_uniforms(device, views, &window), calls: vec![], window, quads: None }
    }

    pub(super) fn frame_uniforms(&self, device: &Device, [view, previous]: [&View; 2], window: &Window) -> BindGroup {
        let frame = FrameUniforms::new(view, previous, self.near, window);
        let lights = self.lighting.record(&self.lights, self.last_level, self.shadow_side);
        let buffers = [
            filled(device, "raster frame", bytemuck::bytes_of(&frame), BufferUsages::UNIFORM),
            filled(device, "raster frame", bytemuck::bytes_of(&lights), BufferUsages::STORAGE),
        ];
        bind_group(device, "frame", &self.layouts.frame, buffers.each_ref().map(Buffer::as_entire_binding))
    }

    /// Records the shadow map anew, as if the scene had moved.
    pub fn record_shadows(&mut self, device: &Device, encoder: &mut CommandEncoder, views: [&View; 2]) {
        self.upload(device, encoder);
        self.is_shadow_stale = true;
        let group = self.frame_uniforms(device, views, &Window::full(views[0].geometry().size_px()));
        self.shadows(encoder, &group);
    }

    /// Draws the shadow map anew if the scene moved. `group`: uniforms of the full-rate frame.
    pub(super) fn shadows(&mut self, encoder: &mut CommandEncoder, group: &BindGroup) {
        if self.has_sun && self.is_shadow_stale {
            self.sun_pass(encoder, group);
            self.is_shadow_stale = false;
        }
    }

    /// Uploads vertices that moved since the last frame.
    pub(super) fn upload(&mut self, device: &Device, encoder: &mut CommandEncoder) {
        let Some([now, before]) = self.pending.take() else { return };
        for (to, vertices) in [(&self.moving.buffer, now), (&self.previous, before)] {
            let from = filled(device, "raster frame", bytemuck::cast_slice(&vertices), BufferUsages::COPY_SRC);
            encoder.copy_buffer_to_buffer(&from, 0, to, 0, STRIDE * vertices.len() as u64);
        }
    }

    fn sun_pass(&self, encoder: &mut CommandEncoder, group: &BindGroup) {
        let mut pass = begin(encoder, "sun", None, (&self.shadow, FAR_PLANE), StoreOp::Store);
        pass.set_bind_group(0, group, &[]);
        // Transmissive and blended surfaces cast no shadow.
        for call in self.calls(None).iter().filter(|call| call.kind != AlphaKind::Blend) {
            pass.set_pipeline(self.pipelines.sun(call.kind));
            self.draw(&mut pass, call);
        }
    }

    fn surface_pass(&self, encoder: &mut CommandEncoder, [depth, motion]: [&TextureView; 2], sections: &[Section]) {
        let motion = target(motion, None, LoadOp::Clear(Color::TRANSPARENT));
        let mut pass = begin(encoder, "surfaces", Some(motion), (depth, FAR_PLANE), StoreOp::Store);
        for section in sections {
            section.set_up(&mut pass);
            for call in &section.calls {
                pass.set_pipeline(self.pipelines.motion(call.kind));
                self.draw(&mut pass, call);
            }
            pass.set_bind_group(1, &self.materials[0], &[]);
            pass.set_pipeline(&self.pipelines.motion_far);
            pass.draw(0..3, 0..1);
        }
    }

    fn color_pass(
        &self,
        encoder: &mut CommandEncoder,
        target: RenderPassColorAttachment<'_>,
        depth: &TextureView,
        pipelines: &ColorPipelines,
        sections: &[Section],
        blended: &BackToFront,
    ) {
        let has_quads = sections.iter().any(|section| section.quads.is_some());
        let behind = if has_quads { NEAR_PLANE } else { FAR_PLANE };
        let mut pass = begin(encoder, "color", Some(target), (depth, behind), StoreOp::Discard);
        pass.set_bind_group(2, &self.lighting_maps, &[]);
        for section in sections {
            section.set_up(&mut pass);
            if let Some(quads) = &section.quads {
                pass.set_pipeline(&self.pipelines.quads);
                pass.set_bind_group(1, &quads.group, &[]);
                pass.draw_indirect(&quads.list, 0);
            }
            for (i, call) in section.calls.iter().enumerate().filter(|(_, call)| call.kind != AlphaKind::Blend) {
                pass.set_pipeline(pipelines.surfaces(call.kind));
                match &section.quads {
                    None => self.draw(&mut pass, call),
                    Some(quads) => {
                        self.bind(&mut pass, call.is_moving, call.material);
                        let (arguments, at) = quads.draw(i);
                        pass.draw_indirect(arguments, at);
                    }
                }
            }
            pass.set_bind_group(1, &self.materials[0], &[]);
            pass.set_pipeline(&pipelines.sky);
            pass.draw(0..3, 0..1);
            self.draw_blended(&mut pass, pipelines, blended);
        }
    }

    /// Draws the blended surfaces, back to front.
    pub(super) fn draw_blended(
        &self,
        pass: &mut RenderPass<'_>,
        pipelines: &ColorPipelines,
        (indices, runs): &BackToFront,
    ) {
        let Some(indices) = indices else { return };
        pass.set_pipeline(pipelines.surfaces(AlphaKind::Blend));
        pass.set_index_buffer(indices.slice(..), IndexFormat::Uint32);
        for run in runs {
            self.bind(pass, run.is_moving, run.material);
            pass.draw_indexed(run.indices.clone(), 0, 0..1);
        }
    }

    /// Draw calls of the static and moving triangles that meet `frustum`, opaque ones first, successive chunks of a
    /// part in one call.
    fn calls(&self, frustum: Option<&Frustum>) -> Vec<DrawCall> {
        let mut calls: Vec<DrawCall> = vec![];
        for (call, _) in self.chunk_calls(frustum) {
            match calls.last_mut() {
                Some(last) if last.is_continued_by(&call) => last.vertices.end = call.vertices.end,
                _ => calls.push(call),
            }
        }
        calls
    }

    /// The same, chunk by chunk, with their boxes.
    fn chunk_calls(&self, frustum: Option<&Frustum>) -> Vec<(DrawCall, [DVec3; 2])> {
        let mut calls = vec![];
        for (set, is_moving) in [(&self.still, false), (&self.moving, true)] {
            for part in &set.grouped.parts {
                let (kind, material) = (part.kind, part.material);
                let call = |vertices| DrawCall { kind, material, is_moving, vertices };
                let met = set.chunks.of(part).filter(|(_, bounds)| frustum.is_none_or(|f| f.meets(*bounds)));
                calls.extend(met.map(|(vertices, bounds)| (call(vertices), bounds)));
            }
        }
        calls.sort_by_key(|(call, _)| call.kind);
        calls
    }

    fn bind(&self, pass: &mut RenderPass<'_>, is_moving: bool, material: u32) {
        let set = if is_moving { &self.moving } else { &self.still };
        let material = self.materials.get(material as usize).unwrap_or(&self.materials[0]);
        pass.set_bind_group(1, material, &[]);
        pass.set_vertex_buffer(0, set.buffer.slice(..));
        pass.set_vertex_buffer(1, if is_moving { &self.previous } else { &set.buffer }.slice(..));
    }

    pub(super) fn draw(&self, pass: &mut RenderPass<'_>, call: &DrawCall) {
        self.bind(pass, call.is_moving, call.material);
        pass.draw(call.vertices.clone(), 0..1);
    }

    /// Index buffer of the blended triangles and its draws. Groups of one material are ordered by the mean distance of
    /// their triangles' centroids along the view axis, farthest first; triangles within a group likewise. Sorting per
    /// group instead of per triangle allows one draw per group; interlocked groups may therefore blend in the wrong
    /// order.
    pub(super) fn back_to_front(&self, device: &Device, view: &View) -> BackToFront {
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

/// A color target of a pass; with `resolved`, only the mean of its samples is kept, there.
pub(super) fn target<'v>(
    view: &'v TextureView,
    resolved: Option<&'v TextureView>,
    load: LoadOp<Color>,
) -> RenderPassColorAttachment<'v> {
    let store = if resolved.is_some() { StoreOp::Discard } else { StoreOp::Store };
    RenderPassColorAttachment { view, depth_slice: None, resolve_target: resolved, ops: Operations { load, store } }
}

fn begin<'e>(
    encoder: &'e mut CommandEncoder,
    label: &str,
    color: Option<RenderPassColorAttachment<'_>>,
    (depth, behind): (&TextureView, f32),
    keep_depth: StoreOp,
) -> RenderPass<'e> {
    let colors = if color.is_some() { std::slice::from_ref(&color) } else { &[] };
    begin_with(encoder, label, colors, (depth, LoadOp::Clear(behind)), keep_depth)
}

/// A pass with several color targets, or with the depth of an earlier one.
pub(super) fn begin_with<'e>(
    encoder: &'e mut CommandEncoder,
    label: &str,
    colors: &[Option<RenderPassColorAttachment<'_>>],
    (depth, load): (&TextureView, LoadOp<f32>),
    store: StoreOp,
) -> RenderPass<'e> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: colors,
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: depth,
            depth_ops: Some(Operations { load, store }),
            stencil_ops: None,
        }),
        ..Default::default()
    })
}
