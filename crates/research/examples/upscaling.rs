//! Uniform upscaling by 2 and 4 along each axis, by the protocol that FSR2's own shaders were measured with
//! (`docs/integration.md`).
//!
//! Shown: 640x360 at 40 degrees, 60 frames a second. In each frame one sample is drawn for a block of 2x2 or 4x4
//! pixels, at a point of Halton's sequence of bases 2 and 3 over the block, 32 of them in turn; depth and motion are
//! known at the samples only. Reference: the mean of 32 jittered frames of the same instant. Each row says the PSNR of
//! frames 24 to 63 in dB (sRGB, pooled) and the mean absolute change of the luma's error from frame to frame, times
//! 1000. `still` also goes on to frame 255.
//!
//! `cargo run --release -p afterimage-research --example upscaling`

use afterimage::cpu::{CpuAfterimage, Frame};
use afterimage::kernel::color::srgb_encode;
use afterimage::{ContextDesc, Filter, Foveation, Gaze, Image, Lattice, Lattices, Method, Settings, Smr, ViewFrame};
use afterimage_lab::frame::SourceFrame;
use afterimage_lab::source::analytic::AnalyticSource;

const SIZE: [u32; 2] = [640, 360];
const FRAMES: u64 = 64;
/// Frames of the still that is shown for longer, of which the last 40 count.
const LONG: u64 = 256;
const COUNTED: u64 = 40;
const REFERENCE_SAMPLES: u64 = 32;
const PHASES: u64 = 32;

type Color = Image<[f32; 3]>;
type Failure = Box<dyn std::error::Error>;

/// A method on frames with one sample in blocks of `step` pixels, and what was measured of it.
struct Row {
    name: &'static str,
    step: u32,
    post: Option<CpuAfterimage>,
    squares: f64,
    change: f64,
    count: f64,
    /// Encoded luma errors of the frame before.
    before: Vec<f64>,
}

impl Row {
    fn new(name: &'static str, step: u32, method: Option<Method>) -> Result<Self, Failure> {
        let rates = Foveation { filter: Filter::Sparse, rate_mid: step, rate_far: step, ..Foveation::default() };
        let foveation = Foveation { fovea_deg: 0.0, mid_deg: 0.0, ..rates };
        let make = |method| {
            let settings = Settings { method, foveation, ..Settings::default() };
            CpuAfterimage::new(&ContextDesc { settings, ..ContextDesc::new(SIZE) })
        };
        let post = method.map(make).transpose()?;
        Ok(Self { name, step, post, squares: 0.0, change: 0.0, count: 0.0, before: vec![] })
    }

    fn show(&mut self, frame: &SourceFrame, view: &ViewFrame, index: u64) -> Result<Color, Failure> {
        let Some(post) = &mut self.post else { return Ok(frame.color.clone()) };
        let (depth, motion) = (frame.depth.as_ref().ok_or("no depth")?, frame.motion.as_ref().ok_or("no motion")?);
        let (colors, depths, motions, views) = ([&frame.color], [depth], [motion], [*view]);
        let frame = Frame { depth: Some(&depths), motion: Some(&motions), ..Frame::new(&colors, &views, index) };
        let mut shown = [Image::filled(SIZE, [0.0; 3])];
        post.process(&frame, &mut shown)?;
        let [shown] = shown;
        Ok(shown)
    }

    fn score(&mut self, shown: &Color, reference: &[[f64; 3]]) {
        let luma = |c: [f64; 3]| 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
        let mut errors = vec![];
        for (i, (&s, &r)) in shown.pixels().iter().zip(reference).enumerate() {
            let s = s.map(encoded);
            errors.push(luma(s) - luma(r));
            self.squares += (0..3).map(|c| (s[c] - r[c]).powi(2)).sum::<f64>() / 3.0;
            self.change += self.before.get(i).map_or(0.0, |before| (errors[i] - before).abs());
        }
        self.count += errors.len() as f64;
        self.before = errors;
    }
}

fn encoded(linear: f32) -> f64 {
    f64::from(srgb_encode(linear.clamp(0.0, 1.0)))
}

