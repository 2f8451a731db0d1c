//! Foveation as the passes take it, of full-size and of planned frames. `levels::Foveation` documents what full-size
//! frames have of it.

use crate::error::{SettingsError, check};
use crate::geometry::ViewGeometry;
use crate::kernel::foveate;
use crate::kernel::lattice::{self, offset_px};
use crate::kernel::quads::{FIRST_STEP, budget_quads};
#[cfg(feature = "bevy-0-20")]
use bevy_reflect::{Reflect, std_traits::ReflectDefault};

/// Kind of frames: the filters of [`levels::Filter`](crate::levels::Filter), and planned frames. Default:
/// [`Mip`](Self::Mip).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "bevy-0-20", derive(Reflect), reflect(Default))]
#[non_exhaustive]
pub enum FoveationKind {
    /// Mip levels, trilinear.
    #[default]
    Mip,
    /// Gaussian blur.
    Gauss,
    /// One point sample a block.
    Block,
    /// Full rate everywhere; no foveation.
    Off,
    /// Quads of 2x2 pixels of one full-rate view, which the post-process chooses before shading (`plan` of either
    /// executor): all in the fovea, one quad a block of an even pattern that moves from frame to frame, and a
    /// [`budget`](Foveation::budget) of quads where history lacks something. Depth and motion are given at every pixel.
    Quads,
}

impl FoveationKind {
    /// All kinds, in the order of the command-line tool.
    pub const ALL: [Self; 5] = [Self::Mip, Self::Gauss, Self::Block, Self::Quads, Self::Off];

    /// Short name in lower case, such as `mip`.
    pub fn name(self) -> &'static str {
        self.texts().0
    }

    /// Summary in one line.
    pub fn summary(self) -> &'static str {
        self.texts().1
    }

    fn texts(self) -> (&'static str, &'static str) {
        match self {
            Self::Mip => ("mip", "Box mip levels, trilinear"),
            Self::Gauss => ("gauss", "Gaussian blur that grows with eccentricity"),
            Self::Block => ("block", "One point sample per block"),
            Self::Quads => ("quads", "Quads of 2x2 pixels of a full-rate view that the post-process chooses"),
            Self::Off => ("off", "Full rate everywhere"),
        }
    }
}

/// Foveation of a renderer: concentric regions around the gaze, and the shading rate of each, as in
/// [`levels::Foveation`](crate::levels::Foveation).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
#[cfg_attr(feature = "bevy-0-20", derive(Reflect), reflect(Default))]
pub struct Foveation {
    /// Kind of frames. Default [`FoveationKind::Mip`].
    pub kind: FoveationKind,
    /// Diameter of the fovea, the full-rate region, in degrees: 0 to 180, at most `mid_deg`. Default 5.
    pub fovea_deg: f32,
    /// Diameter of the middle region in degrees: 0 to 180. Default 15. With [`FoveationKind::Quads`] 180 is the whole
    /// view, even if the gaze is far outside of it.
    pub mid_deg: f32,
    /// Width in degrees of the linear blend outside the radius of each region: 0 to 90. Default 1.
    pub blend_deg: f32,
    /// Block edge in the middle region in pixels: a power of two, at most [`MAX_RATE`](Self::MAX_RATE). Default 8.
    pub rate_mid: u32,
    /// Block edge in the periphery, outside the middle region, in pixels: a power of two from `rate_mid` to
    /// [`MAX_RATE`](Self::MAX_RATE). Default 16.
    pub rate_far: u32,
    /// With [`FoveationKind::Quads`]: share of the pixels that are shaded by need in a frame, beside the fovea and the
    /// even pattern, 0 to 1. With [`noisy`](crate::internal::Settings::noisy) frames it counts paths, of which a pixel
    /// may get several. Default 0.025.
    pub budget: f32,
    /// With [`FoveationKind::Quads`]: whether one pixel of a chosen quad is shaded, outside the fovea, in place of all
    /// four; each in turn. For path tracers and compute shaders, which can shade single pixels: four times as many
    /// places for the same pixels. Default false.
    pub single_pixels: bool,
}

impl Default for Foveation {
    fn default() -> Self {
        Self {
            kind: FoveationKind::Mip,
            fovea_deg: 5.0,
            mid_deg: 15.0,
            blend_deg: 1.0,
            rate_mid: 8,
            rate_far: 16,
            budget: 0.025,
            single_pixels: false,
        }
    }
}

impl Foveation {
    /// Largest block edge, in pixels.
    pub const MAX_RATE: u32 = 256;

