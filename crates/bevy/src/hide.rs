//! Divides what is drawn: lattice cameras draw samples of meshes, and the camera that shows them everything else, as
//! gizmos, at full rate. Of meshes it draws depth and motion alone, in its prepasses (`pass.rs`).

use crate::frame::ExtractedAfterimage;
use bevy::core_pipeline::core_3d::Transparent3d;
use bevy::pbr::{RenderMeshInstances, SpecializedMaterialPipelineCache};
use bevy::platform::collections::HashSet;
use bevy::prelude::*;
use bevy::render::camera::DirtySpecializations;
use bevy::render::render_phase::ViewSortedRenderPhases;
use bevy::render::view::{ExtractedView, RetainedViewEntity};
use bevy::render::{Render, RenderApp, RenderSystems};

pub(crate) struct HidePlugin;

impl Plugin for HidePlugin {
    fn build(&self, app: &mut App) {
        if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
            render_app.init_resource::<Hidden>().add_systems(
                Render,
                (
                    renew.in_set(RenderSystems::PrepareAssets),
                    hide.after(RenderSystems::Specialize).before(RenderSystems::QueueMeshes),
                    keep_meshes.after(RenderSystems::Queue).before(RenderSystems::PhaseSort),
                ),
            );
        }
    }
}

/// Views whose meshes are hidden.
#[derive(Resource, Default)]
struct Hidden(HashSet<RetainedViewEntity>);

/// Has all meshes of a view queued anew when they become hidden or shown: Bevy queues those alone that have changed.
fn renew(
    mut hidden: ResMut<Hidden>,
    mut dirty: ResMut<DirtySpecializations>,
    views: Query<(&ExtractedView, &ExtractedAfterimage)>,
) {
    let now: HashSet<_> =
        views.iter().filter(|(_, frame)| frame.hides_meshes()).map(|(view, _)| view.retained_view_entity).collect();
    dirty.views.extend(now.symmetric_difference(&hidden.0));
    hidden.0 = now;
}

/// Takes the pipelines of the main passes: meshes without one are not queued.
fn hide(hidden: Res<Hidden>, mut pipelines: ResMut<SpecializedMaterialPipelineCache>) {
    for view in &hidden.0 {
        if let Some(pipelines) = pipelines.get_mut(view) {
            pipelines.clear();
        }
    }
}

/// Leaves nothing but meshes to lattice cameras.
fn keep_meshes(
    frames: Query<&ExtractedAfterimage>,
    views: Query<&ExtractedView>,
    meshes: Res<RenderMeshInstances>,
    mut phases: ResMut<ViewSortedRenderPhases<Transparent3d>>,
) {
    for samples in frames.iter().flat_map(|frame| &frame.samples) {
        let Ok(view) = views.get(samples.camera) else { continue };
        if let Some(phase) = phases.get_mut(&view.retained_view_entity) {
            phase.items.retain(|&(_, entity), _| meshes.mesh_asset_id(entity).is_some());
        }
    }
}
