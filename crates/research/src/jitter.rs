//! Jittered projections, and temporal antialiasing before or after the post-process.
//!
//! A renderer jitters its projection so that its antialiasing sees another part of each pixel in every frame. This
//! example compares the orders, on frames with one sample a pixel, against the antialiased full-rate frame.
//! "undeclared": vectors that contain the jitter, contrary to their description.
//!
//! `cargo research jitter`
//!
//! Makes figures of `docs/integration.md`; half a minute.

use crate::error::AnyError;
use afterimage::cpu::{CpuAfterimage, Frame};
use afterimage::internal::{ContextDesc, Foveation, MethodKind, Settings, ViewFrame};
use afterimage::kernel::color::srgb_encode;
use afterimage::{Gaze, Image, ViewGeometry};
use afterimage_lab::frame::SourceFrame;
use afterimage_lab::source::FrameSource;
use afterimage_lab::source::analytic::AnalyticSource;

const SIZE: [u32; 2] = [320, 180];
const FRAMES: u64 = 48;
const ROWS: [&str; 6] = ["foveated", "taa", "smr", "smr, undeclared", "smr, then taa", "taa, then smr"];

type Color = Image<[f32; 3]>;

/// Element `index` of the Halton sequence in `base`, less 1/2.
fn halton(mut index: u64, base: u64) -> f32 {
    let (mut value, mut digit) = (0.0, 1.0);
    while index > 0 {
        digit /= base as f32;
        value += (index % base) as f32 * digit;
        index /= base;
    }
    value - 0.5
}

fn foveated(frame: &Color, geometry: &ViewGeometry, gaze_px: [f32; 2], foveation: &Foveation) -> Color {
    let lods = foveation.lod_map(geometry, gaze_px);
    let pyramid = afterimage::internal::Pyramid::new(frame.clone(), foveation.max_level());
    foveation.render(&pyramid, &lods)
}

struct Pass(CpuAfterimage);

impl Pass {
    fn new(method: MethodKind, jittered_vectors: bool) -> Result<Self, AnyError> {
        let mut desc = ContextDesc::new(SIZE);
        desc.settings = Settings { method: method.into(), ..Settings::default() };
        desc.settings.foveation = foveation();
        desc.motion.jittered = jittered_vectors;
        Ok(Self(CpuAfterimage::new(&desc)?))
    }

    fn process(&mut self, color: &Color, from: &SourceFrame, view: ViewFrame, index: u64) -> Result<Color, AnyError> {
        let (depth, motion) = (from.depth.as_ref().ok_or("no depth")?, from.motion.as_ref().ok_or("no motion")?);
        let (colors, depths, motions, views) = ([color], [depth], [motion], [view]);
        let frame = Frame { depth: Some(&depths), motion: Some(&motions), ..Frame::new(&colors, &views, index) };
        let mut shown = [Image::filled(SIZE, [0.0; 3])];
        self.0.process(&frame, &mut shown)?;
        let [shown] = shown;
        Ok(shown)
    }
}

fn foveation() -> Foveation {
    Foveation { rate_mid: 2, rate_far: 4, fovea_deg: 16.0, mid_deg: 40.0, ..Foveation::default() }
}

fn psnr_db(shown: &Color, reference: &Color) -> f64 {
    let pairs = shown.pixels().iter().flatten().zip(reference.pixels().iter().flatten());
    let squares = pairs.map(|(&a, &b)| f64::from(srgb_encode(a) - srgb_encode(b)).powi(2));
    let count = 3 * shown.pixels().len();
    afterimage_lab::metric::psnr_db(squares.sum::<f64>() / count as f64).unwrap_or(f64::INFINITY)
}

pub fn bench() -> Result<(), AnyError> {
    for scene in ["still", "lateral", "turn"] {
        let mut source = AnalyticSource::new(scene, SIZE, 70.0, 60.0)?;
        let geometry = *source.view();
        let mut passes = [
            vec![],
            vec![Pass::new(MethodKind::Taa, false)?],
            vec![Pass::new(MethodKind::Smr, false)?],
            vec![Pass::new(MethodKind::Smr, false)?],
            vec![Pass::new(MethodKind::Smr, false)?, Pass::new(MethodKind::Taa, false)?],
            vec![Pass::new(MethodKind::Taa, false)?, Pass::new(MethodKind::Smr, false)?],
        ];
        let mut sums = [[0.0; 2]; ROWS.len()];
        let mut previous = vec![None; ROWS.len()];
        let mut jitter_before = [0.0; 2];
        for index in 0..FRAMES {
            let jitter_px = [halton(index % 8 + 1, 2), halton(index % 8 + 1, 3)];
            // The gaze jumps every 12 frames.
            let gaze_px = [[80.0, 60.0], [240.0, 60.0], [240.0, 130.0], [80.0, 130.0]][(index / 12 % 4) as usize];
            let reference = source.frame(index)?.color;
            let frame = source.jittered_frame(index, jitter_px);
            let seen = foveated(&frame.color, &geometry, gaze_px, &foveation());
            let view = ViewFrame {
                jitter_px,
                previous_from_current: frame.previous_from_current,
                ..ViewFrame::new(geometry, Gaze::At { px: gaze_px })
            };
            let contained = [jitter_before[0] - jitter_px[0], jitter_before[1] - jitter_px[1]];
            let with_jitter = SourceFrame {
                motion: frame.motion.as_ref().map(|m| m.map(|v| [v[0] + contained[0], v[1] + contained[1]])),
                ..frame.clone()
            };
            for (row, passes) in passes.iter_mut().enumerate() {
                let from = if ROWS[row] == "smr, undeclared" { &with_jitter } else { &frame };
                let mut shown = seen.clone();
                for pass in passes {
                    shown = pass.process(&shown, from, view, index)?;
                }
                if index >= 12 {
                    sums[row][0] += psnr_db(&shown, &reference);
                    // Change of the error from frame to frame, at pixels that stay (the still scene).
                    if let Some((before, reference_before)) = &previous[row] {
                        sums[row][1] += flicker(&shown, &reference, before, reference_before);
                    }
                }
                previous[row] = Some((shown, reference.clone()));
            }
            jitter_before = jitter_px;
        }
        say!("{scene}");
        for (row, [psnr, change]) in ROWS.iter().zip(sums) {
            let frames = (FRAMES - 12) as f64;
            say!("  {row:<14} PSNR {:6.2} dB, change of the error {:6.2}", psnr / frames, 1000.0 * change / frames);
        }
    }
    Ok(())
}

/// Mean absolute change of the luma's error.
fn flicker(shown: &Color, reference: &Color, before: &Color, reference_before: &Color) -> f64 {
    let luma = |c: [f32; 3]| f64::from(0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]);
    let error = |a: &Color, b: &Color, i: usize| luma(a.pixels()[i]) - luma(b.pixels()[i]);
    let count = shown.pixels().len();
    let changes = (0..count).map(|i| (error(shown, reference, i) - error(before, reference_before, i)).abs());
    changes.sum::<f64>() / count as f64
}
