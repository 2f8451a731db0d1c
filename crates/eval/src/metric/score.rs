//! Accumulates the scores of a method over a clip.

use super::ghost::GhostShares;
use super::mean::{Histogram, Mean};
use super::reference::Prepared;
use super::track::RETAINED_FROM_DEG;
use super::{Band, NO_PAST, Reference, Tracked, error_weight, psnr_db, ssim_map};
use afterimage::Image;
use afterimage::kernel::color;
use afterimage_metric::TestVideo;
use afterimage_metric::strip::{STRIP_ROWS, delta_e94, strips};
use glam::Vec3;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Share of the pixels above `delta_e94_p99`.
const WORST: f64 = 0.01;

/// Accumulator of the scores of one method over a clip.
#[derive(Clone, Debug, Default)]
pub struct Scorer {
    sums: Sums,
    ssim: [Mean; 3],
    luma_error: Option<Image<f32>>,
    skip_ssim: bool,
    video: TestVideo,
}

/// Sums over pixels.
#[derive(Clone, Debug, Default)]
struct Sums {
    squared: [Mean; 3],
    weighted: Mean,
    retained: Mean,
    flip: [Mean; 3],
    delta_e94: Mean,
    delta_e94_counts: Histogram,
    ghosts: GhostShares,
    flicker: Mean,
}

impl Sums {
    fn merge(&mut self, other: &Self) {
        for i in 0..3 {
            self.squared[i].merge(other.squared[i]);
            self.flip[i].merge(other.flip[i]);
        }
        self.weighted.merge(other.weighted);
        self.retained.merge(other.retained);
        self.delta_e94.merge(other.delta_e94);
        self.delta_e94_counts.merge(&other.delta_e94_counts);
        self.ghosts.merge(&other.ghosts);
        self.flicker.merge(other.flicker);
    }
}

/// Scores of one eccentricity band. `None` if the band has no pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BandScores {
    /// PSNR in dB of the pooled squared error; also `None` if the error is 0 (then `mse` is 0).
    pub psnr_db: Option<f64>,
    /// Mean squared error on a scale of 1.
    pub mse: Option<f64>,
    /// Mean SSIM.
    pub ssim: Option<f64>,
    /// Mean FLIP error, 0 to 1; `None` if the references have no FLIP.
    pub flip: Option<f64>,
    /// Just-objectionable differences: 10 means no difference. `None` if the references have no JOD.
    #[serde(default)]
    pub jod: Option<f64>,
}

/// Scores of one method over a clip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Scores {
    /// All pixels of all frames.
    #[serde(flatten)]
    pub whole: BandScores,
    /// By eccentricity, from the gaze outwards.
    #[serde(with = "named_bands")]
    pub bands: [BandScores; 3],
    /// PSNR in dB of the squared error weighted by [`error_weight`]; `None` if the error is 0.
    pub weighted_psnr_db: Option<f64>,
    /// Mean Delta E 94.
    pub delta_e94_mean: Option<f64>,
    /// 99th percentile of Delta E 94 over pixels, to 1/32.
    pub delta_e94_p99: Option<f64>,
    /// PSNR in dB over retained pixels: beyond 3.5 degrees, sampled at full rate earlier, and visible since.
    pub retained_psnr_db: Option<f64>,
    /// Share of retained pixels.
    pub retained_share: Option<f64>,
    /// 1000 x mean absolute change of the luma error between frames, along the motion vectors.
    pub flicker: Option<f64>,
    /// Squared share of the old color in the output beyond 3.5 degrees after a change, summed over 32 frames.
    pub ghost_energy: Option<f64>,
    /// Frames until that share falls to half of its value in the first frame after the change; `None`: not within 32
    /// frames.
    pub ghost_half_frames: Option<u32>,
}

/// Serializes bands by name.
mod named_bands {
    use super::BandScores;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[derive(Serialize, Deserialize)]
    struct Named {
        fovea: BandScores,
        mid: BandScores,
        periphery: BandScores,
    }

