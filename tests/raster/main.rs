//! The rasteriser: motion and depth against rays, colours against closed forms, and what it shows of every scene.
#![cfg(feature = "lab")]

#[path = "../common/gpu.rs"]
mod gpu;

mod geometry;
mod light;
mod real;
mod rig;
