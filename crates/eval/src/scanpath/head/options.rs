//! Options of a generated head and eye, and the surroundings that they look at.

use super::coordination::{ROTATION_GAIN, TRANSLATION_GAIN};
use crate::error::InputError;
use crate::scanpath::sample_times::check_times;

/// Distance in metres from a point to the surface that is seen in a direction, a unit vector; `None` if there is no
/// surface. Both are in the space of [`HeadPose`](crate::scanpath::HeadPose).
pub type DistanceOf<'a> = &'a dyn Fn([f64; 3], [f64; 3]) -> Option<f64>;

/// Options of [`generate_head`](super::generate_head).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadOptions {
    /// Seed. The same seed gives the same scanpath, bit for bit on one platform.
    pub seed: u64,
    /// Duration in seconds, above 0; default 60. `duration_s * rate_hz` is at most ten million.
    pub duration_s: f64,
    /// Samples per second, 1 to 10,000; default 500.
    pub rate_hz: f64,
    /// Whether the person walks, as [`gait`](crate::source::gait) describes; default: stands.
    pub is_walking: bool,
    /// Share of the gaze shifts that end on a moving object, which is then pursued, 0 to 1; default 0: nothing moves.
    pub pursuits: f64,
    /// Share of the head's rotation that the eye compensates at once (vestibulo-ocular reflex); default 0.98, 1 is
    /// perfect. -1 to 2.
    pub rotation_gain: f64,
    /// The same for the head's translation; default 0.6. -1 to 2.
    pub translation_gain: f64,
    /// Whether the gaze drifts; default: it does.
    pub drifts: bool,
}

impl Default for HeadOptions {
    fn default() -> Self {
        Self {
            seed: 0,
            duration_s: 60.0,
            rate_hz: 500.0,
            is_walking: false,
            pursuits: 0.0,
            rotation_gain: ROTATION_GAIN,
            translation_gain: TRANSLATION_GAIN,
            drifts: true,
        }
    }
}

impl HeadOptions {
    /// Checks every option.
    ///
    /// # Errors
    /// [`Request`](InputError::Request) for the first option that is out of range.
    pub fn validate(&self) -> Result<(), InputError> {
        let fault = |option: &str, found: String, remedy: &str| {
            Err(InputError::request(format!("synthetic head, {option}"), found, remedy))
        };
        check_times("synthetic head", self.duration_s, self.rate_hz)?;
        if !(0.0..=1.0).contains(&self.pursuits) {
            return fault("pursuits", self.pursuits.to_string(), "expected a share from 0 to 1");
        }
        for (option, gain) in [("rotation gain", self.rotation_gain), ("translation gain", self.translation_gain)] {
            if !(-1.0..=2.0).contains(&gain) {
                return fault(option, gain.to_string(), "expected -1 to 2, 1 for a perfect reflex");
            }
        }
        Ok(())
    }
}

/// Distances in a room that is 6 m wide, 3 m high and 12 m long: surroundings for scanpaths without a scene. The eyes
/// are 1.6 m above the floor and 3 m in front of the rear wall, and look along the room.
pub fn in_a_room(from: [f64; 3], direction: [f64; 3]) -> Option<f64> {
    const LEAST: [f64; 3] = [-3.0, -1.6, -9.0];
    const MOST: [f64; 3] = [3.0, 1.4, 3.0];
    let wall = |axis: usize| {
        let to = if direction[axis] > 0.0 { MOST[axis] } else { LEAST[axis] };
        if direction[axis] == 0.0 { f64::INFINITY } else { (to - from[axis]) / direction[axis] }
    };
    let nearest = (0..3).map(wall).fold(f64::INFINITY, f64::min);
    (nearest.is_finite() && nearest >= 0.0).then_some(nearest)
}
