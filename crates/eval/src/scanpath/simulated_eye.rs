//! Simulation of the eye for synthetic scanpaths: generates events, and samples the gaze at given times.

use super::kinematics::{
    angle_deg, any_direction, drifted, main_sequence_s, minimum_jerk, tangent_towards, truncated_exponential, turn,
    uniform, unit,
};
use super::viewing::{
    AIM_MARGIN_DEG, CORRECT_ABOVE_DEG, EDGE_MARGIN_DEG, Event, EventKind, FIXATION_S, LANDING_S, MICROSACCADE_DEG,
    MICROSACCADE_HZ, SACCADE_DEG, SACCADE_SCALE_DEG, UNDERSHOOT,
};
use glam::{DVec2, DVec3};
use rand::SeedableRng;
use rand_pcg::Pcg64;

/// Attempts to draw a direction (and amplitude) that stays on the screen, before the eye moves towards the middle
/// instead. Fewer attempts bias amplitudes in the corners of small screens towards short ones.
const AIM_TRIES: usize = 64;

/// Rectangle around the forward direction, by its half size in tangents.
#[derive(Clone, Copy)]
struct Field(DVec2);

impl Field {
    fn inset(half_deg: [f64; 2], margin_deg: f64) -> Self {
        Self(half_deg.map(|h| (h - margin_deg).to_radians().tan()).into())
    }

    fn contains(self, gaze: DVec3) -> bool {
        (gaze.truncate() / gaze.z).abs().cmple(self.0).all() && gaze.z > 0.0
    }
}

/// State of the simulation. Gaze is a unit vector: x right, y down, z forward.
pub(super) struct SimulatedEye<T: Iterator<Item = f64>> {
    rng: Pcg64,
    /// Allowed targets of saccades.
    aim: Field,
    /// Allowed gaze.
    edge: Field,
    times: std::iter::Peekable<T>,
    now_s: f64,
    gaze: DVec3,
    samples: Vec<(f64, [f64; 2])>,
    events: Vec<Event>,
}

impl<T: Iterator<Item = f64>> SimulatedEye<T> {
    pub(super) fn new(seed: u64, half_deg: [f64; 2], times: T) -> Self {
        let mut rng = Pcg64::seed_from_u64(seed);
        let aim = Field::inset(half_deg, AIM_MARGIN_DEG);
        let mut anywhere = |half: f64| uniform(&mut rng, [-half, half]);
        let gaze = DVec3::new(anywhere(aim.0.x), anywhere(aim.0.y), 1.0).normalize();
        Self {
            rng,
            aim,
            edge: Field::inset(half_deg, EDGE_MARGIN_DEG),
            times: times.peekable(),
            now_s: 0.0,
            gaze,
            samples: Vec::new(),
            events: Vec::new(),
        }
    }

    /// Whether all samples are recorded.
    pub(super) fn done(&mut self) -> bool {
        self.times.peek().is_none()
    }

    /// Samples as (seconds, tangents), and events by begin.
    pub(super) fn finish(mut self) -> (Vec<(f64, [f64; 2])>, Vec<Event>) {
        self.events.sort_by(|a, b| a.start_s.total_cmp(&b.start_s));
        (self.samples, self.events)
    }

    /// Simulates a fixation with at most one microsaccade.
    pub(super) fn fixate(&mut self) {
        let rest_s = uniform(&mut self.rng, FIXATION_S);
        let end_s = self.now_s + rest_s;
        let (start_s, start) = (self.now_s, self.gaze);
        if unit(&mut self.rng) < MICROSACCADE_HZ * rest_s {
            let amplitude_deg = uniform(&mut self.rng, MICROSACCADE_DEG);
            let free_s = rest_s - main_sequence_s(amplitude_deg);
            let onset_s = start_s + uniform(&mut self.rng, [0.0, free_s]);
            self.drift_until(onset_s);
            let towards = self.direction_inside(amplitude_deg);
            self.turn_by(EventKind::Microsaccade, towards, amplitude_deg, amplitude_deg);
        }
        self.drift_until(end_s);
        self.note_rest(EventKind::Fixation, start_s, start);
    }

