//! Scores the frames of all tests, one frame at a time.

use super::inputs::Encoded;
use super::plan::Plan;
use crate::failure::Failure;
use crate::output::{Output, csv_cell};
use crate::video::SideBySide;
use afterimage::Image;
use afterimage_eval::metric::{
    FrameErrors, Reference, References, Scorer, Scores, Tracked, crop_mean, psnr_db, ssim_map, worst_crop,
};
use afterimage_metric::Flip;
use indicatif::ProgressBar;
use rayon::prelude::*;
use serde::Serialize;

/// Columns of `frames.csv`.
const HEADER: &str = "frame,method,psnr_db,fovea_psnr_db,mid_psnr_db,periphery_psnr_db,jod,ssim,flip";

/// Width of the border that the map of SSIM, with its window of 11 pixels, does not cover.
const SSIM_MARGIN_PX: u32 = 5;

/// Scores of a comparison.
pub struct Results {
    pub tests: Vec<TestResult>,
    /// Pixels of the reference that were NaN or infinite.
    pub nonfinite_reference: u64,
    /// The last frame of the reference.
    pub reference: Image<[f32; 3]>,
}

/// Scores of a test.
pub struct TestResult {
    pub scores: Scores,
    pub worst_crop: Option<LowestCrop>,
    pub nonfinite: u64,
    pub frames: Vec<FrameErrors>,
    /// The last frame.
    pub shown: Image<[f32; 3]>,
    /// Visible differences of the last frame in JOD.
    pub visible_jod: Option<Image<f32>>,
}

/// The crop with the least PSNR of all frames.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct LowestCrop {
    pub psnr_db: Option<f64>,
    pub ssim: Option<f64>,
    pub flip: Option<f64>,
    /// Mean of the map of visible differences: JOD that would be lost if all of the frame differed as much.
    pub lost_jod: Option<f64>,
    pub frame: usize,
    pub x_px: u32,
    pub y_px: u32,
    #[serde(skip)]
    mse: f64,
}

/// Accumulator of a test.
#[derive(Default)]
struct Accumulator {
    scorer: Scorer,
    worst: Option<LowestCrop>,
    nonfinite: u64,
    frames: Vec<FrameErrors>,
}

/// Scores all frames, and writes `frames.csv` and the frames of a video.
pub fn score(
    plan: &Plan,
    as_black: bool,
    out: &Output,
    mut video: Option<&mut SideBySide>,
    bar: &ProgressBar,
) -> Result<Results, Failure> {
    let mut references = plan.flip.clone().map_or_else(References::default, References::with_flip);
    if let Some(viewing) = plan.viewing {
        references = references.with_jod(viewing);
    }
    let unknown = Tracked::unknown(plan.inputs.size());
    let mut accumulators: Vec<Accumulator> = plan.inputs.tests.iter().map(|_| Accumulator::default()).collect();
    let mut table = out.table("frames.csv", HEADER)?;
    let (mut nonfinite_reference, mut last) = (0, vec![]);
    for (index, &gaze_px) in plan.gaze_px.iter().enumerate() {
        let frames = plan.inputs.read(index, plan.exposure.ev, as_black)?;
        let ecc_deg = plan.geometry.eccentricity_map(gaze_px);
        let reference = references.next(&frames[0].image, &unknown, &ecc_deg);
        nonfinite_reference += frames[0].nonfinite;
        accumulators.par_iter_mut().zip(&frames[1..]).for_each(|(accumulator, test)| {
            accumulator.push(index, &reference, test, &unknown, &ecc_deg, plan.flip.as_ref());
        });
        for ((name, _), accumulator) in plan.inputs.tests.iter().zip(&accumulators) {
            table.row(&accumulator.row(index, name))?;
        }
        if let Some(video) = &mut video {
            video.push(frames.iter().map(|frame| &frame.image), gaze_px)?;
        }
        last = frames;
        bar.inc(1);
    }
    table.finish()?;
    let mut last = last.into_iter().map(|frame| frame.image);
    let reference = last.next().expect("there is a first frame");
    let tests = accumulators.into_iter().zip(last).map(|(accumulator, shown)| accumulator.result(shown)).collect();
    Ok(Results { tests, nonfinite_reference, reference })
}

impl Accumulator {
    fn push(
        &mut self,
        index: usize,
        reference: &Reference<'_>,
        test: &Encoded,
        unknown: &Tracked,
        ecc_deg: &Image<f32>,
        flip: Option<&Flip>,
    ) {
        let (full, shown) = (reference.encoded(), &test.image);
        self.frames.push(self.scorer.push(reference, shown, unknown, ecc_deg));
        self.nonfinite += test.nonfinite;
        if let Some((corner, mse)) = worst_crop(full, shown)
            && self.worst.is_none_or(|worst| mse > worst.mse)
        {
            let mean = |map: Option<Image<f32>>, margin| map.and_then(|map| crop_mean(&map, corner, margin));
            self.worst = Some(LowestCrop {
                psnr_db: psnr_db(mse),
                ssim: mean(ssim_map(full, shown), SSIM_MARGIN_PX),
                flip: mean(flip.map(|flip| flip.map(full, shown)), 0),
                lost_jod: mean(self.scorer.visible_jod(), 0),
                frame: index,
                x_px: corner[0],
                y_px: corner[1],
                mse,
            });
        }
    }

    /// A row of `frames.csv` for the last frame.
    fn row(&self, index: usize, name: &str) -> String {
        let number = |v: Option<f64>| v.map_or(String::new(), |v| format!("{v:.4}"));
        let mut cells = vec![index.to_string(), csv_cell(name)];
        if let Some(errors) = self.frames.last() {
            cells.push(number(psnr_db(errors.mse)));
            cells.extend(errors.band_mse.map(|mse| number(mse.and_then(psnr_db))));
            cells.extend([errors.jod, errors.ssim, errors.flip].map(number));
        }
        cells.join(",")
    }

    fn result(self, shown: Image<[f32; 3]>) -> TestResult {
        let visible_jod = self.scorer.visible_jod();
        // Without motion, no pixel is known to be retained.
        let scores = Scores { retained_share: None, ..self.scorer.scores() };
        let Self { worst: worst_crop, nonfinite, frames, .. } = self;
        TestResult { scores, worst_crop, nonfinite, frames, shown, visible_jod }
    }
}
