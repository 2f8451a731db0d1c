//! Errors. Each reads as one line: what is wrong, what was expected, and what to do about it.

use std::fmt::{Display, Formatter};
use thiserror::Error;

/// A setting that is out of range, or contradicts another one.
///
/// ```
/// let error = afterimage::ViewGeometry::flat([640, 360], 200.0).unwrap_err();
/// assert_eq!(error.setting, "hfov_deg");
/// assert_eq!(error.to_string(), "hfov_deg is 200: expected a horizontal field of view above 0 and below 180 degrees");
/// ```
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{setting} is {found}: expected {expected}")]
pub struct SettingsError {
    /// Name of the setting or argument, or of the device's limit that the settings exceed.
    pub setting: &'static str,
    /// Rejected value.
    pub found: String,
    /// Accepted range, with its unit.
    pub expected: String,
}

/// Rejects a number outside `range`, NaN included.
pub(crate) fn check(
    setting: &'static str,
    value: f32,
    range: std::ops::RangeInclusive<f32>,
    unit: &str,
) -> Result<(), SettingsError> {
    if range.contains(&value) {
        Ok(())
    } else {
        let (low, high) = (range.start(), range.end());
        Err(SettingsError {
            setting,
            found: value.to_string(),
            expected: format!("{low} to {high} {unit}").trim_end().to_owned(),
        })
    }
}

/// A context that cannot be created.
///
/// ```
/// # #[cfg(feature = "gpu")]
/// # {
/// use afterimage::{Afterimage, CreateError, Desc, wgpu};
///
/// # let (device, _queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
/// // A swapchain's format is rarely one that a compute shader may write.
/// let desc = Desc::new([640, 360], wgpu::TextureFormat::Bgra8UnormSrgb);
/// let error = Afterimage::new(&device, &desc).unwrap_err();
/// assert!(matches!(error, CreateError::OutputFormat { .. }));
/// # }
/// ```
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum CreateError {
    /// A setting or another part of the description is out of range.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// A device limit is too low.
    #[error(
        "the device's {limit} is {found}: expected at least {needed}; request the device with Afterimage::required_limits()"
    )]
    Limit {
        /// Name in `wgpu::Limits`.
        limit: &'static str,
        /// Limit of the device.
        found: u64,
        /// Limit that the context needs.
        needed: u64,
    },
    /// The output format is not supported. Render to a supported format, and draw that to the screen.
    #[cfg(feature = "gpu")]
    #[error("output format is {found:?}: expected one of {expected}")]
    OutputFormat {
        /// Requested format.
        found: wgpu::TextureFormat,
        /// Supported formats.
        expected: &'static str,
    },
    /// The device's backend cannot write textures of a format that history has, as wgpu's GL backend cannot.
    #[cfg(feature = "gpu")]
    #[error(
        "the device's backend, {backend:?}, cannot store textures of format {needed:?}, which history has: expected Vulkan, Metal, DirectX 12 or a browser's WebGPU"
    )]
    HistoryFormat {
        /// Format that history has.
        needed: wgpu::TextureFormat,
        /// Backend of the device.
        backend: wgpu::Backend,
    },
}

