//! What a reader gets of a sweep: tables at equal time and equal quality, plots, the page.
#![cfg(feature = "lab")]

mod equal;
mod page;
mod pareto;
mod table;
