//! Streaming accumulators: means and quantiles.

/// Sums that [`Mean::add_all`] computes at a time, so that they become vector instructions.
const LANES: usize = 16;

/// Accumulator of a weighted mean.
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

    /// Adds values with weights of 1.
    #[inline(always)]
    pub fn add_all(&mut self, values: &[f32]) {
        let (chunks, rest) = values.as_chunks::<LANES>();
        let mut sums = [0.0; LANES];
        for chunk in chunks {
            for (sum, &value) in sums.iter_mut().zip(chunk) {
                *sum += f64::from(value);
            }
        }
        let rest: f64 = rest.iter().map(|&value| f64::from(value)).sum();
        self.merge(Self { sum: sums.iter().sum::<f64>() + rest, weight: values.len() as f64 });
    }

    /// Adds values with their weights.
    #[inline(always)]
    pub fn add_all_weighted(&mut self, values: &[f32], weights: &[f32]) {
        let ((values, rest), (weights, weights_of_rest)) = (values.as_chunks::<LANES>(), weights.as_chunks::<LANES>());
        let (mut sums, mut totals) = ([0.0; LANES], [0.0; LANES]);
        for (values, weights) in values.iter().zip(weights) {
            for i in 0..LANES {
                sums[i] += f64::from(values[i]) * f64::from(weights[i]);
                totals[i] += f64::from(weights[i]);
            }
        }
        self.merge(Self { sum: sums.iter().sum(), weight: totals.iter().sum() });
        for (&value, &weight) in rest.iter().zip(weights_of_rest) {
            self.add_weighted(f64::from(value), f64::from(weight));
        }
    }

    /// The mean of values that are `factor` times as large.
    pub fn scaled(self, factor: f64) -> Self {
        Self { sum: self.sum * factor, ..self }
    }

    pub fn merge(&mut self, other: Self) {
        self.sum += other.sum;
        self.weight += other.weight;
    }

    /// Sum of the weights: the number of values if all weights are 1.
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

/// Histogram of non-negative values with bins of equal width. The last bin also holds all larger values.
#[derive(Clone, Debug, Default)]
pub(super) struct Histogram {
    counts: Vec<u64>,
}

impl Histogram {
    /// Bin width, which bounds the error of a quantile. For Delta E 94 it is about 1/30 of the just noticeable
    /// difference.
    pub const BIN: f32 = 1.0 / 32.0;
    /// Bins up to 128, which is above the largest Delta E 94 of sRGB colors.
    const BINS: usize = 4096;

    pub fn add(&mut self, value: f32) {
        if self.counts.is_empty() {
            self.counts.resize(Self::BINS, 0);
        }
        // The conversion saturates, and maps NaN to 0.
        self.counts[((value / Self::BIN) as usize).min(Self::BINS - 1)] += 1;
    }

    pub fn merge(&mut self, other: &Self) {
        if self.counts.is_empty() {
            self.counts.clone_from(&other.counts);
        } else {
            for (count, more) in self.counts.iter_mut().zip(&other.counts) {
                *count += more;
            }
        }
    }

    /// Quantile: upper end of the bin that contains it; 0 for the first bin. `None` without values.
    pub fn quantile(&self, share: f64) -> Option<f64> {
        let all: u64 = self.counts.iter().sum();
        let rank = ((share * all as f64).ceil() as u64).clamp(1, all.max(1));
        let mut passed = 0;
        let bin = self.counts.iter().position(|&count| {
            passed += count;
            passed >= rank
        })?;
        // The first bin counts as 0, so that equal images have a difference of 0 and not of a bin width.
        Some(if bin == 0 { 0.0 } else { (bin + 1) as f64 * f64::from(Self::BIN) })
    }
}
