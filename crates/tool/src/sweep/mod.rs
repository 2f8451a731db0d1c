//! What accuracy costs in time: points of a grid of options, measured one by one, and what a reader wants to know of them.
//!
//! A point is a method with options of `afterimage run`. [`grid`] says which points there are, [`store`] keeps what was measured of each,
//! so that a sweep can be stopped, resumed and spread over machines, [`table`] puts it side by side.

pub mod convergence;
pub mod equal;
pub mod frontier;
pub mod grid;
pub mod markdown;
pub mod measurement;
pub mod metrics;
pub mod paste;
pub mod plan;
pub mod prices;
pub mod store;
pub mod table;

pub use grid::{Axis, Grid, Options, Point};
pub use measurement::Measurement;
pub use metrics::{METRICS, Metric};
pub use plan::Plan;
pub use store::Store;
pub use table::{Row, Table};
