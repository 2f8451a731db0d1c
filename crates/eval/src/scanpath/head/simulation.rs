//! Simulation of head and eye: gaze shifts in space, and rests on points of it.

use super::coordination::{
    AZIMUTH_DEG, ELEVATION_DEG, EYE_ALONE_DEG, EYE_LIMIT_DEG, HEAD_GAIN, HEAD_LAG_S, HEAD_VERTICAL, HeadTurn,
    PURSUIT_DEG_S, PURSUIT_GAIN, PURSUIT_HEAD, PURSUIT_S, RETURN_S, Regarded, SHIFT_DEG, SHIFT_SCALE_DEG,
    VERTICAL_SHARE,
};
use super::neck::Neck;
use super::options::{DistanceOf, HeadOptions};
use crate::scanpath::kinematics::{
    angle_deg, any_direction, axes, drifted, main_sequence_s, minimum_jerk, tangent_towards, truncated_exponential,
    turn, uniform, unit,
};
use crate::scanpath::pose::HeadPose;
use crate::scanpath::viewing::{
    CORRECT_ABOVE_DEG, Event, EventKind, FIXATION_S, LANDING_S, MICROSACCADE_DEG, MICROSACCADE_HZ, UNDERSHOOT,
};
use glam::{DQuat, DVec2, DVec3};
use rand::SeedableRng;
use rand_pcg::Pcg64;
use std::f64::consts::TAU;

/// Attempts to draw a target in the field before the gaze returns towards its middle.
const AIM_TRIES: usize = 64;
/// Longest step in seconds in which slip is integrated: the head turns by less than half a degree in it.
const STEP_S: f64 = 0.002;
/// Distances in metres of points to look at. A walking person would pass a surface nearer than the lower limit within a
/// fixation. Beyond the upper limit, translation does not matter.
const DISTANCE_M: [f64; 2] = [0.4, 1000.0];
/// Points in time at which a gaze shift is checked against the eye's range.
const FLIGHT_CHECKS: u32 = 32;
/// Halvings of the interval that holds a shift's duration: to less than a microsecond.
const FLIGHT_HALVINGS: u32 = 20;

/// A point that stands still or moves uniformly.
#[derive(Clone, Copy)]
struct Thing {
    start_s: f64,
    point: DVec3,
    velocity: DVec3,
}

impl Thing {
    fn at(&self, time_s: f64) -> DVec3 {
        self.point + self.velocity * (time_s - self.start_s)
    }
}

/// One sample: seconds, tangents of the gaze in the head (right, down), pose.
pub(super) type HeadSample = (f64, [f64; 2], HeadPose);

/// State of the simulation. Directions are unit vectors of the space: x right, y up, -z ahead.
pub(super) struct Simulation<'a, T: Iterator<Item = f64>> {
    rng: Pcg64,
    options: HeadOptions,
    distance_of: DistanceOf<'a>,
    times: std::iter::Peekable<T>,
    neck: Neck,
    now_s: f64,
    gaze: DVec3,
    thing: Thing,
    pub(super) samples: Vec<HeadSample>,
    pub(super) events: Vec<Event>,
    pub(super) turns: Vec<HeadTurn>,
    pub(super) regarded: Vec<Regarded>,
}

impl<'a, T: Iterator<Item = f64>> Simulation<'a, T> {
    pub(super) fn new(options: HeadOptions, distance_of: DistanceOf<'a>, times: T) -> Self {
        let mut simulation = Self {
            rng: Pcg64::seed_from_u64(options.seed),
            options,
            distance_of,
            times: times.peekable(),
            neck: Neck::new(options.is_walking),
            now_s: 0.0,
            gaze: DVec3::NEG_Z,
            thing: Thing { start_s: 0.0, point: DVec3::NEG_Z, velocity: DVec3::ZERO },
            samples: vec![],
            events: vec![],
            turns: vec![],
            regarded: vec![],
        };
        simulation.thing = simulation.seen_along(DVec3::NEG_Z);
        simulation
    }

    /// Whether all samples are recorded.
    pub(super) fn done(&mut self) -> bool {
        self.times.peek().is_none()
    }

