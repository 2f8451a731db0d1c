//! Albedo of deferred cameras: their G-buffer has it at every pixel. Samples then show light, and texture is the
//! pixel's own.

use crate::context::ALBEDO_FORMAT;
use crate::frame::ExtractedAfterimage;
use crate::pass::{Contexts, ShowQuads, plan, timed};
use bevy::asset::{embedded_asset, load_embedded_asset};
use bevy::core_pipeline::Core3dSystems;
use bevy::core_pipeline::prepass::ViewPrepassTextures;
use bevy::core_pipeline::schedule::Core3d;
use bevy::pbr::deferred::DEFAULT_PBR_DEFERRED_LIGHTING_PASS_ID;
use bevy::prelude::*;
use bevy::render::render_resource::binding_types::{texture_2d, texture_depth_2d, texture_storage_2d, uniform_buffer};
use bevy::render::render_resource::{
    BindGroupEntries, BindGroupLayoutDescriptor, BindGroupLayoutEntries, CachedComputePipelineId,
    ComputePipelineDescriptor, PipelineCache, ShaderStages, StorageTextureAccess, TextureSampleType, TextureView,
};
use bevy::render::renderer::{RenderContext, ViewQuery};
use bevy::render::view::{ViewUniform, ViewUniformOffset, ViewUniforms};
use bevy::render::{GpuResourceAppExt, Render, RenderApp, RenderSystems};

pub(crate) fn plugin(app: &mut App) {
    embedded_asset!(app, "albedo.wesl");
    if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
        render_app
            .init_gpu_resource::<AlbedoPass>()
            .add_systems(Render, queue.in_set(RenderSystems::Prepare))
            .add_systems(Core3d, record.after(plan).before(Core3dSystems::MainPass).before(ShowQuads));
    }
}

// The number that the shader has.
const _: () = assert!(DEFAULT_PBR_DEFERRED_LIGHTING_PASS_ID == 1);

#[derive(Resource)]
struct AlbedoPass {
    shader: Handle<Shader>,
    layout: BindGroupLayoutDescriptor,
    /// Compiled for the first camera that needs it.
    pipeline: Option<CachedComputePipelineId>,
}

impl FromWorld for AlbedoPass {
    fn from_world(world: &mut World) -> Self {
        let entries = BindGroupLayoutEntries::sequential(
            ShaderStages::COMPUTE,
            (
                uniform_buffer::<ViewUniform>(true),
                texture_depth_2d(),
                texture_2d(TextureSampleType::Uint),
                texture_2d(TextureSampleType::Uint),
                texture_storage_2d(ALBEDO_FORMAT, StorageTextureAccess::WriteOnly),
            ),
        );
        let layout = BindGroupLayoutDescriptor::new("afterimage albedo", &entries);
        Self { shader: load_embedded_asset!(world, "albedo.wesl"), layout, pipeline: None }
    }
}

fn queue(mut pass: ResMut<AlbedoPass>, cache: Res<PipelineCache>, cameras: Query<&ExtractedAfterimage>) {
    if pass.pipeline.is_none() && cameras.iter().any(|frame| frame.desc.has_albedo) {
        pass.pipeline = Some(cache.queue_compute_pipeline(ComputePipelineDescriptor {
            label: Some("afterimage albedo".into()),
            layout: vec![pass.layout.clone()],
            shader: pass.shader.clone(),
            ..default()
        }));
    }
}

/// Writes the albedo of a planned frame. Until the pipeline is compiled, it is 0 everywhere, which changes nothing.
fn record(
    view: ViewQuery<(&ViewPrepassTextures, &ViewUniformOffset), With<ExtractedAfterimage>>,
    contexts: Res<Contexts>,
    pass: Res<AlbedoPass>,
    cache: Res<PipelineCache>,
    uniforms: Res<ViewUniforms>,
    mut ctx: RenderContext,
) {
    let context = contexts.0.get(&view.entity()).filter(|context| context.is_planned);
    let (prepass, uniform) = view.into_inner();
    let (Some(albedo), Some(depth), Some(gbuffer), Some(lighting), Some(uniforms), Some(pipeline)) = (
        context.and_then(|context| context.albedo.as_ref()),
        prepass.depth_only_view(),
        prepass.deferred_view(),
        prepass.deferred_lighting_pass_id.as_ref(),
        uniforms.uniforms.binding(),
        pass.pipeline.and_then(|id| cache.get_compute_pipeline(id)),
    ) else {
        return;
    };
    let output = TextureView::from(albedo.create_view(&Default::default()));
    let group = ctx.render_device().create_bind_group(
        "afterimage albedo",
        &cache.get_bind_group_layout(&pass.layout),
        &BindGroupEntries::sequential((uniforms, depth, gbuffer, &lighting.texture.default_view, &output)),
    );
    timed(&mut ctx, "afterimage_albedo", |_, encoder| {
        let mut compute = encoder.begin_compute_pass(&Default::default());
        compute.set_pipeline(pipeline);
        compute.set_bind_group(0, &group, &[uniform.offset]);
        compute.dispatch_workgroups(albedo.width().div_ceil(8), albedo.height().div_ceil(8), 1);
    });
}
