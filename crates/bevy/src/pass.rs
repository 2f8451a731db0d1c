//! Systems that run the post-process in Bevy's render graph.

use crate::blit::BlitPass;
use crate::camera::FoveationKind;
use crate::context::{Context, Drawn, Facts, Geometry, Output};
use crate::frame::ExtractedAfterimage;
use crate::prime::{DepthPasses, Depths};
use bevy::core_pipeline::Core3dSystems;
use bevy::core_pipeline::core_3d::{Transparent3d, main_opaque_pass_3d, main_transparent_pass_3d};
use bevy::core_pipeline::prepass::ViewPrepassTextures;
use bevy::core_pipeline::schedule::Core3d;
use bevy::core_pipeline::skybox::SkyboxBindGroup;
use bevy::diagnostic::FrameCount;
use bevy::ecs::entity::EntityHashMap;
use bevy::ecs::query::QueryItem;
use bevy::pbr::{RenderMeshInstances, main_transmissive_pass_3d};
use bevy::prelude::*;
use bevy::render::camera::{ExtractedCamera, TemporalJitter};
use bevy::render::diagnostic::RecordDiagnostics;
use bevy::render::render_phase::{PhaseItem, ViewSortedRenderPhases};
use bevy::render::render_resource::{RenderPassDescriptor, StoreOp};
use bevy::render::renderer::{RenderContext, RenderDevice, ViewQuery};
use bevy::render::view::{ExtractedView, ViewDepthTexture, ViewTarget};
use bevy::render::{GpuResourceAppExt, Render, RenderApp, RenderSystems};

pub(crate) struct PassPlugin;

impl Plugin for PassPlugin {
    fn build(&self, app: &mut App) {
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else { return };
        render_app
            .init_gpu_resource::<Contexts>()
            .init_gpu_resource::<Passes>()
            .add_systems(
                Render,
                (
                    prepare.in_set(RenderSystems::PrepareResources),
                    hide_sky.after(RenderSystems::PrepareBindGroups).before(RenderSystems::Render),
                ),
            )
            .add_systems(
                Core3d,
                (
                    gather.after(Core3dSystems::MainPass).before(Core3dSystems::EarlyPostProcess),
                    // Before what the camera draws at full rate.
                    (show_samples, plan).after(Core3dSystems::Prepass).before(Core3dSystems::MainPass),
                    // The same, but after the meshes of chosen pixels.
                    (blend_chosen, show_repaired)
                        .chain()
                        .after(main_opaque_pass_3d)
                        .after(main_transmissive_pass_3d)
                        .before(main_transparent_pass_3d),
                    // Before temporal antialiasing and upscaling, which are in the early post-process set.
                    simulate.after(Core3dSystems::MainPass).before(Core3dSystems::EarlyPostProcess),
                ),
            );
    }
}

/// Post-processes of the cameras, by render entity.
#[derive(Resource, Default)]
pub(crate) struct Contexts {
    pub by_camera: EntityHashMap<Context>,
    /// By lattice camera: the camera that shows it, and its place in `samples`.
    owners: EntityHashMap<(Entity, usize)>,
}

/// Passes that cameras share.
#[derive(Resource, Default)]
struct Passes {
    /// To the main textures that were written last: cameras without `Hdr` share a format.
    blit: Option<BlitPass>,
    depth: Option<DepthPasses>,
}

fn prepare(mut contexts: ResMut<Contexts>, device: Res<RenderDevice>, cameras: Query<(Entity, &ExtractedAfterimage)>) {
    let device = device.wgpu_device();
    let Contexts { by_camera, owners } = &mut *contexts;
    by_camera.retain(|&camera, _| cameras.contains(camera));
    owners.clear();
    for (camera, frame) in &cameras {
        let prepared = match by_camera.get_mut(&camera) {
            Some(context) => context.prepare(device, frame),
            None => Context::new(device, frame).and_then(|mut context| {
                context.prepare(device, frame)?;
                by_camera.insert(camera, context);
                Ok(())
            }),
        };
        if let Err(problem) = prepared {
            error_once!("Afterimage of camera {camera}: {problem}");
            by_camera.remove(&camera);
        }
        owners.extend(frame.samples.iter().enumerate().map(|(i, samples)| (samples.camera, (camera, i))));
    }
}

/// A sky drawn by the camera would cover the samples' frame: lattice cameras draw it. Where the camera repairs, its
/// depth hides it outside the chosen pixels.
fn hide_sky(mut commands: Commands, cameras: Query<(Entity, &ExtractedAfterimage), With<SkyboxBindGroup>>) {
    for (camera, frame) in &cameras {
        if frame.hides_meshes() {
            commands.entity(camera).remove::<SkyboxBindGroup>();
        }
    }
}

