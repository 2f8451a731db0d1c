//! Dynamic resolution: the share of the pixels that keeps a frame's time.

use crate::error::{SettingsError, check};

/// Frames from a change of the share to the first measurement of a frame that has it.
const LATENCY: u32 = 4;
/// The share grows below this part of the target, and shrinks above the target.
const CALM: f32 = 0.85;
/// Part of the target that a change aims at.
const AIM: f32 = 0.95;
/// Largest growth in one step.
const GROWTH: f32 = 1.2;

/// Controller of [`Shading`](super::Shading)'s share, for a steady frame time on a load that changes.
///
/// It ignores single slow frames, waits until a change has had its effect, and changes nothing between 85 and 100 % of
/// the target. A frame's time grows at most in proportion to its share, so that a growing share never misses the
/// target, and a shrinking one never falls below what it must grow from: on a constant load the share does not
/// oscillate.
///
/// ```
/// use afterimage::{ShareControl, Shading};
///
/// let mut control = ShareControl::new(16.0, [0.1, 0.5])?;
/// // Each frame, with the time of the last one that a GPU has finished. Here they take 40 ms at first.
/// let share = (0..20).map(|_| control.share_for(40.0)).last().unwrap();
/// assert_eq!(share, 0.1);
/// let shading = Shading::Everywhere { share };
/// # let _ = shading;
/// # Ok::<(), afterimage::SettingsError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ShareControl {
    target_ms: f32,
    least: f32,
    most: f32,
    share: f32,
    /// The last three measurements, the newest last.
    last_ms: [f32; 3],
    /// Frames until a measurement counts.
    wait: u32,
}

impl ShareControl {
    /// A controller for frames of `target_ms`, with shares from `range[0]` to `range[1]`; it begins with the latter.
    ///
    /// # Errors
    /// [`SettingsError`] if the target is not above 0 and finite, or the range is not within 0.05 to 1 and ordered.
    pub fn new(target_ms: f32, range: [f32; 2]) -> Result<Self, SettingsError> {
        let [least, most] = range;
        check("target_ms", target_ms, f32::MIN_POSITIVE..=f32::MAX, "ms")?;
        check("most", most, 0.05..=1.0, "of the pixels")?;
        check("least", least, 0.05..=most, "of the pixels")?;
        Ok(Self { target_ms, least, most, share: most, last_ms: [f32::NAN; 3], wait: LATENCY })
    }

    /// The share at present.
    pub fn share(&self) -> f32 {
        self.share
    }

    /// Goes on from another share, within the range, as after frames without this controller.
    pub fn set_share(&mut self, share: f32) {
        let share = share.max(self.least).min(self.most);
        (self.share, self.wait, self.last_ms) = (share, LATENCY, [f32::NAN; 3]);
    }

