//! Cameras that share a target, and what lies below them.
//!
//! Cameras of one target, format, usages and MSAA draw to one texture. One that does not clear draws on the picture of
//! the camera below it, and so does one that clears, by Bevy's MSAA writeback: a view model, a head-up display. A
//! foveated camera has other usages and no MSAA, and so a texture of its own: the plugin hands its picture up, to the
//! texture of the camera above it. That one stays as it is.

use crate::blit::BlitPass;
use crate::components::{Afterimage, Foveated, FoveationKind};
use bevy::camera::{
    Camera, CameraMainTextureUsages, ClearColorConfig, CompositingSpace, Hdr, MsaaWriteback, NormalizedRenderTarget,
    RenderTarget,
};
use bevy::core_pipeline::schedule::Core3d;
use bevy::core_pipeline::upscaling::upscaling;
use bevy::ecs::entity::EntityHashMap;
use bevy::ecs::query::QueryData;
use bevy::light::Skybox;
use bevy::prelude::*;
use bevy::render::camera::ExtractedCamera;
use bevy::render::render_resource::TextureUsages;
use bevy::render::renderer::{RenderContext, ViewQuery};
use bevy::render::sync_world::RenderEntity;
use bevy::render::view::{ViewTarget, prepare_view_targets};
use bevy::render::{Extract, ExtractSchedule, Render, RenderApp, RenderSystems};

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Layers>().add_systems(PostUpdate, find_layers);
    if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
        render_app
            .init_resource::<Uppers>()
            .add_systems(ExtractSchedule, extract)
            .add_systems(Render, keep_what_lies_below.in_set(RenderSystems::CreateViews).before(prepare_view_targets))
            .add_systems(Core3d, hand_up.after(upscaling));
    }
}

/// For each camera that keeps the picture of one below it, that one.
#[derive(Resource, Clone, Default)]
pub(crate) struct Layers(EntityHashMap<Entity>);

impl Layers {
    /// The camera on whose picture `camera` draws.
    pub fn below(&self, camera: Entity) -> Option<Entity> {
        self.0.get(&camera).copied()
    }
}

/// The plugin has added `STORAGE_BINDING` to the usages of a camera's main textures.
#[derive(Component)]
pub(crate) struct AddedStorage;

#[derive(QueryData)]
pub(crate) struct Sharing {
    entity: Entity,
    camera: &'static Camera,
    target: &'static RenderTarget,
    msaa: &'static Msaa,
    usages: &'static CameraMainTextureUsages,
    has_added_storage: Has<AddedStorage>,
    is_hdr: Has<Hdr>,
    space: Option<&'static CompositingSpace>,
    sky: Option<&'static Skybox>,
    afterimage: Option<(&'static Afterimage, &'static Foveated)>,
}

/// By what Bevy chooses the texture. The primary window is `None`.
type Texture = (Option<NormalizedRenderTarget>, bool, Option<CompositingSpace>, Msaa, TextureUsages);

impl SharingItem<'_, '_> {
    /// The texture without the plugin.
    fn texture(&self) -> Texture {
        let added = if self.has_added_storage { TextureUsages::STORAGE_BINDING } else { TextureUsages::empty() };
        let usages = self.usages.0.difference(added);
        (self.target.normalize(None), self.is_hdr, self.space.copied(), *self.msaa, usages)
    }

    /// Whether it keeps what is in its texture without the plugin, where another camera has drawn to that.
    fn keeps(&self) -> bool {
        let is_written_back = *self.msaa != Msaa::Off
            && match self.camera.msaa_writeback {
                MsaaWriteback::Off => false,
                MsaaWriteback::Auto => self.camera.viewport.is_none(),
                MsaaWriteback::Always => true,
            };
        matches!(self.camera.clear_color, ClearColorConfig::None) || is_written_back
    }

    /// Whether a foveated camera covers all that lies below.
    fn covers(&self) -> bool {
        let is_foveated = self.afterimage.is_some_and(|(_, foveated)| foveated.kind != FoveationKind::Off);
        is_foveated && self.sky.is_some_and(|sky| sky.image.is_some())
    }
}

pub(crate) fn find_layers(cameras: Query<Sharing>, mut layers: ResMut<Layers>) {
    layers.0.clear();
    if !cameras.iter().any(|camera| camera.afterimage.is_some()) {
        return;
    }
    let mut drawn: Vec<_> = cameras.iter().filter(|camera| camera.camera.is_active).collect();
    drawn.sort_by_key(|camera| (camera.camera.order, camera.entity));
    for (i, camera) in drawn.iter().enumerate().filter(|(_, camera)| camera.keeps() && !camera.covers()) {
        let texture = camera.texture();
        if let Some(below) = drawn[..i].iter().rev().find(|below| below.texture() == texture) {
            layers.0.insert(camera.entity, below.entity);
        }
    }
}

/// [`Layers`] by render entities, from below.
#[derive(Resource, Default)]
struct Uppers(EntityHashMap<Entity>);

fn extract(layers: Extract<Res<Layers>>, entities: Extract<Query<RenderEntity>>, mut uppers: ResMut<Uppers>) {
    uppers.0.clear();
    let pairs = layers.0.iter().filter_map(|(&upper, &lower)| entities.get_many([lower, upper]).ok());
    uppers.0.extend(pairs.map(|[lower, upper]| (lower, upper)));
}

/// Has Bevy keep the texture of a camera, though no other camera has drawn to it, or its MSAA is off now.
fn keep_what_lies_below(uppers: Res<Uppers>, mut cameras: Query<&mut ExtractedCamera>) {
    for &upper in uppers.0.values() {
        let Ok(mut camera) = cameras.get_mut(upper) else { continue };
        camera.clear_color = ClearColorConfig::None;
        camera.msaa_writeback = MsaaWriteback::Always;
    }
}

/// Copies what a camera has drawn to the texture of the camera on top of it, if that is another one.
fn hand_up(
    view: ViewQuery<&ViewTarget>,
    targets: Query<&ViewTarget>,
    uppers: Res<Uppers>,
    mut blit: ResMut<BlitPass>,
    mut ctx: RenderContext,
) {
    let Some(upper) = uppers.0.get(&view.entity()).and_then(|&upper| targets.get(upper).ok()) else { return };
    let (lower, output) = (view.into_inner().main_texture(), upper.main_texture());
    let is_shared = [output, upper.main_texture_other()].iter().any(|texture| texture.id() == lower.id());
    if is_shared || lower.size() != output.size() {
        return;
    }
    let device = ctx.render_device().clone();
    blit.record(device.wgpu_device(), ctx.command_encoder(), lower, upper.main_texture_view(), [0, 0]);
}

#[cfg(test)]
#[path = "../tests/unit/layers.rs"]
mod tests;
