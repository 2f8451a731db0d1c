//! The mathematics, as scalar functions without state.
//!
//! Every file here but `albedo_quadrature` has a WGSL twin of the same stem and the same function names. Twins use only what both sides compute
//! exactly alike: `+ - * /`, `sqrt`, comparisons, integer arithmetic and bit casts. No `pow`, `exp`, `log`, `acos` or fused
//! multiply-add, whose results differ from device to device; the polynomials that replace them state their accuracy.

pub mod acuity;
#[cfg(feature = "lab")]
pub mod albedo;
#[cfg(feature = "lab")]
mod albedo_quadrature;
pub mod approx;
#[cfg(feature = "lab")]
pub mod bsdf;
pub mod color;
pub mod debug_view;
pub mod depth;
#[cfg(feature = "lab")]
pub mod direction;
pub mod foveate;
#[cfg(feature = "lab")]
pub mod layers;
#[cfg(feature = "lab")]
pub mod light;
pub mod matched;
#[cfg(feature = "lab")]
pub mod microfacet;
pub mod noise;
#[cfg(feature = "lab")]
pub mod octahedral;
pub mod pack;
#[cfg(feature = "lab")]
pub mod phong;
pub mod reproject;
pub mod resample;
pub mod reservoir;
pub mod rng;
#[cfg(feature = "lab")]
pub mod sampling;
pub mod scrub;
#[cfg(feature = "lab")]
pub mod shading;
pub mod surface;
pub mod taa;
#[cfg(feature = "lab")]
pub mod texel;
#[cfg(feature = "lab")]
pub mod triangle;
pub mod wrs;
