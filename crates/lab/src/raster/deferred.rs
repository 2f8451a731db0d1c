//! Recording of deferred frames: surfaces into a G-buffer, then light at the pixels that need it.

use super::Raster;
use super::chosen_quads::LIST_DISPATCH;
use super::deferred_pipelines::Deferred;
use super::pipelines::ColorPipelines;
use super::record::{FAR_PLANE, NEAR_PLANE, Section, begin_with, target};
use super::targets::{FoveatedTargets, Targets};
use super::vertices::AlphaKind;
use super::window::Window;
use crate::device::bind_group;
use crate::view::View;
use wgpu::{
    BindGroup, BindingResource, Buffer, Color, CommandEncoder, ComputePipeline, Device, LoadOp, StoreOp, TextureView,
};

impl Raster {
    /// Whether frames with one sample a pixel are deferred.
    pub fn is_deferred(&self) -> bool {
        self.deferred.is_some()
    }

    /// Depth of the opaque surfaces of `targets`.
    fn opaque_depth<'t>(&self, targets: &'t FoveatedTargets) -> &'t TextureView {
        if self.has_blended { &targets.point_depth_view } else { &targets.atlas.views[1] }
    }

    /// Records depth, motion and the G-buffer.
    pub(super) fn g_buffer_pass(
        &self,
        deferred: &Deferred,
        device: &Device,
        encoder: &mut CommandEncoder,
        section: &Section,
        targets: &FoveatedTargets,
    ) {
        let motion = &targets.atlas.views[2];
        let [base, words] = targets.kept(device);
        let kept = [motion, base, words].map(|view| Some(target(view, None, LoadOp::Clear(Color::TRANSPARENT))));
        let depth = (self.opaque_depth(targets), LoadOp::Clear(FAR_PLANE));
        let mut pass = begin_with(encoder, "g-buffer", &kept, depth, StoreOp::Store);
        section.set_up(&mut pass);
        for call in section.calls.iter().filter(|call| call.kind != AlphaKind::Blend) {
            pass.set_pipeline(deferred.pipelines.surfaces(call.kind));
            self.draw(&mut pass, call);
        }
        pass.set_bind_group(1, &self.materials[0], &[]);
        pass.set_pipeline(&deferred.pipelines.far);
        pass.draw(0..3, 0..1);
        drop(pass);
        if self.has_blended {
            self.blended_surfaces(encoder, section, targets);
        }
    }

    /// Adds depth and motion of blended surfaces to those of the opaque ones.
    fn blended_surfaces(&self, encoder: &mut CommandEncoder, section: &Section, targets: &FoveatedTargets) {
        let Targets { depth, views: [_, depth_view, motion], .. } = &targets.atlas;
        let from = targets.point_depth.as_image_copy();
        encoder.copy_texture_to_texture(from, depth.as_image_copy(), depth.size());
        let motion = [Some(target(motion, None, LoadOp::Load))];
        let mut pass = begin_with(encoder, "blended", &motion, (depth_view, LoadOp::Load), StoreOp::Store);
        section.set_up(&mut pass);
        for call in section.calls.iter().filter(|call| call.kind == AlphaKind::Blend) {
            pass.set_pipeline(self.pipelines.motion(call.kind));
            self.draw(&mut pass, call);
        }
    }

    /// Records the color of the quads of `list`, or of all pixels, from the surfaces in `targets`.
    pub(super) fn record_light(
        &mut self,
        device: &Device,
        encoder: &mut CommandEncoder,
        [view, previous]: [&View; 2],
        list: Option<&Buffer>,
        targets: &FoveatedTargets,
    ) {
        self.upload(device, encoder);
        let window = Window::full(view.geometry().size_px()).with_points();
        let section = self.empty_section(device, [view, previous], window);
        self.shadows(encoder, &section.group);
        self.light_pass(device, encoder, &section.group, list, (targets, &targets.atlas.views[0]));
        if self.has_blended {
            let blended = (&targets.atlas.views[0], self.point_pipelines(device));
            self.blend_over(device, encoder, view, &section, (list, targets), blended);
        }
    }

    /// Lights all pixels that `frame` shows, or the quads of `list`, into `to`; other pixels are black.
    pub(super) fn light_pass(
        &self,
        device: &Device,
        encoder: &mut CommandEncoder,
        frame: &BindGroup,
        list: Option<&Buffer>,
        (surfaces, to): (&FoveatedTargets, &TextureView),
    ) {
        let Some(Deferred { pipelines, .. }) = &self.deferred else { return };
        let Some(list) = list else {
            return self.compute_pass(device, encoder, &pipelines.light_all, frame, (surfaces, to));
        };
        clear(encoder, to);
        let quads = bind_group(device, "chosen quads", &self.layouts.quads, [list.as_entire_binding()]);
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipelines.light_quads);
        pass.set_bind_group(0, frame, &[]);
        pass.set_bind_group(1, &self.g_buffer_group(device, surfaces, to), &[]);
        pass.set_bind_group(2, &self.lighting_maps, &[]);
        pass.set_bind_group(3, &quads, &[]);
        pass.dispatch_workgroups_indirect(list, LIST_DISPATCH);
    }

    /// Runs a pipeline for each pixel of `to`.
    fn compute_pass(
        &self,
        device: &Device,
        encoder: &mut CommandEncoder,
        pipeline: &ComputePipeline,
        frame: &BindGroup,
        (surfaces, to): (&FoveatedTargets, &TextureView),
    ) {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, frame, &[]);
        pass.set_bind_group(1, &self.g_buffer_group(device, surfaces, to), &[]);
        pass.set_bind_group(2, &self.lighting_maps, &[]);
        let size = to.texture().size();
        pass.dispatch_workgroups(size.width.div_ceil(64), size.height, 1);
    }

    fn g_buffer_group(&self, device: &Device, surfaces: &FoveatedTargets, to: &TextureView) -> BindGroup {
        let deferred = self.deferred.as_ref().expect("deferred frames have it");
        let [base, words] = surfaces.kept(device);
        let views = [self.opaque_depth(surfaces), base, words, &deferred.materials, to];
        bind_group(device, "g-buffer", &self.layouts.g_buffer, views.map(BindingResource::TextureView))
    }

    /// Draws the blended surfaces of `targets` over `color`, in the quads of `list` or everywhere.
    fn blend_over(
        &self,
        device: &Device,
        encoder: &mut CommandEncoder,
        view: &View,
        section: &Section,
        (list, targets): (Option<&Buffer>, &FoveatedTargets),
        (color, pipelines): (&TextureView, &ColorPipelines),
    ) {
        let blended = self.back_to_front(device, view);
        let color = [Some(target(color, None, LoadOp::Load))];
        let depth = match list {
            None => (self.opaque_depth(targets), LoadOp::Load),
            Some(_) => (targets.closed_depth(device), LoadOp::Clear(NEAR_PLANE)),
        };
        let mut pass = begin_with(encoder, "blended", &color, depth, StoreOp::Store);
        section.set_up(&mut pass);
        if let (Some(list), Some(deferred)) = (list, &self.deferred) {
            let quads = bind_group(device, "chosen quads", &self.layouts.quads, [list.as_entire_binding()]);
            let opaque = BindingResource::TextureView(self.opaque_depth(targets));
            let opaque = bind_group(device, "opaque depth", &self.layouts.opaque_depth, [opaque]);
            pass.set_pipeline(&deferred.pipelines.quads);
            pass.set_bind_group(1, &quads, &[]);
            pass.set_bind_group(2, &opaque, &[]);
            pass.draw_indirect(list, 0);
        }
        pass.set_bind_group(2, &self.lighting_maps, &[]);
        self.draw_blended(&mut pass, pipelines, &blended);
    }

    /// Records the albedo of the surfaces in `targets`.
    pub(super) fn deferred_albedo(
        &self,
        device: &Device,
        encoder: &mut CommandEncoder,
        [view, previous]: [&View; 2],
        window: Window,
        targets: &FoveatedTargets,
    ) {
        let Some(Deferred { pipelines, .. }) = &self.deferred else { return };
        let section = self.empty_section(device, [view, previous], window);
        let pipeline = pipelines.albedo(device, &self.layouts, self.effects);
        let albedo = targets.albedo_view(device);
        self.compute_pass(device, encoder, pipeline, &section.group, (targets, albedo));
        if self.has_blended {
            let blended = (albedo, self.albedo_pipelines(device));
            self.blend_over(device, encoder, view, &section, (None, targets), blended);
        }
    }
}

/// Makes a color target black.
fn clear(encoder: &mut CommandEncoder, color: &TextureView) {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("black"),
        color_attachments: &[Some(target(color, None, LoadOp::Clear(Color::BLACK)))],
        ..Default::default()
    });
}
