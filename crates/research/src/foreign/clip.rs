//! Frames of a scene as every method shows them.

use super::camera::{self, HFOV_DEG};
use super::options::ForeignArgs;
use super::scenes::SceneInput;
use crate::error::AnyError;
use afterimage::cpu::{CpuAfterimage, Frame};
use afterimage::internal::{ContextDesc, Foveation, Method, Reset, Settings, Smr, ViewFrame};
use afterimage::{Gaze, Image, ViewGeometry};
use afterimage_lab::device::Headless;
use afterimage_lab::frame::SourceFrame;
use afterimage_lab::metric::encode;
use afterimage_lab::picture::to_rgb8;
use afterimage_lab::source::{FrameRequest, FrameSource};
use image::RgbImage;
use rayon::prelude::*;
use std::sync::Arc;

/// Rows of the tables.
pub const ROWS: [&str; 4] = ["full rate, taa", "full rate, taau", "quads, 25 %", "quads, `screen`"];
/// Gaze positions as shares of the size, 16 frames each.
const GAZES: [[f32; 2]; 4] = [[0.25, 0.33], [0.75, 0.33], [0.75, 0.72], [0.25, 0.72]];
const FRAMES_PER_GAZE: u64 = 16;

/// The scored frames, sRGB-encoded.
pub struct Clip {
    pub geometry: ViewGeometry,
    /// Index of the first frame.
    pub first: u64,
    /// Gaze of each frame in pixels.
    pub gazes_px: Vec<[f32; 2]>,
    pub reference: Vec<RgbImage>,
    /// In the order of [`ROWS`].
    pub rows: Vec<ShownRow>,
}

/// What a method shows.
pub struct ShownRow {
    pub frames: Vec<RgbImage>,
    /// Mean share of the pixels that are shaded, 0 to 1.
    pub shaded: f64,
}

/// A method on one kind of frames.
struct Run {
    post: CpuAfterimage,
    frames: Vec<RgbImage>,
    /// Sum over the scored frames of the share of the pixels that are shaded.
    shaded: f64,
}

/// Settings in the order of [`ROWS`].
fn settings() -> [Settings; ROWS.len()] {
    let every_pixel = Foveation { fovea_deg: 180.0, mid_deg: 180.0, ..Foveation::quads() };
    let smr = Method::Smr(Smr { antialias: true, ..Smr::default() });
    let of = |method, foveation| Settings { method, foveation, ..Settings::default() };
    [of(Method::Taa, every_pixel), of(Method::Taau, every_pixel), of(smr, Foveation::uniform(0.25)), Settings::screen()]
}

/// Renders a scene, and shows its frames with all methods.
pub fn render(scene: &SceneInput, options: &ForeignArgs, device: &Arc<Headless>) -> Result<Clip, AnyError> {
    let (viewed, turn) = camera::open(scene, options)?;
    let mut source = viewed.on(device.clone())?;
    let geometry = ViewGeometry::flat(options.size, HFOV_DEG)?;
    let mut runs = settings().into_iter().map(|s| Run::new(options.size, s)).collect::<Result<Vec<_>, _>>()?;
    let (mut gazes_px, mut reference) = (vec![], vec![]);
    for index in 0..options.frames {
        let is_scored = index >= options.warm();
        if let Some(turn) = turn {
            source.steer(index, Some([turn.pose(index.saturating_sub(1)), turn.pose(index)]));
        }
        let (gaze_px, jitter_px) = (gaze_px(index, options.size), Foveation::jitter_px(index + 1));
        let frame = source.render(&FrameRequest {
            gaze_px,
            jitter_px: Some(jitter_px),
            reference_samples: is_scored.then_some(options.reference_samples),
            ..FrameRequest::full_rate(index)
        })?;
        let given = frame.given();
        let view = ViewFrame {
            jitter_px,
            previous_from_current: given.previous_from_current,
            ..ViewFrame::new(geometry, Gaze::At { px: gaze_px })
        };
        runs.par_iter_mut().try_for_each(|run| run.show(given, &view, index, is_scored))?;
        if is_scored {
            gazes_px.push(gaze_px);
            reference.push(to_rgb8(&encode(&frame.reference.color, 0.0)));
        }
    }
    let rows =
        runs.into_iter().map(|run| ShownRow { shaded: run.shaded / run.frames.len() as f64, frames: run.frames });
    Ok(Clip { geometry, first: options.warm(), gazes_px, reference, rows: rows.collect() })
}

fn gaze_px(index: u64, size: [u32; 2]) -> [f32; 2] {
    let at = GAZES[(index / FRAMES_PER_GAZE % GAZES.len() as u64) as usize];
    [at[0] * size[0] as f32, at[1] * size[1] as f32]
}

impl Run {
    fn new(size: [u32; 2], settings: Settings) -> Result<Self, AnyError> {
        let post = CpuAfterimage::new(&ContextDesc { settings, ..ContextDesc::new(size) })?;
        Ok(Self { post, frames: vec![], shaded: 0.0 })
    }

    /// Shows a frame, and keeps it if it is scored.
    fn show(&mut self, frame: &SourceFrame, view: &ViewFrame, index: u64, is_scored: bool) -> Result<(), AnyError> {
        let (depth, motion) = (frame.depth.as_ref().ok_or("no depth")?, frame.motion.as_ref().ok_or("no motion")?);
        let (colors, depths, motions) = ([&frame.color], [depth], [motion]);
        let views = [*view];
        let reset = if frame.cut { Reset::All } else { Reset::None };
        let input = Frame { depth: Some(&depths), motion: Some(&motions), reset, ..Frame::new(&colors, &views, index) };
        let shaded = share(&self.post.plan(&input)?[0]);
        let mut shown = [Image::filled(frame.color.size(), [0.0; 3])];
        self.post.process(&input, &mut shown)?;
        if is_scored {
            self.shaded += shaded;
            self.frames.push(to_rgb8(&encode(&shown[0], 0.0)));
        }
        Ok(())
    }
}

/// Share of the pixels that are chosen.
fn share(mask: &Image<bool>) -> f64 {
    mask.pixels().iter().filter(|&&chosen| chosen).count() as f64 / mask.pixels().len() as f64
}
