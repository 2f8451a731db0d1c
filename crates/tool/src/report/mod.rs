//! What a run leaves behind: figures, pictures, and a contact sheet that shows them at a glance.

pub mod backend;
pub mod canvas;
#[cfg(feature = "full")]
pub mod jpeg;
pub mod method;
#[cfg(feature = "full")]
pub mod page;
#[cfg(feature = "full")]
pub mod pareto;
pub mod sheet;
