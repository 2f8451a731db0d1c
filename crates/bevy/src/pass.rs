//! Systems that run the post-process in Bevy's render graph.

use crate::blit::BlitPass;
use crate::context::{Context, Drawn};
use crate::frame::ExtractedAfterimage;
use crate::oblique::ObliquePass;
use crate::orthographic::jittered;
use afterimage::wgpu;
use bevy::core_pipeline::Core3dSystems;
use bevy::core_pipeline::core_3d::{main_opaque_pass_3d, main_transparent_pass_3d};
use bevy::core_pipeline::deferred::copy_lighting_id::{DeferredLightingIdDepthTexture, copy_deferred_lighting_id};
use bevy::core_pipeline::prepass::ViewPrepassTextures;
use bevy::core_pipeline::schedule::Core3d;
use bevy::ecs::entity::EntityHashMap;
use bevy::ecs::query::QueryData;
use bevy::pbr::main_transmissive_pass_3d;
use bevy::prelude::*;
use bevy::render::camera::{ExtractedCamera, TemporalJitter};
use bevy::render::diagnostic::RecordDiagnostics;
use bevy::render::renderer::{RenderContext, RenderDevice, ViewQuery};
use bevy::render::view::{ExtractedView, ViewDepthStencilTexture, ViewTarget, ViewUniformOffset, ViewUniforms};
use bevy::render::{GpuResourceAppExt, Render, RenderApp, RenderSystems};
use wgpu::util::DeviceExt;

/// In Bevy's schedule `Core3d`, after the opaque meshes and before those that blend: history fills what was not shaded.
/// Passes that read the frame belong after it.
#[derive(SystemSet, Clone, Debug, PartialEq, Eq, Hash)]
pub struct ShowQuads;

pub(crate) fn plugin(app: &mut App) {
    let Some(render_app) = app.get_sub_app_mut(RenderApp) else { return };
    render_app
        .init_gpu_resource::<Contexts>()
        .init_gpu_resource::<BlitPass>()
        .init_gpu_resource::<ObliquePass>()
        .add_systems(Render, prepare.in_set(RenderSystems::PrepareResources))
        .configure_sets(
            Core3d,
            ShowQuads
                .after(main_opaque_pass_3d)
                .before(main_transmissive_pass_3d)
                .before(main_transparent_pass_3d)
                .before(Core3dSystems::EarlyPostProcess),
        )
        .add_systems(
            Core3d,
            (
                jitter.before(Core3dSystems::Prepass),
                plan.after(Core3dSystems::Prepass).after(copy_deferred_lighting_id).before(Core3dSystems::MainPass),
                show.in_set(ShowQuads),
            ),
        );
}

/// Post-processes of the cameras, by render entity.
#[derive(Resource, Default)]
pub(crate) struct Contexts(pub EntityHashMap<Context>);

fn prepare(
    mut contexts: ResMut<Contexts>,
    device: Res<RenderDevice>,
    mut cameras: Query<(Entity, &mut ExtractedAfterimage, &ExtractedCamera, Option<&TemporalJitter>)>,
    kept: Query<(), With<crate::camera::WithoutMsaa>>,
) {
    let device = device.wgpu_device();
    let contexts = &mut contexts.0;
    // Where foveation comes and goes by itself, pipelines are not compiled again.
    contexts.iter_mut().filter(|(camera, _)| !cameras.contains(**camera)).for_each(|(_, context)| context.rest());
    contexts.retain(|&camera, _| kept.contains(camera));
    for (camera, mut frame, extracted, jitter) in &mut cameras {
        frame.complete(extracted, jitter);
        let frame = &*frame;
        let prepared = match contexts.get_mut(&camera) {
            Some(context) => context.prepare(device, frame),
            None => Context::new(device, frame).map(|context| {
                contexts.insert(camera, context);
            }),
        };
        if let Err(problem) = prepared {
            error_once!("Afterimage of camera {camera}: {problem}");
            contexts.remove(&camera);
        }
    }
}

#[derive(QueryData)]
pub(crate) struct Camera {
    frame: &'static ExtractedAfterimage,
    camera: &'static ExtractedCamera,
    view: &'static ExtractedView,
    uniforms: &'static ViewUniformOffset,
    target: &'static ViewTarget,
    depth: &'static ViewDepthStencilTexture,
    prepass: &'static ViewPrepassTextures,
    lighting: Option<&'static DeferredLightingIdDepthTexture>,
}

impl<'a> CameraItem<'a, '_> {
    fn drawn(&self) -> Option<Drawn<'a>> {
        // Bevy leaves the texture where a camera is no longer deferred.
        let lighting = self.prepass.deferred_lighting_pass_id.as_ref().and(self.lighting);
        Some(Drawn {
            color: self.target.main_texture(),
            depth: &self.prepass.depth.as_ref()?.texture.texture,
            motion: &self.prepass.motion_vectors.as_ref()?.texture.texture,
            origin_px: self.camera.viewport.as_ref().map_or([0, 0], |viewport| viewport.physical_position.into()),
            tested: self.depth.attachment.depth_stencil_views().attachment_view(),
            tested_lighting: lighting.map(|lighting| &*lighting.texture.default_view),
        })
    }

    fn clip_from_view(&self, jitter_px: [f32; 2]) -> Mat4 {
        jittered(self.view.clip_from_view, self.frame.desc.size_px.into(), jitter_px.into())
    }
}

