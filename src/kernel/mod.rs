//! Per-pixel mathematics of the passes, as functions without state.
//!
//! Each file has a twin in `shaders/lib` with the same stem and the same function names. Twins use only operations that
//! give the same bits in Rust and WGSL: `+ - * /`, `sqrt`, comparisons, integer arithmetic and bit casts. No `pow`,
//! `exp`, `log`, `acos` or fused multiply-add, whose results differ from device to device; the polynomials that replace
//! them state their accuracy.

pub mod acuity;
pub mod antialias;
pub mod approx;
pub mod candidate;
pub mod color;
pub mod debug_view;
pub mod demodulation;
pub mod depth;
pub mod doctor;
pub mod foveate;
pub mod lab;
pub mod lattice;
pub mod lens;
pub mod lod;
pub mod mip_noise;
pub mod noise;
pub mod pack;
pub mod quads;
pub mod reconstruction;
pub mod reproject;
pub mod resample;
pub mod reservoir;
pub mod resize;
pub mod rng;
pub mod sanitize;
pub mod smr;
pub mod stored_reservoir;
pub mod stored_sample;
pub mod surface;
pub mod taa;
pub mod taau;
pub mod wrs;
