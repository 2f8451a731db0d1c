//! Sums that grow with a clip and do not keep it: means and quantiles.

/// A sum of weighted values and of their weights.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Mean {
    sum: f64,
    weight: f64,
}

impl Mean {
    pub fn add(&mut self, value: f64) {
        self.add_weighted(value, 1.0);
    }

    pub fn add_weighted(&mut self, value: f64, weight: f64) {
        self.sum += value * weight;
        self.weight += weight;
    }

    pub fn merge(&mut self, other: Self) {
        self.sum += other.sum;
        self.weight += other.weight;
    }

    /// The sum of the weights: the number of values where none has another.
    pub fn weight(self) -> f64 {
        self.weight
    }

    pub fn value(self) -> Option<f64> {
        (self.weight > 0.0).then(|| self.sum / self.weight)
    }

    pub fn total(parts: impl IntoIterator<Item = Self>) -> Self {
        parts.into_iter().fold(Self::default(), |mut sum, part| {
            sum.merge(part);
            sum
        })
    }
}

/// Counts of values from 0 on, in equal bins; the last one has all above.
#[derive(Clone, Debug, Default)]
pub(super) struct Histogram {
    counts: Vec<u64>,
}

impl Histogram {
    /// Width of a bin, which bounds the error of a quantile. For Delta E 94 a thirtieth of what can be seen.
    pub const BIN: f32 = 1.0 / 32.0;
    /// 128: no two colors of a screen are farther apart in Delta E 94.
    const BINS: usize = 4096;

    pub fn add(&mut self, value: f32) {
        if self.counts.is_empty() {
            self.counts.resize(Self::BINS, 0);
        }
        // The conversion saturates, and takes NaN to 0.
        self.counts[((value / Self::BIN) as usize).min(Self::BINS - 1)] += 1;
    }

    /// The value that a share of the values does not pass, to the width of a bin, from above.
    pub fn quantile(&self, share: f64) -> Option<f64> {
        let all: u64 = self.counts.iter().sum();
        let rank = ((share * all as f64).ceil() as u64).clamp(1, all.max(1));
        let mut passed = 0;
        let bin = self.counts.iter().position(|&count| {
            passed += count;
            passed >= rank
        })?;
        // Equal pictures are 0 apart, not a bin.
        Some(if bin == 0 { 0.0 } else { (bin + 1) as f64 * f64::from(Self::BIN) })
    }
}
