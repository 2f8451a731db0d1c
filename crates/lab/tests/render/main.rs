//! Scenes, and what renders them: glTF files, the rasteriser, the path tracer and its parts.

#[path = "../common/hostile.rs"]
mod hostile;
#[path = "../common/roomy.rs"]
mod roomy;
#[path = "../common/shared_data.rs"]
mod shared_data;

mod given;
mod raster;
mod sampling;
mod scattering;
mod scene_files;
mod trace;
mod traversal;
