//! Reports of a sweep: tables at equal time and equal quality, plots, the page.

mod drawn;
mod equal;
mod page;
mod pareto;
mod psnr;
pub mod table;