    /// Fixates the point of the space, or pursues it when it moves.
    pub(super) fn rest(&mut self) {
        if unit(&mut self.rng) < self.options.pursuits {
            self.pursue();
        } else {
            self.fixate();
        }
    }

    /// Fixates the point of the space for a while, with at most one microsaccade, which ends on a point nearby.
    fn fixate(&mut self) {
        let rest_s = uniform(&mut self.rng, FIXATION_S);
        let (start_s, start) = (self.now_s, self.gaze);
        let end_s = start_s + rest_s;
        if unit(&mut self.rng) < MICROSACCADE_HZ * rest_s {
            let amplitude_deg = uniform(&mut self.rng, MICROSACCADE_DEG);
            let onset_s = start_s + uniform(&mut self.rng, [0.0, rest_s - main_sequence_s(amplitude_deg)]);
            self.rest_until(onset_s);
            let towards = any_direction(&mut self.rng, self.gaze);
            let aside = self.seen_along(turn(self.gaze, towards, amplitude_deg));
            self.shift_to(EventKind::Microsaccade, aside, amplitude_deg);
        }
        self.rest_until(end_s);
        self.note(EventKind::Fixation, start_s, start);
    }

    /// Pursues an object that begins to move at the point of gaze.
    fn pursue(&mut self) {
        let (start_s, start) = (self.now_s, self.gaze);
        let duration_s = uniform(&mut self.rng, PURSUIT_S);
        let speed_deg_s = uniform(&mut self.rng, PURSUIT_DEG_S);
        let (right, down) = axes(self.gaze);
        // The direction is mostly sideways, and towards the middle of the field.
        let slant = uniform(&mut self.rng, [-VERTICAL_SHARE, VERTICAL_SHARE]);
        let side = if right.dot(DVec3::NEG_Z) >= 0.0 { 1.0 } else { -1.0 };
        let along = (right * side + down * slant).normalize();
        let eye = self.neck.pose(start_s).0;
        let point = self.thing.at(start_s);
        let velocity = along * (speed_deg_s.to_radians() * point.distance(eye));
        let from_deg = azimuth_elevation_deg(self.gaze);
        self.thing = Thing { start_s, point, velocity };
        let to_deg = azimuth_elevation_deg(self.ideal(start_s + duration_s));
        let way_deg = to_deg - from_deg;
        let by_deg = way_deg * PURSUIT_HEAD;
        let end_s = self.neck.turn_in(start_s, duration_s, by_deg);
        self.note_turn([start_s, end_s], by_deg, way_deg, start_s);
        self.rest_until(start_s + duration_s);
        self.note(EventKind::Pursuit, start_s, start);
    }

    /// Shifts the gaze to a new target. If the shift falls too short, a landing and a corrective follow.
    pub(super) fn look_elsewhere(&mut self) {
        let (towards, intended_deg) = self.choose_target();
        let target = self.seen_along(turn(self.gaze, towards, intended_deg));
        self.turn_head_to(&target);
        let reached_deg = intended_deg * (1.0 - uniform(&mut self.rng, UNDERSHOOT));
        if intended_deg - reached_deg <= CORRECT_ABOVE_DEG {
            self.shift_to(EventKind::Saccade, target, intended_deg);
            return;
        }
        let short = self.seen_along(turn(self.gaze, towards, reached_deg));
        self.shift_to(EventKind::Saccade, short, intended_deg);
        let (start_s, start) = (self.now_s, self.gaze);
        let until_s = start_s + uniform(&mut self.rng, LANDING_S);
        self.rest_until(until_s);
        self.note(EventKind::Landing, start_s, start);
        let left_deg = angle_deg(self.gaze, (target.at(self.now_s) - self.neck.pose(self.now_s).0).normalize());
        self.shift_to(EventKind::Corrective, target, left_deg);
    }

