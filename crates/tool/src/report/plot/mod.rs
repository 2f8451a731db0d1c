//! Parts that all plots share: page, axes, scales, marks, labels, text, and the pixels of an SVG.

mod axes;
mod elements;
mod labels;
mod marks;
mod page;
mod picture;
mod scale;

pub use axes::axes;
pub use elements::{FAINT, INK, line, mark, on_ground, px, text};
pub use labels::{chars_from, shortened, spread, visible};
pub use marks::Mark;
pub use page::{HIGH_PX, LINE_PX, LOW_PX, document, legend, reading};
pub use picture::png;
pub use scale::{OF_JOD, OF_PSNR, Scale};
