//! Shadow maps of directional lights, which Bevy draws anew for each camera: drawn once for all lattice cameras of one.

use crate::frame::ExtractedAfterimage;
use crate::lattice::LatticeCameras;
use bevy::light::{Cascades, SimulationLightSystems};
use bevy::pbr::ViewLightEntities;
use bevy::prelude::*;
use bevy::render::{Render, RenderApp, RenderSystems};

pub(crate) struct ShadowPlugin;

impl Plugin for ShadowPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(
            PostUpdate,
            share_cascades
                .after(SimulationLightSystems::UpdateDirectionalLightCascades)
                .before(SimulationLightSystems::UpdateLightFrusta),
        );
        if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
            render_app.add_systems(Render, share_maps.in_set(RenderSystems::PrepareResources));
        }
    }
}

/// Gives lattice cameras the camera's cascades: shadows do not depend on the gaze, and are the same in all lattices.
/// The camera itself has none, because it shades no meshes.
fn share_cascades(cameras: Query<(Entity, &LatticeCameras)>, mut lights: Query<&mut Cascades>) {
    for (camera, lattices) in &cameras {
        if lattices.placed.is_none() {
            continue;
        }
        for mut cascades in &mut lights {
            let cascades = &mut cascades.cascades;
            // The entry stays: Bevy expects one of each camera.
            let Some(shared) = cascades.get_mut(&camera).map(std::mem::take) else { continue };
            for entity in &lattices.entities {
                if let Some(own) = cascades.get_mut(entity) {
                    own.clone_from(&shared);
                }
            }
        }
    }
}

/// Draws the maps for the first lattice camera alone. Bevy has one texture for the maps of all cameras, so that they
/// are still in it when the next lattice camera is drawn, directly afterwards.
fn share_maps(cameras: Query<&ExtractedAfterimage>, mut lights: Query<&mut ViewLightEntities>) {
    for frame in &cameras {
        for samples in frame.samples.iter().skip(1) {
            if let Ok(mut lights) = lights.get_mut(samples.camera) {
                lights.lights.clear();
            }
        }
    }
}
