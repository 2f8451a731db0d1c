//! How much a scene may ask for, checked before memory is set aside.

use crate::error::{Bound, Exceeded, InputError};

/// Bounds on what is read. More admits larger scenes, and lets a damaged or hostile file ask for as much memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneLimits {
    /// Most triangles, every use of a mesh counted. Default 50 million, about 10 GB.
    pub max_triangles: u64,
    /// Most texels of all textures together. Default 256 million, 1 GB.
    pub max_texels: u64,
    /// Most bytes of all files of the scene together. Default 4 GiB.
    pub max_file_bytes: u64,
    /// Most bytes of the description of the scene (JSON), which takes many times as much when it is parsed. Default 256 MiB.
    pub max_json_bytes: u64,
}

impl Default for SceneLimits {
    fn default() -> Self {
        Self { max_triangles: 50_000_000, max_texels: 256_000_000, max_file_bytes: 4 << 30, max_json_bytes: 256 << 20 }
    }
}

impl SceneLimits {
    /// Vertex attributes and indices that a triangle can need.
    pub(crate) const ELEMENTS_PER_TRIANGLE: u64 = 8;

    pub(crate) fn check_triangles(&self, subject: &str, triangles: u64) -> Result<(), InputError> {
        check(subject, "triangles", triangles, self.max_triangles, Bound::Triangles)
    }

    pub(crate) fn check_texels(&self, subject: &str, texels: u64) -> Result<(), InputError> {
        check(subject, "texels", texels, self.max_texels, Bound::Texels)
    }

    pub(crate) fn check_file_bytes(&self, subject: &str, bytes: u64) -> Result<(), InputError> {
        check(subject, "bytes of files", bytes, self.max_file_bytes, Bound::FileBytes)
    }

    pub(crate) fn check_json_bytes(&self, subject: &str, bytes: u64) -> Result<(), InputError> {
        check(subject, "bytes of JSON", bytes, self.max_json_bytes, Bound::JsonBytes)
    }

    /// Vertex attributes and indices that may be read, each counted as often as it is used: what the triangles can need.
    pub(crate) fn max_elements(&self) -> u64 {
        self.max_triangles.saturating_mul(Self::ELEMENTS_PER_TRIANGLE)
    }
}

fn check(subject: &str, what: &str, found: u64, limit: u64, bound: Bound) -> Result<(), InputError> {
    if found <= limit {
        return Ok(());
    }
    let setting = match bound {
        Bound::Texels => "max_texels",
        Bound::FileBytes => "max_file_bytes",
        Bound::JsonBytes => "max_json_bytes",
        _ => "max_triangles",
    };
    Err(InputError::limit(
        Exceeded { bound, needed: Some(found), allowed: limit },
        subject,
        format!("comes to {found} {what}, above the limit of {limit}"),
        format!("use a smaller scene, or raise SceneLimits::{setting}"),
    ))
}
