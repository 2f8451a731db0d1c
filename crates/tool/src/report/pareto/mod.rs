//! Plot of error against time with the Pareto frontier, as SVG and as PNG.

mod drawing;
mod tags;

pub use drawing::svg;
