//! Scattering kernels: energy, densities, formulas, hard cases; H83.

mod densities;
mod furnace;
mod hard;
mod laws;
mod surfaces;
