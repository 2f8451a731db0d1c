//! The model of a scene, independent of its source.

use super::animated::Animated;
use super::light::Environment;
use super::material::Material;
use super::pose::Pose;
use super::texture::Texture;
use super::triangles::Triangles;
use crate::error::InputError;
use glam::DVec3;
use std::sync::Arc;

/// A scene: geometry, materials, lights, cameras and one animation.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Name as the user gave it.
    pub name: String,
    /// Materials that triangles refer to.
    pub materials: Vec<Material>,
    /// Textures that materials refer to.
    pub textures: Vec<Texture>,
    /// Radiance of rays that hit nothing.
    pub environment: Environment,
    /// Names of the file's animations, of which at most one plays. Empty for an unnamed one.
    pub animations: Vec<String>,
    /// Features of the file that are ignored or approximated, each once.
    pub warnings: Vec<String>,
    /// Point of the file's coordinates that is the origin here, in metres. Not zero in files whose contents lie far
    /// from their origin, where floats are coarse: add it to positions that leave the scene.
    pub origin: DVec3,
    pub(crate) still: Triangles,
    /// Animated triangles, lights and cameras at time 0.
    pub(crate) rest: Pose,
    /// `None`: a static scene.
    pub(crate) animated: Option<Arc<Animated>>,
}

impl Scene {
    /// A static scene with the triangles `still`, and the triangles, lights and cameras of `pose`.
    ///
    /// # Errors
    /// [`Request`](InputError::Request) if attributes are missing or a material does not exist.
    pub fn from_parts(
        name: &str,
        materials: Vec<Material>,
        still: Triangles,
        pose: Pose,
        environment: Environment,
    ) -> Result<Self, InputError> {
        for triangles in [&still, &pose.moving] {
            let known = |m: &u32| (*m as usize) < materials.len();
            if !(triangles.is_complete() && triangles.materials.iter().all(known)) {
                return Err(InputError::request(
                    name,
                    "has triangles that lack attributes or refer to a material that does not exist",
                    "give each triangle an entry in every array and the index of one of the materials",
                ));
            }
        }
        Ok(Self {
            name: name.into(),
            materials,
            textures: vec![],
            environment,
            animations: vec![],
            warnings: vec![],
            origin: DVec3::ZERO,
            still,
            rest: pose,
            animated: None,
        })
    }

    /// Static triangles.
    pub fn still(&self) -> &Triangles {
        &self.still
    }

    /// Animated triangles, lights and cameras `time_s` seconds into the scene's animation, which
    /// starts at its first key and loops.
    pub fn pose(&self, time_s: f64) -> Pose {
        self.animated.as_ref().map_or_else(|| self.rest.clone(), |animated| animated.pose(time_s))
    }

    /// Duration of the animation in seconds; 0 for a static scene.
    pub fn duration_s(&self) -> f64 {
        self.animated.as_ref().map_or(0.0, |animated| animated.duration_s)
    }
}