/// Copies what a lattice camera has drawn into the atlas.
fn gather(
    view: ViewQuery<&ViewTarget>,
    mut contexts: ResMut<Contexts>,
    frames: Query<&ExtractedAfterimage>,
    mut ctx: RenderContext,
) {
    let Some(&(camera, place)) = contexts.owners.get(&view.entity()) else { return };
    let (Some(context), Ok(frame)) = (contexts.by_camera.get_mut(&camera), frames.get(camera)) else { return };
    let lattice = &frame.samples[place].lattice;
    let drawn = Drawn {
        color: view.into_inner().main_texture(),
        from_px: [0, 0],
        to_px: lattice.atlas_texel.unwrap_or_default(),
        size_px: lattice.points,
    };
    let device = ctx.render_device().clone();
    context.copy(device.wgpu_device(), ctx.command_encoder(), frame, &drawn);
}

type Camera<'a> = (
    &'a ExtractedAfterimage,
    &'a ExtractedCamera,
    &'a ViewTarget,
    Option<&'a ViewPrepassTextures>,
    Option<&'a TemporalJitter>,
);

/// Shows the frame that the samples and history make.
fn show_samples(
    view: ViewQuery<Camera<'_>>,
    mut contexts: ResMut<Contexts>,
    mut passes: ResMut<Passes>,
    count: Res<FrameCount>,
    mut ctx: RenderContext,
) {
    let entity = view.entity();
    let camera = view.into_inner();
    let (frame, ..) = camera;
    if frame.hides_meshes()
        && let Some(context) = complete(&mut contexts, entity, frame)
    {
        record(context, camera, count.0, &mut passes.blit, &mut ctx);
    }
}

/// Chooses the pixels that the camera itself shades, and closes its depth elsewhere. Where that fails, the camera
/// renders every pixel.
fn plan(
    view: ViewQuery<(Camera<'_>, &ViewDepthTexture)>,
    mut contexts: ResMut<Contexts>,
    mut passes: ResMut<Passes>,
    count: Res<FrameCount>,
    mut ctx: RenderContext,
) {
    let entity = view.entity();
    let (camera, depth) = view.into_inner();
    let (frame, extracted, _, prepass, _) = camera;
    if !frame.repairs() {
        return;
    }
    let Some(context) = complete(&mut contexts, entity, frame) else { return };
    let (Some(geometry), Some(depths)) = (geometry(frame, prepass), depths(depth, prepass)) else { return };
    let device = ctx.render_device().clone();
    let diagnostics = ctx.diagnostic_recorder();
    let diagnostics = diagnostics.as_deref();
    let (device, encoder) = (device.wgpu_device(), ctx.command_encoder());
    let facts = (frame, facts(camera, count.0));
    let span = diagnostics.time_span(encoder, "afterimage_plan");
    match context.plan(device, encoder, facts, geometry, origin(extracted)) {
        Ok(quads) => {
            let passes = passes.depth.get_or_insert_with(|| DepthPasses::new(device));
            passes.close(device, encoder, depths, quads, [origin(extracted), frame.desc.size_px]);
        }
        Err(problem) => error_once!("Afterimage of camera {entity} does not repair: {problem}"),
    }
    span.end(encoder);
}

/// Draws the transparent meshes of chosen pixels: what Bevy draws in the pass after that comes on top of the frame.
fn blend_chosen(
    world: &World,
    view: ViewQuery<(&ExtractedView, &ViewTarget, &ViewDepthTexture, &ExtractedCamera)>,
    contexts: Res<Contexts>,
    phases: Res<ViewSortedRenderPhases<Transparent3d>>,
    meshes: Res<RenderMeshInstances>,
    mut ctx: RenderContext,
) {
    let entity = view.entity();
    let (view, target, depth, camera) = view.into_inner();
    let Some(phase) = phases.get(&view.retained_view_entity) else { return };
    let is_mesh: Vec<bool> = phase.items.keys().map(|&(_, entity)| meshes.mesh_asset_id(entity).is_some()).collect();
    if !contexts.by_camera.get(&entity).is_some_and(|context| context.planned) || !is_mesh.contains(&true) {
        return;
    }
    let mut pass = ctx.begin_tracked_render_pass(RenderPassDescriptor {
        label: Some("afterimage transparent"),
        color_attachments: &[Some(target.get_color_attachment())],
        depth_stencil_attachment: Some(depth.get_attachment(StoreOp::Store)),
        ..default()
    });
    if let Some(viewport) = &camera.viewport {
        pass.set_camera_viewport(viewport);
    }
    let mut first = 0;
    for run in is_mesh.chunk_by(|a, b| a == b) {
        let range = first..first + run.len();
        first = range.end;
        if run[0]
            && let Err(problem) = phase.render_range(&mut pass, world, entity, range)
        {
            error_once!("transparent meshes of camera {entity}: {problem:?}");
        }
    }
}

/// Shows the frame that the samples, history and the chosen pixels make.
fn show_repaired(
    view: ViewQuery<(Camera<'_>, &ViewDepthTexture, &ExtractedView)>,
    mut contexts: ResMut<Contexts>,
    mut passes: ResMut<Passes>,
    mut phases: ResMut<ViewSortedRenderPhases<Transparent3d>>,
    meshes: Res<RenderMeshInstances>,
    count: Res<FrameCount>,
    mut ctx: RenderContext,
) {
    let entity = view.entity();
    let (camera, depth, view) = view.into_inner();
    let Some(context) = contexts.by_camera.get_mut(&entity).filter(|context| context.planned) else { return };
    let Passes { blit, depth: depth_passes } = &mut *passes;
    record(context, camera, count.0, blit, &mut ctx);
    if let (Some(passes), Some(depths), Some(quads)) = (depth_passes, depths(depth, camera.3), context.chosen()) {
        let device = ctx.render_device().clone();
        passes.open(device.wgpu_device(), ctx.command_encoder(), depths, quads);
    }
    // These are drawn. Bevy sets the ranges anew in each frame.
    if let Some(phase) = phases.get_mut(&view.retained_view_entity) {
        for (&(_, entity), item) in &mut phase.items {
            if meshes.mesh_asset_id(entity).is_some() {
                *item.batch_range_mut() = 0..0;
            }
        }
    }
}

/// Foveates the camera's frame, and shows the output of the post-process.
fn simulate(
    view: ViewQuery<Camera<'_>>,
    mut contexts: ResMut<Contexts>,
    mut passes: ResMut<Passes>,
    count: Res<FrameCount>,
    mut ctx: RenderContext,
) {
    let entity = view.entity();
    let camera = view.into_inner();
    let (frame, extracted, target, ..) = camera;
    let Some(context) = contexts.by_camera.get_mut(&entity) else { return };
    if frame.kind != FoveationKind::Simulated {
        return;
    }
    let drawn =
        Drawn { color: target.main_texture(), from_px: origin(extracted), to_px: [0, 0], size_px: frame.desc.size_px };
    let device = ctx.render_device().clone();
    context.copy(device.wgpu_device(), ctx.command_encoder(), frame, &drawn);
    record(context, camera, count.0, &mut passes.blit, &mut ctx);
}

/// Post-process of a camera, if all its samples are drawn.
fn complete<'a>(contexts: &'a mut Contexts, camera: Entity, frame: &ExtractedAfterimage) -> Option<&'a mut Context> {
    let context = contexts.by_camera.get_mut(&camera)?;
    if context.copied < frame.samples.len() {
        warn_once!("Afterimage of camera {camera}: a lattice camera did not draw; is its order or target changed?");
        return None;
    }
    Some(context)
}

