//! Camera path that follows the poses of a head.

use super::{HeadPose, Scanpath};
use crate::error::InputError;
use std::sync::Arc;

/// Poses of a head at any time, from a scanpath that has them.
#[derive(Clone, Debug, PartialEq)]
pub struct HeadPath {
    path: Arc<Scanpath>,
    start_s: f64,
}

impl HeadPath {
    /// The poses of `path` from `start_s` seconds after its first sample on.
    ///
    /// # Errors
    /// [`Request`](InputError::Request) if the scanpath has no poses, or `start_s` is not within it.
    pub fn new(path: Arc<Scanpath>, start_s: f64) -> Result<Self, InputError> {
        if path.poses().is_none() {
            return Err(InputError::request(
                path.name(),
                "has no poses of the head",
                "give a scanpath with the columns head_x_m to head_qw, or a synthetic one",
            ));
        }
        if !(start_s >= 0.0 && start_s <= path.duration_s()) {
            return Err(InputError::request(
                "start",
                format!("{start_s} s is not within {}", path.name()),
                format!("expected 0 to {} s", path.duration_s()),
            ));
        }
        Ok(Self { path, start_s })
    }

    /// The scanpath.
    pub fn scanpath(&self) -> &Arc<Scanpath> {
        &self.path
    }

    /// Pose at a time in seconds after the start: between the two samples around it, straight and at a constant speed.
    /// Before the first sample it is the first pose, and after the last sample the last pose.
    pub fn pose(&self, time_s: f64) -> HeadPose {
        let (samples, poses) = (self.path.samples(), self.path.poses().expect("checked when made"));
        let now_s = samples[0].t_s + self.start_s + time_s;
        let after = samples.partition_point(|s| s.t_s <= now_s);
        if after == 0 || after == samples.len() {
            return poses[after.min(samples.len() - 1)];
        }
        let [from, to] = [after - 1, after].map(|i| samples[i].t_s);
        poses[after - 1].towards(&poses[after], (now_s - from) / (to - from))
    }
}
