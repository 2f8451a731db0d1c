//! The rasterizer against the path tracer: motion and depth, and the look of every available scene.

#[allow(dead_code, reason = "the lab's tests of the rasterizer use all of it")]
#[path = "../../../../lab/tests/render/raster/rig.rs"]
pub mod rig;

mod geometry;
pub mod rays;
mod real;
