//! Light apart from texture: planned frames with the albedo of every pixel, beside the same without.
//!
//! Each row says the share of the pixels that are shaded, JOD, PSNR (sRGB), the flicker of the luma and FLIP, over the
//! frames from `--warm` on; jittered frames against a supersampled reference.
//!
//! `cargo research albedo SCENE`
//!
//! Makes the table of `docs/albedo.md`; seven minutes for the courtyard, ten for Sponza, on two busy cores.

use crate::error::AnyError;
use afterimage::cpu::{CpuAfterimage, Frame};
use afterimage::internal::{ContextDesc, Foveation, Method, Reset, Settings, Smr, ViewFrame};
use afterimage::{Gaze, Image, ViewGeometry};
use afterimage_cli::args::parse_size;
use afterimage_lab::device::Headless;
use afterimage_lab::frame::SourceFrame;
use afterimage_lab::metric::{Flip, References, Scorer, Tracker, encode};
use afterimage_lab::source::{
    FrameRequest, FrameSource, RasterSource, ReadLimits, SceneChoice, SceneOptions, ViewedScene,
};
use afterimage_metric::{Display, Viewing};
use clap::Args;
use rayon::prelude::*;

/// Gaze positions as shares of the size, 16 frames each.
const GAZES: [[f32; 2]; 4] = [[0.25, 0.33], [0.75, 0.33], [0.75, 0.72], [0.25, 0.72]];
const FRAMES_PER_GAZE: u64 = 16;
const REFERENCE_SAMPLES: u32 = 16;

/// Planned frames with the albedo of every pixel, beside the same without
#[derive(Args, Clone, Debug)]
pub struct AlbedoArgs {
    /// Scene, as for `afterimage run`
    pub scene: String,
    /// Camera of the scene, as for `afterimage run`
    #[arg(long, value_name = "NAME|FILE.json")]
    pub camera: Option<String>,
    /// Size of a frame, pixels
    #[arg(long, value_parser = parse_size, value_name = "WxH", default_value = "320x180")]
    pub size: [u32; 2],
    /// Frames of the clip
    #[arg(long, value_name = "N", default_value_t = 40, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub frames: u64,
    /// Frames before the first that is scored
    #[arg(long, value_name = "N", default_value_t = 20)]
    pub warm: u64,
}

/// One way to process the frames, and its scores.
struct Row {
    name: &'static str,
    post: CpuAfterimage,
    scorer: Scorer,
    /// Mean share of the pixels that were shaded.
    shaded: f64,
}

/// What all rows have of a frame.
struct Given<'a> {
    frame: &'a SourceFrame,
    albedo: &'a Image<[f32; 3]>,
    view: ViewFrame,
    index: u64,
}

impl AlbedoArgs {
    fn open(&self) -> Result<RasterSource, AnyError> {
        let options = SceneOptions { size: Some(self.size), hfov_deg: None, fps: None };
        let choice = SceneChoice {
            camera: self.camera.as_deref(),
            options,
            limits: ReadLimits::from_megapixels(64),
            ..SceneChoice::new(&self.scene)
        };
        Ok(ViewedScene::open(&choice)?.on(Headless::find_roomy(true).ok_or("no device")?)?)
    }
}

/// Full rate, and each share with color alone and with albedo.
fn rows(size: [u32; 2]) -> Result<Vec<Row>, AnyError> {
    let of = |name, method, foveation, has_albedo| -> Result<Row, AnyError> {
        let settings = Settings { method, foveation, ..Settings::default() };
        let post = CpuAfterimage::new(&ContextDesc { settings, has_albedo, ..ContextDesc::new(size) })?;
        Ok(Row { name, post, scorer: Scorer::default(), shaded: 0.0 })
    };
    let every_pixel = Foveation { fovea_deg: 180.0, mid_deg: 180.0, ..Foveation::quads() };
    let mut all = vec![of("full rate, taa", Method::Taa, every_pixel, false)?];
    let screen = Settings::screen().foveation;
    let budgets = [screen.budget, 0.0155, 0.0].map(|budget| Foveation { budget, ..screen });
    for foveation in [Foveation::uniform(0.25)].into_iter().chain(budgets) {
        let smr = Method::Smr(Smr { antialias: true, ..Smr::default() });
        all.push(of("color", smr, foveation, false)?);
        all.push(of("albedo", smr, foveation, true)?);
    }
    Ok(all)
}

