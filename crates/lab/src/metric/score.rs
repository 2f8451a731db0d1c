//! Accumulates the scores of a method over a clip.

use super::ghost::GhostShares;
use super::mean::{Histogram, Mean};
use super::track::RETAINED_FROM_DEG;
use super::{Band, NO_PAST, Reference, Tracked, error_weight, lab_map, psnr_db, ssim_map};
use afterimage::Image;
use afterimage::kernel::color;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Share of the pixels above `delta_e94_p99`.
const WORST: f64 = 0.01;

/// Accumulator of the scores of one method over a clip.
#[derive(Clone, Debug, Default)]
pub struct Scorer {
    squared: [Mean; 3],
    weighted: Mean,
    retained: Mean,
    ssim: [Mean; 3],
    flip: [Mean; 3],
    delta_e94: Mean,
    delta_e94_counts: Histogram,
    ghosts: GhostShares,
    flicker: Mean,
    luma_error: Option<Image<f32>>,
    skip_ssim: bool,
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
    /// MSE over retained pixels; `None` if there are none.
    pub retained_mse: Option<f64>,
}

impl Scorer {
    /// A scorer without SSIM, which takes much of the time.
    pub fn without_ssim() -> Self {
        Self { skip_ssim: true, ..Self::default() }
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
        assert_eq!(reference.encoded.size(), output.size());
        let errors = self.push_errors(reference, output, tracked, ecc_deg);
        self.push_flicker(reference.encoded, output, tracked);
        for (r, s) in reference.lab.pixels().iter().zip(lab_map(output).pixels()) {
            let difference = color::delta_e94(*r, *s);
            self.delta_e94.add(f64::from(difference));
            self.delta_e94_counts.add(difference);
        }
        if let Some((flip, preprocessed)) = &reference.flip {
            add_by_band(&mut self.flip, &flip.difference(preprocessed, &flip.preprocess(output)), ecc_deg);
        }
        if !self.skip_ssim
            && let Some(map) = ssim_map(reference.encoded, output)
        {
            add_by_band(&mut self.ssim, &map, ecc_deg);
        }
        errors
    }

    /// Adds squared errors and ghosting.
    fn push_errors(
        &mut self,
        reference: &Reference<'_>,
        output: &Image<[f32; 3]>,
        tracked: &Tracked,
        ecc_deg: &Image<f32>,
    ) -> FrameErrors {
        let mut squared = [Mean::default(); 3];
        let mut retained = Mean::default();
        for (i, (r, s)) in reference.encoded.pixels().iter().zip(output.pixels()).enumerate() {
            let (r, s, e_deg) = (Vec3::from(*r), Vec3::from(*s), ecc_deg.pixels()[i]);
            let error = f64::from((s - r).length_squared()) / 3.0;
            squared[Band::of(e_deg) as usize].add(error);
            self.weighted.add_weighted(error, f64::from(error_weight(e_deg)));
            if tracked.retained.pixels()[i] {
                retained.add(error);
            }
            if e_deg > RETAINED_FROM_DEG {
                self.ghosts.add(reference.ghosts.pixels()[i], r, s);
            }
        }
        for (sum, &frame) in self.squared.iter_mut().zip(&squared) {
            sum.merge(frame);
        }
        self.retained.merge(retained);
        FrameErrors {
            mse: Mean::total(squared).value().unwrap_or(0.0),
            band_mse: squared.map(Mean::value),
            retained_mse: retained.value(),
        }
    }

    fn push_flicker(&mut self, reference: &Image<[f32; 3]>, output: &Image<[f32; 3]>, tracked: &Tracked) {
        let error = |i: usize| color::luma(Vec3::from(output.pixels()[i]) - Vec3::from(reference.pixels()[i]));
        let mut index = 0..output.pixels().len();
        let luma_error = output.map(|_| index.next().map_or(0.0, error));
        if let Some(before) = &self.luma_error {
            for (now, &from) in luma_error.pixels().iter().zip(tracked.past.pixels()) {
                if from != NO_PAST {
                    let change = now - before.pixels()[from as usize];
                    self.flicker.add(f64::from(change.abs()));
                }
            }
        }
        self.luma_error = Some(luma_error);
    }

    /// Scores of the frames added so far.
    pub fn scores(&self) -> Scores {
        let figures = |squared: Mean, ssim: Mean, flip: Mean| BandScores {
            psnr_db: squared.value().and_then(psnr_db),
            mse: squared.value(),
            ssim: ssim.value(),
            flip: flip.value(),
        };
        let all = Mean::total(self.squared);
        Scores {
            whole: figures(all, Mean::total(self.ssim), Mean::total(self.flip)),
            bands: [0, 1, 2].map(|i| figures(self.squared[i], self.ssim[i], self.flip[i])),
            weighted_psnr_db: self.weighted.value().and_then(psnr_db),
            delta_e94_mean: self.delta_e94.value(),
            delta_e94_p99: self.delta_e94_counts.quantile(1.0 - WORST),
            retained_psnr_db: self.retained.value().and_then(psnr_db),
            retained_share: (all.weight() > 0.0).then(|| self.retained.weight() / all.weight()),
            flicker: self.flicker.value().map(|v| 1000.0 * v),
            ghost_energy: self.ghosts.energy(),
            ghost_half_frames: self.ghosts.half_frames(),
        }
    }
}

/// Adds the values of a map by band. The map may be smaller by the same border on all sides.
fn add_by_band(sums: &mut [Mean; 3], map: &Image<f32>, ecc_deg: &Image<f32>) {
    let margin = (ecc_deg.width() - map.width()) / 2;
    for y in 0..map.height() {
        for (&value, &e_deg) in map.row(y).iter().zip(&ecc_deg.row(y + margin)[margin..]) {
            sums[Band::of(e_deg) as usize].add(f64::from(value));
        }
    }
}
