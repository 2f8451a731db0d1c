//! The foveation simulators on the GPU against their twins on the CPU, bit for bit; hard cases H62, H69-H71.
#![cfg(feature = "lab")]

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/gpu.rs"]
mod gpu;

mod controls;
mod equal;
mod lifecycle;
mod pictures;
mod rig;
