//! Animation curves: keyframes and interpolation.

use glam::DQuat;

/// Interpolation between keyframes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Interpolation {
    Step,
    Linear,
    /// Cubic Hermite spline; each key stores in-tangent, value and out-tangent.
    Cubic,
}

/// Values over time. The first key's value holds before it, the last key's after it.
#[derive(Clone, Debug)]
pub(crate) struct Curve {
    /// Seconds, ascending; at least one.
    pub times: Vec<f32>,
    /// `width` numbers per key, three times as many with [`Interpolation::Cubic`].
    pub values: Vec<f32>,
    pub width: usize,
    pub interpolation: Interpolation,
}

/// Position of a time among the keys.
enum Place {
    At(usize),
    Between { key: usize, share: f64, seconds: f64 },
}

impl Curve {
    fn place(&self, time_s: f64) -> Place {
        let next = self.times.partition_point(|&t| f64::from(t) <= time_s);
        if next == 0 {
            return Place::At(0);
        }
        let key = next - 1;
        if next == self.times.len() || self.interpolation == Interpolation::Step {
            return Place::At(key);
        }
        let start = f64::from(self.times[key]);
        let seconds = f64::from(self.times[next]) - start;
        Place::Between { key, share: (time_s - start) / seconds, seconds }
    }

    /// Component `i` of a key's in-tangent (`part` 0), value (1) or out-tangent (2).
    fn stored(&self, key: usize, part: usize, i: usize) -> f64 {
        let at = match self.interpolation {
            Interpolation::Cubic => (key * 3 + part) * self.width,
            _ => key * self.width,
        };
        f64::from(self.values[at + i])
    }

    /// Component `i` of the value at a time.
    pub fn component(&self, time_s: f64, i: usize) -> f64 {
        match self.place(time_s) {
            Place::At(key) => self.stored(key, 1, i),
            Place::Between { key, share: t, seconds } => {
                let (from, to) = (self.stored(key, 1, i), self.stored(key + 1, 1, i));
                if self.interpolation == Interpolation::Linear {
                    return from + (to - from) * t;
                }
                // glTF 2.0, appendix C.5.
                let (away, towards) = (self.stored(key, 2, i) * seconds, self.stored(key + 1, 0, i) * seconds);
                let (t2, t3) = (t * t, t * t * t);
                (2.0 * t3 - 3.0 * t2 + 1.0) * from
                    + (t3 - 2.0 * t2 + t) * away
                    + (3.0 * t2 - 2.0 * t3) * to
                    + (t3 - t2) * towards
            }
        }
    }

    /// The first `N` components of the value at a time.
    pub fn components<const N: usize>(&self, time_s: f64) -> [f64; N] {
        std::array::from_fn(|i| self.component(time_s, i))
    }

    /// Unit rotation at a time; linear interpolation follows the shorter arc.
    pub fn rotation(&self, time_s: f64) -> DQuat {
        let at = |key| unit(DQuat::from_array(std::array::from_fn(|i| self.stored(key, 1, i))));
        match self.place(time_s) {
            Place::Between { key, share, .. } if self.interpolation == Interpolation::Linear => {
                at(key).slerp(at(key + 1), share)
            }
            _ => unit(DQuat::from_array(self.components(time_s))),
        }
    }
}

/// A normalised quaternion; the identity if it has no finite length above 0.
pub(crate) fn unit(q: DQuat) -> DQuat {
    let length = q.length();
    if length.is_finite() && length > 0.0 { q / length } else { DQuat::IDENTITY }
}