/// Moves the projection of an orthographic camera that antialiases.
fn jitter(view: ViewQuery<Camera>, contexts: Res<Contexts>, uniforms: Res<ViewUniforms>, mut ctx: RenderContext) {
    let is_known = contexts.0.contains_key(&view.entity());
    let camera = view.into_inner();
    if let (Some(px), Some(buffer), true) = (camera.frame.jitter_px, uniforms.uniforms.buffer(), is_known) {
        let device = ctx.render_device().clone();
        let (device, encoder) = (device.wgpu_device(), ctx.command_encoder());
        set_jitter(device, encoder, buffer, &camera, px);
        // By the third matrix deferred lighting and effects place what depth shows. Depth keeps its jitter to the end.
        let world_from_clip = camera.view.world_from_view.to_matrix() * camera.clip_from_view(px).inverse();
        set_matrix(device, encoder, (buffer, camera.uniforms.offset + 2 * size_of::<Mat4>() as u32), world_from_clip);
    }
}

/// Chooses the quads that the camera shades, and closes its depths elsewhere. Where that fails, it shades every pixel.
///
/// After a cut one pixel of each quad is chosen (`is_quarter`). Bevy's main pass cannot change its size for one frame:
/// devices then shade the whole quad of each pixel that is open, as many as at full rate.
pub(crate) fn plan(
    view: ViewQuery<Camera>,
    mut contexts: ResMut<Contexts>,
    mut oblique: ResMut<ObliquePass>,
    mut ctx: RenderContext,
) {
    let entity = view.entity();
    let camera = view.into_inner();
    let (Some(context), Some(drawn)) = (contexts.0.get_mut(&entity), camera.drawn()) else { return };
    let main = drawn.tested.texture();
    let copies = wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::COPY_DST;
    let is_other = |lighting: &wgpu::TextureView| lighting.texture().size() != main.size();
    // In the frame in which `Afterimage` comes, Bevy's textures may be those of the camera without it.
    if main.sample_count() > 1 || !main.usage().contains(copies) || drawn.tested_lighting.is_some_and(is_other) {
        return;
    }
    let planned = timed(&mut ctx, "afterimage_plan", |device, encoder| {
        context.plan(device, encoder, camera.frame, drawn, &mut oblique)
    });
    if let Err(problem) = planned {
        error_once!("camera {entity} renders every pixel, without Afterimage: {problem}");
    }
}

/// Shows the frame that the quads and history make, and opens depth again, for what is drawn at every pixel.
pub(crate) fn show(
    view: ViewQuery<Camera>,
    mut contexts: ResMut<Contexts>,
    mut blit: ResMut<BlitPass>,
    uniforms: Res<ViewUniforms>,
    mut ctx: RenderContext,
) {
    let entity = view.entity();
    let camera = view.into_inner();
    let (Some(context), Some(drawn)) = (contexts.0.get_mut(&entity), camera.drawn()) else { return };
    if !context.is_planned {
        return;
    }
    let target = camera.target;
    let recorded = timed(&mut ctx, "afterimage", |device, encoder| {
        let recorded =
            context.record(device, encoder, camera.frame, drawn, target.main_texture_other_view(), &mut blit);
        context.open(encoder, camera.depth.texture());
        // What is drawn from here on is averaged by no history.
        if let (true, Some(buffer)) = (camera.frame.view.jitter_px != [0.0; 2], uniforms.uniforms.buffer()) {
            set_jitter(device, encoder, buffer, &camera, [0.0; 2]);
        }
        recorded
    });
    match recorded {
        // Only now is the other texture the main one.
        Ok(()) => drop(target.post_process_write()),
        Err(problem) => {
            error_once!("Afterimage of camera {entity} shows the quads alone: {problem}");
        }
    }
}

/// Records passes whose time is one of Bevy's diagnostics.
pub(crate) fn timed<T>(
    ctx: &mut RenderContext,
    name: &'static str,
    record: impl FnOnce(&wgpu::Device, &mut wgpu::CommandEncoder) -> T,
) -> T {
    let device = ctx.render_device().clone();
    let diagnostics = ctx.diagnostic_recorder();
    let diagnostics = diagnostics.as_deref();
    let encoder = ctx.command_encoder();
    let span = diagnostics.time_span(encoder, name);
    let recorded = record(device.wgpu_device(), encoder);
    span.end(encoder);
    recorded
}

/// Sets the jitter of a projection, for what is drawn from here on: the first matrix of the view's uniforms is
/// `clip_from_world`.
fn set_jitter(
    device: &wgpu::Device,
    encoder: &mut wgpu::CommandEncoder,
    uniforms: &wgpu::Buffer,
    camera: &CameraItem<'_, '_>,
    jitter_px: [f32; 2],
) {
    let clip_from_view = camera.clip_from_view(jitter_px);
    let clip_from_world = clip_from_view * camera.view.world_from_view.to_matrix().inverse();
    set_matrix(device, encoder, (uniforms, camera.uniforms.offset), clip_from_world);
}

/// Writes a matrix to a place in the uniforms.
fn set_matrix(
    device: &wgpu::Device,
    encoder: &mut wgpu::CommandEncoder,
    (uniforms, offset): (&wgpu::Buffer, u32),
    matrix: Mat4,
) {
    let contents: Vec<u8> = matrix.to_cols_array().iter().flat_map(|value| value.to_ne_bytes()).collect();
    let set = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some("afterimage view"),
        contents: &contents,
        usage: wgpu::BufferUsages::COPY_SRC,
    });
    encoder.copy_buffer_to_buffer(&set, 0, uniforms, offset.into(), set.size());
}
