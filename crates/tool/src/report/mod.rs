//! Reports of runs and sweeps: scores, contact sheets, plots, pages.

pub mod cameras;
pub mod frame_plot;
pub mod jpeg;
pub mod page;
pub mod pareto;
pub mod plot;

pub use afterimage_eval::report::canvas;
