//! Motion vectors without the camera's motion: none at all, or those of moving objects alone.
//!
//! smr on frames of a moving camera, with the right vectors, with zero vectors, and with the camera's motion added from
//! depth (`MotionConvention::without_camera`, `no_vector`), against the full-rate frame.
//!
//! `cargo research camera-motion`
//!
//! Makes figures of `docs/integration.md`; half a minute.

use crate::error::AnyError;
use afterimage::cpu::{CpuAfterimage, Frame};
use afterimage::internal::{ContextDesc, Foveation, Settings, ViewFrame};
use afterimage::kernel::color::srgb_encode;
use afterimage::kernel::debug_view::PixelTrace;
use afterimage::{Gaze, Image, MotionConvention, ViewGeometry};
use afterimage_lab::source::FrameSource;
use afterimage_lab::source::analytic::AnalyticSource;

const SIZE: [u32; 2] = [320, 180];
const FRAMES: u64 = 48;
const ROWS: [&str; 5] = ["foveated", "right vectors", "zero vectors", "no vectors", "objects' alone"];
/// Vectors that differ by less are the camera's motion alone.
const SAME_PX: f32 = 0.05;

type Color = Image<[f32; 3]>;
type Vectors = Image<[f32; 2]>;

fn foveation() -> Foveation {
    Foveation { rate_mid: 2, rate_far: 4, fovea_deg: 16.0, mid_deg: 40.0, ..Foveation::default() }
}

fn foveated(frame: &Color, geometry: &ViewGeometry, gaze_px: [f32; 2]) -> Color {
    let lods = foveation().lod_map(geometry, gaze_px);
    let pyramid = afterimage::internal::Pyramid::new(frame.clone(), foveation().max_level());
    foveation().render(&pyramid, &lods)
}

struct Pass(CpuAfterimage);

impl Pass {
    fn new(motion: MotionConvention) -> Result<Self, AnyError> {
        let mut desc = ContextDesc::new(SIZE);
        desc.settings = Settings { foveation: foveation(), ..Settings::default() };
        desc.motion = motion;
        Ok(Self(CpuAfterimage::new(&desc)?))
    }

    /// Output, and the vectors that were used.
    fn process(
        &mut self,
        color: &Color,
        depth: &Image<f32>,
        motion: Option<&Vectors>,
        view: ViewFrame,
        index: u64,
    ) -> Result<(Color, Vectors), AnyError> {
        let (colors, depths, views) = ([color], [depth], [view]);
        let motions = motion.map(|m| [m]);
        let motion = motions.as_ref().map(|m| &m[..]);
        let frame = Frame { depth: Some(&depths), motion, ..Frame::new(&colors, &views, index) };
        let (mut shown, mut traces) = ([Image::filled(SIZE, [0.0; 3])], [Image::filled(SIZE, PixelTrace::default())]);
        self.0.process_traced(&frame, &mut shown, &mut traces)?;
        let ([shown], [trace]) = (shown, traces);
        Ok((shown, trace.map(|t| t.motion)))
    }
}

fn psnr_db(shown: &Color, reference: &Color) -> f64 {
    let pairs = shown.pixels().iter().flatten().zip(reference.pixels().iter().flatten());
    let squares = pairs.map(|(&a, &b)| f64::from(srgb_encode(a) - srgb_encode(b)).powi(2));
    let count = 3 * shown.pixels().len();
    afterimage_lab::metric::psnr_db(squares.sum::<f64>() / count as f64).unwrap_or(f64::INFINITY)
}

/// Vectors of the pixels that do not follow the camera alone, NaN elsewhere.
fn of_objects(right: &Vectors, camera: &Vectors) -> Vectors {
    Image::from_fn(SIZE, |[x, y]| {
        let [a, b] = [right, camera].map(|image| image.at(x as usize, y as usize));
        let differs = (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) > SAME_PX;
        if differs { a } else { [f32::NAN; 2] }
    })
}

pub fn bench() -> Result<(), AnyError> {
    for scene in ["lateral", "turn", "walk", "occluder"] {
        let mut source = AnalyticSource::new(scene, SIZE, 70.0, 60.0)?;
        let geometry = *source.view();
        let plain = MotionConvention::default();
        let none = MotionConvention { no_vector: Some([f32::NAN; 2]), ..plain };
        let without = MotionConvention { without_camera: true, ..plain };
        let [mut right, mut zero] = [Pass::new(plain)?, Pass::new(plain)?];
        let [mut excluded, mut objects] = [Pass::new(without)?, Pass::new(none)?];
        let mut sums = [0.0; ROWS.len()];
        for index in 0..FRAMES {
            // The gaze jumps every 12 frames.
            let gaze_px = [[80.0, 60.0], [240.0, 60.0], [240.0, 130.0], [80.0, 130.0]][(index / 12 % 4) as usize];
            let frame = source.frame(index)?;
            let (depth, motion) = (frame.depth.ok_or("no depth")?, frame.motion.ok_or("no motion")?);
            let seen = foveated(&frame.color, &geometry, gaze_px);
            let view = ViewFrame {
                previous_from_current: frame.previous_from_current,
                ..ViewFrame::new(geometry, Gaze::At { px: gaze_px })
            };
            let zeros = Image::filled(SIZE, [0.0; 2]);
            let (by_right, _) = right.process(&seen, &depth, Some(&motion), view, index)?;
            let (by_zero, _) = zero.process(&seen, &depth, Some(&zeros), view, index)?;
            let (by_camera, camera) = excluded.process(&seen, &depth, None, view, index)?;
            let own = of_objects(&motion, &camera);
            let (by_objects, _) = objects.process(&seen, &depth, Some(&own), view, index)?;
            if index >= 12 {
                let shown = [&seen, &by_right, &by_zero, &by_camera, &by_objects];
                for (sum, shown) in sums.iter_mut().zip(shown) {
                    *sum += psnr_db(shown, &frame.color);
                }
            }
        }
        say!("{scene}");
        for (row, psnr) in ROWS.iter().zip(sums) {
            say!("  {row:<20} PSNR {:6.2} dB", psnr / (FRAMES - 12) as f64);
        }
    }
    Ok(())
}
