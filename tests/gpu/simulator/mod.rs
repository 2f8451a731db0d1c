//! The foveation simulators on the GPU against their twins on the CPU, bit for bit; hard cases H62, H69-H71.

mod controls;
mod equal;
mod lifecycle;
mod pictures;
mod rig;
