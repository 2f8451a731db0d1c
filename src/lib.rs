//! Temporal post-process for foveated and sparse rendering: what was shaded at earlier gaze positions and in earlier
//! frames is not thrown away.
//!
//! # Two doors
//!
//! **Planned frames**: the post-process chooses the pixels whose colors are drawn, a quarter of them or a tenth around
//! the gaze, and shows an antialiased picture at full rate. For one view or several, noisy frames, and renderers that
//! choose the pixels themselves.
#![cfg_attr(
    feature = "gpu",
    doc = "[`Afterimage`] has the calls of a frame; `examples/01_planned.rs` adds them to a small renderer."
)]
#![cfg_attr(not(feature = "gpu"), doc = "`Afterimage` (feature `wgpu-30`) has the calls of a frame.")]
//!
//! **Frames that the renderer foveates itself**, full-size with levels of detail, the setting of the paper by Cantory
//! et al. (MIG 2025): module [`levels`].
//!
//! # Where to look
//!
//! - `Desc`, `Frame`, `Plan`: descriptions of a context of planned frames and of a frame, and the chosen pixels.
//!   `Camera`, [`Gaze`]: description of a view. `Targets`: its textures, for renderers that have none.
//! - [`levels`]: the same of frames with levels of detail, their methods and all tunables.
//! - [`DepthConvention`], [`MotionConvention`]: what a renderer's depth and motion vectors mean.
//! - [`FrameStats`], [`Warning`], [`DebugView`]: counters, messages and images of a frame's decisions.
//! - `gpu::Doctor`, [`doctor::Finding`]: checks whether frames match their description, to diagnose a wrong picture
//!   (`05_doctor.rs`).
//! - [`CreateError`], [`FrameError`], [`SettingsError`]: errors.
//! - `examples/`: numbered programs, from the smallest renderer (`01_planned.rs`) to an engine's loop (`02_engine.rs`),
//!   stereo (`03_stereo.rs`) and a window (`04_window.rs`).
//!
//! # Devices
//!
//! The contexts of both doors record compute passes into your wgpu command encoder: of wgpu 30 (feature `wgpu-30`, on
//! by default) or wgpu 29 (feature `wgpu-29`), exported as `afterimage::wgpu`. The application chooses wgpu's backends.
//! On a lost device nothing panics, with one exception: wgpu 29 reports views of textures that are created after the
//! loss, as in `resize`, to the device's handler of uncaptured errors, and the default handler panics.
//!
//! The same passes exist for images in memory; their results are equal bit for bit on software Vulkan, native and in a
//! browser. The command `afterimage run --backend cpu` runs them on files, without a GPU.
//!
//! # Determinism
//!
//! Random numbers are a hash of [`Settings::seed`](levels::Settings::seed), view, frame index and pixel. The same seed
//! and the same frames give the same bytes, regardless of the number of threads and the size of workgroups. Different
//! GPUs and drivers may round differently.
//!
//! The crate `afterimage-lab` has research tools around this one: scenes, a path tracer, foveation along scanpaths, and
//! metrics.

#[cfg(not(any(feature = "cpu", feature = "gpu")))]
compile_error!(
    "afterimage has no executor: enable one of the features `wgpu-30`, `wgpu-29` and `cpu` (images in memory)"
);
#[cfg(all(feature = "gpu", not(any(feature = "wgpu-29", feature = "wgpu-30"))))]
compile_error!("afterimage has no wgpu: enable the feature `wgpu-30` or `wgpu-29`, the one that your application uses");
#[cfg(all(feature = "wgpu-29", feature = "wgpu-30"))]
compile_error!(
    "afterimage works with one major version of wgpu at a time: enable either the feature `wgpu-30`, which is on by \
     default, or `wgpu-29` with `default-features = false`"
);

// The name `wgpu` for the chosen version, in this crate and for its users.
#[cfg(feature = "wgpu-29")]
pub extern crate wgpu_29 as wgpu;
#[cfg(all(feature = "gpu", not(feature = "wgpu-29")))]
pub extern crate wgpu_30 as wgpu;

mod camera;
mod context;
mod convention;
// For this workspace's other crates and for tests; not part of the stable API.
#[cfg(feature = "cpu")]
#[doc(hidden)]
pub mod cpu;
pub mod doctor;
mod error;
mod foveation;
mod frame;
mod gaze;
mod geometry;
#[cfg(feature = "gpu")]
pub mod gpu;
#[cfg(feature = "cpu")]
mod image;
// For this workspace's other crates and for research; not part of the stable API.
#[doc(hidden)]
pub mod internal;
#[doc(hidden)]
pub mod kernel;
pub mod levels;
mod method;
mod notes;
#[cfg(feature = "cpu")]
mod parallel;
#[cfg(feature = "gpu")]
mod planned;
mod resize;
mod settings;
#[doc(hidden)]
#[cfg(feature = "gpu")]
pub mod shader;
mod simulator;
mod stats;
mod uniforms;
mod view;
mod warning;

pub use convention::{DepthConvention, MotionConvention, MotionDirection, MotionUnit, YAxis};
pub use error::{CreateError, FrameError, FrameValue, SettingsError};
pub use frame::Exposure;
pub use gaze::Gaze;
pub use geometry::ViewGeometry;
#[cfg(feature = "cpu")]
#[doc(hidden)]
pub use image::Image;
pub use kernel::debug_view::DebugView;
#[cfg(feature = "gpu")]
pub use planned::{Afterimage, Camera, Desc, Frame, Plan, Quarter, Shading, ShareControl, Targets};
pub use stats::FrameStats;
pub use warning::Warning;

// For this workspace's other crates and for research; not part of the stable API.
#[doc(hidden)]
pub use kernel::reproject::Verdict;