/// A frame that cannot be processed. The call that returned it changed nothing: history is as before.
///
/// ```
/// use afterimage::FrameError;
///
/// # #[cfg(feature = "gpu")]
/// # {
/// # use afterimage::{Afterimage, Desc, wgpu};
/// # let (device, _queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
/// # let mut post = Afterimage::new(&device, &Desc::new([640, 360], wgpu::TextureFormat::Rgba16Float)).unwrap();
/// // A minimised window.
/// assert!(matches!(post.resize([0, 0]), Err(FrameError::Extent { .. })));
/// assert_eq!(post.desc().size_px, [640, 360]);
/// # }
/// ```
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum FrameError {
    /// The number of pixels does not match the image's size.
    #[error("image of {}x{} has {found} pixels: expected {expected}", size[0], size[1])]
    PixelCount {
        /// Width and height of the image.
        size: [u32; 2],
        /// Width times height.
        expected: usize,
        /// Number of pixels given.
        found: usize,
    },
    /// An input's size is not the context's.
    #[error("{input} of view {view} is {}x{}: expected {}x{}, the context's size; resize the context or the input", found[0], found[1], expected[0], expected[1])]
    Size {
        /// Name of the input.
        input: &'static str,
        /// Index of the view.
        view: usize,
        /// Size of the input, in pixels.
        found: [u32; 2],
        /// Size of the context's views, in pixels.
        expected: [u32; 2],
    },
    /// The frame has more or fewer views, or images of an input, than the context has views.
    #[error("{found} views given: expected {expected}, the context's view_count")]
    ViewCount {
        /// Number of views or images in the frame.
        found: usize,
        /// Number of views of the context.
        expected: usize,
    },
    /// The size of a context is 0 or too large.
    #[error("size is {}x{}: expected {}", size[0], size[1], expected_size(*size, *max))]
    Extent {
        /// Requested size, in pixels.
        size: [u32; 2],
        /// Largest side, in pixels: 16384, or what the device
        /// allows (`max_texture_dimension_2d`).
        max: u32,
    },
    /// A limit of the device is too low for a new size of a context.
    #[error(
        "the device's {limit} is {found}: expected at least {needed} for a size of {}x{}; request the device with Afterimage::required_limits()",
        size[0], size[1]
    )]
    Limit {
        /// Requested size, in pixels.
        size: [u32; 2],
        /// Name in `wgpu::Limits`.
        limit: &'static str,
        /// Limit of the device.
        found: u64,
        /// Limit that the context needs.
        needed: u64,
    },
    /// A texture has the wrong dimension, number of layers or samples, format or usage.
    #[error("{input} is a texture of format {format}, {problem}: expected {expected}")]
    Texture {
        /// Name of the input or output.
        input: &'static str,
        /// Format of the texture.
        format: String,
        /// Problem with the texture.
        problem: String,
        /// Supported textures.
        expected: &'static str,
    },
    /// A buffer is too small or lacks a usage.
    #[error("{input} is a buffer {problem}: expected {expected}")]
    Buffer {
        /// Name of the buffer.
        input: &'static str,
        /// Problem with the buffer.
        problem: String,
        /// Supported buffers.
        expected: &'static str,
    },
    /// A matrix of the frame is no camera's.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// The graphics device was lost. It executes no more work. Recording a frame returns this, except in a
    /// browser, where only the application learns of the loss.
    #[error("the graphics device was lost: create a new device and a new context on it; history starts empty")]
    DeviceLost,
    /// A value of the frame's description is invalid.
    #[error("{value} of view {view} is {found}: expected {expected}")]
    Value {
        /// The rejected part of the description.
        value: FrameValue,
        /// Index of the view.
        view: usize,
        /// Rejected value.
        found: String,
        /// Accepted values.
        expected: &'static str,
    },
}

/// What is expected instead of a rejected size.
pub(crate) fn expected_size(size: [u32; 2], max: u32) -> String {
    if size.contains(&0) {
        return "at least 1x1; skip frames while the window is minimised".into();
    }
    format!("at most {max} pixels a side")
}

/// A value in the description of a frame that [`FrameError::Value`] rejects, for programs that match on it. It displays
/// as its name in the error message.
///
/// ```
/// use afterimage::FrameValue;
///
/// assert_eq!(FrameValue::Jitter.to_string(), "jitter_px");
/// assert_eq!(FrameValue::Region { input: "depth" }.to_string(), "depth");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FrameValue {
    /// Color input of a foveation that the receiver does not process.
    Color,
    /// [`FrameInputs::depth`](crate::levels::FrameInputs::depth).
    Depth,
    /// [`FrameInputs::motion`](crate::levels::FrameInputs::motion).
    Motion,
    /// [`ViewFrame::depth`](crate::levels::ViewFrame::depth).
    DepthConvention,
    /// [`ViewFrame::jitter_px`](crate::levels::ViewFrame::jitter_px).
    Jitter,
    /// [`ViewFrame::visible_px`](crate::levels::ViewFrame::visible_px).
    VisibleBounds,
    /// [`ViewFrame::previous_from_current`](crate::levels::ViewFrame::previous_from_current).
    CameraMotion,
    /// [`FrameInputs::lod`](crate::levels::FrameInputs::lod).
    Lod,
    /// [`FrameInputs::noise`](crate::levels::FrameInputs::noise).
    Noise,
    /// [`FrameInputs::albedo`](crate::levels::FrameInputs::albedo).
    Albedo,
    /// [`FrameInputs::reactive`](crate::levels::FrameInputs::reactive).
    Reactive,
    /// [`FrameInputs::exposure`](crate::levels::FrameInputs::exposure).
    Exposure,
    /// Plan of a planned frame.
    Plan,
    /// Mask of such a frame whose pixels the renderer chose.
    Mask,
    /// A rectangle of a texture that is larger than the view.
    Region {
        /// Name of the input or output.
        input: &'static str,
    },
    /// The debug view beside the output.
    DebugView,
}

impl Display for FrameValue {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.write_str(match *self {
            Self::Color => "color",
            Self::Depth => "depth",
            Self::Motion => "motion",
            Self::DepthConvention => "depth convention",
            Self::Jitter => "jitter_px",
            Self::VisibleBounds => "visible_px",
            Self::CameraMotion => "previous_from_current",
            Self::Lod => "lod",
            Self::Noise => "noise",
            Self::Albedo => "albedo",
            Self::Reactive => "reactive",
            Self::Exposure => "exposure",
            Self::Plan => "plan",
            Self::Mask => "mask",
            Self::Region { input } => input,
            Self::DebugView => "debug view",
        })
    }
}
