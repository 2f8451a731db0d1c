//! Record of the gaze since the last history reset, saved as a scanpath that `run` and `view` can play.

use crate::failure::Failure;
use afterimage_lab::scanpath::{Scanpath, write_csv};
use afterimage_lab::whole_file::write_whole;
use std::path::Path;

/// Longest record, samples: an hour and a half at 60 frames a second.
const MAX_SAMPLES: usize = 1 << 18;
/// Positions are multiples of 1/16 pixel: writing, reading and mapping to frame pixels keep these exactly.
const STEPS_PER_PX: f32 = 16.0;

/// The nearest position that the CSV file preserves exactly.
pub fn rounded(px: [f32; 2]) -> [f32; 2] {
    px.map(|v| (v * STEPS_PER_PX).round() / STEPS_PER_PX)
}

/// Gaze of every frame since the last history reset, in pixels of the frame.
#[derive(Clone, Debug, Default)]
pub struct Record {
    px: Vec<[f32; 2]>,
}

impl Record {
    /// Removes all samples.
    pub fn clear(&mut self) {
        self.px.clear();
    }

    /// Adds a frame's gaze. Samples beyond the limit are dropped.
    pub fn push(&mut self, px: [f32; 2]) {
        if self.px.len() < MAX_SAMPLES {
            self.px.push(px);
        }
    }

    /// Number of frames.
    pub fn len(&self) -> usize {
        self.px.len()
    }

    /// Writes the record as a CSV scanpath for frames of `size` at `fps`.
    pub fn write(&self, path: &Path, size: [u32; 2], fps: f64) -> Result<(), Failure> {
        let scanpath = Scanpath::of_frames("record", size, fps, &self.px)?;
        write_whole(path, |file| write_csv(&scanpath, file)).map_err(|e| Failure::writing(path, e))
    }
}
