//! Whether a software device keeps up, and at which resolution it would.

use std::collections::VecDeque;

/// Frames a second below which looking around is no pleasure: ten, and a tenth for what takes time besides the passes.
const LEAST_FPS: f64 = 11.0;
/// Shares of the input's resolution that are tried.
const SCALES: [f32; 5] = [1.0, 0.75, 0.5, 0.375, 0.25];
/// Frames after a change that are not judged: pipelines are compiled at their first use.
const WARM_UP: usize = 4;
/// Frames that are judged together.
const JUDGED: usize = 12;

/// Times of the last frames.
#[derive(Clone, Debug, Default)]
pub struct AutoScale {
    warm: usize,
    ms: VecDeque<f64>,
}

impl AutoScale {
    /// Takes a frame's milliseconds at `scale`. Gives the scale that is to be used instead, if this one is too slow.
    pub fn judge(&mut self, ms: f64, scale: f32) -> Option<f32> {
        if self.warm < WARM_UP {
            self.warm += 1;
            return None;
        }
        self.ms.push_back(ms);
        if self.ms.len() < JUDGED {
            return None;
        }
        let typical = self.typical_ms();
        self.ms.pop_front();
        let budget = 1e3 / LEAST_FPS;
        if typical <= budget {
            return None;
        }
        // The time goes with the pixels; where that is not enough, the next judgement goes on.
        let expected = |to: f32| typical * f64::from(to / scale).powi(2);
        let mut lower = SCALES.into_iter().filter(|s| *s < scale);
        lower.clone().find(|s| expected(*s) <= budget).or(lower.next_back())
    }

    /// Milliseconds of the frames that are judged: their lower quartile, so that other work on the machine for a second lowers nothing.
    pub fn typical_ms(&self) -> f64 {
        let mut sorted: Vec<f64> = self.ms.iter().copied().collect();
        sorted.sort_by(f64::total_cmp);
        sorted.get(sorted.len() / 4).copied().unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The scale that a device ends at that takes `ms` a frame at full scale.
    fn settled(ms: f64) -> f32 {
        let (mut scale, mut auto_scale) = (1.0, AutoScale::default());
        for _ in 0..200 {
            if let Some(lower) = auto_scale.judge(ms * f64::from(scale).powi(2) + 5.0, scale) {
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
        assert!((0..100).all(|i| auto_scale.judge(if i < 4 || i % 16 < 8 { 900.0 } else { 20.0 }, 1.0).is_none()));
    }
}
