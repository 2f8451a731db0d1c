//! The mathematics, as scalar functions without state.
//!
//! Every file here has a WGSL twin of the same stem and the same function names. Twins use only what both sides compute
//! exactly alike: `+ - * /`, `sqrt`, comparisons, integer arithmetic and bit casts. No `pow`, `exp`, `log`, `acos` or fused
//! multiply-add, whose results differ from device to device; the polynomials that replace them state their accuracy.

pub mod acuity;
pub mod approx;
pub mod color;
pub mod debug_view;
pub mod depth;
pub mod foveate;
pub mod matched;
pub mod noise;
pub mod pack;
pub mod reproject;
pub mod resample;
pub mod reservoir;
pub mod rng;
pub mod sanitize;
pub mod surface;
pub mod taa;
pub mod wrs;
