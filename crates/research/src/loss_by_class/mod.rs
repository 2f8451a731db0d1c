//! Which pixels hold how much of the quality that frames shaded by quads lose: each class of pixels is replaced by the
//! reference, and the JOD gained is printed.
//!
//! Each row says the share of the pixels in a class and of the squared error there (sRGB), the JOD gained if the class
//! were that of the reference, and if it were that of taau at full rate, over the frames from `--warm` on. A pixel may
//! be in several classes. Frames are jittered; the reference is supersampled. Then follows what the errors at
//! silhouettes came from.
//!
//! `cargo research loss-by-class SCENE`
//!
//! Makes the table of `docs/notes.md`; one to three minutes a clip of 320x180.

mod classes;
mod edges;
mod rows;

use crate::error::AnyError;
use afterimage::internal::{Foveation, FoveationKind, Method, Settings, Smr, ViewFrame};
use afterimage::kernel::depth::disparity;
use afterimage::{DepthConvention, Gaze, Image, ViewGeometry};
use afterimage_cli::args::parse_size;
use afterimage_lab::device::Headless;
use afterimage_lab::metric::{References, Tracker, encode};
use afterimage_lab::picture::to_rgb8;
use afterimage_lab::source::{
    FrameRequest, FrameSource, ReadLimits, SceneChoice, SceneOptions, ViewedScene, is_scene, open,
};
use afterimage_metric::{Display, Viewing};
use clap::Args;
use classes::{SILHOUETTE, Seen, luma_of, masks, near, picture};
use edges::Pictures;
use rows::{Classes, Post, Scored, jod_of, squared_errors};
use std::path::{Path, PathBuf};

/// Gaze positions as shares of the size, 16 frames each; those of the experiment `quads`.
const GAZES: [[f32; 2]; 4] = [[0.25, 0.33], [0.75, 0.33], [0.75, 0.72], [0.25, 0.72]];
const FRAMES_PER_GAZE: u64 = 16;

/// The pixels with the largest errors in a class, at most one in each block of 8x8 pixels.
fn worst(errors: &Image<f32>, mask: &Image<bool>, count: usize) -> Vec<[u32; 2]> {
    let size = errors.size();
    let mut pixels: Vec<_> = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y])).collect();
    pixels.retain(|&px| near(mask, px, [0, 0]));
    pixels.sort_by(|&a, &b| near(errors, b, [0, 0]).total_cmp(&near(errors, a, [0, 0])));
    let mut chosen: Vec<[u32; 2]> = vec![];
    for px in pixels {
        if chosen.len() < count && chosen.iter().all(|other| [0, 1].iter().any(|&i| other[i] / 8 != px[i] / 8)) {
            chosen.push(px);
        }
    }
    chosen
}

/// Which pixels hold how much of the quality that frames shaded by quads lose
#[derive(Args, Clone, Debug)]
pub struct LossArgs {
    /// Scene, clip or folder of frames, as for `afterimage run`
    pub input: String,
    /// Camera of the scene, as for `afterimage run`
    #[arg(long, value_name = "NAME|FILE.json")]
    pub camera: Option<String>,
    /// Size of a frame, pixels
    #[arg(long, value_parser = parse_size, value_name = "WxH", default_value = "320x180")]
    pub size: [u32; 2],
    /// Frames of the clip
    #[arg(long, value_name = "N", default_value_t = 36, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub frames: u64,
    /// Frames before the first that is scored
    #[arg(long, value_name = "N", default_value_t = 20)]
    pub warm: u64,
    /// Notes of so many of the worst pixels within one pixel of a silhouette
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub explain: usize,
    /// Write pictures of the last frame here
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
}

fn source_of(args: &LossArgs) -> Result<Box<dyn FrameSource>, AnyError> {
    let input = &args.input;
    let scene = SceneOptions { size: Some(args.size), hfov_deg: None, fps: None };
    let limits = ReadLimits::from_megapixels(64);
    if !is_scene(input) {
        return Ok(open(input, &limits, &scene)?);
    }
    let choice = SceneChoice { camera: args.camera.as_deref(), options: scene, limits, ..SceneChoice::new(input) };
    Ok(Box::new(ViewedScene::open(&choice)?.on(Headless::find_roomy(true).ok_or("no device")?)?))
}

