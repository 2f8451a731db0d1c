//! What foveated frames render wrongly, or as dear as ever: one line in the log each.

use crate::components::{Afterimage, Foveated, FoveationKind};
use crate::frame::ExtractedAfterimage;
use bevy::core_pipeline::core_3d::{AlphaMask3d, Opaque3d};
use bevy::core_pipeline::schedule::Core3d;
use bevy::ecs::schedule::Schedules;
use bevy::platform::collections::HashSet;
use bevy::prelude::*;
use bevy::render::render_phase::{BinnedPhaseItem, BinnedRenderPhase, ViewBinnedRenderPhases};
use bevy::render::render_resource::{
    CachedRenderPipelineId, CompareFunction, PipelineCache, PipelineDescriptor, RenderPipelineDescriptor,
};
use bevy::render::view::ExtractedView;
use bevy::render::{Extract, ExtractSchedule, RenderApp};
use bevy::shader::{Shader, Source};

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(PostUpdate, warn_of_unused);
    if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
        // In extraction, because the text of shaders is in the main world. Phases are those of the last frame.
        render_app.add_systems(ExtractSchedule, (warn_of_pipelines, warn_of_passes));
    }
}

type WithoutAfterimage = (Without<Afterimage>, With<Camera>);

fn warn_of_unused(cameras: Query<(Entity, Ref<Foveated>), WithoutAfterimage>) {
    if let Some((camera, _)) = cameras.iter().find(|(_, f)| f.is_added() && f.kind != FoveationKind::Off) {
        warn_once!("camera {camera} has Foveated, but not Afterimage: it renders every pixel. Add Afterimage, too");
    }
}

/// Shaders for which the depth test comes too late: they shade every pixel.
fn warn_of_pipelines(
    cameras: Query<&ExtractedView, With<ExtractedAfterimage>>,
    opaque: Res<ViewBinnedRenderPhases<Opaque3d>>,
    masked: Res<ViewBinnedRenderPhases<AlphaMask3d>>,
    cache: Res<PipelineCache>,
    shaders: Extract<Option<Res<Assets<Shader>>>>,
    mut known: Local<HashSet<CachedRenderPipelineId>>,
) {
    let Some(shaders) = shaders.as_ref() else { return };
    let mut drawn = vec![];
    for view in &cameras {
        let view = &view.retained_view_entity;
        drawn.extend(opaque.get(view).into_iter().flat_map(|phase| keys(phase).map(|key| key.pipeline)));
        drawn.extend(masked.get(view).into_iter().flat_map(|phase| keys(phase).map(|key| key.pipeline)));
    }
    for id in drawn {
        if known.contains(&id) {
            continue;
        }
        let Some(pipeline) = cache.pipelines().nth(id.id()) else { continue };
        let PipelineDescriptor::RenderPipelineDescriptor(descriptor) = &pipeline.descriptor else { continue };
        known.insert(id);
        let shader = descriptor.fragment.as_ref().and_then(|fragment| shaders.get(&fragment.shader));
        if let Some(reason) = why_late(descriptor, shader) {
            let path = shader.map_or("of a material", |shader| shader.path.as_str());
            warn!("shader {path}: {reason}, so that it is run for every pixel, with Afterimage or without");
        }
    }
}

/// What a phase draws.
fn keys<I: BinnedPhaseItem>(phase: &BinnedRenderPhase<I>) -> impl Iterator<Item = &I::BatchSetKey> {
    let single = phase.batchable_meshes.keys().chain(phase.unbatchable_meshes.keys());
    phase.multidrawable_meshes.keys().chain(single.chain(phase.non_mesh_items.keys()).map(|(key, _)| key))
}

/// Why the depth test does not keep a pipeline from being run.
fn why_late(descriptor: &RenderPipelineDescriptor, shader: Option<&Shader>) -> Option<&'static str> {
    let compared = descriptor.depth_stencil.as_ref().and_then(|depth| depth.depth_compare);
    if compared.is_none_or(|compared| compared == CompareFunction::Always) {
        return Some("its pipeline compares no depth (depth_compare)");
    }
    let (Source::Wgsl(text) | Source::Wesl(text)) = &shader?.source else { return None };
    let has = |word| text.lines().any(|line| line.split("//").next().is_some_and(|code| code.contains(word)));
    match () {
        () if has("early_depth_test(force)") => None,
        () if has("frag_depth") => Some("it writes frag_depth"),
        () if has("read_write") || has("textureStore") => Some("it writes to storage without @early_depth_test(force)"),
        () => None,
    }
}

/// Bevy's own crates that draw between opaque meshes and those that blend.
const BEVY: [&str; 4] = ["bevy_core_pipeline::", "bevy_ecs::", "bevy_pbr::", "bevy_render::"];

/// Passes of others between the opaque meshes and the post-process, in the order in which Bevy submits them. Systems
/// have names if Bevy's feature `debug` is on, as it is by default.
fn warn_of_passes(cameras: Query<(), With<ExtractedAfterimage>>, schedules: Res<Schedules>, mut is_done: Local<bool>) {
    if *is_done || cameras.is_empty() {
        return;
    }
    // Its systems have an order after the first frame.
    let Some(Ok(systems)) = schedules.get(Core3d).map(|schedule| schedule.systems()) else { return };
    *is_done = true;
    let names = systems.map(|(_, system)| (system.name().to_string(), system.has_deferred()));
    let between = names.skip_while(|(name, _)| !name.ends_with("::main_opaque_pass_3d")).skip(1);
    for (name, draws) in between.take_while(|(name, _)| name != "bevy_afterimage::pass::show") {
        let is_bevys = BEVY.iter().any(|own| name.starts_with(own)) && !name.contains("fullscreen_material");
        if draws && !is_bevys {
            warn!(
                "system {name} draws when only the chosen quads are shaded: what it reads beside them is empty. Add \
                 .after(bevy_afterimage::ShowQuads) to it, or have it draw in Core3dSystems::PostProcess"
            );
        }
    }
}
