//! Where the eye looked since the history started afresh, as a scanpath that `run` and `view` play back.

use crate::failure::Failure;
use afterimage_lab::scanpath::{About, Sample, Scanpath, Screen, write_csv};
use afterimage_lab::whole_file::write_whole;
use std::path::Path;

/// Longest record, samples: an hour and a half at 60 frames a second.
const MOST: usize = 1 << 18;
/// Positions are multiples of a 16th of a pixel, which every step from here to a frame's gaze keeps exactly.
const STEPS_PER_PX: f32 = 16.0;

/// The nearest position that a record keeps exactly.
pub fn rounded(px: [f32; 2]) -> [f32; 2] {
    px.map(|v| (v * STEPS_PER_PX).round() / STEPS_PER_PX)
}

/// Gaze of every frame since the start, in pixels of the frame.
#[derive(Clone, Debug, Default)]
pub struct Record {
    px: Vec<[f32; 2]>,
}

impl Record {
    /// Begins anew.
    pub fn clear(&mut self) {
        self.px.clear();
    }

    /// Takes a frame's gaze. A record that is too long is given up.
    pub fn push(&mut self, px: [f32; 2]) {
        if self.px.len() < MOST {
            self.px.push(px);
        }
    }

    /// Frames so far.
    pub fn len(&self) -> usize {
        self.px.len()
    }

    /// Writes it for frames of `size` at `fps`.
    pub fn write(&self, path: &Path, size: [u32; 2], fps: f64) -> Result<(), Failure> {
        // A scanpath's pixels are counted from the corner.
        let sample = |(i, px): (usize, &[f32; 2])| Sample { t_s: i as f64 / fps, px: Some(px.map(|v| v + 0.5)) };
        let samples = self.px.iter().enumerate().map(sample).collect();
        let screen = Screen { size_px: size, size_cm: None, distance_cm: None };
        let scanpath = Scanpath::new("record", screen, About::default(), samples)?;
        write_whole(path, |file| write_csv(&scanpath, file)).map_err(|e| Failure::writing(path, e))
    }
}
