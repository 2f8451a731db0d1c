//! Streaming image quality metrics: PSNR, SSIM and FLIP over the whole frame and by eccentricity, PSNR weighted by
//! visual acuity, retention of detail from earlier foveas, flicker, ghosting, and the worst crop.
//!
//! All compare sRGB-encoded RGB in \[0, 1\] with the full-rate frame of the same time. `docs/metrics.md` has the
//! formulas.

mod crop;
mod ghost;
mod mean;
mod reference;
mod score;
mod track;

pub use crop::{CROP_FROM_FRAME, CROP_INVISIBLE_DB, CROP_PX, Crops, WorstCrop, crop_mean, worst_crop};
pub use ghost::{GHOST_FRAMES, Ghost};
pub use reference::{Reference, References};
pub use score::{BandScores, FrameErrors, Scorer, Scores};
pub use track::{NO_PAST, Tracked, Tracker};

use afterimage::Image;
use afterimage::kernel::{acuity, color};
pub use afterimage_metric::{Band, Display, Flip, flip, psnr_db, ssim_map};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// sRGB encoding in \[0, 1\] of a linear image after `exposure_ev` stops. Non-finite values become 0.
pub fn encode(linear: &Image<[f32; 3]>, exposure_ev: f32) -> Image<[f32; 3]> {
    let gain = exposure_ev.exp2();
    let mut encoded = Image::filled(linear.size(), [0.0; 3]);
    let chunks = encoded.pixels_mut().par_chunks_mut(ENCODED_PIXELS).zip(linear.pixels().par_chunks(ENCODED_PIXELS));
    chunks.for_each(|(encoded, linear)| {
        Arch::new().dispatch(Encode { linear: linear.as_flattened(), encoded: encoded.as_flattened_mut(), gain });
    });
    encoded
}

/// Pixels that [`encode`] gives to a task.
const ENCODED_PIXELS: usize = 16384;

/// Arguments of the loop of [`encode`].
struct Encode<'a> {
    linear: &'a [f32],
    encoded: &'a mut [f32],
    gain: f32,
}

impl WithSimd for Encode<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for (encoded, &linear) in self.encoded.iter_mut().zip(self.linear) {
            let value = linear * self.gain;
            // NaN fails the comparison.
            *encoded = if value > 0.0 { color::srgb_encode(value.min(1.0)) } else { 0.0 };
        }
    }
}

/// Weight of an error at an eccentricity in degrees: the density of retinal ganglion cells (Watson 2014,
/// [`acuity::cell_density`]) relative to the centre of the fovea. Each cell then counts equally, rather than each
/// pixel.
#[inline(always)]
pub fn error_weight(e_deg: f32) -> f32 {
    acuity::cell_density(e_deg) / acuity::cell_density(0.0)
}
