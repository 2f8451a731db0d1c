//! The library under test: that of the tracer and the rasteriser.

use super::probe::Probe;
pub use super::scattering_lobes::table_data;
use super::{facets, lighting, scattering, scattering_lobes, triangles};
pub use afterimage_lab::shader::SHADERS;

/// Where `shaders/lib` and `src/kernel` are.
pub const FOLDER: &str = env!("CARGO_MANIFEST_DIR");

/// (WGSL file stem, function there) without a Rust twin of that name.
pub const WGSL_ONLY: &[(&str, &str)] = &[];

/// (Rust file stem, function there) without a WGSL twin.
pub const RUST_ONLY: &[(&str, &str)] = &[];

/// Functions without a name of their own in the Rust kernel's public interface; probed through their callers.
pub const PRIVATE: &[&str] =
    &["compensation", "eval_reflection", "eval_transmission", "folded", "glass_fresnel", "mirror_probability"];

/// Every probe.
pub fn probes() -> impl Iterator<Item = &'static Probe> {
    let lists = [lighting::PROBES, triangles::PROBES, scattering::PROBES, facets::PROBES, scattering_lobes::PROBES];
    lists.into_iter().flatten()
}