fn rows() -> Result<Vec<Row>, Failure> {
    let smr = Method::Smr(Smr { antialias: true, ..Smr::default() });
    let mut rows = vec![Row::new("full rate, one sample", 1, None)?];
    for step in [2, 4] {
        rows.push(Row::new("taau", step, Some(Method::Taau))?);
        rows.push(Row::new("smr", step, Some(smr))?);
    }
    Ok(rows)
}

/// Place of a sample in its block along one axis: its pixel, and the jitter of the projection, so that the sample shows
/// what is at the block's middle minus `step` times a point of Halton's sequence in \[-0.5, 0.5).
fn placed(index: u64, base: u64, step: u32) -> (u32, f32) {
    let (mut rest, mut digit, mut point) = (index % PHASES + 1, 1.0, -0.5);
    while rest > 0 {
        digit /= base as f64;
        point += (rest % base) as f64 * digit;
        rest /= base;
    }
    let at = 0.5 * f64::from(step - 1) - f64::from(step) * point;
    let px = at.round().clamp(0.0, f64::from(step - 1));
    (px as u32, (px - at) as f32)
}

/// The lattice of a frame over the whole view, and its jitter.
fn sampled(index: u64, step: u32) -> Result<(Lattices, [f32; 2]), Failure> {
    let [x, y] = [2, 3].map(|base| placed(index, base, step));
    let lattice = Lattice::covering(step, [0; 2], SIZE, [x.0, y.0]);
    Ok((Lattices::new(&[lattice])?.with_geometry_at_samples(), [x.1, y.1]))
}

/// Encoded mean of jittered frames of one instant.
fn reference(source: &AnalyticSource, index: u64) -> Vec<[f64; 3]> {
    let mut sum = vec![[0.0; 3]; (SIZE[0] * SIZE[1]) as usize];
    for k in 0..REFERENCE_SAMPLES {
        // Other points than those of the frames.
        let frame = source.jittered_frame(index, Foveation::jitter_px(k + 2000));
        for (sum, c) in sum.iter_mut().zip(frame.color.pixels()) {
            (0..3).for_each(|i| sum[i] += c[i] / REFERENCE_SAMPLES as f32);
        }
    }
    sum.into_iter().map(|c| c.map(encoded)).collect()
}

fn run(scene: &str, frames: u64) -> Result<(), Failure> {
    let source = AnalyticSource::new(scene, SIZE, 40.0, 60.0)?;
    let geometry = *source.view();
    let gaze_px = SIZE.map(|s| 0.5 * s as f32);
    let mut rows = rows()?;
    let mut means = vec![];
    for index in 0..frames {
        let counts = index >= frames - COUNTED;
        if counts && (scene != "still" || means.is_empty()) {
            means = reference(&source, index);
        }
        for step in [1, 2, 4] {
            let (lattices, jitter_px) = if step == 1 {
                (None, [0.0; 2])
            } else {
                let (lattices, jitter_px) = sampled(index, step)?;
                (Some(lattices), jitter_px)
            };
            let frame = source.jittered_frame(index, jitter_px);
            let (previous_from_current, gaze) = (frame.previous_from_current, Gaze::At { px: gaze_px });
            let view = ViewFrame { jitter_px, previous_from_current, lattices, ..ViewFrame::new(geometry, gaze) };
            for row in rows.iter_mut().filter(|row| row.step == step) {
                let shown = row.show(&frame, &view, index)?;
                if counts {
                    row.score(&shown, &means);
                }
            }
        }
    }
    println!("{scene}, {frames} frames");
    for row in &rows {
        // The first frame that counts has none before it.
        let changes = row.count - row.before.len() as f64;
        let (psnr_db, change) = (-10.0 * (row.squares / row.count).log10(), 1000.0 * row.change / changes);
        println!("  step {} {:22} {psnr_db:6.2} / {change:4.1}", row.step, row.name);
    }
    Ok(())
}

fn main() -> Result<(), Failure> {
    ["still", "lateral", "turn", "occluder"].iter().try_for_each(|scene| run(scene, FRAMES))?;
    run("still", LONG)
}
