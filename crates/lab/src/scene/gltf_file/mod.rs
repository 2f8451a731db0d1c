//! glTF 2.0 files.
//!
//! The crate `gltf` provides the types of the JSON. Its validation is not used, because it indexes before it checks,
//! and refuses application-specific attributes; here every reference is looked up with a check. Its import is not used
//! either, because it reads any path.

mod accessors;
mod animation;
mod assemble;
mod buffers;
mod complete;
mod container;
mod document;
mod errors;
mod extensions;
mod images;
mod instances;
mod lobes;
mod material_reader;
mod materials;
mod mesh;
mod nodes;
mod origin;
mod placed;
mod skins;
mod spec_gloss;
mod tangents;
mod uri;
mod uv;
mod viewpoints;
mod warnings;

use super::{Scene, SceneLimits};
use crate::error::InputError;
use document::Document;

/// Opens a file with the animation of the name or index `clip`, by default the first.
pub(super) fn open(input: &str, clip: Option<&str>, limits: &SceneLimits) -> Result<Scene, InputError> {
    let file = container::read(input, limits)?;
    let buffers = buffers::load(&file, limits)?;
    let document = Document { subject: input, root: &file.root, buffers: &buffers, limits };
    assemble::scene(&document, &file, clip)
}
