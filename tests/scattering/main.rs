//! The scattering kernels: energy, densities, reciprocity, hard cases; H83.
#![cfg(feature = "lab")]

#[path = "../common/mod.rs"]
mod common;

mod densities;
mod furnace;
mod hard;
mod laws;
mod surfaces;
