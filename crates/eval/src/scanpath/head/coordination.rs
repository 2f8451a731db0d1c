//! Constants of the coordination of head and eye, with their sources, and events that the model generates besides
//! samples.
//!
//! Values marked *chosen* were chosen here, because no published source was at hand. They agree with the published
//! figures beside them.

/// Amplitude of a gaze shift in degrees: exponential with [`SHIFT_SCALE_DEG`], truncated to this range. The lower end
/// is the same as for saccades on a screen. All subjects of Guitton & Volle 1987 made shifts as large as the upper end
/// (up to 160).
pub(super) const SHIFT_DEG: [f64; 2] = [2.5, 100.0];

/// Scale of the amplitude in degrees; chosen. 65 % of the shifts are then below 15 degrees, where Malinov et al. 2000
/// counted 83 %. Their subjects looked at targets on a table, and had no reason to look behind them.
pub(super) const SHIFT_SCALE_DEG: f64 = 12.0;

/// Vertical component of a shift's direction, as a share of the horizontal one in the mean; chosen. People in headsets
/// mostly look along the horizon (Sitzmann et al. 2018; Bischof et al. 2020).
pub(super) const VERTICAL_SHARE: f64 = 0.5;

/// Where people look: azimuth to either side in degrees; chosen for a person who stands or walks and turns the head but
/// not the feet.
pub(super) const AZIMUTH_DEG: f64 = 80.0;

/// Lowest and highest elevation in degrees; chosen.
pub(super) const ELEVATION_DEG: [f64; 2] = [-35.0, 25.0];

/// Angle in degrees between head and target up to which the eye moves without the head: uniform; chosen. Freedman &
/// Sparks 1997: no contribution of the head below 20 degrees (monkeys). Hu et al. 2026 fit a hinge function to people
/// in headsets, and find a continuum from eye-movers to head-movers; this model lies between the two.
pub(super) const EYE_ALONE_DEG: [f64; 2] = [5.0, 20.0];

/// Turn of the head in degrees for each degree of the target's angle beyond [`EYE_ALONE_DEG`]; chosen. Freedman &
/// Sparks 1997: linear from 25 to 90 degrees. Eyes then rest within 31 degrees of the head's axis for targets within
/// 90.
pub(super) const HEAD_GAIN: f64 = 0.85;

/// Vertical part of a turn, relative to a horizontal turn for the same angle; chosen. Freedman & Sparks 1997: the head
/// contributes less the more vertical a shift is.
pub(super) const HEAD_VERTICAL: f64 = 0.7;

/// Time in seconds from the gaze's start to the head's: uniform; chosen. 10 ms in shifts of 40 degrees by people who
/// walk (Peters et al.), 50 ms at 40 degrees and 139 ms at 10 in the abstract of Jibi to Rinsho 24, 1978, 559.
pub(super) const HEAD_LAG_S: [f64; 2] = [0.02, 0.06];

/// Duration of a head turn in seconds and seconds a degree; chosen. With the minimum-jerk profile (Chen et al. 2012
/// find head movements composed of overlapping ones), the largest speed is 97 degrees a second in a turn of 20 degrees
/// and 197 in one of 80. The head does not exceed 185 when people walk, run and hop (Pozzo et al. 1989), and its speed
/// grows with the target's angle (Jibi to Rinsho).
pub(super) const HEAD_TURN_S: [f64; 2] = [0.26, 0.00625];

/// Largest angle in degrees between eye and head: eye saccades end there on average when the head is kept from moving;
/// the anatomical limit is about 55 (Guitton & Volle 1987). A larger gaze shift takes as long as the head needs to
/// bring the target within it.
pub(super) const EYE_LIMIT_DEG: f64 = 45.0;

/// Gain of the vestibulo-ocular reflex: share of the head's rotation that the eye compensates at once; chosen. It is
/// close to 1 in the light: gaze then slips by 1 degree a second when the head turns by 50.
pub(super) const ROTATION_GAIN: f64 = 0.98;

/// Gain of the reflex for the head's translation: about 0.6 for near and far targets (Liao et al. 2009).
pub(super) const TRANSLATION_GAIN: f64 = 0.6;

/// Gain of the eye for the motion of a pursued object; chosen.
pub(super) const PURSUIT_GAIN: f64 = 0.95;

/// Time in seconds in which gaze approaches its target by a factor e, by slow eye movements; chosen. Slip and drift
/// then do not add up. Shorter times make gaze steadier than the gains alone.
pub(super) const RETURN_S: f64 = 0.2;

/// Speed of a pursued object in degrees a second: uniform; chosen, below the limit of pursuit of 100 (Meyer et al.
/// 1985).
pub(super) const PURSUIT_DEG_S: [f64; 2] = [5.0, 20.0];

/// Duration of a pursuit in seconds: uniform; chosen.
pub(super) const PURSUIT_S: [f64; 2] = [0.6, 1.5];

/// Share of a pursued object's path that the head turns; chosen.
pub(super) const PURSUIT_HEAD: f64 = 0.6;

/// Offset of the eyes from the axis of the neck in metres: above and ahead. Oculus SDK,
/// `OVR_DEFAULT_NECK_TO_EYE_VERTICAL` and `_HORIZONTAL`.
pub(super) const NECK_TO_EYE_M: [f64; 2] = [0.075, 0.0805];

/// Distance in metres of a point ahead at which the head of a walking person keeps aiming. The head pitches and yaws to
/// compensate for the vertical and sideways motion of the steps (Imai et al. 2001). The value is chosen; Hirasaki et
/// al. 1999 measured distances of this order.
pub(super) const HEAD_FIXATION_M: f64 = 1.0;

/// A rotation of the head: ground truth behind the samples. Turns may overlap; their angles then add up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadTurn {
    /// Begin in seconds.
    pub start_s: f64,
    /// End in seconds.
    pub end_s: f64,
    /// To the left and upwards, in degrees.
    pub by_deg: [f64; 2],
    /// Angles to the left and upwards, in degrees, to the target from the planned resting direction of the head.
    pub error_deg: [f64; 2],
    /// Begin of the gaze shift or pursuit that it belongs to, in seconds.
    pub gaze_start_s: f64,
}

/// A rest of the gaze on a point of the space: ground truth behind the samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Regarded {
    /// Begin in seconds.
    pub start_s: f64,
    /// End in seconds. The last may end after the last sample.
    pub end_s: f64,
    /// The point at the begin, in metres.
    pub point_m: [f64; 3],
    /// Its velocity in metres a second; 0 unless it is pursued.
    pub velocity_m_s: [f64; 3],
}
