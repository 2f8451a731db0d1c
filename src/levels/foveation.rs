//! Description of a renderer's foveation: level of detail by eccentricity, and the filter by which coarse regions are
//! shaded.

use crate::error::SettingsError;
use crate::foveation;

/// Filter by which a renderer shades coarse regions. Default: [`Mip`](Self::Mip). Example: [`Foveation`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum Filter {
    /// Mip levels of linear light (means of 2x2 pixels), trilinear between levels: renderers that shade fewer pixels
    /// and upscale.
    #[default]
    Mip,
    /// Gaussian blur whose width grows linearly with eccentricity.
    Gauss,
    /// One point sample a block: coarse shading hardware (variable rate shading). Block edges are powers of two, so
    /// that blends between regions become steps.
    Block,
    /// Full rate everywhere; no foveation.
    Off,
}

/// Foveation of a renderer: concentric regions around the gaze, and the shading rate of each. Angles are true visual
/// angles. A level of detail `l` means blocks of 2^l pixels a side.
///
/// Set it to match your renderer: it tells the post-process the level of detail of each pixel
/// ([`Settings::foveation`](super::Settings::foveation)). The [`Simulator`](super::Simulator) foveates a full-rate
/// frame by the same description.
///
/// ```
/// use afterimage::levels::{Filter, Foveation};
///
/// // Variable rate shading: full rate to 10 degrees, 2x2 blocks to 25 degrees, 4x4 blocks beyond.
/// let foveation = Foveation {
///     filter: Filter::Block,
///     fovea_deg: 10.0,
///     mid_deg: 25.0,
///     rate_mid: 2,
///     rate_far: 4,
///     ..Foveation::default()
/// };
/// foveation.validate()?;
/// assert_eq!((foveation.lod(0.0), foveation.lod(30.0)), (0.0, 2.0));
/// # Ok::<(), afterimage::SettingsError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Foveation {
    /// Filter of coarse regions. Default [`Filter::Mip`].
    pub filter: Filter,
    /// Diameter of the fovea, the full-rate region, in degrees: 0 to 180, at most `mid_deg`. Default 5.
    pub fovea_deg: f32,
    /// Diameter of the middle region in degrees: 0 to 180. Default 15.
    pub mid_deg: f32,
    /// Width in degrees of the linear blend outside the radius of each region: 0 to 90. Default 1.
    pub blend_deg: f32,
    /// Block edge in the middle region in pixels: a power of two, at most 256. Default 8.
    pub rate_mid: u32,
    /// Block edge in the periphery, outside the middle region, in pixels: a power of two from `rate_mid` to 256.
    /// Default 16.
    pub rate_far: u32,
}

impl Default for Foveation {
    fn default() -> Self {
        let foveation::Foveation { fovea_deg, mid_deg, blend_deg, rate_mid, rate_far, .. } = Default::default();
        Self { filter: Filter::Mip, fovea_deg, mid_deg, blend_deg, rate_mid, rate_far }
    }
}

impl Foveation {
    /// Checks the range of every field.
    ///
    /// # Errors
    /// [`SettingsError`] for the first field that is out of range or contradicts another.
    pub fn validate(&self) -> Result<(), SettingsError> {
        self.passes().validate()
    }

    /// Level of detail at eccentricity `e_deg`: log2 of the block edge in pixels, 0 at full rate. Continuous;
    /// [`Filter::Block`] rounds it to whole levels by block.
    pub fn lod(&self, e_deg: f32) -> f32 {
        self.passes().lod(e_deg)
    }

    /// The foveation as the passes take it.
    pub(super) fn passes(self) -> foveation::Foveation {
        let kind = match self.filter {
            Filter::Mip => foveation::FoveationKind::Mip,
            Filter::Gauss => foveation::FoveationKind::Gauss,
            Filter::Block => foveation::FoveationKind::Block,
            Filter::Off => foveation::FoveationKind::Off,
        };
        let Self { fovea_deg, mid_deg, blend_deg, rate_mid, rate_far, .. } = self;
        foveation::Foveation { kind, fovea_deg, mid_deg, blend_deg, rate_mid, rate_far, ..Default::default() }
    }
}
