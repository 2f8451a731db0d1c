//! The WGSL library of the tracer and the rasterizer, as the shared twin tests see it.

use super::probe::Probe;
pub use super::scattering_lobes::table_data;
use super::{facets, lighting, scattering, scattering_lobes, triangles};
pub use afterimage_lab::shader::SHADERS;

/// Folder that contains `shaders/lib` and `src/kernel`.
pub const FOLDER: &str = env!("CARGO_MANIFEST_DIR");

/// Modules that define `load`, for those that need it.
pub const LOADS: &[&str] = &["lighting_maps"];

/// WGSL functions without a Rust twin of the same name, as (file stem, function).
pub const WGSL_ONLY: &[(&str, &str)] = &[];

/// Rust functions without a WGSL twin, as (file stem, function).
pub const RUST_ONLY: &[(&str, &str)] = &[];

/// Every probe.
pub fn probes() -> impl Iterator<Item = &'static Probe> {
    let lists = [lighting::PROBES, triangles::PROBES, scattering::PROBES, facets::PROBES, scattering_lobes::PROBES];
    lists.into_iter().flatten()
}
