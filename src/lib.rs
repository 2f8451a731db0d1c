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
//! **Frames that the renderer foveates itself**, shaded at full rate only where the eye looks: `gpu::Afterimage` runs
//! after it, before tone mapping. It stores the sharpest sample of every surface point, reprojects it along the motion
//! vectors, and shows it as long as it agrees with the foveated frame ([`Method::Smr`]). For comparison there are
//! weighted reservoirs (Cantory et al., MIG 2025; [`Method::Wrs`]) and temporal antialiasing ([`Method::Taa`]).
//!
#![cfg_attr(feature = "gpu", doc = "```")]
#![cfg_attr(not(feature = "gpu"), doc = "```ignore")]
//! # use afterimage::wgpu;
//! # let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
//! # let texture = |usage| device.create_texture(&wgpu::TextureDescriptor {
//! #     label: None,
//! #     size: wgpu::Extent3d { width: 640, height: 360, depth_or_array_layers: 1 },
//! #     mip_level_count: 1,
//! #     sample_count: 1,
//! #     dimension: wgpu::TextureDimension::D2,
//! #     format: wgpu::TextureFormat::Rgba16Float,
//! #     usage,
//! #     view_formats: &[],
//! # });
//! # let color = texture(wgpu::TextureUsages::TEXTURE_BINDING);
//! # let output = texture(wgpu::TextureUsages::STORAGE_BINDING);
//! # let mut encoder = device.create_command_encoder(&Default::default());
//! # let (size, gaze_px, index) = ([640, 360], [200.0, 180.0], 0);
//! use afterimage::gpu::{Afterimage, Frame};
//! use afterimage::{ContextDesc, Foveation, Gaze, ViewFrame, ViewGeometry};
//!
//! // Once: a context, with the foveation of your renderer.
//! let mut desc = ContextDesc::new(size);
//! desc.settings.foveation = Foveation { rate_mid: 4, rate_far: 8, ..Foveation::default() };
//! let mut post = Afterimage::new(&device, &desc, output.format())?;
//!
//! // Every frame, after the renderer has drawn the foveated frame into the texture `color`.
//! let views = [ViewFrame::new(ViewGeometry::flat(size, 70.0)?, Gaze::At { px: gaze_px })];
//! post.record(&device, &mut encoder, &Frame::new(&color, &views, index), &output)?;
//! queue.submit([encoder.finish()]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Add depth and motion vectors as soon as the camera or the scene moves: fields `depth` and `motion` of
//! [`FrameInputs`], in your renderer's [`DepthConvention`] and [`MotionConvention`].
//!
//! # Where to look
//!
//! - [`ContextDesc`]: description of a context. Its [`Settings`] contain the [`Method`], the renderer's [`Foveation`]
//!   and all tunables.
//! - [`FrameInputs`]: inputs of a frame. [`ViewFrame`], [`ViewGeometry`], [`Gaze`]: description of a view.
//! - [`FrameStats`], [`Warning`], [`DebugView`]: counters, messages and images of a frame's decisions.
//! - `gpu::Doctor`, `cpu::Doctor`, [`doctor::Finding`]: checks whether frames match their description, to diagnose
//!   a wrong picture (`07_doctor.rs`).
//! - [`CreateError`], [`FrameError`], [`SettingsError`]: errors.
//! - [`simulator`]: foveation of full-rate frames, for tests and for renderers that do not foveate.
//! - `examples/`: numbered programs, from the smallest renderer (`01_planned.rs`) to an engine's loop (`02_engine.rs`),
//!   stereo (`03_stereo.rs`) and a window (`06_window.rs`).
//!
//! # Executors
//!
//! Two executors run the same passes; their results are equal bit for bit on software Vulkan, native and in a browser.
//!
#![cfg_attr(feature = "gpu", doc = "- [`gpu::Afterimage`]")]
#![cfg_attr(not(feature = "gpu"), doc = "- `gpu::Afterimage`")]
//!   records compute passes into your wgpu command encoder: of wgpu 30 (feature `wgpu-30`, on by default) or wgpu 29
//!   (feature `wgpu-29`), exported as `afterimage::wgpu`. The application chooses wgpu's backends. On a lost
//!   device nothing panics, with one exception: wgpu 29 reports views of textures that are created after the loss, as
//!   in `resize`, to the device's handler of uncaptured errors, and the default handler panics.
#![cfg_attr(feature = "cpu", doc = "- [`cpu::CpuAfterimage`]")]
#![cfg_attr(not(feature = "cpu"), doc = "- `cpu::CpuAfterimage`")]
//!   (feature `cpu`) processes images in memory: for machines without a GPU, and for tests.
//!
//! # Determinism
//!
//! Random numbers are a hash of [`Settings::seed`], view, frame index and pixel. The same seed and the same frames give
//! the same bytes, regardless of the number of threads and the size of workgroups. Different GPUs and drivers may round
//! differently.
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
#[cfg(feature = "cpu")]
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
pub mod simulator;
mod stats;
mod uniforms;
mod view;
mod warning;

pub use context::ContextDesc;
pub use convention::{DepthConvention, MotionConvention, MotionDirection, MotionUnit, YAxis};
pub use error::{CreateError, FrameError, FrameValue, SettingsError};
pub use foveation::{Filter, Foveation};
pub use frame::{Exposure, FrameInputs, Reset};
pub use gaze::Gaze;
pub use geometry::ViewGeometry;
#[cfg(feature = "cpu")]
pub use image::Image;
pub use kernel::debug_view::DebugView;
#[cfg(feature = "gpu")]
pub use planned::{Afterimage, Camera, Desc, Frame, Plan, Quarter, Shading, ShareControl};
pub use settings::{Bias, DepthTest, Gate, GateMetric, GateScale, Method, Sampler, Settings, Smr, Wrs};
pub use stats::FrameStats;
pub use view::ViewFrame;
pub use warning::Warning;

// For this workspace's other crates and for research; not part of the stable API.
#[doc(hidden)]
pub use kernel::reproject::Verdict;
#[doc(hidden)]
pub use settings::MethodKind;
