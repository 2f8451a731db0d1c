//! Size limits of scenes, checked before memory is allocated.

use crate::error::{Bound, Exceeded, InputError};

/// Limits on the size of a scene. Higher limits admit larger scenes, and let a damaged or hostile file claim as much
/// memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneLimits {
    /// Largest number of triangles, counting every instance of a mesh. Default 50 million, about 10 GB.
    pub max_triangles: u64,
    /// Largest number of texels of all textures together. Default 256 million, 1 GB.
    pub max_texels: u64,
    /// Largest number of bytes of all files of the scene together. Default 4 GiB.
    pub max_file_bytes: u64,
    /// Largest number of bytes of the scene's JSON, which takes many times as much memory when parsed. Default 256 MiB.
    pub max_json_bytes: u64,
}

impl Default for SceneLimits {
    fn default() -> Self {
        Self { max_triangles: 50_000_000, max_texels: 256_000_000, max_file_bytes: 4 << 30, max_json_bytes: 256 << 20 }
    }
}

impl SceneLimits {
    /// Bound on accessor elements per triangle: vertex attributes and indices.
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

    /// Largest number of accessor elements (vertex attributes and indices) to read, counted at every use.
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
