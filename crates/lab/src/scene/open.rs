//! Opening a scene: a file or a built-in one.

use super::limits::SceneLimits;
use super::model::Scene;
use super::{builtin, gltf_file};
use crate::error::InputError;
use crate::file_kind::kind;
use std::path::Path;

impl Scene {
    /// Opens a `.gltf` or `.glb` file, or `builtin:NAME`. The file's first animation plays.
    ///
    /// # Errors
    /// - [`Io`](InputError::Io): a file does not exist or cannot be read.
    /// - [`Invalid`](InputError::Invalid): a file is damaged.
    /// - [`NotSupported`](InputError::NotSupported): it is another kind of file or glTF version, requires an
    ///   unsupported extension or image format, or refers to files outside of its folder.
    /// - [`Limit`](InputError::Limit): the scene is larger than `limits` allows.
    /// - [`Request`](InputError::Request): there is no such built-in scene.
    pub fn open(input: &str, limits: &SceneLimits) -> Result<Self, InputError> {
        Self::open_clip(input, None, limits)
    }

    /// Opens a scene like [`open`](Self::open), with the animation named `clip`, or of that index if none has the name.
    ///
    /// # Errors
    /// Those of [`open`](Self::open), and [`Request`](InputError::Request) if there is no such animation.
    pub fn open_clip(input: &str, clip: Option<&str>, limits: &SceneLimits) -> Result<Self, InputError> {
        if let Some(("builtin", name)) = input.split_once(':') {
            let scene = builtin::open(name).ok_or_else(|| {
                InputError::request(
                    input,
                    "is not a built-in scene",
                    "expected builtin:NAME with NAME one of cornell, furnace, control, bunny-low, bunny-high, cubes, \
                     mirror-room, courtyard, interior",
                )
            })?;
            return match clip {
                Some(clip) if !scene.animations.iter().any(|name| name == clip) => {
                    let problem = format!("has no animation '{clip}'");
                    Err(InputError::request(input, problem, "leave the animation out"))
                }
                _ => Ok(scene),
            };
        }
        match kind(Path::new(input)).as_str() {
            "gltf" | "glb" => gltf_file::open(input, clip, limits),
            _ => Err(InputError::not_supported(
                input,
                "is not a supported kind of scene",
                "expected a .gltf or .glb file, or builtin:NAME",
            )),
        }
    }
}