    /// Simulates a saccade to a new target. If the saccade falls too short, a landing and a corrective follow.
    pub(super) fn look_elsewhere(&mut self) {
        let (towards, intended_deg) = self.choose_target();
        let target = turn(self.gaze, towards, intended_deg);
        let reached_deg = intended_deg * (1.0 - uniform(&mut self.rng, UNDERSHOOT));
        self.turn_by(EventKind::Saccade, towards, reached_deg, intended_deg);
        if intended_deg - reached_deg <= CORRECT_ABOVE_DEG {
            return;
        }
        let (start_s, start) = (self.now_s, self.gaze);
        let end_s = start_s + uniform(&mut self.rng, LANDING_S);
        self.drift_until(end_s);
        self.note_rest(EventKind::Landing, start_s, start);
        let left_deg = angle_deg(self.gaze, target);
        let towards = tangent_towards(self.gaze, target);
        self.turn_by(EventKind::Corrective, towards, left_deg, left_deg);
    }

    /// Direction and amplitude in degrees of a saccade that ends in the aim field.
    fn choose_target(&mut self) -> (DVec3, f64) {
        for _ in 0..AIM_TRIES {
            let amplitude_deg = truncated_exponential(unit(&mut self.rng), SACCADE_SCALE_DEG, SACCADE_DEG);
            let towards = any_direction(&mut self.rng, self.gaze);
            if self.aim.contains(turn(self.gaze, towards, amplitude_deg)) {
                return (towards, amplitude_deg);
            }
        }
        // The shortest saccade towards the middle ends in the field, because the field contains a circle of that radius
        // around the middle (`SyntheticOptions::validate`).
        (tangent_towards(self.gaze, DVec3::Z), SACCADE_DEG[0])
    }

    /// A direction in which a movement of `amplitude_deg` stays in the allowed field. The field is convex and wider
    /// than a microsaccade, so the direction towards the middle is always valid.
    fn direction_inside(&mut self, amplitude_deg: f64) -> DVec3 {
        for _ in 0..AIM_TRIES {
            let towards = any_direction(&mut self.rng, self.gaze);
            if self.edge.contains(turn(self.gaze, towards, amplitude_deg)) {
                return towards;
            }
        }
        tangent_towards(self.gaze, DVec3::Z)
    }

    /// Simulates Brownian drift up to `until_s`. Steps that would cross the edge are skipped.
    fn drift_until(&mut self, until_s: f64) {
        while let Some(t_s) = self.times.next_if(|t| *t < until_s) {
            self.drift_by(t_s - self.now_s);
            self.now_s = t_s;
            self.write(t_s, self.gaze);
        }
        self.drift_by(until_s - self.now_s);
        self.now_s = until_s;
    }

    fn drift_by(&mut self, step_s: f64) {
        let moved = drifted(&mut self.rng, self.gaze, step_s);
        if self.edge.contains(moved) {
            self.gaze = moved;
        }
    }

    /// Simulates a movement of `amplitude_deg` with the minimum-jerk profile.
    fn turn_by(&mut self, kind: EventKind, towards: DVec3, amplitude_deg: f64, intended_deg: f64) {
        let (start_s, start) = (self.now_s, self.gaze);
        let duration_s = main_sequence_s(amplitude_deg);
        let end_s = start_s + duration_s;
        while let Some(t_s) = self.times.next_if(|t| *t < end_s) {
            let u = (t_s - start_s) / duration_s;
            self.write(t_s, turn(start, towards, amplitude_deg * minimum_jerk(u)));
        }
        self.now_s = end_s;
        self.gaze = turn(start, towards, amplitude_deg);
        self.events.push(Event { kind, start_s, end_s, amplitude_deg, intended_deg });
    }

    fn note_rest(&mut self, kind: EventKind, start_s: f64, start: DVec3) {
        let moved_deg = angle_deg(start, self.gaze);
        self.events.push(Event { kind, start_s, end_s: self.now_s, amplitude_deg: moved_deg, intended_deg: moved_deg });
    }

    fn write(&mut self, t_s: f64, gaze: DVec3) {
        self.samples.push((t_s, (gaze.truncate() / gaze.z).into()));
    }
}
