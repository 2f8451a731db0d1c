//! Frames of which the post-process chooses the pixels, quads and single ones.
//!
//! Each row says the share of the pixels that are shaded in percent, JOD, PSNR in dB (sRGB), the flicker of the luma
//! and FLIP, over the frames from `--warm` on; jittered frames against a supersampled reference.
//!
//! `cargo research quads SCENE`
//!
//! Makes the table of `docs/quads.md`; half a minute a clip of 320x180, ten minutes for Sponza.

use crate::error::AnyError;
use afterimage::cpu::{CpuAfterimage, Frame};
use afterimage::internal::{ContextDesc, Foveation, Method, Reset, Settings, Smr, ViewFrame};
use afterimage::{Gaze, Image, ViewGeometry};
use afterimage_cli::args::parse_size;
use afterimage_lab::device::Headless;
use afterimage_lab::frame::SourceFrame;
use afterimage_lab::metric::{Flip, References, Scorer, Tracker, encode};
use afterimage_lab::picture::to_rgb8;
use afterimage_lab::source::{
    FrameRequest, FrameSource, ReadLimits, SceneChoice, SceneOptions, ViewedScene, is_scene, open,
};
use afterimage_metric::{Display, Viewing};
use clap::{Args, ValueEnum};
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// Gaze positions as shares of the size, 16 frames each.
const GAZES: [[f32; 2]; 4] = [[0.25, 0.33], [0.75, 0.33], [0.75, 0.72], [0.25, 0.72]];
const FRAMES_PER_GAZE: u64 = 16;

/// Shares of the pixels, one a frame, in turn: 5 to 50 %.
const SHARES: [f32; 7] = [0.05, 0.4, 0.12, 0.5, 0.2, 0.08, 0.3];

struct Row {
    name: String,
    /// Shares that its frames have in turn; none if they have those of the settings.
    shares: &'static [f32],
    post: CpuAfterimage,
    scorer: Scorer,
    /// Sum over frames of the share of the pixels that were shaded.
    shaded: f64,
    shown: Image<[f32; 3]>,
    mask: Option<Image<bool>>,
}

/// Rows of the table.
fn rows(size: [u32; 2], antialias: bool, kind: Rows) -> Result<Vec<Row>, AnyError> {
    let mut rows = vec![];
    let mut add = |name: &str, foveation: Foveation, shares: &'static [f32]| -> Result<(), AnyError> {
        let method = Method::Smr(Smr { antialias, ..Smr::default() });
        let settings = Settings { method, foveation, ..Settings::default() };
        rows.push(Row {
            name: name.into(),
            shares,
            post: CpuAfterimage::new(&ContextDesc { settings, ..ContextDesc::new(size) })?,
            scorer: Scorer::default(),
            shaded: 0.0,
            shown: Image::filled(size, [0.0; 3]),
            mask: None,
        });
        Ok(())
    };
    if kind == Rows::Shares {
        add("uniform, 5 to 50 %", Foveation::uniform(SHARES[0]), &SHARES)?;
        for (name, percent) in [("uniform 20 %", 20.0), ("uniform 22 %", 22.0), ("uniform 24 %", 24.0)] {
            add(name, Foveation::uniform(0.01 * percent), &[])?;
        }
        return Ok(rows);
    }
    let screen = Settings::screen().foveation;
    add("quads, Settings::screen", screen, &[])?;
    add("the same, single pixels", Foveation { single_pixels: true, ..screen }, &[])?;
    add("one pixel in 4", Foveation::quarter(), &[])?;
    add("uniform 25 %", Foveation::uniform(0.25), &[])?;
    Ok(rows)
}

impl Row {
    /// Shows a frame; the share of the pixels that are shaded.
    fn show(&mut self, frame: &SourceFrame, view: &ViewFrame, index: u64) -> Result<f64, AnyError> {
        let size = frame.color.size();
        if !self.shares.is_empty() {
            let foveation = Foveation::uniform(self.shares[index as usize % self.shares.len()]);
            self.post.set_settings(Settings { foveation, ..self.post.desc().settings })?;
        }
        let (depth, motion) = (frame.depth.as_ref().ok_or("no depth")?, frame.motion.as_ref().ok_or("no motion")?);
        let (colors, depths, motions) = ([&frame.color], [depth], [motion]);
        let views = [*view];
        let reset = if frame.cut { Reset::All } else { Reset::None };
        let input = Frame { depth: Some(&depths), motion: Some(&motions), reset, ..Frame::new(&colors, &views, index) };
        let mask = self.post.plan(&input)?[0].clone();
        let mut shown = [Image::filled(size, [0.0; 3])];
        self.post.process(&input, &mut shown)?;
        let [shown] = shown;
        self.shown = encode(&shown, 0.0);
        let chosen = mask.pixels().iter().filter(|&&chosen| chosen).count();
        self.mask = Some(mask);
        Ok(chosen as f64 / f64::from(size[0] * size[1]))
    }
}

