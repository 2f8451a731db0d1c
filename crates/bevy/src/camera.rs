//! Cameras with the plugin's components: their depth, size, usages and MSAA.

use crate::components::{Afterimage, Foveated, FoveationKind};
use crate::layers::{AddedStorage, Layers, LayersFound, ReplacedMsaa, chosen_msaa};
use crate::oblique::{NEAR, is_oblique};
use crate::orthographic::{self, is_orthographic};
use afterimage::DepthConvention;
use bevy::camera::{CameraMainTextureUsages, Hdr, RenderTarget};
use bevy::core_pipeline::prepass::{DepthPrepass, MotionVectorPrepass, NormalPrepass};
use bevy::ecs::query::QueryData;
use bevy::ecs::system::SystemChangeTick;
use bevy::prelude::*;
use bevy::render::render_resource::TextureUsages;

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

pub(crate) struct CameraPlugin;

impl Plugin for CameraPlugin {
    fn build(&self, app: &mut App) {
        // Before what reads these components in this frame.
        app.add_systems(
            PostUpdate,
            (replace_msaa, add_usages)
                .run_if(resource_exists::<AfterimageSupported>)
                .after(LayersFound)
                .before(bevy::camera::CameraUpdateSystems),
        );
    }
}

/// What says whether MSAA of a camera is off.
#[derive(QueryData)]
struct Sampled {
    entity: Entity,
    target: &'static RenderTarget,
    afterimage: Option<(&'static Afterimage, &'static Foveated)>,
    prepasses: (Has<DepthPrepass>, Has<NormalPrepass>, Has<MotionVectorPrepass>),
}

impl SampledItem<'_, '_> {
    /// What draws on another camera's picture is not foveated.
    fn foveated(&self, layers: &Layers) -> Option<&Afterimage> {
        let (afterimage, foveated) = self.afterimage?;
        // Where foveation comes and goes by itself, MSAA stays off: other pipelines would have to be compiled.
        let is_foveated = foveated.kind != FoveationKind::Off || foveated.target_fps.is_some();
        (is_foveated && layers.below(self.entity).is_none()).then_some(afterimage)
    }

    fn has_prepass(&self) -> bool {
        let (depth, normal, motion) = self.prepasses;
        depth || normal || motion
    }
}

/// Switches MSAA off for cameras that are foveated, and back when they no longer are. Other cameras of their targets
/// with a prepass have none either: Bevy has prepasses of one target share textures.
fn replace_msaa(
    mut commands: Commands,
    mut cameras: Query<(&mut Msaa, Option<Ref<ReplacedMsaa>>, Sampled)>,
    layers: Res<Layers>,
    tick: SystemChangeTick,
) {
    let foveated = cameras.iter().filter(|(.., camera)| camera.foveated(&layers).is_some());
    let targets: Vec<_> = foveated.map(|(.., camera)| camera.target.normalize(None)).collect();
    for (mut msaa, replaced, camera) in &mut cameras {
        let chosen = chosen_msaa(&msaa, replaced.as_ref(), tick.this_run());
        let foveated = camera.foveated(&layers);
        let is_off = foveated.is_some() || camera.has_prepass() && targets.contains(&camera.target.normalize(None));
        if is_off && *msaa != Msaa::Off {
            if foveated.is_some_and(|afterimage| afterimage.antialias) {
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
            commands.entity(camera.entity).insert(ReplacedMsaa(*msaa));
            *msaa = Msaa::Off;
        } else if replaced.is_some() && (!is_off || chosen == Msaa::Off) {
            *msaa = chosen;
            commands.entity(camera.entity).remove::<ReplacedMsaa>();
        }
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
