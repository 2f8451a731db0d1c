//! The kernel's functions: each computes its formula, and the model that they make is right.

mod color;
mod depth;
mod elementary;
mod reprojection;
mod reservoir;
mod rng;
