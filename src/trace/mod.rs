//! Path tracing. So far what rays meet: acceleration structures and packed geometry, on the CPU and in WGSL.
//!
//! - [`Geometry`]: the triangles that never move and those that do, each under a hierarchy of its own; a ray visits both.
//! - [`heap`]: everything that a GPU tracer reads, as one array of `vec4<u32>`.

mod alias;
mod bvh;
mod bvh2;
pub mod cpu;
pub mod effects;
pub mod film;
mod geometry;
pub mod gpu;
pub mod gpu_heap;
pub mod gpu_rays;
pub mod heap;
pub mod measure;
mod node;
mod record;
pub mod records;
pub mod sampling;
pub mod settings;
pub mod surfaces;
mod tracer;
pub mod view;
pub mod work;
pub mod world;

pub use bvh::{Bvh, Hit, Ray};
pub use geometry::Geometry;
pub use record::{AttributeRecord, Attributes, AttributesAt, PreviousRecord, TriangleFlags, TriangleRecord};
pub use tracer::Tracer;