    /// Largest block edge with [`FoveationKind::Quads`], in pixels.
    pub const MAX_QUADS_RATE: u32 = 8;

    /// Foveation by quads: all within `fovea_deg` (a diameter in degrees), beyond it one quad in a block of 4x4 pixels
    /// within 15 degrees and one in two blocks of 8x8 pixels in the periphery, and the default budget.
    /// [`Settings::screen`](crate::internal::Settings::screen) and
    /// [`Settings::headset`](crate::internal::Settings::headset) score better.
    ///
    /// ```
    /// use afterimage::internal::Foveation;
    ///
    /// assert!(Foveation::quads().validate().is_ok());
    /// ```
    pub fn quads() -> Self {
        Self { kind: FoveationKind::Quads, rate_mid: 4, rate_far: 8, ..Self::default() }
    }

    /// Quads without a gaze: `share` of the pixels, 0 to 1, everywhere alike. An even pattern takes 1/8 of the pixels,
    /// or 1/32 of them if `share` is below 0.25; the rest goes by need. It is a temporal upscaler with depth and motion
    /// at full rate.
    ///
    /// ```
    /// use afterimage::internal::Foveation;
    ///
    /// assert_eq!(Foveation::uniform(0.25).budget, 0.125);
    /// ```
    pub fn uniform(share: f32) -> Self {
        let (rate, even) = if share >= 0.25 { (4, 1.0 / 8.0) } else { (8, 1.0 / 32.0) };
        let budget = (share - even).clamp(0.0, 1.0);
        Self { fovea_deg: 0.0, mid_deg: 0.0, rate_mid: rate, rate_far: rate, budget, ..Self::quads() }
    }

    /// One pixel of each quad, without a gaze: what a temporal upscaler from half the width and height is given.
    ///
    /// ```
    /// use afterimage::internal::Foveation;
    ///
    /// assert!(Foveation::quarter().single_pixels);
    /// ```
    pub fn quarter() -> Self {
        let rates = Self { rate_mid: 2, rate_far: 2, ..Self::quads() };
        Self { fovea_deg: 0.0, mid_deg: 180.0, blend_deg: 0.0, budget: 0.0, single_pixels: true, ..rates }
    }

    /// Place in its quad of the pixel that frame `index` shades alone, of each quad outside the fovea, if it shades one
    /// of each.
    pub fn quarter_place_px(index: u64) -> [u32; 2] {
        offset_px(index, 2)
    }

    /// Jitter of the projection in a frame for [`Smr::antialias`](crate::internal::Smr::antialias), in pixels, each in
    /// \[-0.5, 0.5). It moves the samples within their pixels from frame to frame, so that a mean over time is a mean
    /// over the pixel's area. This also holds where the even pattern visits a pixel only every 16 or 128 frames. A
    /// point at `p` without jitter is drawn at `p + jitter_px`. `index`: frame counter.
    ///
    /// ```
    /// use afterimage::internal::Foveation;
    ///
    /// assert_eq!(Foveation::jitter_px(0), [-0.5, -0.5]);
    /// assert!(Foveation::jitter_px(7).iter().all(|v| v.abs() <= 0.5));
    /// ```
    pub fn jitter_px(index: u64) -> [f32; 2] {
        lattice::jitter_px(index)
    }

    /// Checks the range of every field.
    ///
    /// # Errors
    /// [`SettingsError`] for the first field that is out of range or contradicts another.
    pub fn validate(&self) -> Result<(), SettingsError> {
        check("fovea_deg", self.fovea_deg, 0.0..=180.0, "degrees")?;
        check("mid_deg", self.mid_deg, 0.0..=180.0, "degrees")?;
        check("blend_deg", self.blend_deg, 0.0..=90.0, "degrees")?;
        if self.fovea_deg > self.mid_deg {
            return Err(SettingsError {
                setting: "fovea_deg",
                found: format!("{} degrees", self.fovea_deg),
                expected: format!(
                    "at most the middle region's {} degrees; widen the middle region or narrow the fovea",
                    self.mid_deg
                ),
            });
        }
        let range = if self.kind == FoveationKind::Quads { 2..=Self::MAX_QUADS_RATE } else { 1..=Self::MAX_RATE };
        for (setting, rate) in [("rate_mid", self.rate_mid), ("rate_far", self.rate_far)] {
            let expected = match rate.is_power_of_two() && range.contains(&rate) {
                true if rate >= self.rate_mid => continue,
                true => format!("at least rate_mid, {}", self.rate_mid),
                false => format!("a power of two from {} to {}", range.start(), range.end()),
            };
            return Err(SettingsError { setting, found: rate.to_string(), expected });
        }
        check("budget", self.budget, 0.0..=1.0, "of the pixels")
    }

