//! How a video is seen: geometry, photometry and rate, and the pyramid's bands that follow from them.

use super::CHANNELS;
use super::constants::{BAND_TILT, DECADES_PER_DEG, LEAST_CPD, RADIUS_CYCLES};
use crate::csf::{ChannelSensitivity, SUSTAINED, SensitivityAt, TRANSIENT};
use crate::display::Display;
use afterimage::ViewGeometry;
use std::f32::consts::PI;

/// How a video is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewing {
    /// Size of the frames and field of view.
    pub geometry: ViewGeometry,
    /// Photometry of the display.
    pub display: Display,
    /// Frames per second, clamped to 1 to 1000.
    pub fps: f32,
}

impl Viewing {
    /// Resolution in the middle of the view in pixels per degree.
    pub fn pixels_per_degree(&self) -> f32 {
        pixels_per_degree(&self.geometry)
    }

    /// How many times as many pixels a degree has at `x_px`, `y_px` as on the axis: the geometric mean of
    /// 1 / cos^2 a outwards and 1 / cos a around, at `a` degrees from the axis of a flat view.
    #[inline(always)]
    pub(super) fn pixels_per_degree_times(&self, [x_px, y_px]: [f32; 2]) -> f32 {
        let (scale, offset) = self.geometry.scale_offset();
        let [x, y] = [x_px * scale[0] + offset[0], y_px * scale[1] + offset[1]];
        let root = (1.0 + x * x + y * y).sqrt();
        root * root.sqrt()
    }

    /// Sensitivity of both channels in each band of the pyramid, the finest first.
    pub(super) fn bands(&self) -> Vec<[SensitivityAt; CHANNELS]> {
        let pixels_per_degree = self.pixels_per_degree();
        let side = self.geometry.size_px().into_iter().min().unwrap_or(1).max(2);
        (0..side.ilog2() as usize)
            .map(|i| band_cpd(i, pixels_per_degree))
            .enumerate()
            .take_while(|&(i, cpd)| i == 0 || cpd > LEAST_CPD)
            .map(|(_, cpd)| {
                let radius_deg = RADIUS_CYCLES / cpd;
                let area_deg2 = PI * radius_deg * radius_deg;
                let of = |channel: ChannelSensitivity, c: usize| {
                    let channel = ChannelSensitivity { decades_per_deg: DECADES_PER_DEG[c], ..channel };
                    channel.at(cpd, area_deg2).tilted(BAND_TILT[c], cpd)
                };
                [of(SUSTAINED, 0), of(TRANSIENT, 1)]
            })
            .collect()
    }
}

/// Resolution in the middle of a view in pixels per degree.
pub(crate) fn pixels_per_degree(view: &ViewGeometry) -> f32 {
    let ([tangent_per_px, _], _) = view.scale_offset();
    1.0 / (2.0 * (0.5 * tangent_per_px).atan().to_degrees())
}

/// Peak frequency in cycles per degree of band `i` of a Laplacian pyramid.
fn band_cpd(i: usize, pixels_per_degree: f32) -> f32 {
    let nyquist = 0.5 * pixels_per_degree;
    if i == 0 { nyquist } else { nyquist * 0.3228 * 0.5_f32.powi(i as i32 - 1) }
}
