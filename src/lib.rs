//! Temporal post-process for foveated rendering: what the eye has already paid for is not thrown away.
//!
//! A foveating renderer shades at full rate only where the eye looks. `afterimage` runs after it: per-pixel reservoirs keep
//! sharp samples from earlier gaze positions, follow them along the motion vectors, and show them while they still fit what
//! the renderer delivers. The method is Cantory et al., "Enhancing Foveated Rendering with Weighted Reservoir Sampling"
//! (MIG 2025).
//!
//! ```
//! use afterimage::Settings;
//! use afterimage::cpu::{CpuAfterimage, CpuFrame, CpuView};
//! use afterimage::display::ViewGeometry;
//! use afterimage::frame::{ContextDesc, Gaze, Reset, ViewFrame};
//! use afterimage::image::Image;
//!
//! let size = [64, 36];
//! let mut post = CpuAfterimage::new(ContextDesc::new(size), Settings::default())?;
//!
//! // Every frame: colour, and depth and motion where there are any, one gaze a view.
//! let color = Image::filled(size, [0.2, 0.4, 0.6]);
//! let facts = ViewFrame {
//!     geometry: ViewGeometry::flat(size, 70.0)?,
//!     gaze: Gaze::At { px: [20.0, 18.0] },
//!     previous_from_current: None,
//! };
//! let view = CpuView { facts, color: &color, depth: None, motion: None };
//! let mut output = [Image::filled(size, [0.0; 3])];
//! post.process(&CpuFrame { views: &[view], index: 0, reset: Reset::None }, &mut output, None)?;
//! assert_eq!(output[0], color);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Where to look:
//!
//! - [`settings`]: what can be tuned, what more and less of it does.
//! - [`frame`], [`convention`], [`display`]: what the caller says about a frame, and in which conventions.
//! - [`cpu`]: the executor. [`kernel`]: the mathematics it calls, one function a formula.
//! - With the feature `lab`: `source` (stills, EXR sequences, analytic scenes), `foveation` (simulators), `scanpath`
//!   (recorded and synthetic eyes), `pipeline` (all of it, frame by frame), `metric` and `report`.
//!
//! Results do not depend on the number of threads: same seed, same frames, same bytes.

pub mod convention;
pub mod cpu;
pub mod display;
pub mod error;
#[cfg(feature = "lab")]
pub mod foveation;
pub mod frame;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod image;
pub mod kernel;
#[cfg(feature = "lab")]
pub mod metric;
#[cfg(feature = "lab")]
pub mod pipeline;
#[cfg(feature = "lab")]
pub mod report;
#[cfg(feature = "lab")]
pub mod scanpath;
pub mod settings;
#[cfg(feature = "lab")]
pub mod source;
#[cfg(feature = "lab")]
pub mod whole_file;

pub use settings::Settings;
