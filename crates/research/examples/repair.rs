//! Repair of sparse frames: what samples of their own are worth for the pixels that history has nothing for.
//!
//! The repaired samples are pixels of the full-rate frame. Each row says PSNR in dB (sRGB) of the first third of a
//! clip, which starts without history, and of its last third; and the share of pixels that were repaired in these
//! thirds, in percent. Frame 0 is a cut. A row also says how many frames it takes from there until the picture is
//! rebuilt: until the PSNR of a frame first reaches 95 % of the mean PSNR, both in dB, of the row's last third.
//!
//! `cargo run --release -p afterimage-research --example repair`
//!
//! Makes tables of `docs/method.md` and of `docs/equal-time.md`, "Repair"; a minute and a half.

use afterimage::cpu::{CpuAfterimage, Frame};
use afterimage::kernel::color::srgb_encode;
use afterimage::{ContextDesc, Filter, Foveation, Gaze, Image, Method, Repair, Settings, Smr, ViewFrame};
use afterimage_lab::frame::SourceFrame;
use afterimage_lab::source::FrameSource;
use afterimage_lab::source::analytic::AnalyticSource;

const SIZE: [u32; 2] = [320, 180];
const FRAMES: u64 = 48;
/// Lattices of steps 4 and 8 visit all pixels in 64 frames.
const FRAMES_OF_STILL: u64 = 96;
const GAZE: [f32; 2] = [120.0, 100.0];
const BUDGETS: [Option<f32>; 5] = [None, Some(0.01), Some(0.03), Some(0.1), Some(1.0)];

type Color = Image<[f32; 3]>;
type Failure = Box<dyn std::error::Error>;

/// smr with a budget, and what was measured of it in each third.
struct Row {
    budget: Option<f32>,
    frames: u64,
    post: CpuAfterimage,
    squared: [f64; 3],
    share: [f64; 3],
    /// PSNR of each frame.
    psnr: Vec<f64>,
}

impl Row {
    fn new(budget: Option<f32>, frames: u64, foveation: Foveation) -> Result<Self, Failure> {
        let method = Method::Smr(Smr { repair: budget.map(|budget| Repair { budget }), ..Smr::default() });
        let settings = Settings { method, foveation, ..Settings::default() };
        let post = CpuAfterimage::new(&ContextDesc { settings, ..ContextDesc::new(SIZE) })?;
        Ok(Self { budget, frames, post, squared: [0.0; 3], share: [0.0; 3], psnr: vec![] })
    }

    fn show(&mut self, full: &SourceFrame, view: ViewFrame, index: u64) -> Result<(), Failure> {
        let (depth, motion) = (full.depth.as_ref().ok_or("no depth")?, full.motion.as_ref().ok_or("no motion")?);
        let (colors, depths, motions, views) = ([&full.color], [depth], [motion], [view]);
        let frame = Frame { depth: Some(&depths), motion: Some(&motions), ..Frame::new(&colors, &views, index) };
        let masks = if self.budget.is_some() { self.post.plan(&frame)?.to_vec() } else { vec![] };
        let mut shown = [Image::filled(SIZE, [0.0; 3])];
        let repaired = self.budget.map(|_| &colors[..]);
        self.post.process(&Frame { repaired, ..frame }, &mut shown)?;
        let third = (3 * index / self.frames) as usize;
        let wanted = masks.iter().flat_map(|mask| mask.pixels()).filter(|&&wanted| wanted).count();
        self.share[third] += 3.0 * wanted as f64 / (self.frames as f64 * depth.pixels().len() as f64);
        let squared = squared_error(&shown[0], &full.color);
        self.squared[third] += 3.0 * squared / self.frames as f64;
        // The limit is for pictures that are exact.
        self.psnr.push(-10.0 * squared.max(2e-10).log10());
        Ok(())
    }

    /// Number of frames until one reaches 95 % of the final PSNR.
    fn frames_until_rebuilt(&self) -> usize {
        let last = &self.psnr[2 * self.psnr.len() / 3..];
        let enough = 0.95 * last.iter().sum::<f64>() / last.len() as f64;
        1 + self.psnr.iter().take_while(|&&psnr| psnr < enough).count()
    }
}

/// Mean squared difference of encoded colors.
fn squared_error(shown: &Color, full: &Color) -> f64 {
    let pairs = shown.pixels().iter().flatten().zip(full.pixels().iter().flatten());
    let squares = pairs.map(|(&a, &b)| f64::from(srgb_encode(a) - srgb_encode(b)).powi(2));
    squares.sum::<f64>() / (3 * full.pixels().len()) as f64
}

fn main() -> Result<(), Failure> {
    for scene in ["still", "occluder", "lateral", "walk", "turn"] {
        for [rate_mid, rate_far] in [[2, 4], [4, 8]] {
            let frames = if scene == "still" { FRAMES_OF_STILL } else { FRAMES };
            let mut source = AnalyticSource::new(scene, SIZE, 70.0, 60.0)?;
            let geometry = *source.view();
            let foveation = Foveation { filter: Filter::Sparse, rate_mid, rate_far, ..Foveation::default() };
            let mut rows =
                BUDGETS.into_iter().map(|b| Row::new(b, frames, foveation)).collect::<Result<Vec<_>, _>>()?;
            let mut samples = 0.0;
            for index in 0..frames {
                let full = source.frame(index)?;
                let lattices = foveation.lattices(&geometry, GAZE, index);
                let points = lattices.as_slice().iter().map(|lattice| lattice.points[0] * lattice.points[1]);
                samples += f64::from(points.sum::<u32>()) / (frames as f64 * f64::from(SIZE[0] * SIZE[1]));
                let view = ViewFrame {
                    previous_from_current: full.previous_from_current,
                    lattices: Some(lattices),
                    ..ViewFrame::new(geometry, Gaze::At { px: GAZE })
                };
                for row in &mut rows {
                    row.show(&full, view, index)?;
                }
            }
            println!("{scene}, sparse {rate_mid}/{rate_far}: lattices sample {:.1} % of the pixels", 100.0 * samples);
            for row in &rows {
                let name =
                    row.budget.map_or("without repair".into(), |budget| format!("budget {:.0} %", 100.0 * budget));
                let [first, last] = [0, 2].map(|third| (-10.0 * row.squared[third].log10(), 100.0 * row.share[third]));
                println!(
                    "  {name:15} first third {:5.2} dB, {:4.1} %; last third {:5.2} dB, {:4.1} %; 95 % after {} frames",
                    first.0,
                    first.1,
                    last.0,
                    last.1,
                    row.frames_until_rebuilt()
                );
            }
        }
    }
    Ok(())
}
