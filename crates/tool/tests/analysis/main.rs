//! Sweeps: points, storage, page and plots.

mod report;
mod sweep;
