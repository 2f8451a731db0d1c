//! The CPU executor: whole passes, method by method, and the simulators of foveation.

#[path = "../common/any_frame.rs"]
mod any_frame;
mod pass;
mod simulator;
mod surfaces;
