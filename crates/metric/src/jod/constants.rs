//! Constants of the model, by channel where there are two: sustained, transient. Fitted by least squares to the scores
//! of FovVideoVDP 1.2.2 for 171 pairs of videos and 73 pairs of gratings and edges; the loss with eccentricity for 99
//! other pairs, two thirds of them wide, and 75 rings of noise.

use super::CHANNELS;

/// Bands of the pyramid lie above this frequency in cycles per degree.
pub(super) const LEAST_CPD: f32 = 0.15;
/// Luminance in cd/m2 to which the eye is adapted, at least.
pub(super) const LEAST_NITS: f32 = 0.01;
/// Radius in cycles of the patch for which sensitivity is taken.
pub(super) const RADIUS_CYCLES: f32 = 1.0;
/// Exponent of frequency over 2 cycles per degree, by which sensitivity is multiplied.
pub(super) const BAND_TILT: [f32; CHANNELS] = [-0.6698, 0.1889];
/// Share of its own luminance, instead of the reference's, to which the eye adapts in a test.
pub(super) const ADAPTATION_SHARE: f32 = 0.1602;

/// Loss of sensitivity in decades a degree of eccentricity, in place of that of thresholds
/// ([`ChannelSensitivity::decades_per_deg`](crate::csf::ChannelSensitivity)): at frequency 0, and more for each cycle
/// per degree.
pub(super) const DECADES_PER_DEG: [[f32; 2]; CHANNELS] = [[0.0058, 0.0065], [0.0161, 0.0046]];

/// Exponent of the difference, p; that of the mask, q, is 4.5.
pub(super) const DIFFERENCE_EXPONENT: f64 = 4.0;
/// Gain of the mask, k.
pub(super) const MASK_GAIN: [f32; CHANNELS] = [0.9036, 2.423];
/// Masked difference at which a channel is half saturated.
pub(super) const MOST: [f32; CHANNELS] = [206.9, 9.4];

/// Weight of a channel.
pub(super) const CHANNEL_WEIGHT: [f64; CHANNELS] = [1.0, 1.389];
/// Weight of the Weber contrast that the bands leave, and its exponent.
pub(super) const BASE_WEIGHT: [f64; CHANNELS] = [1.653, 0.02193];
pub(super) const BASE_EXPONENT: f64 = 0.8844;
/// Exponents of pooling over bands, channels and frames.
pub(super) const BAND_EXPONENT: f64 = 2.256;
pub(super) const CHANNEL_EXPONENT: f64 = 2.299;
pub(super) const FRAME_EXPONENT: f64 = 2.924;
/// JOD lost by a visible difference d: scale times d to the exponent.
pub(super) const JOD_SCALE: f64 = 0.2965;
pub(super) const JOD_EXPONENT: f64 = 1.659;
