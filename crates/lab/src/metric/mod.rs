//! Streaming image quality metrics: PSNR, SSIM and FLIP over the whole frame and by eccentricity, PSNR weighted by
//! visual acuity, retention of detail from earlier foveas, flicker, ghosting, and the worst crop.
//!
//! All compare sRGB-encoded RGB in \[0, 1\] with the full-rate frame of the same time. `docs/metrics.md` has the
//! formulas.

mod crop;
pub mod flip;
mod ghost;
mod mean;
mod reference;
mod score;
mod ssim;
mod track;

pub use crop::{CROP_FROM_FRAME, CROP_INVISIBLE_DB, CROP_PX, Crops, WorstCrop};
pub use flip::Flip;
pub use ghost::{GHOST_FRAMES, Ghost};
pub use reference::{Reference, References};
pub use score::{BandScores, FrameErrors, Scorer, Scores};
pub use ssim::ssim_map;
pub use track::{NO_PAST, Tracked, Tracker};

use afterimage::Image;
use afterimage::kernel::{acuity, color};
use glam::Vec3;
use rayon::prelude::*;

/// Eccentricity bands of reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Band {
    /// Below 2.5 degrees.
    Fovea = 0,
    /// 2.5 to 7.5 degrees.
    Mid = 1,
    /// Beyond 7.5 degrees.
    Periphery = 2,
}

impl Band {
    /// All bands, from the gaze outwards.
    pub const ALL: [Self; 3] = [Self::Fovea, Self::Mid, Self::Periphery];

    /// Band of an eccentricity in degrees.
    pub fn of(e_deg: f32) -> Self {
        if e_deg < 2.5 {
            Self::Fovea
        } else if e_deg <= 7.5 {
            Self::Mid
        } else {
            Self::Periphery
        }
    }
}

/// sRGB encoding in \[0, 1\] of a linear image after `exposure_ev` stops. Non-finite values become 0.
pub fn encode(linear: &Image<[f32; 3]>, exposure_ev: f32) -> Image<[f32; 3]> {
    let gain = exposure_ev.exp2();
    let mut encoded = Image::filled(linear.size(), [0.0; 3]);
    encoded.pixels_mut().par_iter_mut().zip(linear.pixels()).with_min_len(4096).for_each(|(out, c)| {
        *out = c.map(|v| {
            let v = v * gain;
            // NaN fails the comparison.
            if v > 0.0 { color::srgb_encode(v.min(1.0)) } else { 0.0 }
        });
    });
    encoded
}

/// L\*a\*b\* of sRGB-encoded colors.
fn lab_map(encoded: &Image<[f32; 3]>) -> Image<Vec3> {
    let mut lab = Image::filled(encoded.size(), Vec3::ZERO);
    lab.pixels_mut().par_iter_mut().zip(encoded.pixels()).with_min_len(4096).for_each(|(lab, c)| {
        *lab = color::lab(Vec3::from(c.map(color::srgb_decode)));
    });
    lab
}

/// Weight of an error at an eccentricity in degrees: the density of retinal ganglion cells (Watson 2014,
/// [`acuity::cell_density`]) relative to the centre of the fovea. Each cell then counts equally, rather than each
/// pixel.
pub fn error_weight(e_deg: f32) -> f32 {
    acuity::cell_density(e_deg) / acuity::cell_density(0.0)
}

/// PSNR in dB of a mean squared error on a scale of 1; `None` for an error of 0, where it is infinite.
pub fn psnr_db(mse: f64) -> Option<f64> {
    (mse > 0.0).then(|| -10.0 * mse.log10())
}
