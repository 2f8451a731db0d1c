//! Conventions of motion vectors and depth values, and their conversion to internal conventions.
//!
//! Internally, a motion vector is `previous - current` in pixels with y down: a pixel `p` was at `p + motion` in the
//! previous frame. Depth is a **disparity** 1/z, with z the distance along the view axis. It is 0 at infinity and
//! linear in screen space over planes, and every perspective depth buffer is an affine function of it.

use crate::error::SettingsError;
use crate::kernel::depth::{DisparityMap, disparity};

/// Unit of motion vectors. Example: [`MotionConvention`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum MotionUnit {
    /// Pixels of the frame.
    #[default]
    Pixels,
    /// Texture coordinates: 1 is the full width or height.
    Uv,
    /// Normalised device coordinates: 2 is the full width or height.
    Ndc,
}

/// Sign of motion vectors. Example: [`MotionConvention`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
pub enum MotionDirection {
    /// Position of the surface point in the previous frame minus its position in this frame.
    #[default]
    PreviousMinusCurrent,
    /// Position of the surface point in this frame minus its position in the previous frame.
    CurrentMinusPrevious,
}

/// Direction of the vertical axis of motion vectors. Example: [`MotionConvention`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
pub enum YAxis {
    /// Downwards: towards later rows of the image.
    #[default]
    Down,
    /// Upwards, as in normalised device coordinates.
    Up,
}

/// Convention of motion vectors. Default: previous minus current position in pixels, y down, without jitter, with the
/// camera's motion, at every pixel.
///
/// A wrong convention shows as history that is rejected or smeared in motion, while a still view looks right.
///
/// ```
/// use afterimage::{MotionConvention, MotionUnit};
///
/// let of_bevy = MotionConvention::BEVY;
/// // An upscaler's vectors, but in texture coordinates (FSR2 with a motionVectorScale of the frame's size).
/// let of_uv = MotionConvention { unit: MotionUnit::Uv, ..MotionConvention::FSR2 };
/// // Objects that move write vectors into a texture that was cleared to 0.
/// let cleared = MotionConvention { no_vector: Some([0.0; 2]), ..MotionConvention::FSR2 };
/// # let _ = (of_bevy, of_uv, cleared);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct MotionConvention {
    /// Unit. Default: pixels.
    pub unit: MotionUnit,
    /// Sign. Default: previous minus current.
    pub direction: MotionDirection,
    /// Vertical axis. Default: down.
    pub y_axis: YAxis,
    /// Whether vectors contain the jitter of the projection: differences of jittered positions. The jitter of each
    /// frame is [`ViewFrame::jitter_px`](crate::levels::ViewFrame::jitter_px). Default: false, as in all engines named
    /// here.
    pub jittered: bool,
    /// Whether no vector contains the camera's motion: each is the object's own motion, as this frame's camera would
    /// see it, and 0 for what stands still. Without a motion input, everything stands still in the world. Default:
    /// false.
    ///
    /// Where the camera's motion is missing, here or because of [`no_vector`](Self::no_vector), it is added from
    /// [`depth`](crate::levels::FrameInputs::depth) and
    /// [`ViewFrame::previous_from_current`](crate::levels::ViewFrame::previous_from_current), which are then required.
    /// What lies at the far plane or at infinity, as the sky, follows the camera's turns alone.
    pub without_camera: bool,
    /// The vector of pixels that have none, as the texture holds it, such as its clear value; a vector that is not
    /// finite then means none, too. Such a pixel belongs to a surface that stands still in the world. Without a motion
    /// input, no pixel has a vector. `None`: every pixel has one, and one that is not finite rejects the pixel's
    /// history. Default: `None`.
    pub no_vector: Option<[f32; 2]>,
}

impl MotionConvention {
    /// Blender's vector pass (`Vector.X`, `Vector.Y`): previous minus current in pixels, y up.
    pub const BLENDER: Self = Self { y_axis: YAxis::Up, ..Self::FSR2 };

    /// Bevy's `MotionVectorPrepass` texture: current minus previous in texture coordinates, y down.
    pub const BEVY: Self =
        Self { unit: MotionUnit::Uv, direction: MotionDirection::CurrentMinusPrevious, ..Self::FSR2 };

    /// Unity's `_MotionVectorTexture` (built-in, URP and HDRP) on graphics APIs whose textures start at the top
    /// (Direct3D, Metal, Vulkan): current minus previous in texture coordinates, y down. On OpenGL y is up.
    pub const UNITY: Self = Self::BEVY;

    /// Unreal's velocity after `DecodeVelocityFromTexture`: current minus previous in normalised device coordinates,
    /// y up. Decode the texture before you pass it. Write NaN to its pixels without velocity, and set
    /// [`no_vector`](Self::no_vector).
    pub const UNREAL: Self = Self {
        unit: MotionUnit::Ndc,
        direction: MotionDirection::CurrentMinusPrevious,
        y_axis: YAxis::Up,
        jittered: false,
        without_camera: false,
        no_vector: None,
    };