    /// The share for the next frame. `measured_ms`: time of the last finished frame; one that is not above 0 and finite
    /// counts as missing.
    pub fn share_for(&mut self, measured_ms: f32) -> f32 {
        if !(measured_ms.is_finite() && measured_ms > 0.0) {
            return self.share;
        }
        self.last_ms = [self.last_ms[1], self.last_ms[2], measured_ms];
        self.wait = self.wait.saturating_sub(1);
        let [a, b, c] = self.last_ms;
        // The median; not a number before there are three.
        let median = a.min(b).max(a.max(b).min(c));
        let load = median / self.target_ms;
        if self.wait == 0 && (a + b).is_finite() && !(CALM..=1.0).contains(&load) {
            let share = (self.share * (AIM / load).min(GROWTH)).clamp(self.least, self.most);
            if share != self.share {
                (self.share, self.wait, self.last_ms) = (share, LATENCY, [f32::NAN; 3]);
            }
        }
        self.share
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Frames of a renderer that takes `fixed + slope * share` ms, three frames after a share was asked for: shares and
    /// times.
    fn run(frames: usize, mut load: impl FnMut(usize) -> [f32; 2], control: &mut ShareControl) -> Vec<[f32; 2]> {
        let mut asked = vec![control.share; 3];
        let mut made: Vec<[f32; 2]> = vec![];
        for i in 0..frames {
            let share = asked[i];
            let [fixed, slope] = load(i);
            made.push([share, fixed + slope * share]);
            asked.push(control.share_for(made[i][1]));
        }
        made
    }

    /// Number of times that the share turns from growing to shrinking or back.
    fn turns(made: &[[f32; 2]]) -> usize {
        let steps: Vec<f32> = made.windows(2).map(|w| w[1][0] - w[0][0]).filter(|step| *step != 0.0).collect();
        steps.windows(2).filter(|w| w[0] * w[1] < 0.0).count()
    }

    fn control() -> ShareControl {
        ShareControl::new(16.0, [0.05, 1.0]).unwrap()
    }

    proptest! {
        #![proptest_config(afterimage_testing::property("share_control", 256))]

        #[test]
        fn a_constant_load_is_met_without_oscillation(fixed in 0.0_f32..15.0, slope in 0.1_f32..200.0, noise in 0.0_f32..0.04) {
            let mut draws = 1_u32;
            let made = run(400, |_| {
                draws = draws.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let factor = 1.0 + noise * ((draws >> 8) as f32 / (1 << 23) as f32 - 1.0);
                [fixed * factor, slope * factor]
            }, &mut control());
            prop_assert!(turns(&made) == 0, "{made:?}");
            let [share, time] = made[399];
            prop_assert!(time <= 16.0 * 1.001 || share == 0.05, "{share}: {time} ms");
            prop_assert!(time >= 16.0 * 0.8 || share == 1.0, "{share}: {time} ms");
        }

        #[test]
        fn a_change_of_load_is_followed(before in 5.0_f32..60.0, after in 5.0_f32..60.0) {
            let made = run(600, |i| [3.0, if i < 300 { before } else { after }], &mut control());
            prop_assert!(turns(&made) <= 1, "{made:?}");
            let late = made[300..].iter().position(|[share, time]| *time <= 16.0 || *share == 0.05);
            prop_assert!(late.is_some_and(|frames| frames <= 30), "{late:?} frames");
        }
    }

    #[test]
    fn single_slow_frames_change_nothing() {
        let made = run(300, |i| if i % 3 == 0 { [90.0, 15.5] } else { [0.0, 15.5] }, &mut control());
        assert!(made.iter().all(|[share, _]| *share == 1.0));
    }

    /// A load that alternates with the controller's own latency, the worst case of a controller without a memory.
    #[test]
    fn a_load_in_step_with_the_controller_does_not_make_it_swing() {
        for period in 1..24 {
            let made = run(2000, |i| [2.0, if i / period % 2 == 0 { 20.0 } else { 60.0 }], &mut control());
            let allowed = 2000 / period;
            assert!(turns(&made) <= allowed, "period {period}: {} turns of {allowed} changes", turns(&made));
            let over = made[100..].iter().filter(|[_, time]| *time > 48.0).count();
            assert!(over * 20 < made.len(), "period {period}: {over} frames of more than three times the target");
        }
    }

    #[test]
    fn another_share_stays_within_the_range_and_grows_from_there() {
        let mut control = ShareControl::new(16.0, [0.1, 0.5]).unwrap();
        for (asked, set) in [(0.2, 0.2), (0.0, 0.1), (7.0, 0.5), (f32::NAN, 0.1)] {
            control.set_share(asked);
            // A measurement of a frame before it does not count.
            assert_eq!(control.share_for(1.0), set);
        }
        assert!((0..20).map(|_| control.share_for(1.0)).last().unwrap() > 0.15);
    }

    #[test]
    fn missing_times_and_wrong_settings_are_refused() {
        let mut control = control();
        assert!([f32::NAN, -1.0, 0.0, f32::INFINITY].map(|ms| control.share_for(ms)).iter().all(|share| *share == 1.0));
        for (target, range) in [(f32::NAN, [0.1, 0.5]), (0.0, [0.1, 0.5]), (16.0, [0.5, 0.1]), (16.0, [0.0, 0.5])] {
            assert!(ShareControl::new(target, range).is_err(), "{target}, {range:?}");
        }
    }
}
