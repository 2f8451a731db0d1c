//! The pass on the GPU against its twin on the CPU: whole sequences, decisions and stored state bit for bit.
#![cfg(all(feature = "gpu", feature = "lab"))]

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/gpu.rs"]
mod gpu;

mod controls;
mod decisions;
mod gaze;
mod layout;
mod lifecycle;
mod light;
mod motion;
mod properties;
mod reservoirs;
mod rig;
mod sequences;
mod surfaces;
mod surfaces_controls;
mod surfaces_hard;
mod surfaces_lifecycle;
mod surfaces_variants;
