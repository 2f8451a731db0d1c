//! Antialiasing of jittered frames, at full rate and planned, against a supersampled reference.
//!
//! Reference: the mean of 32 jittered frames of the same instant. Each row says PSNR of the whole picture and within
//! 3.5 degrees of the gaze in dB (sRGB), and the mean absolute change of the luma's error from frame to frame, times
//! 1000.
//!
//! `cargo research antialias`
//!
//! Makes figures of `docs/integration.md`, "Jitter and temporal antialiasing"; minutes.

use crate::error::AnyError;
use afterimage::cpu::{CpuAfterimage, Frame};
use afterimage::internal::{ContextDesc, Foveation, Method, Settings, Smr, ViewFrame};
use afterimage::kernel::color::srgb_encode;
use afterimage::{Gaze, Image};
use afterimage_lab::frame::SourceFrame;
use afterimage_lab::source::analytic::AnalyticSource;

const SIZE: [u32; 2] = [320, 180];
const FRAMES: u64 = 48;
/// Frames before the first that counts.
const WARM: u64 = 24;
const REFERENCE_SAMPLES: u64 = 32;
/// Largest eccentricity of the second column, in degrees.
const NEAR_DEG: f32 = 3.5;

type Color = Image<[f32; 3]>;
/// A method on one kind of frames, and its measurements.
struct Row {
    name: &'static str,
    jitters: bool,
    post: Option<CpuAfterimage>,
    whole: Mean,
    near: Mean,
    change: Mean,
    /// Encoded luma error of the frame before.
    before: Option<Vec<f64>>,
}

#[derive(Default)]
struct Mean {
    sum: f64,
    count: f64,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1.0;
    }

    fn psnr_db(&self) -> f64 {
        -10.0 * (self.sum / self.count).log10()
    }
}

impl Row {
    fn new(name: &'static str, foveation: Foveation, jitters: bool, method: Option<Method>) -> Result<Self, AnyError> {
        let make = |method| {
            let settings = Settings { method, foveation, ..Settings::default() };
            CpuAfterimage::new(&ContextDesc { settings, ..ContextDesc::new(SIZE) })
        };
        let [whole, near, change] = [(); 3].map(|()| Mean::default());
        Ok(Self { name, jitters, post: method.map(make).transpose()?, whole, near, change, before: None })
    }

    fn show(&mut self, frame: &SourceFrame, view: &ViewFrame, index: u64) -> Result<Color, AnyError> {
        let Some(post) = &mut self.post else { return Ok(frame.color.clone()) };
        let (depth, motion) = (frame.depth.as_ref().ok_or("no depth")?, frame.motion.as_ref().ok_or("no motion")?);
        let (colors, depths, motions, views) = ([&frame.color], [depth], [motion], [*view]);
        let frame = Frame { depth: Some(&depths), motion: Some(&motions), ..Frame::new(&colors, &views, index) };
        let mut shown = [Image::filled(SIZE, [0.0; 3])];
        post.plan(&frame)?;
        post.process(&frame, &mut shown)?;
        let [shown] = shown;
        Ok(shown)
    }

    fn score(&mut self, shown: &Color, reference: &Color, ecc_deg: &Image<f32>, counts: bool) {
        let luma = |c: [f64; 3]| 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
        let encode = |c: [f32; 3]| c.map(|v| f64::from(srgb_encode(v)));
        let mut errors = vec![];
        for (i, (&s, &r)) in shown.pixels().iter().zip(reference.pixels()).enumerate() {
            let (s, r) = (encode(s), encode(r));
            errors.push(luma(s) - luma(r));
            let square = [0, 1, 2].map(|c| (s[c] - r[c]).powi(2)).iter().sum::<f64>() / 3.0;
            if counts {
                self.whole.add(square);
                if ecc_deg.pixels()[i] < NEAR_DEG {
                    self.near.add(square);
                }
                if let Some(before) = &self.before {
                    self.change.add((errors[i] - before[i]).abs());
                }
            }
        }
        self.before = Some(errors);
    }
}

fn rows() -> Result<Vec<Row>, AnyError> {
    let planned = Settings::screen().foveation;
    let (quarter, full) = (Foveation::quarter(), Foveation { fovea_deg: 180.0, mid_deg: 180.0, ..Foveation::quads() });
    let smr = |antialias| Some(Method::Smr(Smr { antialias, ..Smr::default() }));
    Ok(vec![
        Row::new("full rate, one sample a pixel, as it is", full, false, None)?,
        Row::new("full rate, jitter, taa", full, true, Some(Method::Taa))?,
        Row::new("full rate, jitter, taau", full, true, Some(Method::Taau))?,
        Row::new("full rate, jitter, smr", full, true, smr(true))?,
        Row::new("one pixel in 4, jitter, taau", quarter, true, Some(Method::Taau))?,
        Row::new("one pixel in 4, jitter, smr", quarter, true, smr(true))?,
        Row::new("planned, taau", planned, false, Some(Method::Taau))?,
        Row::new("planned, jitter, taau", planned, true, Some(Method::Taau))?,
        Row::new("planned, smr", planned, false, smr(false))?,
        Row::new("planned, jitter, smr without antialias", planned, true, smr(false))?,
        Row::new("planned, jitter, smr", planned, true, smr(true))?,
    ])
}

/// Mean of jittered frames of one instant.
fn reference(source: &AnalyticSource, index: u64) -> Color {
    let mut sum = vec![[0.0; 3]; (SIZE[0] * SIZE[1]) as usize];
    for k in 0..REFERENCE_SAMPLES {
        // Other points than those of the frames.
        let frame = source.jittered_frame(index, Foveation::jitter_px(k + 2000));
        for (sum, c) in sum.iter_mut().zip(frame.color.pixels()) {
            (0..3).for_each(|i| sum[i] += c[i] / REFERENCE_SAMPLES as f32);
        }
    }
    Image::from_pixels(SIZE, sum).expect("one color a pixel")
}

pub fn bench() -> Result<(), AnyError> {
    for scene in ["still", "lateral", "turn"] {
        let source = AnalyticSource::new(scene, SIZE, 40.0, 60.0)?;
        let geometry = *source.view();
        let mut rows = rows()?;
        for index in 0..FRAMES {
            let gaze_px = [[80.0, 60.0], [240.0, 60.0], [240.0, 130.0], [80.0, 130.0]][(index / 16 % 4) as usize];
            let jitter_px = Foveation::jitter_px(index + 1);
            let frames = [[0.0; 2], jitter_px].map(|jitter| source.jittered_frame(index, jitter));
            let (reference, ecc_deg) = (reference(&source, index), geometry.eccentricity_map(gaze_px));
            for row in &mut rows {
                let frame = &frames[usize::from(row.jitters)];
                let view = ViewFrame {
                    jitter_px: if row.jitters { jitter_px } else { [0.0; 2] },
                    previous_from_current: frame.previous_from_current,
                    ..ViewFrame::new(geometry, Gaze::At { px: gaze_px })
                };
                let shown = row.show(frame, &view, index)?;
                row.score(&shown, &reference, &ecc_deg, index >= WARM);
            }
        }
        say!("{scene}");
        for row in &rows {
            let change = 1000.0 * row.change.sum / row.change.count;
            say!("  {:41} {:5.1} / {:4.1} / {change:4.1}", row.name, row.whole.psnr_db(), row.near.psnr_db());
        }
    }
    Ok(())
}