pub fn bench(args: &LossArgs) -> Result<(), AnyError> {
    let LossArgs { input, frames, warm, explain, .. } = args;
    let (frames, warm) = (*frames, *warm);
    let mut source = source_of(args)?;
    let info = source.info().clone();
    let size = info.size;
    let geometry = ViewGeometry::flat(size, info.hfov_deg.unwrap_or(70.0))?;
    let viewing = Viewing { geometry, display: Display::default(), fps: info.fps.unwrap_or(60.0) };
    let (mut references, mut tracker) = (References::default().with_jod(viewing), Tracker::default());
    let coarse = Image::filled(size, 3.0);
    let smr = Method::Smr(Smr { antialias: true, ..Smr::default() });
    let full_rate = Foveation { kind: FoveationKind::Off, ..Foveation::default() };
    let mut baselines = [
        Post::new("full rate, taa", Method::Taa, full_rate, size)?,
        Post::new("full rate, taau", Method::Taau, full_rate, size)?,
    ];
    let mut rows = [
        (Post::new("quads, 25 %, no gaze", smr, Foveation::uniform(0.25), size)?, Classes::new()),
        (Post::new("quads, Settings::screen", smr, Settings::screen().foveation, size)?, Classes::new()),
    ];
    let mut luma_before: Option<Image<f32>> = None;
    for index in 0..frames {
        let at = GAZES[(index / FRAMES_PER_GAZE % 4) as usize];
        let gaze_px = [at[0] * size[0] as f32, at[1] * size[1] as f32];
        let jitter_px = Foveation::jitter_px(index + 1);
        let request = FrameRequest {
            gaze_px,
            jitter_px: Some(jitter_px),
            reference_samples: Some(16),
            ..FrameRequest::full_rate(index)
        };
        let frame = source.render(&request)?;
        let ecc_deg = geometry.eccentricity_map(gaze_px);
        let tracked = tracker.advance(&frame.reference, &geometry, &ecc_deg, &coarse);
        let full = encode(&frame.reference.color, 0.0);
        let sampled = encode(&frame.given().color, 0.0);
        let reference = references.next(&full, &tracked, &ecc_deg);
        let scored = Scored { reference: &reference, tracked: &tracked, ecc_deg: &ecc_deg, first: index == warm };
        let view = ViewFrame {
            jitter_px,
            previous_from_current: frame.given().previous_from_current,
            ..ViewFrame::new(geometry, Gaze::At { px: gaze_px })
        };
        let map = DepthConvention::Linear.disparity_map();
        let depth = frame.reference.depth.as_ref().ok_or("no depth")?;
        let seen = Seen {
            disparity: depth.map(|z| disparity(z, map)),
            luma: luma_of(&full),
            luma_before: luma_before.as_ref(),
            tracked: &tracked,
        };
        for post in baselines.iter_mut().chain(rows.iter_mut().map(|row| &mut row.0)) {
            post.show(frame.given(), &view, index, None)?;
            scored.push(&mut post.scorer, &post.shown);
        }
        let taau = &baselines[1].shown;
        for (post, classes) in &mut rows {
            classes.masks = masks(&seen, &post.decided);
            classes.push(&scored, &post.shown, taau);
            if index >= warm {
                let given = frame.given();
                let pictures = Pictures { given, reference: &full, shown: &post.shown, sampled: &sampled, taau };
                classes.count(&seen, &post.decided, &pictures);
            }
            if index + 1 == frames {
                let errors = squared_errors(&post.shown, &full);
                for px in worst(&errors, &classes.masks[SILHOUETTE], *explain) {
                    say!("reference {:?}, shown {:?}", near(&full, px, [0, 0]), near(&post.shown, px, [0, 0]));
                    post.show(frame.given(), &view, index, Some(px))?;
                }
                if let Some(out) = &args.out {
                    write_pictures(out, post, classes, &full, &errors)?;
                }
            }
        }
        luma_before = Some(seen.luma);
    }
    say!("{input} {}x{}, frames {warm} to {frames}", size[0], size[1]);
    for post in &baselines {
        say!("{:26} {:.3} JOD", post.name, jod_of(&post.scorer));
    }
    for (post, classes) in &rows {
        let jod = jod_of(&post.scorer);
        say!("{:26} {jod:.3} JOD", post.name);
        classes.print(jod);
    }
    Ok(())
}

/// Writes the reference, the shown frame, its errors (white: 0.25 in sRGB) and the classes of its pixels.
fn write_pictures(
    out: &Path,
    post: &Post,
    classes: &Classes,
    full: &Image<[f32; 3]>,
    errors: &Image<f32>,
) -> Result<(), AnyError> {
    std::fs::create_dir_all(out)?;
    let name = post.name.replace([' ', ',', '%', ':'], "_");
    to_rgb8(full).save(out.join("reference.png"))?;
    to_rgb8(&post.shown).save(out.join(format!("{name}.png")))?;
    let bright = errors.map(|error| [(4.0 * (error / 3.0).sqrt()).min(1.0); 3]);
    to_rgb8(&bright).save(out.join(format!("{name}_errors.png")))?;
    to_rgb8(&picture(&classes.masks)).save(out.join(format!("{name}_classes.png")))?;
    Ok(())
}
