//! The WGSL library of the tracer and the rasterizer against its Rust kernel, function by function, bit for bit; hard
//! cases H80, H83.

#[path = "../../../../tests/gpu/twins/modules.rs"]
mod modules;
#[path = "../../../../tests/gpu/twins/names.rs"]
mod names;
#[path = "../../../../tests/gpu/twins/order.rs"]
mod order;
#[allow(dead_code, reason = "the drop-in's twins use all of it")]
#[path = "../../../../tests/gpu/twins/probe.rs"]
mod probe;
#[allow(dead_code, unused_imports, unused_macros, reason = "the drop-in's twins use all of it")]
#[path = "../../../../tests/gpu/twins/shape.rs"]
mod shape;
#[allow(dead_code, reason = "the drop-in's twins use all of it")]
#[path = "../../../../tests/gpu/twins/values.rs"]
mod values;

mod backends;
mod controls;
mod facets;
mod functions;
mod library;
mod lighting;
mod scattering;
mod scattering_lobes;
mod triangles;
