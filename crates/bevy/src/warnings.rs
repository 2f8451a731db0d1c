//! Warnings about components and materials that sparse frames render wrongly: one line in the log each.

use crate::camera::{Afterimage, Foveated, FoveationKind};
use crate::lattice::{LatticeCameras, LatticeSystems};
use bevy::light::VolumetricFog;
use bevy::pbr::{ScreenSpaceAmbientOcclusion, ScreenSpaceReflections};
use bevy::prelude::*;
use bevy::render::camera::TemporalJitter;

pub(crate) struct WarningsPlugin;

impl Plugin for WarningsPlugin {
    fn build(&self, app: &mut App) {
        let systems = (warn_of_components, warn_of_transmission, warn_of_unused).after(LatticeSystems::Spawn);
        app.add_systems(PostUpdate, systems);
    }
}

type Components<'a> = (
    Has<ScreenSpaceAmbientOcclusion>,
    Has<ScreenSpaceReflections>,
    Has<VolumetricFog>,
    Has<TemporalJitter>,
    &'a Afterimage,
);

/// Components that a camera has and its lattice cameras cannot have.
fn warn_of_components(cameras: Query<(Entity, Components<'_>), With<LatticeCameras>>) {
    for (camera, (occlusion, reflections, fog, jitter, afterimage)) in &cameras {
        if occlusion {
            warn_once!(
                "camera {camera}: ScreenSpaceAmbientOcclusion does not reach meshes beside Afterimage. Remove it"
            );
        }
        if reflections {
            warn_once!("camera {camera}: ScreenSpaceReflections are not drawn beside Afterimage. Remove them");
        }
        if fog {
            warn_once!("camera {camera}: VolumetricFog is not drawn beside Afterimage. Use DistanceFog");
        }
        // With `antialias` another line says so (`lattice.rs`).
        if jitter && !afterimage.antialias {
            warn_once!(
                "camera {camera}: TemporalJitter, which temporal antialiasing adds, blurs beside Afterimage. Remove \
                 temporal antialiasing, or set FoveationKind::Simulated"
            );
        }
    }
}

/// Transmission reads what the camera has drawn so far; a lattice camera has drawn one sample a block.
fn warn_of_transmission(
    mut is_said: Local<bool>,
    materials: Option<Res<Assets<StandardMaterial>>>,
    server: Res<AssetServer>,
    cameras: Query<Ref<LatticeCameras>>,
) {
    let Some(materials) = materials.filter(|_| !*is_said && !cameras.is_empty()) else { return };
    if !materials.is_changed() && !cameras.iter().any(|camera| camera.is_added()) {
        return;
    }
    if let Some((material, _)) = materials.iter().find(|(_, material)| material.specular_transmission > 0.0) {
        *is_said = true;
        let material = server.get_path(material).map_or("a material".into(), |path| format!("material {path}"));
        warn!(
            "{material} has specular_transmission, which is wrong beside Afterimage: behind it stand samples, \
             blurred. Set it to 0 and use AlphaMode::Blend. Models of glTF may bring it (KHR_materials_transmission)"
        );
    }
}

type WithoutAfterimage = (Without<Afterimage>, With<Camera>);

fn warn_of_unused(cameras: Query<(Entity, Ref<Foveated>), WithoutAfterimage>) {
    if let Some((camera, _)) = cameras.iter().find(|(_, f)| f.is_added() && f.kind != FoveationKind::Off) {
        warn_once!("camera {camera} has Foveated, but not Afterimage: it renders every pixel. Add Afterimage, too");
    }
}
