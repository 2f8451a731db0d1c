//! Rays against the triangles of a scene, on the CPU.
//!
//! [`Geometry`] has static and moving triangles, each under a hierarchy of its own ([`Bvh`]). It is what the path
//! tracer of `afterimage-trace` traverses, and what the rasterizer measures a scene's enclosure with.

mod bvh;
mod bvh2;
mod geometry;
mod node;
mod triangle_records;

pub use bvh::{Bvh, Hit, Ray};
pub use geometry::Geometry;
pub use triangle_records::{AttributeRecord, Attributes, AttributesAt, SecondUvRecord, TriangleFlags, TriangleRecord};
