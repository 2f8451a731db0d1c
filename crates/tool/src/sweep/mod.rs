//! Sweeps: error against time of the points of a grid of methods and options.
//!
//! A point is a method with options of `afterimage run`. [`grid`] enumerates the points. [`store`] keeps the
//! measurements of each point in a file, so that a sweep can be stopped, resumed and split between machines. [`table`]
//! compares the measurements.

pub mod convergence;
pub mod equal;
pub mod frontier;
pub mod grid;
pub mod markdown;
pub mod measurement;
pub mod metrics;
pub mod plan;
pub mod prices;
pub mod row;
pub mod rust_source;
pub mod store;
pub mod table;

pub use grid::{Axis, Grid, Options, Point};
pub use measurement::Measurement;
pub use metrics::{METRICS, Metric};
pub use plan::Plan;
pub use row::Row;
pub use store::Store;
pub use table::Table;
