//! Mathematics of the path tracer and the rasterizer: scalar functions without state, with WGSL twins as in the
//! drop-in's kernel.
//!
//! Every file except `albedo_quadrature` has a WGSL twin with the same stem and the same function names.

pub mod albedo;
mod albedo_quadrature;
pub mod bsdf;
pub mod direction;
pub mod layers;
pub mod light;
pub mod microfacet;
pub mod octahedral;
pub mod phong;
pub mod sampling;
pub mod shading;
pub mod texel;
pub mod triangle;
