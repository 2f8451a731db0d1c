//! The rasteriser: motion and depth against rays, colours against closed forms, and what it shows of every scene.

#[path = "../common/gpu.rs"]
#[allow(dead_code)]
mod gpu;

mod geometry;
mod light;
mod real;
mod rig;
