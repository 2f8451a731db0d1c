//! The path tracer and its parts, and the rasterizer against its rays.

#[allow(dead_code, reason = "the lab's tests of scene files use all of it")]
#[path = "../../../lab/tests/render/scene_files/builder.rs"]
mod builder;
#[path = "../../../lab/tests/render/given.rs"]
mod given;
#[path = "../../../lab/tests/common/roomy.rs"]
mod roomy;
#[path = "../../../lab/tests/common/shared_data.rs"]
mod shared_data;
#[path = "../../../lab/tests/common/sound_scene.rs"]
mod sound_scene;

mod head;
mod raster;
mod sampling;
mod shaders;
mod trace;
mod traversal;
