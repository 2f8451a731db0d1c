//! Reports of runs and sweeps: scores, contact sheets, plots, pages.

pub mod backend;
pub mod canvas;
#[cfg(feature = "full")]
pub mod jpeg;
#[cfg(feature = "full")]
pub mod page;
#[cfg(feature = "full")]
pub mod pareto;
#[cfg(feature = "full")]
pub mod plot;
#[cfg(feature = "full")]
pub mod psnr_plot;
pub mod sheet;
