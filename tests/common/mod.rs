//! What the tests of both executors share: laws of hard cases, frames and settings.

pub mod any_frame;
pub mod depth_hard;
pub mod feedback_hard;
pub mod gaze_hard;
#[allow(dead_code, reason = "the device's tests use all of it")]
pub mod images;
pub mod laws;
pub mod lifecycle_hard;
pub mod light_hard;
pub mod low_pass;
pub mod mask_hard;
pub mod motion_hard;
#[allow(dead_code, reason = "the CPU's tests use all of it")]
pub mod planned_hard;
pub mod reactive;
pub mod scale_hard;
pub mod settings;
#[allow(dead_code, reason = "the CPU's tests use all of it")]
pub mod simulator_hard;
pub mod surfaces_hard;
