//! The library under test: the drop-in's.

use super::probe::Probe;
use super::{
    antialias, decisions, demodulation, doctor, foveation, lattice, lens, matching, mathematics, noise, quads, sparse,
    state, surfaces, upsampling, weighted,
};
pub use afterimage::shader::SHADERS;

/// Where `shaders/lib` and `src/kernel` are.
pub const FOLDER: &str = env!("CARGO_MANIFEST_DIR");

/// Modules that define `load`, for those that need it: none here.
pub const LOADS: &[&str] = &[];

/// (WGSL file stem, function there) without a Rust twin of that name: stand-ins for the standard library and for a
/// closure, and `mix`, which is a builtin of WGSL.
pub const WGSL_ONLY: &[(&str, &str)] =
    &[("stored_sample", "nothing_around"), ("reservoir", "saturating_add"), ("rng", "pcg4d_mix")];

/// (Rust file stem, function there) without a WGSL twin: some take a closure, in whose place the pass has a loop;
/// others are of what is known before a device sees a frame, or of notes of a pixel.
pub const RUST_ONLY: &[(&str, &str)] = &[
    ("depth", "distance_of"),
    ("depth", "slope"),
    ("lattice", "jitter_px"),
    ("lattice", "offset_px"),
    ("quads", "budget_quads"),
    ("quads", "threshold"),
    ("resample", "gather_around"),
];

/// Every probe.
pub fn probes() -> impl Iterator<Item = &'static Probe> {
    let lists = [
        demodulation::PROBES,
        antialias::PROBES,
        decisions::PROBES,
        doctor::PROBES,
        foveation::PROBES,
        lattice::PROBES,
    ]
    .into_iter();
    let lists = lists.chain([lens::PROBES, matching::PROBES, mathematics::PROBES, noise::PROBES, quads::PROBES]);
    lists.chain([sparse::PROBES, state::PROBES, surfaces::PROBES, upsampling::PROBES, weighted::PROBES]).flatten()
}

/// Words in front of the rows of a module's probes: data that it loads.
pub fn table_data(_module: &str) -> Vec<u32> {
    vec![]
}