fn origin(camera: &ExtractedCamera) -> [u32; 2] {
    camera.viewport.as_ref().map_or([0, 0], |viewport| viewport.physical_position.into())
}

fn facts((frame, camera, .., jitter): QueryItem<'_, '_, Camera<'static>>, index: u32) -> Facts {
    // Bevy adds the offset to the projection's z column, whose factor is negative.
    let jitter_px = jitter.map_or(frame.view.jitter_px, |jitter| (-jitter.offset).to_array());
    Facts { index: index.into(), exposure: camera.exposure, jitter_px }
}

fn geometry<'a>(frame: &ExtractedAfterimage, prepass: Option<&'a ViewPrepassTextures>) -> Option<Geometry<'a>> {
    let prepass = prepass.filter(|_| frame.kind != FoveationKind::QuadViews)?;
    let (depth, motion) = (prepass.depth.as_ref()?, prepass.motion_vectors.as_ref()?);
    Some(Geometry { depth: &depth.texture.texture, motion: &motion.texture.texture })
}

fn depths<'a>(depth: &'a ViewDepthTexture, prepass: Option<&'a ViewPrepassTextures>) -> Option<Depths<'a>> {
    let prepass = prepass?.depth.as_ref()?;
    Some(Depths { tested: depth.view(), prepass: &prepass.texture.default_view })
}

fn record(
    context: &mut Context,
    view: QueryItem<'_, '_, Camera<'static>>,
    index: u32,
    blit: &mut Option<BlitPass>,
    ctx: &mut RenderContext,
) {
    let (frame, camera, target, prepass, _) = view;
    let repaired = context.planned.then(|| &**target.main_texture());
    let output = Output {
        texture: target.main_texture_other(),
        view: target.main_texture_other_view(),
        repaired,
        origin_px: origin(camera),
    };
    let facts = facts(view, index);
    let geometry = geometry(frame, prepass);
    let device = ctx.render_device().clone();
    let diagnostics = ctx.diagnostic_recorder();
    let diagnostics = diagnostics.as_deref();
    let encoder = ctx.command_encoder();
    let span = diagnostics.time_span(encoder, "afterimage");
    let recorded = context.record(device.wgpu_device(), encoder, (frame, facts), geometry, output, blit);
    span.end(encoder);
    match recorded {
        // Only now is the other texture the main one.
        Ok(()) => drop(target.post_process_write()),
        Err(problem) => {
            error_once!("Afterimage shows the frame without history: {problem}");
        }
    }
}
