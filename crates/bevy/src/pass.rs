//! Systems that run the post-process in Bevy's render graph.

use crate::blit::BlitPass;
use crate::camera::FoveationKind;
use crate::context::{Context, Drawn, Facts, Geometry, Output};
use crate::frame::ExtractedAfterimage;
use bevy::core_pipeline::Core3dSystems;
use bevy::core_pipeline::prepass::ViewPrepassTextures;
use bevy::core_pipeline::schedule::Core3d;
use bevy::core_pipeline::skybox::SkyboxBindGroup;
use bevy::diagnostic::FrameCount;
use bevy::ecs::entity::EntityHashMap;
use bevy::ecs::query::QueryItem;
use bevy::prelude::*;
use bevy::render::camera::{ExtractedCamera, TemporalJitter};
use bevy::render::diagnostic::RecordDiagnostics;
use bevy::render::renderer::{RenderContext, RenderDevice, ViewQuery};
use bevy::render::view::ViewTarget;
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
                    show_samples.after(Core3dSystems::Prepass).before(Core3dSystems::MainPass),
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

/// A sky drawn by the camera would cover the samples' frame: lattice cameras draw it.
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

fn record(
    context: &mut Context,
    view: QueryItem<'_, '_, Camera<'static>>,
    index: u32,
    blit: &mut Option<BlitPass>,
    ctx: &mut RenderContext,
) {
    let (frame, camera, target, prepass, _) = view;
    let output = Output {
        texture: target.main_texture_other(),
        view: target.main_texture_other_view(),
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
