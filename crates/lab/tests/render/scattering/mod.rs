//! Scattering kernels: energy, densities, reciprocity, hard cases; H83.

mod densities;
mod furnace;
mod hard;
mod laws;
mod surfaces;
