//! Scenes, and what renders them: glTF files, rays, scattering, the rasteriser.

#[path = "../common/hostile.rs"]
mod hostile;
#[path = "../common/roomy.rs"]
mod roomy;
#[path = "../common/shared_data.rs"]
mod shared_data;
#[path = "../common/sound_scene.rs"]
mod sound_scene;

mod given;
mod raster;
mod scattering;
mod scene_files;
mod traversal;
