//! Scores of a clip.

use super::camera::FPS;
use super::clip::{Clip, ShownRow};
use afterimage::Image;
use afterimage_lab::metric::CROP_PX;
use afterimage_metric::{Display, ReferenceVideo, TestVideo, Viewing, psnr_db};
use image::RgbImage;
use rayon::prelude::*;

/// Rows of the tables that shade quads, 25 % first.
pub const QUADS: [usize; 2] = [2, 3];

/// Scores of a scene.
pub struct SceneScores {
    pub name: String,
    /// In the order of [`ROWS`](super::clip::ROWS).
    pub rows: Vec<RowScores>,
    /// The crop in which a row that shades quads has most error beyond that of full rate with taa.
    pub shown: ShownCrop,
}

/// Scores of a row.
pub struct RowScores {
    /// Share of the pixels that are shaded, 0 to 1.
    pub shaded: f64,
    pub jod: f64,
    /// `None` if no judge ran.
    pub fvvdp_jod: Option<f64>,
    /// Mean squared error on a scale of 1.
    pub mse: f64,
    pub worst: Crop,
}

/// A crop of [`CROP_PX`] a side.
#[derive(Clone, Copy)]
pub struct Crop {
    /// Index of the frame in the scored part of the clip.
    at: usize,
    /// Index of the frame in the clip.
    pub frame: u64,
    /// Top left corner in pixels.
    pub px: [u32; 2],
    /// What the crop was chosen by: a mean squared error on a scale of 1, or a difference of two.
    pub error: f64,
}

/// One crop as the reference and all rows show it.
pub struct ShownCrop {
    pub crop: Crop,
    pub reference: RgbImage,
    pub rows: Vec<RgbImage>,
    /// Mean squared errors of the rows on a scale of 1.
    pub mse: Vec<f64>,
}

/// Scores a clip. `fvvdp_jod`: FovVideoVDP of each row.
pub fn score(name: &str, clip: &Clip, fvvdp_jod: Option<Vec<f64>>) -> SceneScores {
    let jods = jods(clip);
    let row = |(i, row): (usize, &ShownRow)| RowScores {
        shaded: row.shaded,
        jod: jods[i],
        fvvdp_jod: fvvdp_jod.as_ref().map(|jod| jod[i]),
        mse: clip.reference.iter().zip(&row.frames).map(|(r, s)| mse(r, s)).sum::<f64>() / row.frames.len() as f64,
        worst: worst_crop(clip, |at, px| crop_mse(clip, row, at, px)),
    };
    let added = |at, px| {
        let quads = QUADS.map(|i| crop_mse(clip, &clip.rows[i], at, px));
        quads[0].max(quads[1]) - crop_mse(clip, &clip.rows[0], at, px)
    };
    let rows = clip.rows.iter().enumerate().map(row).collect();
    SceneScores { name: name.into(), rows, shown: show(clip, worst_crop(clip, added)) }
}

/// JOD of each row.
fn jods(clip: &Clip) -> Vec<f64> {
    let viewing = Viewing { geometry: clip.geometry, display: Display::default(), fps: FPS };
    let mut video = ReferenceVideo::new(viewing);
    let mut tests = vec![TestVideo::default(); clip.rows.len()];
    for (i, (reference, &gaze_px)) in clip.reference.iter().zip(&clip.gazes_px).enumerate() {
        let reference = video.push(&unpacked(reference), Some(gaze_px));
        tests.par_iter_mut().zip(&clip.rows).for_each(|(test, row)| {
            test.push(&reference, &unpacked(&row.frames[i]));
        });
    }
    tests.iter().map(|test| test.score().map_or(f64::NAN, |score| score.jod)).collect()
}

fn unpacked(picture: &RgbImage) -> Image<[f32; 3]> {
    let pixels = picture.pixels().map(|c| c.0.map(|v| f32::from(v) / 255.0)).collect();
    Image::from_pixels([picture.width(), picture.height()], pixels).expect("one color a pixel")
}

/// The crop with the largest `error`, of a frame and a corner; the earliest of equally bad ones. Crops tile the frame
/// from its top left corner; the last column and row are moved inwards to fit.
fn worst_crop(clip: &Clip, error: impl Fn(usize, [u32; 2]) -> f64) -> Crop {
    let [width, height] = clip.geometry.size_px();
    let corners = |len: u32| (0..len).step_by(CROP_PX as usize).map(move |at| at.min(len.saturating_sub(CROP_PX)));
    let mut worst = Crop { at: 0, frame: clip.first, px: [0; 2], error: f64::NEG_INFINITY };
    for at in 0..clip.reference.len() {
        for px in corners(height).flat_map(|y| corners(width).map(move |x| [x, y])) {
            let error = error(at, px);
            if error > worst.error {
                worst = Crop { at, frame: clip.first + at as u64, px, error };
            }
        }
    }
    worst
}

fn crop_mse(clip: &Clip, row: &ShownRow, at: usize, px: [u32; 2]) -> f64 {
    mse(&cut(&clip.reference[at], px), &cut(&row.frames[at], px))
}

fn show(clip: &Clip, crop: Crop) -> ShownCrop {
    let reference = cut(&clip.reference[crop.at], crop.px);
    let rows: Vec<_> = clip.rows.iter().map(|row| cut(&row.frames[crop.at], crop.px)).collect();
    let mse = rows.iter().map(|row| mse(&reference, row)).collect();
    ShownCrop { crop, reference, rows, mse }
}

fn cut(picture: &RgbImage, px: [u32; 2]) -> RgbImage {
    image::imageops::crop_imm(picture, px[0], px[1], CROP_PX, CROP_PX).to_image()
}

/// Mean squared error of two pictures on a scale of 1.
fn mse(reference: &RgbImage, shown: &RgbImage) -> f64 {
    let pairs = reference.as_raw().iter().zip(shown.as_raw());
    let squared: u64 = pairs.map(|(&r, &s)| u64::from(r.abs_diff(s)).pow(2)).sum();
    squared as f64 / (255.0 * 255.0 * reference.as_raw().len() as f64)
}

/// PSNR in dB as text.
pub fn psnr(mse: f64) -> String {
    psnr_db(mse).map_or("no error".into(), |db| format!("{db:.1}"))
}
