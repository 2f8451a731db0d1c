//! How good a shown frame is, frame by frame, without keeping frames: PSNR and SSIM, whole and by eccentricity, what was
//! retained of earlier foveas, and flicker.
//!
//! All figures are of sRGB-encoded RGB in \[0, 1\] against the full-rate frame of the same moment.

mod score;
mod ssim;
mod track;

pub use score::{BandScores, FrameErrors, Scorer, Scores};
pub use ssim::ssim_map;
pub use track::{NO_PAST, Tracked, Tracker};

use crate::image::Image;
use crate::kernel::color;
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

    /// The band of an eccentricity in degrees.
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

/// PSNR in dB of a mean squared error on a scale of 1; `None` for an error of 0, which has none.
pub fn psnr_db(mse: f64) -> Option<f64> {
    (mse > 0.0).then(|| -10.0 * mse.log10())
}