    pub fn serialize<S: Serializer>(&[fovea, mid, periphery]: &[BandScores; 3], s: S) -> Result<S::Ok, S::Error> {
        Named { fovea, mid, periphery }.serialize(s)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(d: D) -> Result<[BandScores; 3], D::Error> {
        Named::deserialize(d).map(|Named { fovea, mid, periphery }| [fovea, mid, periphery])
    }
}

/// Mean squared errors of one frame, on a scale of 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameErrors {
    /// MSE over all pixels.
    pub mse: f64,
    /// MSE by eccentricity, from the gaze outwards; `None` for a band without pixels.
    pub band_mse: [Option<f64>; 3],
    /// MSE over retained pixels; `None` without retained pixels.
    pub retained_mse: Option<f64>,
    /// JOD of the frame; `None` if the reference has none.
    pub jod: Option<f64>,
    /// Mean SSIM; `None` if it is not measured, or if the frame is smaller than its window.
    pub ssim: Option<f64>,
    /// Mean FLIP error, 0 to 1; `None` if the references have no FLIP.
    pub flip: Option<f64>,
}

impl Scorer {
    /// A scorer without SSIM, which takes much of the time.
    pub fn without_ssim() -> Self {
        Self { skip_ssim: true, ..Self::default() }
    }

    /// Forgets the scores so far: the next frame continues the clip, as the first that counts.
    pub fn restart(&mut self) {
        self.video.restart();
        let (video, luma_error) = (std::mem::take(&mut self.video), self.luma_error.take());
        *self = Self { video, luma_error, skip_ssim: self.skip_ssim, ..Self::default() };
    }

    /// Adds a frame: its reference, the method's sRGB-encoded output, correspondence to the previous frame, and
    /// eccentricities in degrees. Returns the frame's own errors.
    ///
    /// # Panics
    /// If the sizes differ.
    pub fn push(
        &mut self,
        reference: &Reference<'_>,
        output: &Image<[f32; 3]>,
        tracked: &Tracked,
        ecc_deg: &Image<f32>,
    ) -> FrameErrors {
        let size = reference.encoded.size();
        assert!(output.size() == size && ecc_deg.size() == size);
        let before = self.luma_error.as_ref();
        let mut luma_error = Image::filled(size, 0.0);
        let strip_len = (STRIP_ROWS * output.width()).max(1);
        let parts: Vec<Sums> = strips(output.height())
            .zip(&reference.strips)
            .zip(luma_error.pixels_mut().par_chunks_mut(strip_len))
            .map(|((rows, prepared), luma_error)| {
                let strip = ScoreStrip { reference, prepared, output, tracked, ecc_deg, before, rows, luma_error };
                Arch::new().dispatch(strip)
            })
            .collect();
        self.luma_error = Some(luma_error);
        // In the order of the strips, so that sums do not depend on the number of threads.
        let mut frame = Sums::default();
        for part in &parts {
            frame.merge(part);
        }
        self.sums.merge(&frame);
        let mut ssim = [Mean::default(); 3];
        if !self.skip_ssim
            && let Some(map) = ssim_map(reference.encoded, output)
        {
            let margin = (ecc_deg.width() - map.width()) / 2;
            for y in 0..map.height() {
                let ecc_deg = &ecc_deg.row(y + margin)[margin..margin + map.width()];
                add_by_band(&mut ssim, map.row(y), ecc_deg);
            }
        }
        self.ssim.iter_mut().zip(ssim).for_each(|(sum, part)| sum.merge(part));
        let jod = reference.video.as_ref().map(|video| self.video.push(video, output).jod);
        FrameErrors {
            jod,
            mse: Mean::total(frame.squared).value().unwrap_or(0.0),
            band_mse: frame.squared.map(Mean::value),
            retained_mse: frame.retained.value(),
            ssim: Mean::total(ssim).value(),
            flip: Mean::total(frame.flip).value(),
        }
    }

    /// Map of the visible differences of the last frame, in JOD; `None` if the references have no JOD.
    pub fn visible_jod(&self) -> Option<Image<f32>> {
        self.video.heat_map()
    }

    /// Scores of the frames added so far.
    pub fn scores(&self) -> Scores {
        let video = self.video.score();
        let figures = |squared: Mean, ssim: Mean, flip: Mean, jod: Option<f64>| BandScores {
            psnr_db: squared.value().and_then(psnr_db),
            mse: squared.value(),
            ssim: ssim.value(),
            flip: flip.value(),
            jod,
        };
        let sums = &self.sums;
        let all = Mean::total(sums.squared);
        Scores {
            whole: figures(all, Mean::total(self.ssim), Mean::total(sums.flip), video.map(|v| v.jod)),
            bands: [0, 1, 2]
                .map(|i| figures(sums.squared[i], self.ssim[i], sums.flip[i], video.and_then(|v| v.bands[i]))),
            weighted_psnr_db: sums.weighted.value().and_then(psnr_db),
            delta_e94_mean: sums.delta_e94.value(),
            delta_e94_p99: sums.delta_e94_counts.quantile(1.0 - WORST),
            retained_psnr_db: sums.retained.value().and_then(psnr_db),
            retained_share: (all.weight() > 0.0).then(|| sums.retained.weight() / all.weight()),
            flicker: sums.flicker.value().map(|v| 1000.0 * v),
            ghost_energy: sums.ghosts.energy(),
            ghost_half_frames: sums.ghosts.half_frames(),
        }
    }
}

