//! The rasteriser: motion and depth against rays, colors against closed forms, and what it shows of every scene.

mod geometry;
mod light;
mod real;
mod rig;
