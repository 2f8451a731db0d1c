//! Opaque items without a prepass: those of materials that switch it off, and what other plugins queue.
//!
//! Quads know neither their depth nor their motion. They are not drawn with the quads, but at every pixel, when the
//! post-process has made the frame and depth is open again.

use crate::pass::{Contexts, ShowQuads, show};
use bevy::core_pipeline::core_3d::{AlphaMask3d, Opaque3d};
use bevy::core_pipeline::prepass::{AlphaMask3dPrepass, Opaque3dPrepass};
use bevy::core_pipeline::schedule::Core3d;
use bevy::pbr::{PreparedMaterial, RenderMaterialInstances};
use bevy::prelude::*;
use bevy::render::camera::ExtractedCamera;
use bevy::render::erased_render_asset::ErasedRenderAssets;
use bevy::render::render_phase::{
    BinnedPhaseItem, BinnedRenderPhase, CachedRenderPipelinePhaseItem, Draw, DrawError, DrawFunctions, PhaseItem,
    TrackedRenderPass, ViewBinnedRenderPhases,
};
use bevy::render::render_resource::{PipelineCache, PipelineDescriptor, RenderPassDescriptor, StoreOp};
use bevy::render::renderer::{RenderContext, ViewQuery};
use bevy::render::sync_world::MainEntity;
use bevy::render::view::{ExtractedView, RetainedViewEntity, ViewDepthStencilTexture, ViewTarget};
use bevy::render::{Render, RenderApp, RenderSystems};
use std::sync::atomic::Ordering;

pub(crate) fn plugin(app: &mut App) {
    let Some(render_app) = app.get_sub_app_mut(RenderApp) else { return };
    render_app
        .add_systems(Render, (part::<Opaque3d>, part::<AlphaMask3d>).in_set(RenderSystems::Prepare))
        .add_systems(Core3d, draw_late.after(show).in_set(ShowQuads));
}

/// A draw function that draws items with a prepass together with the quads, and the others after the post-process.
struct Parted<P: PhaseItem>(Box<dyn Draw<P>>);

impl<P: CachedRenderPipelinePhaseItem> Draw<P> for Parted<P> {
    fn prepare(&mut self, world: &World) {
        self.0.prepare(world);
    }

    fn draw<'w>(
        &mut self,
        world: &'w World,
        pass: &mut TrackedRenderPass<'w>,
        view: Entity,
        item: &P,
    ) -> Result<(), DrawError> {
        let context = world.get_resource::<Contexts>().and_then(|contexts| contexts.0.get(&view));
        if let Some(context) = context.filter(|context| context.is_planned) {
            let is_late = !has_prepass(world, view, item.main_entity());
            if is_late && !context.is_shown {
                context.has_late.store(true, Ordering::Relaxed);
                warn_of(world, item);
            }
            if is_late != context.is_shown {
                return Ok(());
            }
        }
        self.0.draw(world, pass, view, item)
    }
}

/// Whether an item is drawn in a prepass of a view, too: its material says so, or it is there as one that cannot be
/// batched.
fn has_prepass(world: &World, view: Entity, item: MainEntity) -> bool {
    let instance = world.get_resource::<RenderMaterialInstances>().and_then(|all| all.instances.get(&item));
    let materials = world.get_resource::<ErasedRenderAssets<PreparedMaterial>>();
    let material = materials.zip(instance).and_then(|(materials, instance)| materials.get(instance.asset_id));
    if let Some(material) = material {
        return material.properties.prepass_enabled;
    }
    let Some(view) = world.get::<ExtractedView>(view).map(|view| view.retained_view_entity) else { return false };
    is_queued::<Opaque3dPrepass>(world, &view, item) || is_queued::<AlphaMask3dPrepass>(world, &view, item)
}

fn is_queued<P: BinnedPhaseItem>(world: &World, view: &RetainedViewEntity, item: MainEntity) -> bool {
    let phases = world.get_resource::<ViewBinnedRenderPhases<P>>();
    phases.and_then(|phases| phases.get(view)).is_some_and(|phase: &BinnedRenderPhase<P>| {
        phase.non_mesh_items.values().any(|bin| bin.entities.contains_key(&item))
            || phase.unbatchable_meshes.values().any(|bin| bin.entities.contains_key(&item))
    })
}

fn warn_of<P: CachedRenderPipelinePhaseItem>(world: &World, item: &P) {
    let pipelines = world.get_resource::<PipelineCache>();
    let pipeline = pipelines.and_then(|cache| cache.pipelines().nth(item.cached_pipeline().id()));
    let label = pipeline.and_then(|pipeline| match &pipeline.descriptor {
        PipelineDescriptor::RenderPipelineDescriptor(descriptor) => descriptor.label.as_deref(),
        _ => None,
    });
    warn_once!(
        "opaque entity {} has no prepass (pipeline {}): it is drawn at every pixel, without antialiasing. Enable its \
         prepass (Material::enable_prepass), or queue it into Opaque3dPrepass, too",
        item.main_entity().id(),
        label.unwrap_or("without a label")
    );
}

/// Wraps the draw functions that were registered since the last frame.
fn part<P: CachedRenderPipelinePhaseItem>(functions: Res<DrawFunctions<P>>, mut parted: Local<usize>) {
    let mut functions = functions.write();
    for function in functions.draw_functions.split_off(*parted) {
        functions.draw_functions.push(Box::new(Parted(function)));
    }
    *parted = functions.draw_functions.len();
}

/// Draws what has no prepass.
fn draw_late(
    world: &World,
    view: ViewQuery<(&ExtractedCamera, &ExtractedView, &ViewTarget, &ViewDepthStencilTexture)>,
    contexts: Res<Contexts>,
    opaque: Res<ViewBinnedRenderPhases<Opaque3d>>,
    masked: Res<ViewBinnedRenderPhases<AlphaMask3d>>,
    mut ctx: RenderContext,
) {
    let entity = view.entity();
    if !contexts.0.get(&entity).is_some_and(|context| context.is_shown && context.has_late.load(Ordering::Relaxed)) {
        return;
    }
    let (camera, view, target, depth) = view.into_inner();
    let color_attachments = [Some(target.get_color_attachment())];
    let mut pass = ctx.begin_tracked_render_pass(RenderPassDescriptor {
        label: Some("afterimage late"),
        color_attachments: &color_attachments,
        depth_stencil_attachment: Some(depth.get_attachment(StoreOp::Store)),
        ..default()
    });
    if let Some(viewport) = &camera.viewport {
        pass.set_camera_viewport(viewport);
    }
    let view = &view.retained_view_entity;
    let drawn = [
        opaque.get(view).map(|phase| phase.render(&mut pass, world, entity)),
        masked.get(view).map(|phase| phase.render(&mut pass, world, entity)),
    ];
    for problem in drawn.into_iter().flatten().filter_map(Result::err) {
        error!("what has no prepass cannot be drawn: {problem}");
    }
}
