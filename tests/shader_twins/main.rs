//! The WGSL library against the Rust kernel, function by function, bit for bit; hard cases H01-H04, H15, H17-H21, H23, H28,
//! H30-H39, H41, H42, H45, H47, H54, H57, H61, H64, H65, H71, H80, H83.
#![cfg(feature = "lab")]

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/gpu.rs"]
mod gpu;

mod controls;
mod decisions;
mod facets;
mod foveation;
mod functions;
mod hard_colors;
mod hard_reservoirs;
mod laws;
mod lighting;
mod matching;
mod mathematics;
mod modules;
mod noise;
mod probe;
mod scattering;
mod scattering_lobes;
mod state;
mod surfaces;
mod triangles;
mod values;
