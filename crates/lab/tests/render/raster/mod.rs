//! The rasterizer: motion and depth against rays, colors against closed forms, and every available scene.

mod geometry;
mod head;
mod light;
mod methods;
mod noise;
mod quad_views;
mod real;
pub mod rig;
mod shaded;
