//! The kernel's functions: each computes its formula, and their model has the properties it promises.

mod color;
mod conventions;
mod depth;
mod elementary;
mod geometry;
mod kept;
mod lattice;
mod reprojection;
mod reservoir;
mod rng;
