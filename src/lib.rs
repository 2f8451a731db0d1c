//! Temporal post-process for foveated rendering: what the eye has already paid for is not thrown away.
//!
//! A foveating renderer shades at full rate only where the eye looks. `afterimage` runs after it: it keeps the sharpest sample
//! of every surface point, follows it along the motion vectors, and shows it while it explains what the renderer delivers
//! ([`Method::Smr`](settings::Method::Smr)). To compare: weighted reservoirs (Cantory et al., MIG 2025) and temporal antialiasing.
//!
//! ```
//! use afterimage::{Foveation, Gaze, ViewFrame, ViewGeometry};
//! use afterimage::gpu::{Afterimage, Frame, GpuDesc};
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
//!
//! let mut desc = GpuDesc::new(size, output.format());
//! // As your renderer foveates.
//! desc.settings.foveation = Foveation { rate_mid: 4, rate_far: 8, ..Foveation::default() };
//! let mut post = Afterimage::new(&device, &desc)?;
//!
//! // Every frame, after the foveated frame is rendered: its textures, one gaze a view, your encoder.
//! let views = [ViewFrame {
//!     geometry: ViewGeometry::flat(size, 70.0)?,
//!     gaze: Gaze::At { px: gaze_px },
//!     previous_from_current: None,
//! }];
//! post.record(&device, &mut encoder, &Frame::new(&color, &output, &views, index))?;
//! queue.submit([encoder.finish()]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Without a GPU the same in memory: [`cpu::CpuAfterimage`].
//!
//! Where to look:
//!
//! - [`settings`]: what can be tuned, what more and less of it does.
//! - [`frame`], [`convention`], [`geometry`]: what the caller says about a frame, and in which conventions.
//! - [`stats`], [`warning`]: what a frame came to, and what was odd about it.
//! - [`gpu`] and [`cpu`]: the two executors of the same passes, equal bit for bit on software Vulkan. [`kernel`]: the mathematics
//!   they share, one function a formula.
//! - With the feature `lab`: `scene` (glTF and built-in scenes), `trace` (path tracing), `source` (stills, EXR sequences, analytic scenes), `foveation` (simulators), `scanpath`
//!   (recorded and synthetic eyes), `pipeline` (all of it, frame by frame), `metric`, `report`, and `sweep` (what
//!   accuracy costs in time).
//!
//! Results do not depend on the number of threads: same seed, same frames, same bytes.

#[cfg(not(any(feature = "cpu", feature = "gpu")))]
compile_error!("afterimage without an executor: enable the feature `gpu` (wgpu) or `cpu` (images in memory)");

mod convention;
#[cfg(feature = "cpu")]
pub mod cpu;
mod error;
mod foveation;
mod frame;
mod geometry;
#[cfg(feature = "gpu")]
pub mod gpu;
#[cfg(feature = "cpu")]
mod image;
// For this workspace's other crates and for research; promised to nobody.
#[doc(hidden)]
pub mod kernel;
mod method;
mod settings;
#[doc(hidden)]
#[cfg(feature = "gpu")]
pub mod shader;
pub mod simulator;
mod stats;
mod uniforms;
mod warning;

pub use convention::{DepthConvention, MotionConvention, MotionDirection, MotionUnit, YAxis};
pub use error::{CreateError, FrameError, SettingsError};
pub use foveation::{Filter, Foveation};
pub use frame::{ContextDesc, Executor, Exposure, Frame, Gaze, Reset, ViewFrame};
pub use geometry::ViewGeometry;
#[cfg(feature = "cpu")]
pub use image::Image;
pub use kernel::debug_view::DebugView;
pub use kernel::reproject::Verdict;
pub use settings::{Bias, DepthTest, Gate, GateMetric, Method, Sampler, Settings, Smr};
pub use stats::{COUNTERS_BYTES, FrameStats};
pub use warning::Warning;
