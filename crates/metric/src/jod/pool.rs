//! From masked differences to JOD: over pixels, bands, channels and frames.

use super::CHANNELS;
use super::constants::{
    BAND_EXPONENT, BASE_EXPONENT, BASE_WEIGHT, CHANNEL_EXPONENT, CHANNEL_WEIGHT, DIFFERENCE_EXPONENT, FRAME_EXPONENT,
    JOD_EXPONENT, JOD_SCALE,
};

/// Quality of a video, or of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VideoScore {
    /// JOD: 10 for no difference; lower is worse.
    pub jod: f64,
    /// JOD if the video had only the pixels of a [`Band`](crate::Band), from the gaze outwards; `None` for a band that
    /// no frame has.
    pub bands: [Option<f64>; 3],
}

/// Accumulator of a mean.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Mean {
    sum: f64,
    count: f64,
}

impl Mean {
    #[inline(always)]
    pub fn add_all(&mut self, values: &[f32]) {
        const LANES: usize = 16;
        let (chunks, rest) = values.as_chunks::<LANES>();
        let mut sums = [0.0_f32; LANES];
        for chunk in chunks {
            for (sum, value) in sums.iter_mut().zip(chunk) {
                *sum += value;
            }
        }
        let sums = sums.iter().chain(rest).map(|&v| f64::from(v));
        self.merge(Self { sum: sums.sum(), count: values.len() as f64 });
    }

    pub fn merge(&mut self, other: Self) {
        self.sum += other.sum;
        self.count += other.count;
    }

    fn total(parts: &[Self; 3]) -> Self {
        let mut total = Self::default();
        parts.iter().for_each(|part| total.merge(*part));
        total
    }

    fn value(self) -> Option<f64> {
        (self.count > 0.0).then(|| self.sum / self.count)
    }
}

/// Mean differences of a frame, by channel and eccentricity.
#[derive(Clone, Debug, Default)]
pub(super) struct FrameSums {
    /// Masked differences of each band of the pyramid.
    pub bands: Vec<[[Mean; 3]; CHANNELS]>,
    /// Squared Weber contrasts between the coarsest levels.
    pub base: [[Mean; 3]; CHANNELS],
}

impl FrameSums {
    /// Visible difference of the frame, with the means that `of` chooses; `None` if it has no pixels.
    fn difference(&self, of: impl Fn(&[Mean; 3]) -> Option<f64>) -> Option<f64> {
        let mut channels = 0.0;
        for c in 0..CHANNELS {
            let bands = self.bands.iter().enumerate().map(|(i, band)| match of(&band[c]) {
                Some(mean) => Some((CHANNEL_WEIGHT[c] * mean.powf(1.0 / DIFFERENCE_EXPONENT)).powf(BAND_EXPONENT)),
                // Few pixels may lie between those of a coarse level.
                None if i > 0 => Some(0.0),
                None => None,
            });
            let sum = bands.sum::<Option<f64>>()?;
            let base = of(&self.base[c]).unwrap_or(0.0);
            let base = (BASE_WEIGHT[c] * base.powf(0.5 * BASE_EXPONENT)).powf(BAND_EXPONENT);
            channels += (sum + base).powf(CHANNEL_EXPONENT / BAND_EXPONENT);
        }
        Some(channels.powf(1.0 / CHANNEL_EXPONENT))
    }

    /// Visible difference of the whole frame, and of each band of eccentricity.
    fn differences(&self) -> [Option<f64>; 4] {
        let band = |i: usize| self.difference(|parts| parts[i].value());
        [self.difference(|parts| Mean::total(parts).value()), band(0), band(1), band(2)]
    }
}

/// JOD of a visible difference.
fn jod(difference: f64) -> f64 {
    10.0 - JOD_SCALE * difference.powf(JOD_EXPONENT)
}

/// Score of a frame.
pub(super) fn frame_score(sums: &FrameSums) -> VideoScore {
    let [whole, bands @ ..] = sums.differences().map(|difference| difference.map(jod));
    VideoScore { jod: whole.unwrap_or(10.0), bands }
}

/// Score of a video; `None` without frames.
pub(super) fn video_score(frames: &[FrameSums]) -> Option<VideoScore> {
    let mut totals = [(0.0, 0.0); 4];
    for frame in frames {
        for ((sum, count), difference) in totals.iter_mut().zip(frame.differences()) {
            if let Some(difference) = difference {
                *sum += difference.powf(FRAME_EXPONENT);
                *count += 1.0;
            }
        }
    }
    let score = |(sum, count): (f64, f64)| (count > 0.0).then(|| jod((sum / count).powf(1.0 / FRAME_EXPONENT)));
    let [whole, bands @ ..] = totals.map(score);
    Some(VideoScore { jod: whole?, bands })
}

/// What the channels of a band add to a pixel of the heat map.
pub(super) fn local(differences: [f32; CHANNELS]) -> f32 {
    let terms = differences.iter().zip(CHANNEL_WEIGHT).map(|(&difference, weight)| {
        (weight * f64::from(difference).powf(1.0 / DIFFERENCE_EXPONENT)).powf(BAND_EXPONENT)
    });
    terms.sum::<f64>() as f32
}

/// Loss in JOD of a pixel of the heat map.
pub(super) fn local_loss(sum: f32) -> f32 {
    (10.0 - jod(f64::from(sum.max(0.0)).powf(1.0 / BAND_EXPONENT))) as f32
}