    /// Direction and amplitude in degrees of a shift that ends in the field.
    fn choose_target(&mut self) -> (DVec3, f64) {
        for _ in 0..AIM_TRIES {
            let amplitude_deg = truncated_exponential(unit(&mut self.rng), SHIFT_SCALE_DEG, SHIFT_DEG);
            let (sin, cos) = (TAU * unit(&mut self.rng)).sin_cos();
            let (right, down) = axes(self.gaze);
            let towards = (right * cos + down * (VERTICAL_SHARE * sin)).normalize();
            let [azimuth, elevation] = azimuth_elevation_deg(turn(self.gaze, towards, amplitude_deg)).to_array();
            if azimuth.abs() <= AZIMUTH_DEG && (ELEVATION_DEG[0]..=ELEVATION_DEG[1]).contains(&elevation) {
                return (towards, amplitude_deg);
            }
        }
        (tangent_towards(self.gaze, DVec3::NEG_Z), SHIFT_DEG[0])
    }

    /// The point that is seen in a direction.
    fn seen_along(&self, direction: DVec3) -> Thing {
        let eye = self.neck.pose(self.now_s).0;
        let distance_m = (self.distance_of)(eye.to_array(), direction.to_array()).filter(|d| !d.is_nan());
        let distance_m = distance_m.unwrap_or(f64::INFINITY).clamp(DISTANCE_M[0], DISTANCE_M[1]);
        Thing { start_s: self.now_s, point: eye + direction * distance_m, velocity: DVec3::ZERO }
    }

    /// Plans the turn of the head in a gaze shift: the part of the target's angle that the eye does not cover alone.
    /// The angle is measured from the planned resting direction of the head (Goossens & Van Opstal 1997).
    fn turn_head_to(&mut self, target: &Thing) {
        let eye = self.neck.pose(self.now_s).0;
        let error_deg = azimuth_elevation_deg((target.point - eye).normalize()) - self.neck.goal_deg();
        // Both numbers are always drawn, so that the same seed gives the same shifts in other surroundings.
        let beyond_deg = error_deg.length() - uniform(&mut self.rng, EYE_ALONE_DEG);
        let lag_s = uniform(&mut self.rng, HEAD_LAG_S);
        if beyond_deg <= 0.0 {
            return;
        }
        let by_deg = error_deg.normalize() * (HEAD_GAIN * beyond_deg) * DVec2::new(1.0, HEAD_VERTICAL);
        let start_s = self.now_s + lag_s;
        let end_s = self.neck.turn(start_s, by_deg);
        self.note_turn([start_s, end_s], by_deg, error_deg, self.now_s);
    }

    /// Direction from the eyes to the point that is looked at.
    fn ideal(&self, time_s: f64) -> DVec3 {
        (self.thing.at(time_s) - self.neck.pose(time_s).0).normalize()
    }

    /// Rests on the point: slip, slow return and drift.
    fn rest_until(&mut self, until_s: f64) {
        let start_s = self.now_s;
        while self.now_s < until_s {
            let sample_s = self.times.peek().copied().filter(|t| *t < until_s);
            let next_s = (self.now_s + STEP_S).min(until_s).min(sample_s.unwrap_or(f64::INFINITY));
            self.stabilize(next_s);
            if sample_s == Some(next_s) {
                self.times.next();
                self.write(next_s, self.gaze);
            }
        }
        let (point_m, velocity_m_s) = (self.thing.at(start_s).to_array(), self.thing.velocity.to_array());
        self.regarded.push(Regarded { start_s, end_s: until_s, point_m, velocity_m_s });
        self.neck.forget(self.now_s);
    }

    /// Eye movements up to `next_s` that keep gaze on the point.
    fn stabilize(&mut self, next_s: f64) {
        let (before_s, step_s) = (self.now_s, next_s - self.now_s);
        let ((eye0, turned0), (eye, turned)) = (self.neck.pose(before_s), self.neck.pose(next_s));
        let (point0, point) = (self.thing.at(before_s), self.thing.at(next_s));
        let was = (point0 - eye0).normalize();
        let moved = (point0 - eye).normalize();
        let ideal = (point - eye).normalize();
        // In the head, the eye turns by -gain times the head's rotation. In space, it turns by the rest, (1 - gain)
        // times the head's rotation.
        let slip = scaled(turned * turned0.inverse(), 1.0 - self.options.rotation_gain);
        let translation = scaled(DQuat::from_rotation_arc(was, moved), self.options.translation_gain);
        let pursuit = scaled(DQuat::from_rotation_arc(moved, ideal), PURSUIT_GAIN);
        let gaze = (pursuit * translation * slip * self.gaze).normalize();
        let back = 1.0 - (-step_s / RETURN_S).exp();
        let gaze = turn(gaze, tangent_towards(gaze, ideal), angle_deg(gaze, ideal) * back);
        self.gaze = if self.options.drifts { drifted(&mut self.rng, gaze, step_s) } else { gaze };
        self.now_s = next_s;
    }

