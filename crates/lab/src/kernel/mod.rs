//! The mathematics of the tracer and the rasteriser, as scalar functions without state; twins as those of the drop-in's kernel.
//!
//! Every file here but `albedo_quadrature` has a WGSL twin of the same stem and the same function names.

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
