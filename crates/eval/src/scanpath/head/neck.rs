//! Motion of the head: turns that add up, the neck below the eyes, and gait.

use super::coordination::{HEAD_FIXATION_M, HEAD_TURN_S, NECK_TO_EYE_M};
use crate::scanpath::kinematics::minimum_jerk;
use crate::source::gait;
use glam::{DQuat, DVec2, DVec3};

/// One turn to the left and upwards, in degrees.
#[derive(Clone, Copy)]
struct Turn {
    start_s: f64,
    duration_s: f64,
    by_deg: DVec2,
}

/// Head of a person who stands or walks.
pub(super) struct Neck {
    is_walking: bool,
    /// Angles after the turns that are over.
    done_deg: DVec2,
    turns: Vec<Turn>,
}

impl Neck {
    pub(super) fn new(is_walking: bool) -> Self {
        Self { is_walking, done_deg: DVec2::ZERO, turns: vec![] }
    }

    /// Adds a turn whose duration follows from its amplitude; returns its end.
    pub(super) fn turn(&mut self, start_s: f64, by_deg: DVec2) -> f64 {
        self.turn_in(start_s, HEAD_TURN_S[0] + HEAD_TURN_S[1] * by_deg.length(), by_deg)
    }

    /// Adds a turn of this duration; returns its end.
    pub(super) fn turn_in(&mut self, start_s: f64, duration_s: f64, by_deg: DVec2) -> f64 {
        self.turns.push(Turn { start_s, duration_s, by_deg });
        start_s + duration_s
    }

    /// Angles to the left and upwards where the head rests after all turns, in degrees and without gait.
    pub(super) fn goal_deg(&self) -> DVec2 {
        self.done_deg + self.turns.iter().map(|t| t.by_deg).sum::<DVec2>()
    }

    /// Drops the turns that are over. Poses are requested only at `now_s` and later.
    pub(super) fn forget(&mut self, now_s: f64) {
        let is_over = |t: &Turn| t.start_s + t.duration_s <= now_s;
        self.done_deg += self.turns.iter().filter(|t| is_over(t)).map(|t| t.by_deg).sum::<DVec2>();
        self.turns.retain(|t| !is_over(t));
    }

    /// Time at which all turns are over.
    pub(super) fn rests_s(&self) -> f64 {
        self.turns.iter().map(|t| t.start_s + t.duration_s).fold(0.0, f64::max)
    }

    /// Place between the eyes and orientation at a time.
    pub(super) fn pose(&self, time_s: f64) -> (DVec3, DQuat) {
        let share = |t: &Turn| minimum_jerk(((time_s - t.start_s) / t.duration_s).clamp(0.0, 1.0));
        let angles = self.done_deg + self.turns.iter().map(|t| t.by_deg * share(t)).sum::<DVec2>();
        let (mut left, mut up) = (angles.x.to_radians(), angles.y.to_radians());
        let mut body = DVec3::ZERO;
        if self.is_walking {
            let step = gait::Head::at(time_s);
            body = DVec3::new(step.right_m, step.up_m, -step.ahead_m);
            left += (step.right_m / HEAD_FIXATION_M).atan();
            up -= (step.up_m / HEAD_FIXATION_M).atan();
        }
        // Azimuth about the vertical, then elevation about the ears, without roll: the head obeys Donders' law in these
        // coordinates of Fick's.
        let orientation = DQuat::from_rotation_y(left) * DQuat::from_rotation_x(up);
        let eyes = DVec3::new(0.0, NECK_TO_EYE_M[0], -NECK_TO_EYE_M[1]);
        (body + orientation * eyes - eyes, orientation)
    }

    /// Direction of the head's axis at a time.
    pub(super) fn ahead(&self, time_s: f64) -> DVec3 {
        self.pose(time_s).1 * DVec3::NEG_Z
    }
}
