//! Chooses a lower resolution for a software device that is too slow.

use std::collections::VecDeque;

/// Frame rate below which the resolution is lowered: 10 frames a second, and a tenth more for work outside the passes.
const MIN_FPS: f64 = 11.0;
/// Factors on the input's resolution.
const SCALES: [f32; 5] = [1.0, 0.75, 0.5, 0.375, 0.25];
/// Frames after a change that do not count: pipelines are compiled at their first use.
const WARM_UP: usize = 4;
/// Number of frames in the statistic.
const WINDOW: usize = 12;

/// Times of the last frames.
#[derive(Clone, Debug, Default)]
pub struct AutoScale {
    warm: usize,
    ms: VecDeque<f64>,
}

impl AutoScale {
    /// Adds a frame's milliseconds at `scale`. Returns a lower scale if frames at this one are too slow.
    pub fn push(&mut self, ms: f64, scale: f32) -> Option<f32> {
        if self.warm < WARM_UP {
            self.warm += 1;
            return None;
        }
        self.ms.push_back(ms);
        if self.ms.len() < WINDOW {
            return None;
        }
        let typical = self.typical_ms();
        self.ms.pop_front();
        let budget = 1e3 / MIN_FPS;
        if typical <= budget {
            return None;
        }
        // Time is proportional to the number of pixels. If that estimate is too low, later frames lower the scale
        // again.
        let expected = |to: f32| typical * f64::from(to / scale).powi(2);
        let mut lower = SCALES.into_iter().filter(|s| *s < scale);
        lower.clone().find(|s| expected(*s) <= budget).or(lower.next_back())
    }

    /// Lower quartile of the last frames' milliseconds: a second of other load on the machine does not change it.
    pub fn typical_ms(&self) -> f64 {
        let mut sorted: Vec<f64> = self.ms.iter().copied().collect();
        sorted.sort_by(f64::total_cmp);
        sorted.get(sorted.len() / 4).copied().unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The final scale for a device that takes `ms` per frame at full scale.
    fn settled(ms: f64) -> f32 {
        let (mut scale, mut auto_scale) = (1.0, AutoScale::default());
        for _ in 0..200 {
            if let Some(lower) = auto_scale.push(ms * f64::from(scale).powi(2) + 5.0, scale) {
                (scale, auto_scale) = (lower, AutoScale::default());
            }
        }
        scale
    }

    #[test]
    fn a_device_that_keeps_up_is_left_alone_and_a_slow_one_helped() {
        assert_eq!([80.0, 120.0, 300.0, 500.0, 1e5].map(settled), [1.0, 0.75, 0.5, 0.375, 0.25]);
    }

    #[test]
    fn slow_frames_now_and_then_change_nothing() {
        let mut auto_scale = AutoScale::default();
        assert!((0..100).all(|i| auto_scale.push(if i < 4 || i % 16 < 8 { 900.0 } else { 20.0 }, 1.0).is_none()));
    }
}