/// Frames of which the post-process chooses the pixels, quads and single ones, beside full rate
#[derive(Args, Clone, Debug)]
pub struct QuadsArgs {
    /// Scene, clip or folder of frames, as for `afterimage run`
    pub input: String,
    /// Camera of the scene, as for `afterimage run`
    #[arg(long, value_name = "NAME|FILE.json")]
    pub camera: Option<String>,
    /// Size of a scene's frame, pixels
    #[arg(long, value_parser = parse_size, value_name = "WxH", default_value = "320x180")]
    pub size: [u32; 2],
    /// Frames of the clip
    #[arg(long, value_name = "N", default_value_t = 48, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub frames: u64,
    /// Frames before the first that is scored
    #[arg(long, value_name = "N", default_value_t = 24)]
    pub warm: u64,
    /// Added to the index of every frame: other jitter and noise
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub offset: u64,
    /// Jitter of the frames; folders have none
    #[arg(long, value_enum, default_value = "halton")]
    pub jitter: Jitter,
    /// Whether the gaze moves
    #[arg(long, value_enum, default_value = "moving")]
    pub gaze: GazeKind,
    /// shares: a share that changes in every frame beside a constant one
    #[arg(long, value_enum, default_value = "kinds")]
    pub rows: Rows,
    /// Write frames and masks here
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
}

/// Offsets of samples in their pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Jitter {
    Halton,
    Off,
}

/// Kinds of gaze.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum GazeKind {
    Moving,
    Fixed,
}

/// Rows of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Rows {
    Kinds,
    Shares,
}

pub fn bench(args: &QuadsArgs) -> Result<(), AnyError> {
    let QuadsArgs { input, frames, warm, .. } = args;
    let (frames, warm) = (*frames, *warm);
    let is_folder = Path::new(input).is_dir();
    let options = SceneOptions { size: (!is_folder).then_some(args.size), hfov_deg: None, fps: None };
    let limits = ReadLimits::from_megapixels(64);
    let mut source: Box<dyn FrameSource> = if is_scene(input) {
        let choice = SceneChoice { camera: args.camera.as_deref(), options, limits, ..SceneChoice::new(input) };
        Box::new(ViewedScene::open(&choice)?.on(Headless::find_roomy(true).ok_or("no device")?)?)
    } else {
        open(input, &limits, &options)?
    };
    let info = source.info().clone();
    let size = info.size;
    let is_jittered = args.jitter == Jitter::Halton && !is_folder;
    let moves = args.gaze == GazeKind::Moving;
    let geometry = ViewGeometry::flat(size, info.hfov_deg.unwrap_or(70.0))?;
    let mut rows = rows(size, is_jittered, args.rows)?;
    let viewing = Viewing { geometry, display: Display::default(), fps: info.fps.unwrap_or(60.0) };
    let mut references = References::with_flip(Flip::for_view(&geometry)).with_jod(viewing);
    let mut tracker = Tracker::default();
    let coarse = Image::filled(size, 3.0);
    for index in 0..frames {
        let at = if moves { GAZES[(index / FRAMES_PER_GAZE % 4) as usize] } else { [0.375, 0.55] };
        let gaze_px = [at[0] * size[0] as f32, at[1] * size[1] as f32];
        let jitter_px = is_jittered.then(|| Foveation::jitter_px(index + args.offset + 1));
        let request = FrameRequest {
            gaze_px,
            jitter_px,
            reference_samples: is_jittered.then_some(16),
            ..FrameRequest::full_rate(index)
        };
        let frame = source.render(&request)?;
        let ecc_deg = geometry.eccentricity_map(gaze_px);
        let tracked = tracker.advance(&frame.reference, &geometry, &ecc_deg, &coarse);
        let full = encode(&frame.reference.color, 0.0);
        let reference = references.next(&full, &tracked, &ecc_deg);
        let view = ViewFrame {
            jitter_px: jitter_px.unwrap_or_default(),
            previous_from_current: frame.given().previous_from_current,
            ..ViewFrame::new(geometry, Gaze::At { px: gaze_px })
        };
        for row in &mut rows {
            let shaded = row.show(frame.given(), &view, index + args.offset)?;
            row.shaded += if index >= warm { shaded / (frames - warm) as f64 } else { 0.0 };
        }
        rows.par_iter_mut().for_each(|row| {
            if index == warm {
                row.scorer.restart();
            }
            row.scorer.push(&reference, &row.shown, &tracked, &ecc_deg);
        });
        if let Some(out) = &args.out
            && [warm, frames.saturating_sub(13), frames - 1].contains(&index)
        {
            std::fs::create_dir_all(out)?;
            to_rgb8(&full).save(out.join(format!("reference_{index:03}.png")))?;
            for row in &rows {
                let name = row.name.replace([' ', '/', '%', '.', ','], "_");
                to_rgb8(&row.shown).save(out.join(format!("{name}_{index:03}.png")))?;
                if let Some(mask) = &row.mask {
                    let picture = mask.map(|chosen| [f32::from(u8::from(chosen)); 3]);
                    to_rgb8(&picture).save(out.join(format!("{name}_mask_{index:03}.png")))?;
                }
            }
        }
    }
    say!("{input} {}x{}, frames {warm} to {frames}, jitter {is_jittered}", size[0], size[1]);
    for row in &rows {
        let scores = row.scorer.scores();
        let number = |v: Option<f64>| v.unwrap_or(f64::NAN);
        say!(
            "{:24} {:5.2} %  {:6.3} JOD  {:5.2} dB  flicker {:5.2}  FLIP {:.4}",
            row.name,
            100.0 * row.shaded,
            number(scores.whole.jod),
            number(scores.whole.psnr_db),
            number(scores.flicker),
            number(scores.whole.flip),
        );
    }
    Ok(())
}
