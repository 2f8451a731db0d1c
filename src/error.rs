//! Errors, and how they read: what was wrong, what was expected, what to do.

use thiserror::Error;

/// A setting outside its range, or two that contradict each other.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{setting} is {found}: expected {expected}")]
pub struct SettingsError {
    /// Name of the setting, as in [`Settings`](crate::Settings).
    pub setting: &'static str,
    /// The value that was refused.
    pub found: String,
    /// The accepted range, with its unit.
    pub expected: String,
}

/// Refuses a number outside `range`, NaN included.
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

/// A context that cannot be made.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum CreateError {
    /// A setting or fact out of range.
    #[error(transparent)]
    Settings(#[from] SettingsError),
    /// A device limit is too low.
    #[error(
        "the device's {limit} is {found}: expected at least {needed}; request the device with it, see required_limits()"
    )]
    Limit {
        /// Name in `wgpu::Limits`.
        limit: &'static str,
        /// The device's.
        found: u32,
        /// What is needed.
        needed: u32,
    },
    /// The output format cannot be written by a compute shader.
    #[cfg(feature = "gpu")]
    #[error("output format {found:?}: expected one of {expected}")]
    OutputFormat {
        /// What was asked for.
        found: wgpu::TextureFormat,
        /// What is accepted.
        expected: &'static str,
    },
}

/// A frame that cannot be processed. Nothing was changed: the history is as it was before the call.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum FrameError {
    /// A pixel buffer that does not fill its image.
    #[error("{found} pixels given for an image of {}x{}: expected {expected}", size[0], size[1])]
    PixelCount {
        /// Width and height asked for.
        size: [u32; 2],
        /// Width x height.
        expected: usize,
        /// Pixels given.
        found: usize,
    },
    /// An input of another size than the context's.
    #[error("{input} of view {view} is {}x{}: expected {}x{}, the size the context was made for; resize the context or the input", found[0], found[1], expected[0], expected[1])]
    Size {
        /// Which input.
        input: &'static str,
        /// Index of the view.
        view: usize,
        /// Its size.
        found: [u32; 2],
        /// The context's size.
        expected: [u32; 2],
    },
    /// More or fewer views than the context was made for.
    #[error("{found} views given: expected {expected}, as the context was made for")]
    ViewCount {
        /// Views in the frame.
        found: usize,
        /// Views of the context.
        expected: usize,
    },
    /// A context or frame without a single pixel.
    #[error("size is {}x{}: expected at least 1x1 pixels and at most {max} a side; skip frames while the window is minimised", size[0], size[1])]
    Extent {
        /// The size asked for.
        size: [u32; 2],
        /// Largest side accepted.
        max: u32,
    },
    /// A texture that cannot be bound as what it is given for.
    #[error("{input} is a texture of format {format}, {problem}: expected {expected}")]
    Texture {
        /// Which input.
        input: &'static str,
        /// Its format.
        format: String,
        /// What is wrong with it.
        problem: String,
        /// What is accepted.
        expected: &'static str,
    },
    /// A buffer that cannot be bound as what it is given for.
    #[error("{input} is a buffer {problem}: expected {expected}")]
    Buffer {
        /// Which input.
        input: &'static str,
        /// What is wrong with it.
        problem: String,
        /// What is accepted.
        expected: &'static str,
    },
    /// Nothing that was asked of the device is done any more.
    #[error("the graphics device was lost: make a new device and a new context on it, which starts afresh")]
    DeviceLost,
    /// A number of the frame's description is not usable.
    #[error("{what} of view {view} is {found}: expected {expected}")]
    Value {
        /// Which number.
        what: &'static str,
        /// Index of the view.
        view: usize,
        /// Its value.
        found: String,
        /// What is accepted.
        expected: &'static str,
    },
}
