//! Sums over a clip, and the figures made of them.

use super::{Band, NO_PAST, Tracked, psnr_db, ssim_map};
use crate::image::Image;
use crate::kernel::color;
use glam::Vec3;
use serde::Serialize;

/// A sum and how many values it is of.
#[derive(Clone, Copy, Debug, Default)]
struct Mean {
    sum: f64,
    count: u64,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1;
    }

    fn merge(&mut self, other: Self) {
        self.sum += other.sum;
        self.count += other.count;
    }

    fn value(self) -> Option<f64> {
        (self.count > 0).then(|| self.sum / self.count as f64)
    }
}

/// Collects the scores of one method over a clip.
#[derive(Clone, Debug, Default)]
pub struct Scorer {
    squared: [Mean; 3],
    retained: Mean,
    ssim: [Mean; 3],
    flicker: Mean,
    luma_error: Option<Image<f32>>,
    skip_ssim: bool,
}

/// Figures of one eccentricity band. `None` where no pixel fell into it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct BandScores {
    /// PSNR in dB over pooled squared error; also `None` where the error is 0 (then `mse` is 0).
    pub psnr_db: Option<f64>,
    /// Mean squared error on a scale of 1.
    pub mse: Option<f64>,
    /// Mean SSIM.
    pub ssim: Option<f64>,
    /// FLIP; not measured by this version.
    pub flip: Option<f64>,
}

/// Figures of one method over a clip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Scores {
    /// All pixels of all frames.
    #[serde(flatten)]
    pub whole: BandScores,
    /// By eccentricity, from the gaze outwards.
    #[serde(serialize_with = "named_bands")]
    pub bands: [BandScores; 3],
    /// PSNR in dB over pixels beyond 3.5 degrees that were shown at full rate earlier and have stayed visible.
    pub retained_psnr_db: Option<f64>,
    /// Share of pixels that the retained figure is about.
    pub retained_share: Option<f64>,
    /// 1000 x mean absolute change of the luma error from a frame to the next, along the motion.
    pub flicker: Option<f64>,
}

fn named_bands<S: serde::Serializer>(bands: &[BandScores; 3], s: S) -> Result<S::Ok, S::Error> {
    use serde::ser::SerializeMap;
    let mut map = s.serialize_map(Some(3))?;
    for (name, scores) in ["fovea", "mid", "periphery"].iter().zip(bands) {
        map.serialize_entry(name, scores)?;
    }
    map.end()
}

/// Mean squared errors of one frame, on a scale of 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameErrors {
    /// Over all pixels.
    pub mse: f64,
    /// Over retained pixels; `None` if there are none.
    pub retained_mse: Option<f64>,
}

impl Scorer {
    /// A scorer that leaves SSIM out, which is half of the work.
    pub fn without_ssim() -> Self {
        Self { skip_ssim: true, ..Self::default() }
    }

    /// Takes one frame: sRGB-encoded reference and shown image, what is known of the frame, eccentricities in degrees. Gives
    /// the frame's own errors.
    pub fn push(
        &mut self,
        reference: &Image<[f32; 3]>,
        shown: &Image<[f32; 3]>,
        tracked: &Tracked,
        ecc_deg: &Image<f32>,
    ) -> FrameErrors {
        let mut squared = [Mean::default(); 3];
        let mut retained = Mean::default();
        let mut luma_error = Image::filled(shown.size(), 0.0);
        for (i, (r, s)) in reference.pixels().iter().zip(shown.pixels()).enumerate() {
            let d = Vec3::from(*s) - Vec3::from(*r);
            luma_error.pixels_mut()[i] = color::luma(d);
            let error = f64::from(d.length_squared()) / 3.0;
            squared[Band::of(ecc_deg.pixels()[i]) as usize].add(error);
            if tracked.retained.pixels()[i] {
                retained.add(error);
            }
        }
        for (sum, &frame) in self.squared.iter_mut().zip(&squared) {
            sum.merge(frame);
        }
        self.retained.merge(retained);
        if let Some(before) = &self.luma_error {
            for (now, &from) in luma_error.pixels().iter().zip(tracked.past.pixels()) {
                if from != NO_PAST {
                    let change = now - before.pixels()[from as usize];
                    self.flicker.add(f64::from(change.abs()));
                }
            }
        }
        self.luma_error = Some(luma_error);
        let map = if self.skip_ssim { None } else { ssim_map(reference, shown) };
        if let Some(map) = map {
            let margin = (shown.width() - map.width()) / 2;
            for y in 0..map.height() {
                let ecc = &ecc_deg.row(y + margin)[margin..];
                for (&value, &e) in map.row(y).iter().zip(ecc) {
                    self.ssim[Band::of(e) as usize].add(f64::from(value));
                }
            }
        }
        FrameErrors { mse: total(squared).value().unwrap_or(0.0), retained_mse: retained.value() }
    }

    /// The figures so far.
    pub fn scores(&self) -> Scores {
        let figures = |squared: Mean, ssim: Mean| BandScores {
            psnr_db: squared.value().and_then(psnr_db),
            mse: squared.value(),
            ssim: ssim.value(),
            flip: None,
        };
        let all = total(self.squared);
        Scores {
            whole: figures(all, total(self.ssim)),
            bands: [0, 1, 2].map(|i| figures(self.squared[i], self.ssim[i])),
            retained_psnr_db: self.retained.value().and_then(psnr_db),
            retained_share: (all.count > 0).then(|| self.retained.count as f64 / all.count as f64),
            flicker: self.flicker.value().map(|v| 1000.0 * v),
        }
    }
}

fn total(parts: [Mean; 3]) -> Mean {
    parts.into_iter().fold(Mean::default(), |mut sum, m| {
        sum.merge(m);
        sum
    })
}
