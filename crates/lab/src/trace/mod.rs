//! Path tracing of scenes, on the CPU and on a GPU, foveated or not. `docs/path-tracing.md` has the formulas.
//!
//! - [`world::World`]: a scene prepared for tracing, with its [`Geometry`]: static and moving triangles, each under a
//!   hierarchy of its own.
//! - [`Tracer`]: [`cpu`] or [`gpu`], which trace the same paths, specialized to the [`effects::Effects`] that the scene
//!   needs. It adds the samples of [`work::Spans`] to a [`film::Film`].
//! - [`sampling`]: foveated sampling patterns. [`surfaces`]: exact depth and motion. [`stereo`]: views and gaze of two
//!   eyes.
//! - [`scene_buffer`]: the scene as one array of `vec4u`, which the GPU tracer reads.

mod alias;
mod bvh;
mod bvh2;
pub mod cpu;
pub mod effects;
pub mod film;
mod geometry;
pub mod gpu;
mod node;
pub mod sampling;
pub mod scene_buffer;
pub mod settings;
pub mod shading_records;
pub mod stereo;
pub mod surfaces;
mod tracer;
mod triangle_records;
pub mod view;
pub mod work;
pub mod world;

pub use bvh::{Bvh, Hit, Ray};
pub use geometry::Geometry;
pub use tracer::Tracer;
pub use triangle_records::{AttributeRecord, Attributes, AttributesAt, SecondUvRecord, TriangleFlags, TriangleRecord};
