//! The rasterizer: colors against closed forms, quad views and chosen pixels. What it shares with the path tracer is
//! tested in `crates/trace/tests/render/raster/`.

mod deferred;
mod light;
mod methods;
mod noise;
mod quad_views;
mod rig;
mod shaded;