    /// FSR2 after its `motionVectorScale`: previous minus current in pixels, y down. XeSS (with low-resolution vectors
    /// in pixels) and DLSS (after `InMVScale`) have the same convention; it is also the default.
    pub const FSR2: Self = Self {
        unit: MotionUnit::Pixels,
        direction: MotionDirection::PreviousMinusCurrent,
        y_axis: YAxis::Down,
        jittered: false,
        without_camera: false,
        no_vector: None,
    };

    /// Factors that convert a vector of this convention to the default convention, for a frame of `size_px`. They leave
    /// the jitter in the vector.
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

    /// Whether the post-process adds the camera's motion somewhere.
    pub(crate) fn lacks_camera(self) -> bool {
        self.without_camera || self.no_vector.is_some()
    }

    /// `CAMERA_MOTION` of the shaders.
    #[cfg(feature = "gpu")]
    pub(crate) fn camera_code(self) -> u32 {
        u32::from(self.no_vector.is_some()) | u32::from(self.without_camera) << 1
    }

    /// Vector of pixels that have none; finite.
    pub(crate) fn finite_no_vector(self) -> [f32; 2] {
        // No motion is that large.
        self.no_vector.filter(|none| none.iter().all(|v| v.is_finite())).unwrap_or([f32::MAX; 2])
    }

    /// Vector in pixels, y down, to add to a converted vector so that it contains no jitter, for the jitters in pixels
    /// of this frame and of the previous one.
    pub(crate) fn jitter_offset(self, jitter_px: [f32; 2], previous_px: [f32; 2]) -> [f32; 2] {
        if self.jittered { [jitter_px[0] - previous_px[0], jitter_px[1] - previous_px[1]] } else { [0.0; 2] }
    }
}

/// Convention of depth values. Default: [`Linear`](Self::Linear).
///
/// Distances are along the view axis. Any unit will do, as long as
/// [`ViewFrame::previous_from_current`](crate::levels::ViewFrame) uses the same one.
///
/// ```
/// use afterimage::DepthConvention;
///
/// // A reversed-z depth buffer with an infinite far plane.
/// DepthConvention::Reversed { near: 0.1, far: f32::INFINITY }.validate()?;
/// # Ok::<(), afterimage::SettingsError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum DepthConvention {
    /// Distance along the view axis. Infinity, or a value above 1e30, means that the pixel shows no surface.
    #[default]
    Linear,
    /// Perspective depth buffer: 0 at `near`, 1 at `far`.
    Forward {
        /// Distance of the near plane, above 0 and finite.
        near: f32,
        /// Distance of the far plane, above `near`; `f32::INFINITY` for an infinite projection.
        #[cfg_attr(feature = "serde", serde(with = "far_plane"))]
        far: f32,
    },
    /// Reversed perspective depth buffer: 1 at `near`, 0 at `far`.
    Reversed {
        /// Distance of the near plane, above 0 and finite.
        near: f32,
        /// Distance of the far plane, above `near`; `f32::INFINITY` for an infinite projection.
        #[cfg_attr(feature = "serde", serde(with = "far_plane"))]
        far: f32,
    },
    /// Orthographic depth buffer: 0 at `near`, 1 at `far`, linear in distance.
    Orthographic {
        /// Distance of the near plane, finite; may be negative.
        near: f32,
        /// Distance of the far plane, finite, above `near` and above 0.
        far: f32,
    },
}

impl DepthConvention {
    /// Checks the distances of the planes.
    ///
    /// # Errors
    /// [`SettingsError`] if a plane is outside the range that its variant documents.
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

    /// Map from a stored value to a disparity. For perspective buffers it is affine: `(1 - d) / near + d / far`.
    pub fn disparity_map(self) -> DisparityMap {
        let (a, b, invert, clamp) = match self {
            Self::Linear => (1.0, 0.0, true, false),
            Self::Forward { near, far } => (1.0 / far - 1.0 / near, 1.0 / near, false, true),
            Self::Reversed { near, far } => (1.0 / near - 1.0 / far, 1.0 / far, false, true),
            Self::Orthographic { near, far } => (far - near, near, true, true),
        };
        DisparityMap { a, b, invert, clamp }
    }

    /// Disparity of the far plane, where a depth buffer holds the sky; 0 if that is infinitely far away.
    pub(crate) fn sky_disparity(self) -> f32 {
        let map = self.disparity_map();
        match self {
            Self::Forward { .. } => disparity(1.0, map),
            Self::Reversed { .. } => disparity(0.0, map),
            Self::Linear | Self::Orthographic { .. } => 0.0,
        }
    }
}

/// Distances of far planes in configuration files: "infinite" for infinity, which JSON lacks.
#[cfg(feature = "serde")]
mod far_plane {
    use serde::de::Error;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    const INFINITE: &str = "infinite";

    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Plane {
        Distance(f32),
        Name(String),
    }

    pub fn serialize<S: Serializer>(far: &f32, serializer: S) -> Result<S::Ok, S::Error> {
        if far.is_infinite() { INFINITE.serialize(serializer) } else { far.serialize(serializer) }
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f32, D::Error> {
        match Plane::deserialize(deserializer)? {
            Plane::Distance(far) => Ok(far),
            Plane::Name(name) if name == INFINITE => Ok(f32::INFINITY),
            Plane::Name(name) => Err(D::Error::custom(format!("far is '{name}': expected a distance or '{INFINITE}'"))),
        }
    }
}
