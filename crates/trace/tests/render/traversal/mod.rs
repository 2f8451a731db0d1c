//! Traversal on the device against that on the CPU, and the scene buffer that it reads.

#[allow(dead_code, reason = "the lab's tests of rays use all of it")]
#[path = "../../../../lab/tests/render/traversal/scenes.rs"]
mod scenes;

mod on_gpu;
mod scene_buffer;
