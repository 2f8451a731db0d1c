//! The kernel's functions: each computes its formula, and their model has the properties it promises.

mod color;
mod conventions;
mod demodulation;
mod depth;
mod elementary;
mod geometry;
mod hard;
mod jitter;
#[path = "../common/kernel_hard.rs"]
mod kernel_hard;
mod lattice;
#[path = "../common/laws.rs"]
mod laws;
mod means;
mod quads;
mod reprojection;
mod reservoir;
mod rng;
mod stored_sample;
