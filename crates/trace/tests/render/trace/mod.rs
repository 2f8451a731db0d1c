//! The whole path tracer: CPU against GPU, integrators against each other and against closed forms, energy, effects,
//! depth and motion, invalid input; hard cases H80-H84.

mod agree;
mod albedo;
mod closed_form;
mod coordinates;
mod device_loss;
mod effects;
mod equal;
mod frames;
mod hard;
mod quads;
mod radiosity;
pub mod rig;
mod scenes;
pub mod statistics;
mod stereo;
mod surfaces;