impl Row {
    /// What it shows of a frame, and the share of the pixels that it shaded.
    fn show(&mut self, given: &Given<'_>) -> Result<(Image<[f32; 3]>, f64), AnyError> {
        let SourceFrame { color, depth, motion, cut, .. } = given.frame;
        let (colors, depths) = ([color], [depth.as_ref().ok_or("no depth")?]);
        let (motions, albedos) = ([motion.as_ref().ok_or("no motion")?], [given.albedo]);
        let views = [given.view];
        let frame = Frame {
            depth: Some(&depths),
            motion: Some(&motions),
            albedo: self.post.desc().has_albedo.then_some(&albedos),
            reset: if *cut { Reset::All } else { Reset::None },
            ..Frame::new(&colors, &views, given.index)
        };
        let mask = &self.post.plan(&frame)?[0];
        let shaded = mask.pixels().iter().filter(|&&chosen| chosen).count() as f64 / mask.pixels().len() as f64;
        let mut shown = [Image::filled(color.size(), [0.0; 3])];
        self.post.process(&frame, &mut shown)?;
        Ok((encode(&shown[0], 0.0), shaded))
    }

    /// Its line of the table.
    fn line(&self, scene: &str) -> String {
        let scores = self.scorer.scores();
        let number = |v: Option<f64>, digits| v.map_or("-".into(), |v| format!("{v:.digits$}"));
        let [jod, psnr_db] = [number(scores.whole.jod, 3), number(scores.whole.psnr_db, 2)];
        let [flicker, flip] = [number(scores.flicker, 2), number(scores.whole.flip, 4)];
        format!("| {scene} | {} | {:.2} | {jod} | {psnr_db} | {flicker} | {flip} |", self.name, 100.0 * self.shaded)
    }
}

pub fn bench(args: &AlbedoArgs) -> Result<(), AnyError> {
    let mut source = args.open()?;
    let info = source.info().clone();
    let size = info.size;
    let geometry = ViewGeometry::flat(size, info.hfov_deg.unwrap_or(70.0))?;
    let viewing = Viewing { geometry, display: Display::default(), fps: info.fps.unwrap_or(60.0) };
    let mut references = References::with_flip(Flip::for_view(&geometry)).with_jod(viewing);
    let mut tracker = Tracker::default();
    let coarse = Image::filled(size, 3.0);
    let mut rows = rows(size)?;
    for index in 0..args.frames {
        let at = GAZES[(index / FRAMES_PER_GAZE % 4) as usize];
        let gaze_px = [at[0] * size[0] as f32, at[1] * size[1] as f32];
        let jitter_px = Foveation::jitter_px(index + 1);
        let frame = source.render(&FrameRequest {
            gaze_px,
            jitter_px: Some(jitter_px),
            reference_samples: Some(REFERENCE_SAMPLES),
            ..FrameRequest::full_rate(index)
        })?;
        let albedo = source.albedo(index, jitter_px)?;
        let ecc_deg = geometry.eccentricity_map(gaze_px);
        let tracked = tracker.advance(&frame.reference, &geometry, &ecc_deg, &coarse);
        let full = encode(&frame.reference.color, 0.0);
        let reference = references.next(&full, &tracked, &ecc_deg);
        let previous_from_current = frame.given().previous_from_current;
        let view = ViewFrame { jitter_px, previous_from_current, ..ViewFrame::new(geometry, Gaze::At { px: gaze_px }) };
        let given = Given { frame: frame.given(), albedo: &albedo, view, index };
        rows.par_iter_mut().try_for_each(|row| {
            let (shown, shaded) = row.show(&given).map_err(|error| error.to_string())?;
            if index == args.warm {
                row.scorer.restart();
            }
            row.scorer.push(&reference, &shown, &tracked, &ecc_deg);
            let scored = args.frames.saturating_sub(args.warm) as f64;
            row.shaded += if index >= args.warm { shaded / scored } else { 0.0 };
            Ok::<_, String>(())
        })?;
    }
    say!("| scene | frames | pixels shaded, % | JOD | PSNR, dB | flicker | FLIP |\n|---|---|---|---|---|---|---|");
    rows.iter().for_each(|row| say!("{}", row.line(&args.scene)));
    Ok(())
}
