//! A generated head among the surfaces of a scene.

use crate::surfaces::distance_m;
use crate::world::World;
use afterimage_lab::error::InputError;
use afterimage_lab::scanpath::{HeadOptions, SyntheticHead, generate_head};
use afterimage_lab::scene::Scene;
use afterimage_lab::source::SceneCamera;
use glam::DVec3;

/// A head and eye that look around in a scene, from [`SceneCamera::head_space`]: gaze rests on its surfaces, as they
/// are at time 0.
///
/// # Errors
/// Those of [`generate_head`].
pub fn head_in_scene(scene: &Scene, options: &HeadOptions) -> Result<SyntheticHead, InputError> {
    let world_from_space = SceneCamera::head_space(scene);
    let world = World::new(scene);
    generate_head(options, &|from, direction| {
        let from = world_from_space.transform_point3(DVec3::from(from));
        distance_m(&world, from, world_from_space.transform_vector3(DVec3::from(direction)))
    })
}
