//! Cameras with the plugin's components: their depth, size, usages and MSAA.

use crate::components::Afterimage;
use crate::layers::{AddedStorage, Layers, find_layers};
use crate::oblique::{NEAR, is_oblique};
use crate::orthographic::{self, is_orthographic};
use afterimage::DepthConvention;
use bevy::camera::{CameraMainTextureUsages, Hdr};
use bevy::core_pipeline::prepass::{DepthPrepass, MotionVectorPrepass, NormalPrepass};
use bevy::prelude::*;
use bevy::render::camera::ExtractedCamera;
use bevy::render::render_resource::TextureUsages;
use bevy::render::{Render, RenderApp, RenderSystems};

/// Size in pixels of what a camera draws: its viewport, which must lie inside its target. `None`: nothing is drawn, or
/// an application has changed the target and not yet the viewport.
pub(crate) fn drawn_size_px(camera: &Camera) -> Option<UVec2> {
    let (size, target) = (camera.physical_viewport_size()?, camera.physical_target_size()?);
    let origin = camera.viewport.as_ref().map_or(UVec2::ZERO, |viewport| viewport.physical_position);
    let is_inside = (origin + size).cmple(target).all();
    (camera.is_active && size.min_element() > 0 && is_inside).then_some(size)
}

/// Convention of the depth that the post-process gets: Bevy's, reversed, with a far plane that is infinite or not.
pub(crate) fn depth_convention(clip_from_view: Mat4) -> Result<DepthConvention, String> {
    if is_orthographic(clip_from_view) {
        return orthographic::depth_convention(clip_from_view);
    }
    if is_oblique(clip_from_view) {
        if clip_from_view.w_axis.z <= 0.0 {
            return Err("its near_clip_plane keeps what is before it. Turn the plane round".into());
        }
        return Ok(DepthConvention::Reversed { near: NEAR, far: f32::INFINITY });
    }
    // depth = w.z / distance - z.z
    let (z, w) = (clip_from_view.z_axis.z, clip_from_view.w_axis.z);
    if w <= 0.0 || z < 0.0 {
        return Err("its depth is not reversed, as Bevy's is".into());
    }
    let near = w / (1.0 + z);
    let far = if z > 0.0 { w / z } else { f32::INFINITY };
    let depth = DepthConvention::Reversed { near, far };
    depth.validate().map(|()| depth).map_err(|error| error.to_string())
}

/// A resource that is there if cameras with [`Afterimage`] are foveated: the plugin has found a renderer, and a device
/// with compute shaders. Without it they render every pixel, and the log says why. It is known from `Startup` on.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub struct AfterimageSupported;

pub(crate) fn plugin(app: &mut App) {
    // Before what reads these components in this frame.
    app.add_systems(
        PostUpdate,
        add_usages
            .run_if(resource_exists::<AfterimageSupported>)
            .after(find_layers)
            .before(bevy::camera::CameraUpdateSystems),
    );
    if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
        // Before what chooses textures and pipelines.
        let switch = switch_msaa_off.after(RenderSystems::ExtractCommands).before(RenderSystems::PrepareAssets);
        render_app.add_systems(Render, switch);
    }
}

/// A camera that is rendered without MSAA, because most of its pixels have no samples to average.
#[derive(Component, Clone, Copy, Debug)]
pub(crate) struct WithoutMsaa {
    /// Whether history antialiases instead.
    pub antialias: bool,
}

type HasPrepass = Or<(With<DepthPrepass>, With<NormalPrepass>, With<MotionVectorPrepass>)>;

/// Switches MSAA off for what is rendered; the camera's own component stays. Other cameras of its target with a prepass
/// have none either: Bevy has prepasses of one target share textures.
fn switch_msaa_off(mut cameras: Query<(&mut Msaa, &ExtractedCamera, Option<&WithoutMsaa>), HasPrepass>) {
    let targets: Vec<_> =
        cameras.iter().filter(|(.., without)| without.is_some()).map(|(_, camera, _)| camera.target.clone()).collect();
    for (mut msaa, camera, without) in &mut cameras {
        if *msaa == Msaa::Off || !targets.contains(&camera.target) {
            continue;
        }
        if without.is_some_and(|without| without.antialias) {
            info_once!("Afterimage sets Msaa::Off, and antialiases in its place");
        } else if *msaa == Msaa::default() {
            // Bevy's default was hardly chosen.
            info_once!("Afterimage sets Msaa::Off. Set Afterimage::antialias for what it did");
        } else {
            warn_once!(
                "Afterimage sets Msaa::Off: most pixels of a foveated frame have no samples to average. Set \
                 Afterimage::antialias for what it did"
            );
        }
        *msaa = Msaa::Off;
    }
}

type Used<'a> =
    (Entity, &'a mut CameraMainTextureUsages, Option<&'a mut Camera3d>, Has<AddedStorage>, Has<Afterimage>, Has<Hdr>);

/// Has the post-process write the main texture itself where compute shaders can: not sRGB-encoded formats, which
/// cameras without `Hdr` have. Has the depth that it closes be restored.
fn add_usages(mut commands: Commands, mut cameras: Query<Used<'_>>, layers: Res<Layers>) {
    let storage = TextureUsages::STORAGE_BINDING;
    for (entity, mut usages, camera, is_added, has_afterimage, is_hdr) in &mut cameras {
        let needed = is_hdr && has_afterimage && layers.below(entity).is_none();
        if needed && !usages.0.contains(storage) {
            usages.0.insert(storage);
            commands.entity(entity).insert(AddedStorage);
        } else if !needed && is_added {
            usages.0.remove(storage);
            commands.entity(entity).remove::<AddedStorage>();
        }
        if let Some(mut camera) = camera.filter(|_| has_afterimage) {
            let depth = TextureUsages::from(camera.depth_texture_usages);
            if !depth.contains(TextureUsages::COPY_DST) {
                camera.depth_texture_usages = (depth | TextureUsages::COPY_DST).into();
            }
        }
    }
}

#[cfg(test)]
#[path = "../tests/unit/camera.rs"]
mod tests;
