//! Worst crop: the small part of a frame in which a method loses most against the foveated frame.

use super::mean::Mean;
use super::psnr_db;
use afterimage::Image;
use glam::Vec3;
use pulp::{Arch, Simd, WithSimd};
use serde::{Deserialize, Serialize};

/// Side of a crop in pixels.
pub const CROP_PX: u32 = 64;

/// First frame of a clip whose crops count: before it there is almost no history.
pub const CROP_FROM_FRAME: u64 = 2;

/// PSNR in dB beyond which the error of a crop cannot be seen: a root mean square of 0.8 steps of 8-bit output. A
/// difference between two larger PSNRs counts as 0.
pub const CROP_INVISIBLE_DB: f64 = 50.0;

/// The crop of a clip in which a method loses most against the foveated frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WorstCrop {
    /// PSNR of the method minus PSNR of the foveated frame, in dB, each at most [`CROP_INVISIBLE_DB`]. Negative: the
    /// method is worse.
    pub delta_db: f64,
    /// Frame of the crop, from 0.
    pub frame: u64,
    /// Left edge of the crop in pixels.
    pub x_px: u32,
    /// Top edge of the crop in pixels.
    pub y_px: u32,
}

/// Compares the crops of a method with those of the foveated frame over a clip.
#[derive(Clone, Copy, Debug, Default)]
pub struct Crops {
    frames: u64,
    worst: Option<WorstCrop>,
}

impl Crops {
    /// Adds the next frame: full-rate reference, the method's output, and the foveated frame (the output of
    /// [`Method::None`](afterimage::internal::Method::None)), all sRGB-encoded.
    ///
    /// Crops tile the frame from its top left corner; the last column and row are moved inwards to fit. A frame smaller
    /// than a crop is one crop.
    ///
    /// # Panics
    /// If the sizes differ.
    pub fn push(&mut self, reference: &Image<[f32; 3]>, output: &Image<[f32; 3]>, foveated: &Image<[f32; 3]>) {
        let size = reference.size();
        assert!(output.size() == size && foveated.size() == size);
        let frame = self.frames;
        self.frames += 1;
        if frame < CROP_FROM_FRAME {
            return;
        }
        for [x_px, y_px] in corners(size) {
            let shown_db = |image| visible_db(crop_mse(reference, image, [x_px, y_px]));
            let delta_db = shown_db(output) - shown_db(foveated);
            if self.worst.is_none_or(|worst| delta_db < worst.delta_db) {
                self.worst = Some(WorstCrop { delta_db, frame, x_px, y_px });
            }
        }
    }

    /// Forgets the worst crop so far.
    pub fn restart(&mut self) {
        self.worst = None;
    }

    /// The worst crop so far; the earliest of equally bad ones. `None` before frame [`CROP_FROM_FRAME`].
    pub fn worst(&self) -> Option<WorstCrop> {
        self.worst
    }
}

/// The crop of a frame with the largest mean squared error, by its top left corner, and this error; the first of equal
/// ones. Both images are sRGB-encoded. `None` if they are equal.
///
/// # Panics
/// If the sizes differ.
pub fn worst_crop(reference: &Image<[f32; 3]>, output: &Image<[f32; 3]>) -> Option<([u32; 2], f64)> {
    assert!(output.size() == reference.size());
    let errors = corners(reference.size()).map(|px| (px, crop_mse(reference, output, px)));
    errors.filter(|(_, mse)| *mse > 0.0).reduce(|worst, next| if next.1 > worst.1 { next } else { worst })
}

/// Mean of the values that a map has in the crop with this corner. `margin_px`: width of the frame's border that the
/// map does not cover. `None` if it covers none of the crop.
pub fn crop_mean(map: &Image<f32>, corner_px: [u32; 2], margin_px: u32) -> Option<f64> {
    let range = |from: u32, len: usize| {
        let [from, to] = [from, from + CROP_PX].map(|at| (at.saturating_sub(margin_px) as usize).min(len));
        from..to
    };
    let columns = range(corner_px[0], map.width());
    let mut mean = Mean::default();
    range(corner_px[1], map.height()).for_each(|y| mean.add_all(&map.row(y)[columns.clone()]));
    mean.value()
}

/// Corners of the crops of a frame, row by row.
fn corners(size: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    let [columns, rows] = size.map(|len| (0..len).step_by(CROP_PX as usize).map(move |at| inwards(at, len)));
    rows.flat_map(move |y_px| columns.clone().map(move |x_px| [x_px, y_px]))
}

/// Position of a crop along `len` pixels, moved inwards if it would cross the border.
fn inwards(at: u32, len: u32) -> u32 {
    at.min(len.saturating_sub(CROP_PX))
}

/// PSNR in dB of a mean squared error, at most [`CROP_INVISIBLE_DB`].
fn visible_db(mse: f64) -> f64 {
    psnr_db(mse).map_or(CROP_INVISIBLE_DB, |db| db.min(CROP_INVISIBLE_DB))
}

fn crop_mse(reference: &Image<[f32; 3]>, image: &Image<[f32; 3]>, px: [u32; 2]) -> f64 {
    Arch::new().dispatch(Crop { reference, image, px })
}

/// Arguments of the loop of [`crop_mse`].
struct Crop<'a> {
    reference: &'a Image<[f32; 3]>,
    image: &'a Image<[f32; 3]>,
    /// Top left corner.
    px: [u32; 2],
}

impl WithSimd for Crop<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        let Self { reference, image, px: [x_px, y_px] } = self;
        let columns = x_px as usize..reference.width().min((x_px + CROP_PX) as usize);
        let rows = y_px as usize..reference.height().min((y_px + CROP_PX) as usize);
        let mut mean = Mean::default();
        let mut squared = [0.0; CROP_PX as usize];
        let squared = &mut squared[..columns.len()];
        for y in rows {
            let pairs = reference.row(y)[columns.clone()].iter().zip(&image.row(y)[columns.clone()]);
            for (squared, (r, s)) in squared.iter_mut().zip(pairs) {
                *squared = (Vec3::from(*s) - Vec3::from(*r)).length_squared();
            }
            mean.add_all(squared);
        }
        mean.value().unwrap_or(0.0) / 3.0
    }
}
