//! Reports of a sweep: tables at equal time and equal quality, plots, the page.

mod equal;
mod page;
mod pareto;
mod table;
