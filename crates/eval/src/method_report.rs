//! Scores, times and counts of a method over a clip.

use crate::clock::Quartiles;
use crate::frame::RenderedFrame;
use crate::metric::{Crops, FrameErrors, Reference, Scorer, Scores, WorstCrop, psnr_db};
use crate::pipeline::{MethodOutput, Step};
use crate::times::{FrameTime, RenderTime, Times};
use afterimage::Image;
use serde::{Deserialize, Serialize};

/// Results of a method, as in `report.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MethodReport {
    /// Gain over the foveated frame as a fraction of the oracle's gain, if `none` and `oracle` were run.
    pub share_of_oracle: Option<Share>,
    /// Wall time of the pass per frame.
    pub ms: Option<Quartiles>,
    /// Median CPU time of the pass per frame.
    pub cpu_ms: Option<f64>,
    /// Time of the whole frame.
    #[serde(flatten)]
    pub frame: FrameTime,
    /// Quality of the frames.
    #[serde(flatten)]
    pub scores: Scores,
    /// PSNR of the last frame alone.
    pub psnr_last_frame_db: Option<f64>,
    /// Crop that loses most against the foveated frame; `None` if `none` was not run, or not for three frames.
    pub worst_crop: Option<WorstCrop>,
    /// Input pixels that were NaN or infinite.
    pub nonfinite_in: u64,
    /// Output pixels that were NaN or infinite.
    pub nonfinite_out: u64,
    /// Share of pixels whose history was rejected (disocclusion, frame border or invalid motion), after the first
    /// frame.
    #[serde(rename = "flushed")]
    pub rejected: Option<f64>,
    /// Share of replaced samples among pixels with valid history.
    pub replaced: Option<f64>,
    /// Mean share of the pixels that were shaded; `None` unless the method chooses all pixels that are shaded.
    #[serde(default)]
    pub shaded_share: Option<f64>,
    /// Bytes per pixel and frame that the pass reads and writes, for half-float inputs.
    pub bytes_per_pixel: Option<u32>,
    /// Bytes per pixel that are kept between frames.
    pub persistent_bytes_per_pixel: f64,
}

/// Position between `none` (0) and `oracle` (1); below 0 is worse than the foveated frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Share {
    /// In whole-image PSNR.
    pub psnr: Option<f64>,
    /// In whole-image SSIM.
    pub ssim: Option<f64>,
}

impl MethodReport {
    /// Cost of the pass: timestamp queries if available, otherwise CPU time, otherwise wall time.
    pub fn post_ms(&self) -> Option<f64> {
        self.frame.device_ms.or(self.cpu_ms).or(self.ms.map(|q| q.median))
    }

    /// Cost of the renderer and the pass, each by the clock of the device that it runs on.
    pub fn total_ms(&self) -> Option<f64> {
        Some(self.frame.render.cost_ms()? + self.post_ms()?)
    }
}

/// Accumulates scores, times and counts of a method over the frames of a clip.
#[derive(Default)]
pub struct MethodAccumulator {
    scorer: Scorer,
    crops: Crops,
    times: Times,
    render: Times,
    shaded: Vec<f64>,
    nonfinite_in: u64,
    nonfinite_out: u64,
    pixels: u64,
    rejected: u64,
    with_history: u64,
    replaced: u64,
    last: Option<FrameErrors>,
    frame_mse: Vec<f64>,
    traffic: Option<u32>,
}

impl MethodAccumulator {
    /// Adds a frame: the method's output, its sRGB-encoded image, and that of the foveated frame, if there is one.
    pub fn push(
        &mut self,
        frame: &RenderedFrame,
        reference: &Reference<'_>,
        encoded: &Image<[f32; 3]>,
        foveated: Option<&Image<[f32; 3]>>,
        shown: &MethodOutput,
        step: &Step,
    ) {
        let errors = self.scorer.push(reference, encoded, &step.tracked, &step.ecc_deg);
        self.frame_mse.push(errors.mse);
        self.last = Some(errors);
        if let Some(foveated) = foveated {
            self.crops.push(reference.encoded(), encoded, foveated);
        }
        self.traffic = shown.traffic_bytes_per_pixel;
        self.times.push(shown.elapsed);
        let shading = shown.chosen.and_then(|chosen| chosen.shading);
        let render = frame.render.map(|render| shading.map_or(render, |shading| render.and(shading)));
        render.into_iter().for_each(|elapsed| self.render.push(elapsed));
        if let Some(chosen) = shown.chosen {
            self.shaded.push(chosen.share);
        }
        let frame = &frame.reference;
        self.nonfinite_in += frame.nonfinite + shown.stats.nonfinite;
        let bad = |c: &&[f32; 3]| !c.iter().all(|v| v.is_finite());
        self.nonfinite_out += shown.image.pixels().iter().filter(bad).count() as u64;
        if !frame.cut {
            self.pixels += shown.stats.pixels;
            self.rejected += shown.stats.rejected();
            self.with_history += shown.stats.valid();
            self.replaced += shown.stats.replaced;
        }
    }

