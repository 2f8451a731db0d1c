//! Foveated sampling of traced frames: where samples go, and what is made of them.
#![cfg(feature = "lab")]

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/gpu.rs"]
mod gpu;

mod acuity;
mod fills;
mod guided;
mod papers;
