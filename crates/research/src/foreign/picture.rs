//! Crops of all scenes, side by side.

use super::scores::{QUADS, SceneScores};
use crate::error::AnyError;
use afterimage_eval::report::canvas::Canvas;
use afterimage_lab::metric::CROP_PX;
use afterimage_lab::whole_file::write_whole;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::imageops::{self, FilterType as Resampling};
use image::{ExtendedColorType, ImageEncoder, RgbImage};
use std::path::Path;

/// Pixels of the picture per pixel of a crop, each way.
const ZOOM: u32 = 2;
const CROP_SIDE_PX: u32 = CROP_PX * ZOOM;
const GAP_PX: u32 = 4;
const LABEL_PX: u32 = 16;
/// Scenes side by side.
const COLUMNS: u32 = 2;
/// What the crops of a strip show: the reference, full rate with taa, and the rows with quads.
const CROPS: [&str; 2 + QUADS.len()] = ["reference", "full rate, taa", "quads, 25 %", "quads, screen"];
const STRIP_PX: [u32; 2] =
    [CROPS.len() as u32 * (CROP_SIDE_PX + GAP_PX) + 3 * GAP_PX, CROP_SIDE_PX + LABEL_PX + GAP_PX];
const PAPER: [u8; 3] = [255; 3];
const INK: [u8; 3] = [0; 3];

/// A labelled strip of crops for each scene: reference, full rate with taa, quads.
pub fn crops(scores: &[SceneScores]) -> RgbImage {
    let lines = (scores.len() as u32).div_ceil(COLUMNS).max(1);
    let mut canvas = Canvas::new(COLUMNS * STRIP_PX[0], LABEL_PX + lines * STRIP_PX[1], PAPER);
    for strip in 0..COLUMNS {
        for (column, name) in (0..).zip(CROPS) {
            canvas.small(name, strip * STRIP_PX[0] + crop_x(column), 0, INK);
        }
    }
    for (i, scene) in (0..).zip(scores) {
        let [x, y] = [i / lines * STRIP_PX[0], LABEL_PX + i % lines * STRIP_PX[1]];
        canvas.small(&scene.name, x, y, INK);
        let shown = &scene.shown;
        let quads = QUADS.map(|row| &shown.rows[row]);
        let crops = [&shown.reference, &shown.rows[0]].into_iter().chain(quads);
        for (column, crop) in (0..).zip(crops) {
            let [width, height] = [crop.width() * ZOOM, crop.height() * ZOOM];
            let crop = imageops::resize(crop, width, height, Resampling::Nearest);
            canvas.put(&crop, x + crop_x(column), y + LABEL_PX);
        }
    }
    canvas.0
}

/// Left edge of a crop in its strip.
fn crop_x(column: u32) -> u32 {
    column * (CROP_SIDE_PX + GAP_PX)
}

/// Writes a small PNG.
pub fn write(path: &Path, picture: &RgbImage) -> Result<(), AnyError> {
    write_whole(path, |file| {
        PngEncoder::new_with_quality(file, CompressionType::Best, FilterType::Adaptive)
            .write_image(picture.as_raw(), picture.width(), picture.height(), ExtendedColorType::Rgb8)
            .map_err(std::io::Error::other)
    })
    .map_err(|e| format!("{}: {e}", path.display()).into())
}
