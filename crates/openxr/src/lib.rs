//! Foveated rendering with memory in headsets: an OpenXR session whose two views are drawn as sparse lattices around
//! the gaze, and made whole by [`afterimage`].
//!
//! [`Headset`] creates the device through the runtime, waits for frames, follows the session's states, asks the eye
//! tracker, places the lattices, and shows the result. The application draws: for each eye, for each of its
//! [`Draw`]s, its scene into a rectangle of the atlas.
//!
//! ```no_run
//! # #[cfg(feature = "wgpu-30")]
//! # fn main() -> Result<(), afterimage_openxr::Error> {
//! # struct Renderer;
//! # impl Renderer {
//! #     fn new(_: &afterimage_openxr::wgpu::Device) -> Self { Self }
//! #     fn draw(&mut self, _: &mut afterimage_openxr::HeadsetFrame<'_>) {}
//! # }
//! use afterimage_openxr::{Headset, HeadsetDesc};
//!
//! let mut headset = Headset::new("my game", HeadsetDesc::default())?;
//! let mut renderer = Renderer::new(headset.device());
//! while let Some(mut frame) = headset.next_frame()? {
//!     renderer.draw(&mut frame);
//!     frame.submit()?;
//! }
//! # Ok(())
//! # }
//! # #[cfg(not(feature = "wgpu-30"))]
//! # fn main() {}
//! ```
//!
//! # What `draw` does
//!
//! For each eye, one render pass over the attachments of [`Targets::views`], with depth cleared to 0 (it is reversed)
//! and, for each [`Draw`], its viewport and scissor, its matrix and its bias of textures' level of detail. Motion
//! vectors are previous minus current position in pixels of the whole view, y down, from [`Eye::clip_from_world`] and
//! [`Eye::previous_clip_from_world`]. `examples/headset` is a whole program.

#![cfg(feature = "wgpu-30")]

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
pub use eye::{Draw, Eye};
pub use gaze::Ray;
pub use headset::{ActionsFn, GazeFn, Headset, HeadsetDesc, HeadsetFrame, Shown};
pub use openxr;
pub use session::HiddenMesh;
pub use targets::Targets;
