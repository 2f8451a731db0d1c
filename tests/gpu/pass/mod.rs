//! The pass on the GPU against its twin on the CPU: whole sequences, decisions and stored state bit for bit.

mod antialiasing;
mod engines;
mod gaze;
mod lens;
mod lifecycle;
mod light;
mod limits;
mod motion;
mod objects;
mod prime;
mod properties;
mod quads;
mod reactive;
mod reservoirs;
#[allow(dead_code, reason = "the lab's tests on analytic scenes use all of it")]
pub mod rig;
mod sparse;
mod sparse_hard;
mod submission;
mod surfaces;
mod surfaces_hard;
