//! Foveated rendering with memory in headsets: an OpenXR session with one ordinary view an eye. The application shades
//! the quads of 2x2 pixels that [`afterimage`] chooses, and afterimage makes whole frames of them.
//!
//! [`Headset`] creates the device through the runtime, waits for frames, follows the session's states, asks the eye
//! tracker, chooses the quads of both eyes, and shows the result. The application draws.
//!
//! ```no_run
//! # #[cfg(feature = "wgpu-30")]
//! # fn main() -> Result<(), afterimage_openxr::Error> {
//! # struct Renderer;
//! # impl Renderer {
//! #     fn new(_: &afterimage_openxr::wgpu::Device) -> Self { Self }
//! #     fn draw_depth_and_motion(&mut self, _: &mut afterimage_openxr::HeadsetFrame<'_>) {}
//! #     fn draw_colors(&mut self, _: &mut afterimage_openxr::HeadsetFrame<'_>) {}
//! # }
//! use afterimage_openxr::{Headset, HeadsetDesc};
//!
//! let mut headset = Headset::new("my game", HeadsetDesc::default())?;
//! let mut renderer = Renderer::new(headset.device());
//! while let Some(mut frame) = headset.next_frame()? {
//!     renderer.draw_depth_and_motion(&mut frame);
//!     frame.choose()?;
//!     // At half the size where `frame.halve()` says so: after a cut.
//!     renderer.draw_colors(&mut frame);
//!     frame.submit()?;
//! }
//! # Ok(())
//! # }
//! # #[cfg(not(feature = "wgpu-30"))]
//! # fn main() {}
//! ```
//!
//! # What the application draws
//!
//! For each eye, into its layers of [`Targets::views`], with [`Eye::jittered_clip_from_world`]:
//!
//! 1. **The prepass**: `depth`, cleared to 0 (it is reversed), and `motion`, previous minus current position in pixels,
//!    y down, from [`Eye::clip_from_world`] and [`Eye::previous_clip_from_world`]. First what the lens hides
//!    ([`Headset::hidden_mesh`]), at the near plane.
//! 2. [`HeadsetFrame::choose`], once for both eyes.
//! 3. **The color pass**: `color`, cleared, on `primed`, loaded, with the depth test `GreaterEqual`. Vertex positions
//!    must be those of the prepass, bit for bit (`@invariant` in WGSL), and surfaces with holes discard in both passes.
//!    What is transparent follows on the same depth.
//!
//! In the first frame and after resets, one pixel of each quad is chosen, because nothing is known. Draw such a frame
//! at half the width and height ([`HeadsetFrame::halve`]), or it shades every pixel.
//!
//! `examples/headset` is a whole program.

#![cfg(feature = "wgpu-30")]

mod chain;
mod error;
mod eye;
mod gaze;
mod headset;
mod present;
mod session;
mod targets;
mod vulkan;

pub use afterimage;
pub use afterimage::wgpu;
pub use error::Error;
pub use eye::Eye;
pub use gaze::Ray;
pub use headset::{ActionsFn, GazeFn, Headset, HeadsetDesc, HeadsetFrame, Shown};
pub use openxr;
pub use session::HiddenMesh;
pub use targets::{HalfViews, TargetViews, Targets};