    /// Forgets scores and shares so far: the next frame continues the clip, as the first that counts. Times and counts
    /// of pixels are those of all frames.
    pub fn restart(&mut self) {
        self.scorer.restart();
        self.crops.restart();
        self.shaded.clear();
    }

    /// Scores of the frames so far.
    pub fn scores(&self) -> Scores {
        self.scorer.scores()
    }

    /// Visible difference of the last frame in JOD; `None` if it is not measured.
    pub fn visible_jod(&self) -> Option<Image<f32>> {
        self.scorer.visible_jod()
    }

    /// Times of the pass.
    pub fn times(&self) -> &Times {
        &self.times
    }

    /// Times of rendering the method's input: the frame, and the pixels that the method chose.
    pub fn render(&self) -> &Times {
        &self.render
    }

    /// Mean squared error of each frame.
    pub fn into_frame_mse(self) -> Vec<f64> {
        self.frame_mse
    }

    /// A row of `frames.csv` for the last frame.
    pub fn row(&self, index: usize, name: &str) -> String {
        let db = |mse: Option<f64>| mse.and_then(psnr_db).map_or(String::new(), |v| format!("{v:.4}"));
        let (psnr, retained) = self.last.map_or_else(Default::default, |e| (db(Some(e.mse)), db(e.retained_mse)));
        let [fovea, mid, periphery] = self.last.map_or_else(Default::default, |e| e.band_mse.map(db));
        let (post, render) = (self.times.last(), self.render.last());
        let [ms, cpu_ms] = [post.map(|e| e.wall_ms), post.and_then(|e| e.cpu_ms)];
        let [render_ms, render_cpu_ms] = [render.map(|e| e.wall_ms), render.and_then(|e| e.cpu_ms)];
        let sum = |a: Option<f64>, b: Option<f64>| Some(a? + b?);
        let times = [cpu_ms, render_ms, render_cpu_ms, sum(render_ms, ms), sum(render_cpu_ms, cpu_ms)];
        let number = |v: Option<f64>| v.map_or(String::new(), |v| format!("{v:.3}"));
        let (ms, times) = (number(ms), times.map(number).join(","));
        let last = |shares: &[f64]| shares.last().map_or(String::new(), |share| format!("{share:.6}"));
        let shaded = last(&self.shaded);
        let jod = self.last.and_then(|e| e.jod).map_or(String::new(), |jod| format!("{jod:.4}"));
        format!("{index},{name},{psnr},{retained},{ms},{fovea},{mid},{periphery},{times},{jod},{shaded}")
    }

    /// The results of the method.
    pub fn report(&self, persistent_bytes_per_pixel: f64) -> MethodReport {
        let share = |part: u64, whole: u64| (whole > 0).then(|| part as f64 / whole as f64);
        let mean = |shares: &[f64]| (!shares.is_empty()).then(|| shares.iter().sum::<f64>() / shares.len() as f64);
        MethodReport {
            share_of_oracle: None,
            ms: self.times.wall_ms(),
            cpu_ms: self.times.cpu_ms(),
            frame: FrameTime::of(RenderTime::of(&self.render), &self.times),
            scores: self.scorer.scores(),
            psnr_last_frame_db: self.last.and_then(|e| psnr_db(e.mse)),
            worst_crop: self.crops.worst(),
            nonfinite_in: self.nonfinite_in,
            nonfinite_out: self.nonfinite_out,
            rejected: share(self.rejected, self.pixels),
            replaced: share(self.replaced, self.with_history),
            shaded_share: mean(&self.shaded),
            bytes_per_pixel: self.traffic,
            persistent_bytes_per_pixel,
        }
    }
}
