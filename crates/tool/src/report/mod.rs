//! Reports of runs and sweeps: scores, contact sheets, plots, pages.

pub mod cameras;
pub mod jpeg;
pub mod page;
pub mod pareto;
pub mod plot;
pub mod psnr_plot;

pub use afterimage_eval::report::canvas;
