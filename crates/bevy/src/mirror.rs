//! Components of a camera that its lattice cameras need, too, because they change how meshes are shaded.

use crate::lattice::{LatticeCamera, LatticeCameras, LatticeSystems};
use bevy::camera::visibility::RenderLayers;
use bevy::camera::{Exposure, Hdr};
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::ecs::query::QueryFilter;
use bevy::light::cluster::ClusterConfig;
use bevy::light::{EnvironmentMapLight, ShadowFilteringMethod, Skybox};
use bevy::pbr::DistanceFog;
use bevy::prelude::*;
use bevy::render::view::ColorGrading;
use std::marker::PhantomData;

/// Copies the component `T` of cameras with lattice cameras to those, whenever it changes: for components that change
/// how meshes are shaded.
///
/// The plugin does so for `AmbientLight`, `ClusterConfig`, `ColorGrading`, `DistanceFog`, `EnvironmentMapLight`,
/// `Exposure`, `RenderLayers`, `ShadowFilteringMethod`, `Skybox`, and for cameras without `Hdr`, `Tonemapping`. Add
/// this plugin for components of your own.
///
/// ```
/// # use bevy::prelude::*;
/// # #[derive(Component, Clone)]
/// # struct MyFog;
/// # let mut app = App::new();
/// app.add_plugins(bevy_afterimage::MirrorPlugin::<MyFog>::default());
/// ```
#[derive(Debug)]
pub struct MirrorPlugin<T, F = ()>(PhantomData<fn() -> (T, F)>);

impl<T, F> Default for MirrorPlugin<T, F> {
    fn default() -> Self {
        Self(PhantomData)
    }
}

impl<T: Component + Clone, F: QueryFilter + 'static> Plugin for MirrorPlugin<T, F> {
    fn build(&self, app: &mut App) {
        app.add_systems(PostUpdate, mirror::<T, F>.in_set(LatticeSystems::Mirror));
    }
}

pub(crate) struct MirrorDefaultsPlugin;

impl Plugin for MirrorDefaultsPlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins((
            MirrorPlugin::<AmbientLight>::default(),
            MirrorPlugin::<ClusterConfig>::default(),
            MirrorPlugin::<ColorGrading>::default(),
            MirrorPlugin::<DistanceFog>::default(),
            MirrorPlugin::<EnvironmentMapLight>::default(),
            MirrorPlugin::<Exposure>::default(),
            MirrorPlugin::<RenderLayers>::default(),
            MirrorPlugin::<ShadowFilteringMethod>::default(),
            MirrorPlugin::<Skybox>::default(),
            // With it tone mapping is a pass of the camera itself.
            MirrorPlugin::<Tonemapping, Without<Hdr>>::default(),
        ));
    }
}

fn mirror<T: Component + Clone, F: QueryFilter>(
    mut commands: Commands,
    cameras: Query<(&LatticeCameras, Option<Ref<T>>), F>,
    copies: Query<(Has<T>, Ref<LatticeCamera>)>,
) {
    for (lattices, original) in &cameras {
        for &entity in &lattices.entities {
            let Ok((has, lattice)) = copies.get(entity) else { continue };
            match &original {
                Some(original) if original.is_changed() || !has || lattice.is_added() => {
                    commands.entity(entity).insert(T::clone(original));
                }
                None if has => {
                    commands.entity(entity).remove::<T>();
                }
                _ => {}
            }
        }
    }
}
