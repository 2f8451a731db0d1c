//! The second door: full-size frames that the renderer foveates itself, with levels of detail.
//!
//! Such a frame has every pixel, and is sharp only where the eye looks: the renderer shades fewer pixels beyond, and
//! upscales ([`Foveation`]). The post-process runs after it, before tone mapping. It stores the sharpest sample of
//! every surface point, reprojects it along the motion vectors, and shows it as long as it agrees with the foveated
//! frame ([`Method::Smr`]). For comparison there are weighted reservoirs (Cantory et al., MIG 2025; [`Method::Wrs`])
//! and temporal antialiasing ([`Method::Taa`]).
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
//! use afterimage::levels::{Afterimage, Desc, Foveation, Frame, ViewFrame};
//! use afterimage::{Gaze, ViewGeometry};
//!
//! // Once: a context, with the foveation of your renderer.
//! let mut desc = Desc::new(size, output.format());
//! desc.settings.foveation = Foveation { rate_mid: 4, rate_far: 8, ..Foveation::default() };
//! let mut post = Afterimage::new(&device, &desc)?;
//!
//! // Every frame, after the renderer has drawn the foveated frame into the texture `color`.
//! let views = [ViewFrame::new(ViewGeometry::flat(size, 70.0)?, Gaze::At { px: gaze_px })];
//! post.record(&mut encoder, &Frame::new(&color, &views, index), &output)?;
//! queue.submit([encoder.finish()]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Add depth and motion vectors as soon as the camera or the scene moves: fields `depth` and `motion` of
//! [`FrameInputs`], in your renderer's [`DepthConvention`](crate::DepthConvention) and
//! [`MotionConvention`](crate::MotionConvention).
//!
//! - `Desc`: description of a context. Its [`Settings`] contain the [`Method`], the renderer's [`Foveation`] and all
//!   tunables.
//! - [`FrameInputs`]: inputs of a frame. [`ViewFrame`]: description of a view.
//! - `Simulator`: foveation of full-rate frames, for tests and for renderers that do not foveate.

#[cfg(feature = "gpu")]
mod afterimage;
#[cfg(feature = "gpu")]
mod desc;
mod foveation;
mod settings;
#[cfg(feature = "gpu")]
mod simulator;

#[cfg(feature = "gpu")]
pub use self::afterimage::Afterimage;
#[cfg(feature = "gpu")]
pub use self::desc::Desc;
pub use self::foveation::{Filter, Foveation};
pub use self::settings::{Method, Settings, Smr};
#[cfg(feature = "gpu")]
pub use self::simulator::Simulator;
pub use crate::frame::{FrameInputs, Reset};
#[cfg(feature = "gpu")]
pub use crate::gpu::frame::Frame;
pub use crate::settings::{Bias, DepthTest, Gate, GateMetric, GateScale, Sampler, Wrs};
#[cfg(feature = "gpu")]
pub use crate::simulator::SimulatorFrame;
pub use crate::view::ViewFrame;