    /// Moves the gaze onto a point. The vestibulo-ocular reflex is off in large shifts and compensated in small ones
    /// (Guitton & Volle 1987), so the plan describes the gaze in space, not the eye in the head.
    fn shift_to(&mut self, kind: EventKind, to: Thing, intended_deg: f64) {
        let (start_s, start) = (self.now_s, self.gaze);
        self.thing = to;
        let duration_s = self.flight_s(start);
        let end_s = start_s + duration_s;
        while let Some(t_s) = self.times.next_if(|t| *t < end_s) {
            self.write(t_s, self.flown(start, t_s, (t_s - start_s) / duration_s));
        }
        self.now_s = end_s;
        self.gaze = self.ideal(end_s);
        let amplitude_deg = angle_deg(start, self.gaze);
        self.events.push(Event { kind, start_s, end_s, amplitude_deg, intended_deg });
    }

    /// Gaze at the share `u` of a shift's duration.
    fn flown(&self, start: DVec3, time_s: f64, u: f64) -> DVec3 {
        let ideal = self.ideal(time_s);
        turn(start, tangent_towards(start, ideal), angle_deg(start, ideal) * minimum_jerk(u))
    }

    /// Duration of a shift in seconds: the main sequence of the eye, or longer until the eye stays within its range.
    fn flight_s(&self, start: DVec3) -> f64 {
        let is_in_range = |duration_s: f64| {
            (0..=FLIGHT_CHECKS).all(|i| {
                let u = f64::from(i) / f64::from(FLIGHT_CHECKS);
                let time_s = self.now_s + u * duration_s;
                angle_deg(self.neck.ahead(time_s), self.flown(start, time_s, u)) <= EYE_LIMIT_DEG
            })
        };
        let mut short_s = main_sequence_s(angle_deg(start, self.ideal(self.now_s)));
        if is_in_range(short_s) {
            return short_s;
        }
        let mut long_s = short_s + (self.neck.rests_s() - self.now_s).max(0.0);
        for _ in 0..FLIGHT_HALVINGS {
            let middle_s = 0.5 * (short_s + long_s);
            if is_in_range(middle_s) { long_s = middle_s } else { short_s = middle_s }
        }
        long_s
    }

    fn note(&mut self, kind: EventKind, start_s: f64, start: DVec3) {
        let moved_deg = angle_deg(start, self.gaze);
        self.events.push(Event { kind, start_s, end_s: self.now_s, amplitude_deg: moved_deg, intended_deg: moved_deg });
    }

    fn note_turn(&mut self, [start_s, end_s]: [f64; 2], by_deg: DVec2, error_deg: DVec2, gaze_start_s: f64) {
        let (by_deg, error_deg) = (by_deg.to_array(), error_deg.to_array());
        self.turns.push(HeadTurn { start_s, end_s, by_deg, error_deg, gaze_start_s });
    }

    fn write(&mut self, t_s: f64, gaze: DVec3) {
        let (eye, orientation) = self.neck.pose(t_s);
        let pose = HeadPose::new(eye, orientation);
        let in_head = orientation.inverse() * gaze;
        // Gaze stays within the eye's range of 45 degrees, except for a little slip.
        let ahead = -in_head.z;
        self.samples.push((t_s, [in_head.x / ahead, -in_head.y / ahead], pose));
    }
}

/// A rotation by a multiple of its angle.
fn scaled(rotation: DQuat, by: f64) -> DQuat {
    DQuat::from_scaled_axis(rotation.to_scaled_axis() * by)
}

/// Angles of a direction to the left and upwards.
fn azimuth_elevation_deg(direction: DVec3) -> DVec2 {
    let azimuth = (-direction.x).atan2(-direction.z);
    DVec2::new(azimuth.to_degrees(), direction.y.clamp(-1.0, 1.0).asin().to_degrees())
}
