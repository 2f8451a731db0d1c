//! The post-process on analytic scenes: both executors agree in every bit, and planted errors are seen.

#[allow(dead_code, reason = "the drop-in's tests use the rest")]
#[path = "../../../../tests/common/images.rs"]
mod images;
#[allow(dead_code, unused_imports, reason = "the drop-in's tests use the rest")]
#[path = "../../../../tests/gpu/pass/rig.rs"]
mod rig;

mod controls;
mod decisions;
mod sequences;
mod surfaces_lifecycle;
mod surfaces_scenes;
mod worst_crops;
