//! What the renderer's foveation does, and simulators of it.
//!
//! Two independent questions: **where** the frame is how coarse (a level of detail by eccentricity) and **how** coarse looks (the
//! filter). A level of detail `l` means blocks of 2^l pixels a side. The post-process is told both by [`Foveation`]; with the
//! feature `lab` the same description turns a full-rate frame into what such a renderer would have delivered.

use crate::error::{SettingsError, check};
use crate::kernel::foveate;

/// How coarse looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Filter {
    /// Box mip levels of linear light, trilinear between levels: a renderer that shades fewer pixels and upscales.
    #[default]
    Mip,
    /// Gaussian blur that grows linearly with eccentricity.
    Gauss,
    /// One point sample a block, constant over it: coarse shading hardware. Blends between regions become steps of powers of
    /// two.
    Block,
    /// Full rate everywhere.
    Off,
}

/// Regions and rates of a foveated frame. Angles are true visual angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foveation {
    /// How coarse looks.
    pub filter: Filter,
    /// Diameter of the full-rate region in degrees. Default 5.
    pub fovea_deg: f32,
    /// Diameter of the middle region in degrees. Default 15.
    pub mid_deg: f32,
    /// Width in degrees of the linear blend outside each radius. Default 1.
    pub blend_deg: f32,
    /// Block edge in the middle region in pixels, a power of two. Default 8.
    pub rate_mid: u32,
    /// Block edge beyond in pixels, a power of two, at least `rate_mid`. Default 16.
    pub rate_far: u32,
}

impl Default for Foveation {
    fn default() -> Self {
        Self { filter: Filter::Mip, fovea_deg: 5.0, mid_deg: 15.0, blend_deg: 1.0, rate_mid: 8, rate_far: 16 }
    }
}

impl Foveation {
    /// Largest block edge.
    pub const MAX_RATE: u32 = 256;

    /// Checks ranges and order.
    ///
    /// # Errors
    /// Names the first field that is out of range or contradicts another.
    pub fn validate(&self) -> Result<(), SettingsError> {
        check("fovea", self.fovea_deg, 0.0..=180.0, "degrees")?;
        check("mid", self.mid_deg, 0.0..=180.0, "degrees")?;
        check("blend", self.blend_deg, 0.0..=90.0, "degrees")?;
        if self.fovea_deg > self.mid_deg {
            return Err(SettingsError {
                setting: "fovea",
                found: format!("{} degrees", self.fovea_deg),
                expected: format!(
                    "at most the middle region's {} degrees; widen the middle region or narrow the fovea",
                    self.mid_deg
                ),
            });
        }
        for (setting, rate, least) in [("rate_mid", self.rate_mid, 1), ("rate_far", self.rate_far, self.rate_mid)] {
            if !rate.is_power_of_two() || rate < least || rate > Self::MAX_RATE {
                return Err(SettingsError {
                    setting,
                    found: rate.to_string(),
                    expected: format!("a power of two from {least} to {}", Self::MAX_RATE),
                });
            }
        }
        Ok(())
    }

    /// Mip levels above the full-rate one that the filter may read.
    pub fn max_level(&self) -> u32 {
        self.rate_far.ilog2()
    }

    pub(crate) fn fovea_radius_deg(&self) -> f32 {
        0.5 * self.fovea_deg
    }

    pub(crate) fn mid_radius_deg(&self) -> f32 {
        0.5 * self.mid_deg
    }

    fn lod_mid(&self) -> f32 {
        self.rate_mid.ilog2() as f32
    }

    fn lod_far(&self) -> f32 {
        self.rate_far.ilog2() as f32
    }

    /// Standard deviation of the Gaussian at the edge of the middle region in pixels.
    fn sigma_mid_px(&self) -> f32 {
        0.5 * (self.rate_mid - 1) as f32
    }

    /// Largest standard deviation of the Gaussian in pixels.
    pub(crate) fn sigma_far_px(&self) -> f32 {
        0.5 * (self.rate_far - 1) as f32
    }

    /// Level of detail at eccentricity `e_deg`, before the filter's own quantisation.
    pub fn lod(&self, e_deg: f32) -> f32 {
        let (fovea, mid) = (self.fovea_radius_deg(), self.mid_radius_deg());
        match self.filter {
            Filter::Off => 0.0,
            Filter::Gauss => foveate::blur_lod(e_deg, fovea, mid, self.sigma_mid_px(), self.sigma_far_px()),
            Filter::Mip | Filter::Block => {
                foveate::region_lod(e_deg, fovea, mid, self.blend_deg, self.lod_mid(), self.lod_far())
            }
        }
    }

    /// How coarse the middle region is, and beyond: levels of detail, or the largest standard deviations of a blur in pixels.
    #[cfg(feature = "gpu")]
    pub(crate) fn coarseness(&self) -> [f32; 2] {
        match self.filter {
            Filter::Off => [0.0, 0.0],
            Filter::Gauss => [self.sigma_mid_px(), self.sigma_far_px()],
            Filter::Mip | Filter::Block => [self.lod_mid(), self.lod_far()],
        }
    }
}
