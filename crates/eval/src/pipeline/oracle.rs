//! The upper bound of temporal reuse.

use super::run::MethodOutput;
use crate::clock::Stopwatch;
use afterimage::internal::{Foveation, Pyramid};
use afterimage::{FrameError, FrameStats, FrameValue, Image};

/// Every pixel at its finest level of detail so far.
#[derive(Default)]
pub(super) struct Oracle {
    best: Option<Image<f32>>,
}

impl Oracle {
    /// The next frame of a still: a simulator's mip chain, and the levels of detail.
    pub fn run(
        &mut self,
        pyramid: Option<&Pyramid>,
        lods: &Image<f32>,
        foveation: &Foveation,
    ) -> Result<MethodOutput, FrameError> {
        let pyramid = pyramid.ok_or_else(|| FrameError::Value {
            value: FrameValue::Color,
            view: 0,
            found: "a frame that its source foveated".into(),
            expected: "a simulator's, which the oracle needs",
        })?;
        let watch = Stopwatch::start();
        let best = self.best.get_or_insert_with(|| lods.clone());
        for (b, &l) in best.pixels_mut().iter_mut().zip(lods.pixels()) {
            *b = b.min(l);
        }
        let image = foveation.render(pyramid, best);
        Ok(MethodOutput {
            image,
            elapsed: watch.elapsed(),
            chosen: None,
            stats: FrameStats::default(),
            traffic_bytes_per_pixel: None,
            debug: vec![],
            notes: vec![],
        })
    }

    /// Bytes kept between frames.
    pub fn memory_bytes(&self) -> usize {
        self.best.as_ref().map_or(0, |best| size_of_val(best.pixels()))
    }
}
