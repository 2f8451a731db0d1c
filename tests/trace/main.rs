//! The path tracer as a whole: CPU against GPU, integrators against each other and against closed forms, energy, effects, depth
//! and motion, bad input; hard cases H80-H84.
#![cfg(feature = "lab")]

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/gpu.rs"]
mod gpu;

mod agree;
mod chance;
mod closed_form;
mod effects;
mod equal;
mod frames;
mod hard;
mod radiosity;
mod rig;
mod scenes;
mod statistics;
mod stereo;
mod surfaces;