    /// Coarsest level of detail: log2 of `rate_far`.
    pub fn max_level(&self) -> u32 {
        self.rate_far.ilog2()
    }

    /// Places in their blocks of the pixels of the even pattern of frame `index`: x and y in the middle region, x and y
    /// in the periphery. There a frame has every second block.
    pub(crate) fn pattern_px(&self, index: u64) -> [u32; 4] {
        let [mid_x, mid_y] = offset_px(index, self.rate_mid);
        let [far_x, far_y] = offset_px(index / 2, self.rate_far);
        [mid_x, mid_y, far_x, far_y]
    }

    /// Foveation of a frame without history, if that shades a quarter of the pixels: the fovea, and one pixel of each
    /// quad around it.
    pub(crate) fn after_cut(&self) -> Self {
        Self { fovea_deg: self.fovea_deg, ..Self::quarter() }
    }

    /// Whether a frame without history shades a quarter of the pixels, evenly: if other frames have about as few.
    pub(crate) fn takes_quarter(&self) -> bool {
        let pixels = if self.single_pixels { 1.0 } else { 4.0 };
        let even = 0.5 * pixels / (self.rate_far * self.rate_far) as f32;
        even + self.budget < 0.3
    }

    /// Number of the quads of a view of `quads` quads for which the budget pays.
    pub(crate) fn budget_quads(&self, quads: [u32; 2]) -> u32 {
        let share = if self.single_pixels { 4.0 * self.budget } else { self.budget };
        budget_quads(share, quads)
    }

    /// Place in its block of [`FIRST_STEP`] quads of the quad that frame `index` chooses first without history,
    /// in quads.
    pub(crate) fn first_quad(index: u64) -> [u32; 2] {
        // Not of the frame itself, whose quad an even pattern of this step has already.
        offset_px(index.wrapping_add(1), FIRST_STEP)
    }

    pub(crate) fn fovea_radius_deg(&self) -> f32 {
        0.5 * self.fovea_deg
    }

    pub(crate) fn mid_radius_deg(&self) -> f32 {
        // Pixels may be more than 90 degrees from a gaze outside the view; a quarter has them, too.
        if self.kind == FoveationKind::Quads && self.mid_deg >= 180.0 { 360.0 } else { 0.5 * self.mid_deg }
    }

    fn lod_mid(&self) -> f32 {
        self.rate_mid.ilog2() as f32
    }

    fn lod_far(&self) -> f32 {
        self.rate_far.ilog2() as f32
    }

    /// Angle in degrees from the gaze by which the region and the level of detail of the pixel `px` are chosen: its
    /// eccentricity. Regions of other shapes need another angle.
    pub fn region_angle_deg(&self, geometry: &ViewGeometry, px: [f32; 2], gaze_px: [f32; 2]) -> f32 {
        geometry.eccentricity_deg(px, gaze_px)
    }

    /// Smallest rectangle that contains all pixels up to an [angle](Self::region_angle_deg) of `radius_deg`: first
    /// pixel, and pixel after the last. It is clamped to the view, and empty if it lies outside the view. For renderers
    /// that draw regions as views of their own.
    pub fn region_px(&self, geometry: &ViewGeometry, gaze_px: [f32; 2], radius_deg: f32) -> [[u32; 2]; 2] {
        geometry.around_px(gaze_px, radius_deg)
    }

    /// Level of detail at eccentricity `e_deg`: log2 of the block edge in pixels, 0 at full rate. Continuous;
    /// [`FoveationKind::Block`] rounds it to whole levels by block.
    pub fn lod(&self, e_deg: f32) -> f32 {
        let (fovea, mid) = (self.fovea_radius_deg(), self.mid_radius_deg());
        match self.kind {
            FoveationKind::Off => 0.0,
            FoveationKind::Gauss => foveate::blur_lod(e_deg, fovea, mid, self.lod_mid(), self.lod_far()),
            FoveationKind::Mip | FoveationKind::Block | FoveationKind::Quads => {
                foveate::region_lod(e_deg, fovea, mid, self.blend_deg, self.lod_mid(), self.lod_far())
            }
        }
    }

    /// Levels of detail of the middle region and of the periphery.
    #[cfg(feature = "gpu")]
    pub(crate) fn lods(&self) -> [f32; 2] {
        if self.kind == FoveationKind::Off { [0.0; 2] } else { [self.lod_mid(), self.lod_far()] }
    }
}
