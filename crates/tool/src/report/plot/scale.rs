//! Axis scales: from values to pixels, and tick values.

/// Ratio of largest to smallest value from which the axis is logarithmic.
const LOG_FROM: f64 = 10.0;

/// Limit on the ticks of an axis.
const MAX_TICKS: usize = 9;

/// Least length and end of an axis of PSNR, dB: smaller differences are hardly seen, and do not fill a plot.
pub const OF_PSNR: [f64; 2] = [1.0, f64::INFINITY];

/// Least length and end of an axis of JOD.
pub const OF_JOD: [f64; 2] = [0.5, 10.0];

/// One axis.
pub struct Scale {
    low: f64,
    high: f64,
    is_log: bool,
    /// Ticks are no closer than this.
    least_step: f64,
    from_px: f64,
    to_px: f64,
}

impl Scale {
    /// A scale for finite values, with margins. `may_be_log`: logarithmic if they span more than a decade.
    pub fn new(values: impl Iterator<Item = f64> + Clone, may_be_log: bool, from_px: f64, to_px: f64) -> Self {
        let low = values.clone().fold(f64::INFINITY, f64::min);
        let high = values.fold(f64::NEG_INFINITY, f64::max);
        let (low, high) = if low <= high { (low, high) } else { (0.0, 1.0) };
        let is_log = may_be_log && low > 0.0 && high > LOG_FROM * low;
        let least_step = 0.0;
        if is_log {
            let room = (high / low).powf(0.06);
            return Self { low: low / room, high: high * room, is_log, least_step, from_px, to_px };
        }
        let room = if high > low { 0.06 * (high - low) } else { 0.05 * high.abs().max(1e-3) };
        // The axis of nonnegative values does not extend below zero.
        let floor = if low >= 0.0 { 0.0 } else { f64::NEG_INFINITY };
        Self { low: (low - room).max(floor), high: high + room, is_log, least_step, from_px, to_px }
    }

    /// The same axis, no shorter than `least`: what differs by less does not fill it. It grows to both sides, but not
    /// above `highest`, the largest possible value.
    pub fn of_at_least(self, [least, highest]: [f64; 2]) -> Self {
        let lacks = least - (self.high - self.low);
        if lacks <= 0.0 || self.is_log {
            return self;
        }
        let high = (self.high + 0.5 * lacks).min(highest.max(self.high));
        Self { low: high - least, high, ..self }
    }

    /// A scale for the whole numbers below `count`, without margins; a single one is in the middle.
    pub fn counting(count: usize, from_px: f64, to_px: f64) -> Self {
        let (low, high) = if count > 1 { (0.0, (count - 1) as f64) } else { (-0.5, 0.5) };
        Self { low, high, is_log: false, least_step: 1.0, from_px, to_px }
    }

    /// The same axis in another unit, of which `factor` make one unit of this axis.
    pub fn in_unit(&self, factor: f64) -> Self {
        Self { low: factor * self.low, high: factor * self.high, least_step: 0.0, ..*self }
    }

    /// Position of a value, clamped to the ends.
    pub fn px(&self, value: f64) -> f64 {
        let place = |v: f64| if self.is_log { v.ln() } else { v };
        let (low, high) = (place(self.low), place(self.high));
        let t = (place(value.clamp(self.low, self.high)) - low) / (high - low);
        self.from_px + t * (self.to_px - self.from_px)
    }

    /// Tick values with their text.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        let values = if self.is_log { self.log_ticks() } else { self.linear_ticks() };
        let least_step = values.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
        let digits = if least_step.is_finite() { (-least_step.log10() - 1e-9).ceil().max(0.0) as usize } else { 3 };
        let text = |v: f64| {
            // On a logarithmic axis, small values need more digits than large ones.
            let digits = if self.is_log { (-v.log10() - 1e-9).ceil().max(0.0) as usize } else { digits };
            format!("{v:.digits$}")
        };
        values.into_iter().map(|v| (v, text(v))).collect()
    }

    fn linear_ticks(&self) -> Vec<f64> {
        let rough = ((self.high - self.low) / MAX_TICKS as f64).max(self.least_step);
        let decade = 10.0_f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * decade).into_iter().find(|s| *s >= rough).unwrap_or(10.0 * decade);
        let first = (self.low / step).ceil() as i64;
        let last = (self.high / step).floor() as i64;
        (first..=last).map(|i| i as f64 * step).collect()
    }

    fn log_ticks(&self) -> Vec<f64> {
        let decades = self.low.log10().floor() as i32..=self.high.log10().ceil() as i32;
        let all = |mantissas: &[f64]| -> Vec<f64> {
            let of = |d: i32| mantissas.iter().map(move |m| m * 10.0_f64.powi(d));
            decades.clone().flat_map(of).filter(|v| (self.low..=self.high).contains(v)).collect()
        };
        let fits = |ticks: &Vec<f64>| ticks.len() <= MAX_TICKS;
        let dense = [&[1.0, 2.0, 3.0, 5.0, 7.0][..], &[1.0, 2.0, 5.0], &[1.0, 3.0]].map(all).into_iter().find(fits);
        dense.unwrap_or_else(|| {
            let powers = all(&[1.0]);
            let stride = powers.len().div_ceil(MAX_TICKS);
            powers.into_iter().step_by(stride.max(1)).collect()
        })
    }
}
