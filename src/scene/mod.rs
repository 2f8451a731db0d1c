//! Scenes: what there is to render. Read from glTF 2.0 files or built in; posed at a time.
//!
//! World space is glTF's: right-handed, y up, metres. Everything is triangles in world space: those that never move are made
//! once ([`Scene::still`]), those that do are posed for each frame ([`Scene::pose`]), in the same order and number at every time,
//! so that a triangle's place a frame ago is its place in an earlier pose.

pub mod builtin;
pub mod camera;
pub mod camera_file;
pub mod light;
pub mod material;
pub mod texture;
pub mod triangles;

pub use camera::Camera;
pub use light::{Environment, PunctualKind, PunctualLight};
pub use material::{Alpha, Material, TextureRef};
pub use texture::{Texture, Wrap};
pub use triangles::Triangles;

/// Everything there is to render, and how it moves.
#[derive(Clone, Debug)]
pub struct Scene {
    /// As the user named it.
    pub name: String,
    /// What surfaces are made of.
    pub materials: Vec<Material>,
    /// Images that materials refer to.
    pub textures: Vec<Texture>,
    /// What rays see that hit nothing.
    pub environment: Environment,
    /// What the file asks for and is not done, each once.
    pub warnings: Vec<String>,
    pub(crate) still: Triangles,
    /// Lights and cameras at time 0, and the triangles that move.
    pub(crate) rest: Pose,
}

/// What moves, at a time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    /// Triangles that move, in the same order and number at every time.
    pub moving: Triangles,
    /// Punctual lights, in the same order and number at every time.
    pub lights: Vec<PunctualLight>,
    /// Cameras, in the same order and number at every time.
    pub cameras: Vec<Camera>,
}

impl Scene {
    /// Triangles that never move.
    pub fn still(&self) -> &Triangles {
        &self.still
    }

    /// What moves, `time_s` seconds into the scene's animation.
    pub fn pose(&self, _time_s: f64) -> Pose {
        self.rest.clone()
    }
}
