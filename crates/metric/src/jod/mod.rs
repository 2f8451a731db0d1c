//! Foveated video quality in just-objectionable differences (JOD): 10 for no visible difference; of two videos that are
//! one JOD apart, 75 % of people prefer the better.
//!
//! ```
//! # use afterimage::{Image, ViewGeometry};
//! # use afterimage_metric::{Display, ReferenceVideo, TestVideo, Viewing};
//! # let frames = [Image::filled([64, 36], [0.5_f32; 3]), Image::filled([64, 36], [0.5; 3])];
//! # fn your_method(frame: &Image<[f32; 3]>) -> Image<[f32; 3]> { frame.clone() }
//! let geometry = ViewGeometry::flat([64, 36], 70.0)?;
//! let mut reference = ReferenceVideo::new(Viewing { geometry, display: Display::default(), fps: 60.0 });
//! let mut test = TestVideo::default();
//! for full_rate in &frames {
//!     let frame = reference.push(full_rate, Some([32.0, 18.0]));
//!     test.push(&frame, &your_method(full_rate));
//! }
//! assert_eq!(test.score().unwrap().jod, 10.0);
//! # Ok::<(), afterimage::SettingsError>(())
//! ```
//!
//! The model follows FovVideoVDP (Mantiuk et al., "FovVideoVDP: A visible difference predictor for wide field-of-view
//! video", 2021) in its steps: luminance of the display, a sustained and a transient temporal channel, a Laplacian
//! pyramid of local contrasts, sensitivity by frequency, luminance and eccentricity, mutual masking, and pooling. It
//! sees luminance only. The constants are our own, fitted to the scores of FovVideoVDP; `docs/metrics.md` has
//! its agreement on clips that were set aside. Eccentricity is the true visual angle. Off the axis of a flat view a
//! degree has more pixels, which raises frequencies.
//!
//! Memory: the luminance of 250 ms of frames, for the reference and for each test, four bytes a pixel, and about 120
//! bytes a pixel for the frame at hand. The score does not depend on the number of threads.

mod compare;
mod constants;
mod pool;
mod reference;
mod viewing;

pub use compare::TestVideo;
pub use pool::VideoScore;
pub use reference::{ReferenceFrame, ReferenceVideo};
pub use viewing::Viewing;
pub(crate) use viewing::pixels_per_degree;

/// Temporal channels: sustained, transient.
const CHANNELS: usize = 2;
