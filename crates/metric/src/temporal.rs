//! Temporal channels, as in FovVideoVDP: a sustained one that averages over a tenth of a second, and a transient one
//! that answers change.

use crate::display::Display;
use crate::pyramid::Plane;
use afterimage::Image;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use std::collections::VecDeque;
use std::sync::Arc;

/// Length of the filters in seconds.
const MEMORY_S: f32 = 0.25;
/// Time of the sustained filter's peak in seconds, and its width in units of ln t.
const PEAK_S: f32 = 0.06;
const WIDTH: f32 = 0.5;
/// Frequency in Hz at which the transient filter's gain is 1.
const TRANSIENT_HZ: f32 = 5.0;

/// Filter weights of both channels by age in frames, the newest frame first.
#[derive(Clone, Debug, PartialEq)]
pub struct TemporalFilters {
    /// Sum is 1: a still picture passes unchanged.
    pub sustained: Vec<f32>,
    /// Sum is 0: a still picture has no response. The gain at 5 Hz is 1.
    pub transient: Vec<f32>,
}

impl TemporalFilters {
    /// The filters at a rate in frames per second, clamped to 1 to 1000.
    #[expect(clippy::manual_clamp, reason = "`clamp` would keep NaN")]
    pub fn new(fps: f32) -> Self {
        let fps = fps.max(1.0).min(1000.0);
        let taps = ((MEMORY_S * fps).ceil() as usize).max(1);
        let seconds = |i: usize| i as f32 / fps;
        // A log-normal curve and its derivative.
        let ln_ratio = |t: f32| ((t + 1e-4) / PEAK_S).ln();
        let curve = |t: f32| (-ln_ratio(t).powi(2) / (2.0 * WIDTH * WIDTH)).exp();
        let slope = |t: f32| -curve(t) * ln_ratio(t) / (WIDTH * WIDTH * (t + 1e-4));
        let mut sustained: Vec<f32> = (0..taps).map(|i| curve(seconds(i))).collect();
        let sum: f32 = sustained.iter().sum();
        sustained.iter_mut().for_each(|w| *w /= sum);
        let mut transient: Vec<f32> = (0..taps).map(|i| slope(seconds(i))).collect();
        let mean = transient.iter().sum::<f32>() / taps as f32;
        transient.iter_mut().for_each(|w| *w -= mean);
        let [mut re, mut im] = [0.0_f32; 2];
        for (i, w) in transient.iter().enumerate() {
            let (sin, cos) = (std::f32::consts::TAU * TRANSIENT_HZ * seconds(i)).sin_cos();
            re += w * cos;
            im += w * sin;
        }
        let gain = re.hypot(im);
        if gain > 0.0 {
            transient.iter_mut().for_each(|w| *w /= gain);
        }
        Self { sustained, transient }
    }
}

/// The luminance of the frames that the filters reach.
#[derive(Clone, Debug, Default)]
pub(crate) struct Memory {
    /// The newest first.
    frames: VecDeque<Arc<Vec<f32>>>,
}

/// Pixels that a task converts or filters.
const CHUNK: usize = 2048;

impl Memory {
    /// Takes a frame, and gives both channels' response. The first frame is taken to have been shown for ever.
    pub fn advance(&mut self, encoded: &Image<[f32; 3]>, display: Display, filters: &TemporalFilters) -> [Plane; 2] {
        let mut nits = vec![0.0; encoded.pixels().len()];
        nits.par_chunks_mut(CHUNK).zip(encoded.pixels().par_chunks(CHUNK)).for_each(|(nits, encoded)| {
            Arch::new().dispatch(Convert { display, encoded, nits });
        });
        let frame = Arc::new(nits);
        let taps = filters.sustained.len();
        while self.frames.len() + 1 < taps {
            self.frames.push_front(frame.clone());
        }
        self.frames.truncate(taps - 1);
        self.frames.push_front(frame);
        let [mut sustained, mut transient] = [0; 2].map(|_| Plane::new(encoded.width(), encoded.height()));
        let chunks = sustained.values.par_chunks_mut(CHUNK).zip(transient.values.par_chunks_mut(CHUNK));
        chunks.enumerate().for_each(|(i, (sustained, transient))| {
            Arch::new().dispatch(Filter { memory: self, filters, start: i * CHUNK, sustained, transient });
        });
        [sustained, transient]
    }
}

/// Luminance of pixels.
struct Convert<'a> {
    display: Display,
    encoded: &'a [[f32; 3]],
    nits: &'a mut [f32],
}

impl WithSimd for Convert<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for (nits, &encoded) in self.nits.iter_mut().zip(self.encoded) {
            *nits = self.display.luminance(encoded);
        }
    }
}

/// Both channels' response at pixels, which is 0 before.
struct Filter<'a> {
    memory: &'a Memory,
    filters: &'a TemporalFilters,
    start: usize,
    sustained: &'a mut [f32],
    transient: &'a mut [f32],
}

impl WithSimd for Filter<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { memory, filters, start, sustained, transient } = self;
        for ((frame, &ws), &wt) in memory.frames.iter().zip(&filters.sustained).zip(&filters.transient) {
            let frame = &frame[start..start + sustained.len()];
            for ((s, t), &v) in sustained.iter_mut().zip(transient.iter_mut()).zip(frame) {
                *s += ws * v;
                *t += wt * v;
            }
        }
    }
}
