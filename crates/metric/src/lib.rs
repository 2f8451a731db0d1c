//! Image and video quality: PSNR, SSIM, FLIP, and a foveated video metric in just-objectionable differences (JOD).
//!
//! Images are sRGB-encoded, in \[0, 1\]. [`jod`] knows where the eye looks and what the display shows, and sees
//! flicker; [`flip`] compares two pictures that are shown in turn; [`ssim_map`] and [`psnr_db`] know neither eye nor
//! display.

mod band;
pub mod csf;
mod display;
pub mod flip;
pub mod jod;
mod pyramid;
mod ssim;
pub mod strip;
mod temporal;

pub use band::Band;
pub use display::Display;
pub use flip::Flip;
pub use jod::{ReferenceFrame, ReferenceVideo, TestVideo, VideoScore, Viewing};
pub use ssim::ssim_map;

/// PSNR in dB of a mean squared error on a scale of 1; `None` for an error of 0, where it is infinite.
pub fn psnr_db(mse: f64) -> Option<f64> {
    (mse > 0.0).then(|| -10.0 * mse.log10())
}
