//! What a run leaves behind: figures, pictures, and a sheet that shows them at a glance.

pub mod canvas;
pub mod clock;
pub mod page;
pub mod pareto;
pub mod picture;
pub mod sheet;
pub mod tally;
