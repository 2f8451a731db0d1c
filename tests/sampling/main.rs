//! Foveated sampling of traced frames: where samples go, and what is made of them.
#![cfg(feature = "lab")]

#[path = "../common/gpu.rs"]
mod gpu;

mod acuity;
mod fills;
mod papers;
