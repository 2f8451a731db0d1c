//! Contrast sensitivity of the sustained and of the transient channel to a patch of a grating: a function of spatial
//! frequency, temporal frequency, eccentricity, luminance and area.
//!
//! The form is that of stelaCSF (Mantiuk, Ashraf and Chapiro, "stelaCSF: A Unified Model of Contrast Sensitivity as the
//! Function of Spatio-Temporal Frequency, Eccentricity, Luminance and Area", 2022): two channels, each a parabola of
//! the logarithm of spatial frequency, whose peak depends on luminance; a loss with eccentricity that grows with
//! frequency; summation over area by Rovamo, Luntinen and Näsänen 1993. The constants are our own fit to 260
//! published thresholds of ten studies (`fixtures/contrast_thresholds.csv`, root mean square error 3.1 dB).

use afterimage::kernel::approx;
use std::f32::consts::{LOG2_10, LOG2_E};

/// Constants of a channel's sensitivity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChannelSensitivity {
    /// log10 of the sensitivity to a large patch at high luminance, at the best frequency.
    pub log10_peak: f32,
    /// Luminance in cd/m2 below which the peak falls, and the exponent with which it falls.
    pub peak_nits: [f32; 2],
    /// Best frequency at high luminance in cycles per degree: sensitivity is constant below it, but for area.
    pub peak_cpd: f32,
    /// Luminance in cd/m2 below which the best frequency falls, and the exponent.
    pub cpd_nits: [f32; 2],
    /// Width of the parabola: the square of the decades of frequency that cost one decade of sensitivity.
    pub width: f32,
    /// Loss in decades a degree of eccentricity: at frequency 0, and more for each cycle per degree.
    pub decades_per_deg: [f32; 2],
}

/// The channel that answers slow changes (sustained).
pub const SUSTAINED: ChannelSensitivity = ChannelSensitivity {
    log10_peak: 2.6941,
    peak_nits: [1.7138, 0.30396],
    peak_cpd: 1.7376,
    cpd_nits: [5.3911, 0.27848],
    width: 0.85369,
    decades_per_deg: [0.037639, 0.011879],
};

/// The channel that answers fast changes (transient).
pub const TRANSIENT: ChannelSensitivity = ChannelSensitivity {
    log10_peak: 3.2464,
    peak_nits: [5.5982, 0.82943],
    peak_cpd: 0.14746,
    cpd_nits: [0.0, 0.0],
    width: 2.2254,
    decades_per_deg: [0.010251, 0.014159],
};

/// Constants of summation over area: A0 in square degrees, and f0 squared in (cycles per degree)^2 (Rovamo et al.
/// 1993).
const SUMMATION: [f32; 2] = [56.126, 0.62512];

impl ChannelSensitivity {
    /// The sensitivity at one spatial frequency and area, with luminance and eccentricity left open.
    ///
    /// `cycles_per_degree` is positive, `area_deg2` the area of the patch in square degrees.
    pub fn at(&self, cycles_per_degree: f32, area_deg2: f32) -> SensitivityAt {
        let squared = cycles_per_degree * cycles_per_degree;
        let [a0, f0] = SUMMATION;
        let summed = area_deg2 * squared / (a0 + area_deg2 * (f0 + squared));
        let [base, slope] = self.decades_per_deg;
        SensitivityAt {
            log2_peak: LOG2_10 * self.log10_peak + 0.5 * summed.log2(),
            peak_nits: self.peak_nits,
            log2_above_peak: (cycles_per_degree / self.peak_cpd).log2(),
            cpd_nits: self.cpd_nits,
            // The parabola is one of log10; this one is of log2 and gives log2.
            curvature: 1.0 / (LOG2_10 * self.width),
            log2_per_deg: [LOG2_10 * base, LOG2_10 * slope * cycles_per_degree],
            tilt: 0.0,
        }
    }
}

/// Sensitivity at one spatial frequency and area as a function of luminance and eccentricity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensitivityAt {
    log2_peak: f32,
    peak_nits: [f32; 2],
    log2_above_peak: f32,
    cpd_nits: [f32; 2],
    curvature: f32,
    /// Loss a degree of eccentricity: at frequency 0, and what this frequency adds.
    log2_per_deg: [f32; 2],
    /// Exponent of frequency by which sensitivity is multiplied.
    tilt: f32,
}

impl SensitivityAt {
    /// The sensitivity times a power of the frequency over 2 cycles per degree; `cycles_per_degree` is that of
    /// [`ChannelSensitivity::at`].
    pub fn tilted(self, exponent: f32, cycles_per_degree: f32) -> Self {
        let log2_peak = self.log2_peak + exponent * (0.5 * cycles_per_degree).log2();
        Self { log2_peak, tilt: self.tilt + exponent, ..self }
    }

    /// log2 of the contrast sensitivity at a luminance in cd/m2 and an eccentricity in degrees, to a frequency `times`
    /// as high, at least 1, in a patch of as many cycles.
    #[inline(always)]
    pub fn log2(&self, nits: f32, eccentricity_deg: f32, times: f32) -> f32 {
        let octaves = log2(times);
        let [knee, exponent] = self.peak_nits;
        let peak = self.log2_peak + self.tilt * octaves - exponent * log2(1.0 + knee / nits);
        let [knee, exponent] = self.cpd_nits;
        // Frequency over the best frequency, which is lower in the dark.
        let above = (self.log2_above_peak + octaves + exponent * log2(1.0 + knee / nits)).max(0.0);
        let [base, slope] = self.log2_per_deg;
        peak - self.curvature * above * above - (base + slope * times) * eccentricity_deg
    }

    /// The contrast sensitivity; arguments are those of [`Self::log2`].
    #[inline(always)]
    pub fn sensitivity(&self, nits: f32, eccentricity_deg: f32, times: f32) -> f32 {
        approx::exp2_approx(self.log2(nits, eccentricity_deg, times))
    }
}

/// log2 of `x` >= 1.
#[inline(always)]
fn log2(x: f32) -> f32 {
    LOG2_E * approx::ln_approx(x)
}

/// Response of the sustained channel to a temporal frequency in Hz, 1 at 0 Hz.
pub fn sustained_response(hz: f32) -> f32 {
    (-hz.powf(1.6417) / 6.643).exp()
}

/// Response of the transient channel to a temporal frequency in Hz, 1 at its best frequency, which rises with
/// luminance.
pub fn transient_response(hz: f32, nits: f32) -> f32 {
    const EXPONENT: f32 = 0.16009;
    let best_hz = (3.4966 + 1.9605 * nits.log10()).max(1.0);
    let distance = hz.powf(EXPONENT) - best_hz.powf(EXPONENT);
    (-distance * distance / 0.050739).exp()
}

/// Sensitivity of the eye, the sum of both channels, to a patch of `area_deg2` of a grating that is modulated in time.
pub fn sensitivity(cycles_per_degree: f32, hz: f32, eccentricity_deg: f32, nits: f32, area_deg2: f32) -> f32 {
    let of = |channel: &ChannelSensitivity| {
        channel.at(cycles_per_degree, area_deg2).sensitivity(nits, eccentricity_deg, 1.0)
    };
    sustained_response(hz) * of(&SUSTAINED) + transient_response(hz, nits) * of(&TRANSIENT)
}
