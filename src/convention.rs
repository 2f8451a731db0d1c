//! What motion vectors and depth values mean, as types, and the one internal form they are brought to.
//!
//! Inside, a motion vector is `previous - current` in pixels with y down: a pixel `p` was at `p + motion` in the previous
//! frame. Depth is a **disparity** 1/z, with z the distance along the view axis: 0 is infinitely far, planes are linear in
//! screen space, and every perspective depth buffer is an affine function of it.

use crate::error::SettingsError;
use crate::kernel::depth::DisparityMap;

/// Unit of motion vectors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MotionUnit {
    /// Pixels of the frame.
    #[default]
    Pixels,
    /// Texture coordinates: 1 is the whole width or height.
    Uv,
    /// Normalised device coordinates: 2 is the whole width or height.
    Ndc,
}

/// Which difference a motion vector is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MotionDirection {
    /// Where the surface point was in the previous frame, minus where it is now.
    #[default]
    PreviousMinusCurrent,
    /// Where it is now, minus where it was.
    CurrentMinusPrevious,
}

/// Direction of the vertical axis of motion vectors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum YAxis {
    /// Downwards, as rows are stored.
    #[default]
    Down,
    /// Upwards, as in normalised device coordinates.
    Up,
}

/// What a motion vector means. The default is the internal form.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MotionConvention {
    /// Unit.
    pub unit: MotionUnit,
    /// Sign.
    pub direction: MotionDirection,
    /// Vertical axis.
    pub y_axis: YAxis,
}

impl MotionConvention {
    /// Blender's `Vector.X`, `Vector.Y`: previous minus current in pixels, y up.
    pub const BLENDER: Self =
        Self { unit: MotionUnit::Pixels, direction: MotionDirection::PreviousMinusCurrent, y_axis: YAxis::Up };

    /// Factors that bring a vector of this convention to the internal form, for a frame of `size_px`.
    pub fn to_internal(self, size_px: [u32; 2]) -> [f32; 2] {
        let [w, h] = size_px.map(|s| s as f32);
        let [sx, sy] = match self.unit {
            MotionUnit::Pixels => [1.0, 1.0],
            MotionUnit::Uv => [w, h],
            MotionUnit::Ndc => [0.5 * w, 0.5 * h],
        };
        let sign = match self.direction {
            MotionDirection::PreviousMinusCurrent => 1.0,
            MotionDirection::CurrentMinusPrevious => -1.0,
        };
        let flip = match self.y_axis {
            YAxis::Down => 1.0,
            YAxis::Up => -1.0,
        };
        [sign * sx, sign * flip * sy]
    }
}

/// What a depth value means. Distances are along the view axis, in any one unit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum DepthConvention {
    /// The distance itself; infinite (or huge) where there is nothing.
    #[default]
    Linear,
    /// Perspective, 0 at `near` and 1 at `far`.
    Forward {
        /// Distance of the near plane.
        near: f32,
        /// Distance of the far plane; `f32::INFINITY` for none.
        far: f32,
    },
    /// Perspective, 1 at `near` and 0 at `far`.
    Reversed {
        /// Distance of the near plane.
        near: f32,
        /// Distance of the far plane; `f32::INFINITY` for none.
        far: f32,
    },
    /// Orthographic, 0 at `near` and 1 at `far`, linear in between.
    Orthographic {
        /// Distance of the near plane.
        near: f32,
        /// Distance of the far plane.
        far: f32,
    },
}

impl DepthConvention {
    /// Checks the planes.
    ///
    /// # Errors
    /// If near is not above zero (orthographic: not finite), or far not above near.
    pub fn validate(self) -> Result<(), SettingsError> {
        let refuse = |found: String, expected: &str| {
            Err(SettingsError { setting: "depth convention", found, expected: expected.into() })
        };
        match self {
            Self::Linear => Ok(()),
            Self::Forward { near, far } | Self::Reversed { near, far } => {
                if near.is_finite() && near > 0.0 && far > near {
                    Ok(())
                } else {
                    refuse(format!("near {near}, far {far}"), "0 < near < far, near finite, far finite or infinite")
                }
            }
            Self::Orthographic { near, far } => {
                if near.is_finite() && far.is_finite() && far > near && far > 0.0 {
                    Ok(())
                } else {
                    refuse(format!("near {near}, far {far}"), "finite planes, near below far, far above 0")
                }
            }
        }
    }

    /// How a stored value becomes a disparity. Perspective buffers are affine in it: `(1 - d) / near + d / far`.
    pub fn disparity_map(self) -> DisparityMap {
        let (a, b, invert, clamp) = match self {
            Self::Linear => (1.0, 0.0, true, false),
            Self::Forward { near, far } => (1.0 / far - 1.0 / near, 1.0 / near, false, true),
            Self::Reversed { near, far } => (1.0 / near - 1.0 / far, 1.0 / far, false, true),
            Self::Orthographic { near, far } => (far - near, near, true, true),
        };
        DisparityMap { a, b, invert, clamp }
    }
}
