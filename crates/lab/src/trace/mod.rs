//! Path tracing of scenes, on the CPU and on a GPU, foveated or not. `docs/path-tracing.md` has the formulas.
//!
//! - [`world::World`]: a scene made ready; in it [`Geometry`], the triangles that never move and those that do, each under a hierarchy
//!   of its own.
//! - [`Tracer`]: [`cpu`] or [`gpu`], the same paths; specialised to [`effects::Effects`] that the scene calls for. It adds the samples
//!   of a [`work::Work`] to a [`film::Film`].
//! - [`sampling`]: where a frame is sampled for a gaze. [`surfaces`]: exact depth and motion. [`stereo`]: a gaze for each eye.
//! - [`scene_buffer`]: everything that the tracer on a GPU reads, as one array of `vec4<u32>`.

mod alias;
mod bvh;
mod bvh2;
pub mod cpu;
pub mod effects;
pub mod film;
mod geometry;
pub mod gpu;
pub mod measure;
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
pub use triangle_records::{AttributeRecord, Attributes, AttributesAt, PreviousRecord, TriangleFlags, TriangleRecord};
