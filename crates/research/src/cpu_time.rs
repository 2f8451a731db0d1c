//! CPU time of each method on the CPU executor and of the metrics, for a picture at rest and under a moving camera.
//!
//! `RAYON_NUM_THREADS=1 cargo research cpu-time PICTURE.png` gives the time of one core.
//!
//! Makes the table "CPU executor and metrics" of `docs/performance.md`.

use crate::error::AnyError;
use afterimage::internal::{Foveation, MethodKind, Settings};
use afterimage::kernel::color::srgb_decode;
use afterimage::{Image, ViewGeometry};
use afterimage_lab::clock::Stopwatch;
use afterimage_lab::device::Backend;
use afterimage_lab::frame::{RenderedFrame, SourceFrame};
use afterimage_lab::metric::{self, Crops, Flip, References, Scorer};
use afterimage_lab::pipeline::{Pipeline, RunKind};
use clap::Args;
use std::path::PathBuf;

/// Motion of every pixel in the second half, in pixels: between texels, so that history is resampled.
const MOTION_PX: [f32; 2] = [-1.3, 0.6];

/// CPU time of each method on the CPU executor and of the metrics
#[derive(Args, Clone, Debug)]
pub struct CpuTimeArgs {
    /// A picture
    #[arg(value_name = "PICTURE.png")]
    pub picture: PathBuf,
    /// Frames that are timed
    #[arg(default_value_t = 10, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub frames: u64,
}

pub fn bench(args: &CpuTimeArgs) -> Result<(), AnyError> {
    let picture = image::open(&args.picture)?.into_rgb8();
    let frames = args.frames;
    let size = [picture.width(), picture.height()];
    let linear = picture.pixels().map(|p| p.0.map(|v| srgb_decode(f32::from(v) / 255.0)));
    let color = Image::from_pixels(size, linear.collect())?;
    for motion in [None, Some(Image::filled(size, MOTION_PX))] {
        say!("{}", if motion.is_none() { "at rest" } else { "moving" });
        let still = SourceFrame {
            color: color.clone(),
            depth: None,
            motion,
            trust: None,
            previous_from_current: None,
            cut: false,
            nonfinite: 0,
        };
        measure(RenderedFrame::full_rate(0, [0.0; 2], still), frames)?;
    }
    Ok(())
}

fn measure(mut frame: RenderedFrame, frames: u64) -> Result<(), AnyError> {
    let size = frame.reference.color.size();
    let geometry = ViewGeometry::flat(size, 70.0)?;
    let methods = [MethodKind::None, MethodKind::Taa, MethodKind::Wrs, MethodKind::Smr, MethodKind::Taau];
    let kinds = methods.map(|method| RunKind::PostProcess(Settings { method: method.into(), ..Settings::default() }));
    let mut pipeline = Pipeline::new(geometry, Foveation::default(), &kinds, true, &[], &Backend::Cpu)?;
    let mut references = References::with_flip(Flip::for_view(&geometry));
    let mut scorers = methods.map(|_| Scorer::default());
    let mut crops = methods.map(|_| Crops::default());
    let mut post_ms = methods.map(|_| 0.0);
    let [mut encode_ms, mut reference_ms, mut score_ms, mut crops_ms] = [0.0; 4];
    for index in 0..frames {
        let watch = Stopwatch::start();
        let full = metric::encode(&frame.reference.color, 0.0);
        encode_ms += watch.cpu_ms().unwrap_or(f64::NAN);
        // A gaze that jumps every eighth frame.
        frame.index = index;
        frame.gaze_px = [size[0] as f32 * (0.3 + 0.2 * ((index / 8) % 3) as f32), size[1] as f32 * 0.5];
        let step = pipeline.step(&frame)?;
        // The first frame has no history.
        for (sum, output) in post_ms.iter_mut().zip(&step.outputs).filter(|_| index > 0) {
            *sum += output.elapsed.cpu_ms.unwrap_or(f64::NAN);
        }
        let watch = Stopwatch::start();
        let reference = references.next(&full, &step.tracked, &step.ecc_deg);
        reference_ms += watch.cpu_ms().unwrap_or(f64::NAN);
        let watch = Stopwatch::start();
        let encoded: Vec<_> = step.outputs.iter().map(|output| metric::encode(&output.image, 0.0)).collect();
        encode_ms += watch.cpu_ms().unwrap_or(f64::NAN);
        let watch = Stopwatch::start();
        for (scorer, output) in scorers.iter_mut().zip(&encoded) {
            scorer.push(&reference, output, &step.tracked, &step.ecc_deg);
        }
        score_ms += watch.cpu_ms().unwrap_or(f64::NAN);
        let watch = Stopwatch::start();
        for (crops, output) in crops.iter_mut().zip(&encoded) {
            crops.push(&full, output, &encoded[0]);
        }
        crops_ms += watch.cpu_ms().unwrap_or(f64::NAN);
    }
    let megapixels = size.map(f64::from).iter().product::<f64>() * 1e-6;
    for (method, ms) in methods.iter().zip(post_ms) {
        say!("{:>10} {:7.1} ms a megapixel", method.name(), ms / (frames - 1).max(1) as f64 / megapixels);
    }
    let images = (frames * methods.len() as u64) as f64 * megapixels;
    let per_reference = frames as f64 * megapixels;
    say!("{:>10} {:7.1} ms a megapixel of full-rate frame", "reference", reference_ms / per_reference);
    say!("{:>10} {:7.1} ms a megapixel of output", "scores", score_ms / images);
    say!("{:>10} {:7.1}", "crops", crops_ms / images);
    say!("{:>10} {:7.1}", "encode", encode_ms / (images + per_reference));
    for (method, scorer) in methods.iter().zip(&scorers) {
        let scores = scorer.scores().whole;
        say!(
            "{:>10} PSNR {:.12?} dB, SSIM {:.12?}, FLIP {:.12?}",
            method.name(),
            scores.psnr_db,
            scores.ssim,
            scores.flip
        );
    }
    Ok(())
}
