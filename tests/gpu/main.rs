//! The GPU executor against its twin on the CPU: function by function, then whole sequences, decisions and stored
//! state, bit for bit.

#[path = "../common/any_frame.rs"]
mod any_frame;
#[path = "../common/depth_hard.rs"]
mod depth_hard;
#[path = "../common/feedback_hard.rs"]
mod feedback_hard;
#[path = "../common/gaze_hard.rs"]
mod gaze_hard;
#[path = "../common/images.rs"]
mod images;
#[path = "../common/kernel_hard.rs"]
mod kernel_hard;
#[path = "../common/laws.rs"]
mod laws;
#[path = "../common/lifecycle_hard.rs"]
mod lifecycle_hard;
#[path = "../common/light_hard.rs"]
mod light_hard;
#[path = "../common/low_pass.rs"]
mod low_pass;
#[path = "../common/motion_hard.rs"]
mod motion_hard;
mod pass;
#[path = "../common/reactive.rs"]
mod reactive;
#[path = "../common/scale_hard.rs"]
mod scale_hard;
#[path = "../common/settings.rs"]
mod settings;
mod simulator;
#[allow(dead_code, reason = "the CPU's tests use all of it")]
#[path = "../common/simulator_hard.rs"]
mod simulator_hard;
#[path = "../common/sparse_hard/mod.rs"]
mod sparse_hard;
#[path = "../common/surfaces_hard.rs"]
mod surfaces_hard;
mod twins;
