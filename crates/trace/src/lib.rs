//! Path tracing of scenes, on the CPU and on a GPU, foveated or not, to test and measure [`afterimage`].
//! `docs/path-tracing.md` has the formulas.
//!
//! - [`world::World`]: a scene prepared for tracing.
//! - [`Tracer`]: [`cpu`] or [`gpu`], which trace the same paths, specialized to the
//!   [`Effects`](afterimage_lab::scene::effects::Effects) that the scene needs. It adds the samples of [`work::Spans`]
//!   to a [`film::Film`].
//! - [`sampling`]: foveated sampling patterns. [`surfaces`]: exact depth and motion, and albedo. [`stereo`]: gaze of
//!   two eyes. [`head_in_scene`]: a head that looks at surfaces.
//! - [`scene_buffer`]: the scene as one array of `vec4u`, which the GPU tracer reads.
//! - [`TracedSource`]: frames of a scene. [`measure`]: times of frames.

extern crate wgpu_30 as wgpu;

mod alias;
pub mod cpu;
pub mod film;
pub mod gpu;
mod head;
pub mod measure;
pub mod records;
pub mod sampling;
pub mod scene_buffer;
pub mod settings;
pub mod shader;
mod source;
pub mod stereo;
pub mod surfaces;
mod tracer;
pub mod work;
pub mod world;

pub use head::head_in_scene;
pub use source::{TracedSamples, TracedSource};
pub use tracer::Tracer;
