//! Head of a walking person, as an offset from a pose at rest.

use std::f64::consts::TAU;

/// Speed in m/s, and the seconds after which the walk turns back.
const SPEED_M_S: f64 = 0.9;
const LEG_S: f64 = 3.0;
/// The head looks left and right, nods with every step and rolls with every second one; degrees. The largest angular
/// speeds are 45, 57 and 31 degrees per second.
const YAW: Swing = Swing { most: 45.0 / (0.5 * TAU), hz: 0.5 };
const NOD: Swing = Swing { most: 4.5, hz: 2.0 };
const ROLL: Swing = Swing { most: 5.0, hz: 1.0 };
/// Amplitudes in metres: the head rises with every step and sways with every second one.
const BOB: Swing = Swing { most: 0.03, hz: 2.0 };
const SWAY: Swing = Swing { most: 0.02, hz: 1.0 };

/// Harmonic oscillation through 0 at time 0.
#[derive(Clone, Copy, Debug)]
struct Swing {
    most: f64,
    hz: f64,
}

impl Swing {
    fn at(self, time_s: f64) -> f64 {
        self.most * (self.hz * TAU * time_s).sin()
    }
}

/// Position and rotation of the head: moved in level directions, then yawed, nodded and rolled in that order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Head {
    /// Forwards, in metres.
    pub ahead_m: f64,
    /// To the right, in metres.
    pub right_m: f64,
    /// Upwards, in metres.
    pub up_m: f64,
    /// To the left, in radians.
    pub yaw: f64,
    /// Upwards, in radians.
    pub nod: f64,
    /// Anticlockwise, seen from behind, in radians.
    pub roll: f64,
}

impl Head {
    /// The head `time_s` after the start of a walk: 0.9 m/s forwards for 3 s, then back, and so on.
    pub fn at(time_s: f64) -> Self {
        let there_and_back = time_s.rem_euclid(2.0 * LEG_S);
        Self {
            ahead_m: SPEED_M_S * there_and_back.min(2.0 * LEG_S - there_and_back),
            right_m: SWAY.at(time_s),
            up_m: BOB.at(time_s),
            yaw: YAW.at(time_s).to_radians(),
            nod: NOD.at(time_s).to_radians(),
            roll: ROLL.at(time_s).to_radians(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_walk_has_the_speeds_that_the_documents_state() {
        let (mut fastest, mut yaw, mut nod, mut roll) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
        let mut slowest = f64::INFINITY;
        for i in 0..60_000 {
            let t = f64::from(i) * 1e-4;
            let (a, b) = (Head::at(t), Head::at(t + 1e-4));
            let speed = (b.ahead_m - a.ahead_m).abs() / 1e-4;
            (fastest, slowest) = (fastest.max(speed), slowest.min(speed));
            let rate = |a: f64, b: f64| ((b - a) / 1e-4).to_degrees().abs();
            (yaw, nod, roll) =
                (yaw.max(rate(a.yaw, b.yaw)), nod.max(rate(a.nod, b.nod)), roll.max(rate(a.roll, b.roll)));
        }
        println!("{slowest:.3} to {fastest:.3} m/s, yaw {yaw:.2}, nod {nod:.2}, roll {roll:.2} degrees/s");
        assert!((fastest - 0.9).abs() < 1e-6 && (slowest - 0.9).abs() < 1e-6);
        assert!((yaw - 45.0).abs() < 0.01 && (nod - 56.5).abs() < 0.1 && (roll - 31.4).abs() < 0.1);
    }

    #[test]
    fn a_walk_turns_back_after_three_seconds_and_never_jumps() {
        assert_eq!(Head::at(0.0), Head { ahead_m: 0.0, right_m: 0.0, up_m: 0.0, yaw: 0.0, nod: 0.0, roll: 0.0 });
        assert!((Head::at(3.0).ahead_m - 2.7).abs() < 1e-12 && Head::at(6.0).ahead_m.abs() < 1e-12);
        let positions: Vec<_> = (-600..3000).map(|i| Head::at(f64::from(i) / 60.0).ahead_m).collect();
        assert!(positions.iter().all(|p| (0.0..=2.7 + 1e-12).contains(p)));
        assert!(positions.windows(2).all(|w| (w[1] - w[0]).abs() <= 0.015 + 1e-12));
    }
}
