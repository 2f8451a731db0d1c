//! Scenes, and what renders them: glTF files, the rasteriser, the path tracer and its parts.

mod raster;
mod sampling;
mod scattering;
mod scene_files;
mod trace;
mod traversal;
