//! Scenes: what there is to render. Read from glTF 2.0 files or built in; posed at a time.
//!
//! World space is glTF's: right-handed, y up, metres. Everything is triangles in world space: those that never move are made
//! once ([`Scene::still`]), those that do are posed for each frame ([`Scene::pose`]), in the same order and number at every time,
//! so that a triangle's place a frame ago is its place in an earlier pose.
//!
//! # What is read of glTF 2.0
//!
//! - `.gltf` and `.glb`; buffers and images beside the file or below its folder, in data URIs, in the `.glb`, in buffer views.
//!   Addresses that lead out of the folder are refused. Images: PNG and JPEG, brought to 8 bit RGBA.
//! - Triangles, strips and fans, indexed or not. All component types, normalised or not (KHR_mesh_quantization), sparse accessors.
//!   Without normals faces are flat; tangents that are needed and absent are MikkTSpace's. `COLOR_0` is held in 0 to 1.
//! - Metallic-roughness materials, normal maps, alpha MASK and BLEND, emission; of the extensions KHR_materials_anisotropy,
//!   \_clearcoat, \_emissive_strength, \_ior, \_sheen, \_specular, \_transmission, \_unlit (as emission of the base color, which
//!   lights its surroundings) and \_volume. KHR_texture_transform is baked into the texture coordinates. Occlusion maps are not
//!   used: the tracer finds what is occluded.
//! - KHR_lights_punctual, perspective cameras.
//! - The node tree, of any depth; skins with any number of joints a vertex; morph targets of positions, normals and tangents;
//!   animations of all of these with every interpolation. One animation plays, over and over.
//!
//! What is read differently, each with a warning ([`Scene::warnings`]): textures of one material that want different sets or
//! transforms of texture coordinates (all follow the base color's), the textures of anisotropy and of the coat's normal, rotated
//! anisotropy together with a normal map, orthographic cameras, points and lines, several scenes in a file (the default one is
//! shown), factors out of range, triangles that are not finite, and every extension that a file uses and that is not in this
//! list. If a file *requires* such an extension (Draco and meshopt compression, Basis Universal textures ...) it is refused.

mod animated;
mod bounds;
pub mod builtin;
pub mod camera;
pub mod camera_file;
pub mod cameras;
mod geometry;
mod gltf_file;
pub mod light;
mod limits;
pub mod material;
pub mod texture;
pub mod triangles;

pub use bounds::Bounds;
pub use camera::Camera;
pub use light::{Environment, PunctualKind, PunctualLight};
pub use limits::SceneLimits;
pub use material::{Alpha, Material, Phong, TextureRef};
pub use texture::{Texture, Wrap};
pub use triangles::Triangles;

use crate::error::InputError;
use std::path::Path;
use std::sync::Arc;

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
    /// Names of the file's animations, of which at most one plays; of those without a name, empty ones.
    pub animations: Vec<String>,
    /// What the file asks for and is not done, each once.
    pub warnings: Vec<String>,
    pub(crate) still: Triangles,
    /// Lights and cameras at time 0, and the triangles that move.
    pub(crate) rest: Pose,
    /// `None`: nothing moves.
    pub(crate) animated: Option<Arc<animated::Animated>>,
}

/// What moves, at a time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    /// Triangles that move, in the same order and number at every time, with their corners in the same order except where an
    /// animation mirrors them.
    pub moving: Triangles,
    /// Punctual lights, in the same order and number at every time.
    pub lights: Vec<PunctualLight>,
    /// Cameras, in the same order and number at every time.
    pub cameras: Vec<Camera>,
}

impl Scene {
    /// A scene made by code: `still`, and what is in `pose`, which stays where it is.
    ///
    /// # Errors
    /// If attributes are missing or a material does not exist.
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
                    "has triangles without all attributes or with a material that it lacks",
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
            still,
            rest: pose,
            animated: None,
        })
    }

    /// Reads what the user named: a `.gltf` or `.glb` file, or `builtin:NAME`. Of a file's animations the first one plays.
    ///
    /// # Errors
    /// If it does not exist, is damaged, is above the limits, or requires what is not supported.
    pub fn open(input: &str, limits: &SceneLimits) -> Result<Self, InputError> {
        Self::open_clip(input, None, limits)
    }

    /// As [`open`](Self::open), with the animation of that name, or of that number (from 0) if none has the name.
    ///
    /// # Errors
    /// As [`open`](Self::open), and if there is no such animation.
    pub fn open_clip(input: &str, clip: Option<&str>, limits: &SceneLimits) -> Result<Self, InputError> {
        if let Some(("builtin", name)) = input.split_once(':') {
            let scene = builtin::open(name).ok_or_else(|| {
                InputError::request(
                    input,
                    "is not a built-in scene",
                    "expected builtin:NAME with NAME one of cornell, furnace, control, bunny-low, bunny-high, cubes, \
                     mirror-room, courtyard",
                )
            })?;
            return match clip {
                None => Ok(scene),
                Some(clip) => {
                    let problem = format!("has no animation '{clip}', nor any other");
                    Err(InputError::request(input, problem, "leave the animation out"))
                }
            };
        }
        let extension = Path::new(input).extension().map(|e| e.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some("gltf" | "glb") => gltf_file::open(input, clip, limits),
            _ => Err(InputError::not_supported(
                input,
                "is not a scene that is read",
                "expected a .gltf or .glb file, or builtin:NAME",
            )),
        }
    }

    /// Triangles that never move.
    pub fn still(&self) -> &Triangles {
        &self.still
    }

    /// What moves, `time_s` seconds into the scene's animation, which starts over at its end.
    pub fn pose(&self, time_s: f64) -> Pose {
        self.animated.as_ref().map_or_else(|| self.rest.clone(), |animated| animated.pose(time_s))
    }

    /// Length of the animation in seconds; 0 if nothing moves.
    pub fn duration_s(&self) -> f64 {
        self.animated.as_ref().map_or(0.0, |animated| animated.duration_s)
    }
}