/// A strip of a frame to score.
struct ScoreStrip<'a> {
    reference: &'a Reference<'a>,
    prepared: &'a Prepared,
    output: &'a Image<[f32; 3]>,
    tracked: &'a Tracked,
    ecc_deg: &'a Image<f32>,
    /// Luma errors of the previous frame.
    before: Option<&'a Image<f32>>,
    rows: Range<usize>,
    /// Luma errors of the strip, to be written.
    luma_error: &'a mut [f32],
}

impl WithSimd for ScoreStrip<'_> {
    type Output = Sums;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Sums {
        let Self { reference, prepared, output, tracked, ecc_deg, before, rows, luma_error } = self;
        let width = output.width();
        let mut sums = Sums::default();
        let (mut squared, mut weights) = (vec![0.0; width], vec![0.0; width]);
        for (y, luma_error) in rows.clone().zip(luma_error.chunks_exact_mut(width)) {
            let (r, s, ecc_deg) = (reference.encoded.row(y), output.row(y), ecc_deg.row(y));
            for (squared, (r, s)) in squared.iter_mut().zip(r.iter().zip(s)) {
                *squared = (Vec3::from(*s) - Vec3::from(*r)).length_squared();
            }
            for (luma_error, (r, s)) in luma_error.iter_mut().zip(r.iter().zip(s)) {
                *luma_error = color::luma(Vec3::from(*s) - Vec3::from(*r));
            }
            for (weight, &e_deg) in weights.iter_mut().zip(ecc_deg) {
                *weight = error_weight(e_deg);
            }
            add_by_band(&mut sums.squared, &squared, ecc_deg);
            sums.weighted.add_all_weighted(&squared, &weights);
            for (&squared, _) in squared.iter().zip(tracked.retained.row(y)).filter(|(_, retained)| **retained) {
                sums.retained.add(f64::from(squared));
            }
            let ghosts = reference.ghosts.row(y).iter().zip(ecc_deg).zip(r.iter().zip(s));
            for ((&ghost, _), (&r, &s)) in ghosts.filter(|((_, e_deg), _)| **e_deg > RETAINED_FROM_DEG) {
                sums.ghosts.add(ghost, r.into(), s.into());
            }
            if let Some(before) = before {
                for (now, &from) in luma_error.iter().zip(tracked.past.row(y)) {
                    if from != NO_PAST {
                        let change = now - before.pixels()[from as usize];
                        sums.flicker.add(f64::from(change.abs()));
                    }
                }
            }
        }
        // Converts the sum of the squares of three channels to their mean.
        sums.squared = sums.squared.map(|mean| mean.scaled(1.0 / 3.0));
        sums.weighted = sums.weighted.scaled(1.0 / 3.0);
        sums.retained = sums.retained.scaled(1.0 / 3.0);

        let shown = Prepared::new(output, rows.clone(), reference.flip);
        let differences = delta_e94(&prepared.lab, &shown.lab);
        sums.delta_e94.add_all(&differences);
        for &difference in &differences {
            sums.delta_e94_counts.add(difference);
        }
        if let (Some(flip), Some(r), Some(s)) = (reference.flip, &prepared.flip, &shown.flip) {
            let errors = flip.difference(r, s);
            for (y, errors) in rows.zip(errors.chunks_exact(width)) {
                add_by_band(&mut sums.flip, errors, ecc_deg.row(y));
            }
        }
        sums
    }
}

/// Adds the values of a row by band.
#[inline(always)]
fn add_by_band(sums: &mut [Mean; 3], values: &[f32], ecc_deg: &[f32]) {
    let mut rest = values;
    for run in ecc_deg.chunk_by(|a, b| Band::of(*a) == Band::of(*b)) {
        let (of_run, after) = rest.split_at(run.len());
        sums[Band::of(run[0]) as usize].add_all(of_run);
        rest = after;
    }
}
