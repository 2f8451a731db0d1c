//! Description of a context for planned frames.

use crate::context::ContextDesc;
use crate::convention::{DepthConvention, MotionConvention};
use crate::error::{SettingsError, check};
use crate::foveation::Foveation;
use wgpu::TextureFormat;

/// How many pixels are shaded, and where. Default: a quarter of them, everywhere alike.
///
/// | | shaded | JOD on Sponza |
/// |---|---|---|
/// | full rate with temporal antialiasing | 100 % | 9.53 |
/// | `Everywhere { share: 0.25 }` | 25 % | 9.66 |
/// | `Gaze { fovea_deg: 5.0, share: 0.08 }` | 10 % | 9.45 |
///
/// The README says how these were measured. `fovea_deg` 10 suits headsets, which are about 100 degrees wide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shading {
    /// A share of the pixels, everywhere alike, without an eye tracker: a temporal upscaler with depth at full rate.
    Everywhere {
        /// Share of the pixels, 0.05 to 1.
        share: f32,
    },
    /// All pixels around the gaze, and a share of the pixels beyond.
    Gaze {
        /// Diameter of the fovea in degrees, 0 to 180.
        fovea_deg: f32,
        /// Share of the pixels outside the fovea, 0.05 to 1.
        share: f32,
    },
}

impl Default for Shading {
    fn default() -> Self {
        Self::Everywhere { share: 0.25 }
    }
}

impl Shading {
    pub(super) fn validate(self) -> Result<(), SettingsError> {
        let share = match self {
            Self::Everywhere { share } => share,
            Self::Gaze { fovea_deg, share } => {
                check("fovea_deg", fovea_deg, 0.0..=180.0, "degrees")?;
                share
            }
        };
        check("share", share, 0.05..=1.0, "of the pixels")
    }

    /// The even pattern takes a part of the share, and what history lacks gets the rest.
    pub(super) fn foveation(self, single_pixels: bool) -> Foveation {
        let outside = |share: f32| {
            let quads = Foveation::uniform(share);
            let even = share - quads.budget;
            // One pixel of each quad of the pattern.
            let budget = if single_pixels { share - 0.25 * even } else { quads.budget };
            Foveation { budget, single_pixels, ..quads }
        };
        match self {
            Self::Everywhere { share } => outside(share),
            Self::Gaze { fovea_deg, share } => {
                let mid_deg = fovea_deg.max(15.0);
                Foveation { fovea_deg, mid_deg, blend_deg: 1.0, ..outside(share) }
            }
        }
    }
}

/// Description of an [`Afterimage`](super::Afterimage). Create it with [`new`](Self::new) and `..`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Desc {
    /// Size of each view in pixels, each side 1 to 16384.
    pub size_px: [u32; 2],
    /// Number of views: 1 for a screen, 2 for stereo; at most 4. Textures have an array layer for each. Default 1.
    pub view_count: u32,
    /// Format of the output texture.
    pub output: TextureFormat,
    /// Pixels that are shaded. Default: a quarter.
    pub shading: Shading,
    /// Convention of motion vectors. `None`: there are none, because only the camera moves; the context knows its
    /// motion. Default `None`.
    pub motion: Option<MotionConvention>,
    /// Whether the depth texture holds distances along the view axis, in place of the depth buffer of the camera's
    /// projection. Default false.
    pub has_distances: bool,
    /// Whether the projection is jittered ([`Afterimage::jittered`](super::Afterimage::jittered)), and the picture is
    /// antialiased, in place of other temporal antialiasing. Default true.
    pub antialias: bool,
    /// Whether the output has the alpha of the colors, with a history like theirs, instead of 1. It takes 8 more bytes
    /// a pixel. Default false.
    pub keep_alpha: bool,
    /// Whether frames have the [albedo](super::Frame::albedo) of every pixel: samples then show light, and texture is
    /// the pixel's own. It needs `antialias`, excludes `keep_alpha` and `is_noisy`, and takes 8 more bytes a pixel.
    /// Default false.
    pub has_albedo: bool,
    /// Whether the renderer draws [quarter frames](super::Plan::quarters) at half the width and height. Otherwise the
    /// first frame, and those after cuts, are shaded at every pixel by rasterisers, and are right, too. Default false.
    pub draws_quarters: bool,
    /// Whether the renderer can shade single pixels of a quad, as path tracers and compute shaders can: outside the
    /// fovea the mask then has one pixel of a quad, four times as many places for the same pixels. Default false.
    pub single_pixels: bool,
    /// Whether frames are path-traced with few samples a pixel, and have a [noise input](super::Frame::noise). It takes
    /// 8 more bytes a pixel. Default false.
    pub is_noisy: bool,
}

impl Desc {
    /// A frame of `size_px`, shown in textures of the format `output`, with the defaults of the fields.
    pub fn new(size_px: [u32; 2], output: TextureFormat) -> Self {
        Self {
            size_px,
            view_count: 1,
            output,
            shading: Shading::default(),
            motion: None,
            has_distances: false,
            antialias: true,
            keep_alpha: false,
            has_albedo: false,
            draws_quarters: false,
            single_pixels: false,
            is_noisy: false,
        }
    }

    /// Description of the passes, for this workspace's other crates.
    ///
    /// # Errors
    /// [`SettingsError`] if a share or an angle is out of range.
    #[doc(hidden)]
    pub fn context(&self) -> Result<ContextDesc, SettingsError> {
        self.shading.validate()?;
        Ok(self.unchecked())
    }

    pub(super) fn unchecked(&self) -> ContextDesc {
        let still = MotionConvention { without_camera: true, ..MotionConvention::default() };
        ContextDesc {
            view_count: self.view_count,
            motion: self.motion.unwrap_or(still),
            depth: DepthConvention::Linear,
            keep_alpha: self.keep_alpha,
            has_albedo: self.has_albedo,
            settings: self.settings(),
            ..ContextDesc::new(self.size_px)
        }
    }
}
