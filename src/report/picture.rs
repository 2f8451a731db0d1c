//! Images as files people can open: 8-bit PNG and JPEG, written whole or not at all.

use crate::image::Image;
use crate::whole_file::write_whole;
use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::imageops::FilterType as FilterKind;
use image::{ExtendedColorType, ImageEncoder, RgbImage};
use std::io;
use std::path::Path;

/// 8-bit image of sRGB-encoded values in \[0, 1\].
pub fn to_rgb8(encoded: &Image<[f32; 3]>) -> RgbImage {
    let [width, height] = encoded.size();
    let pixels: Vec<[u8; 3]> = encoded.pixels().iter().map(|c| c.map(|v| (v * 255.0 + 0.5) as u8)).collect();
    let bytes = bytemuck::allocation::cast_vec(pixels);
    RgbImage::from_raw(width, height, bytes).expect("three bytes a pixel")
}

/// Writes a PNG, whole or not at all. Fast compression: frames are many.
///
/// # Errors
/// Those of the file system.
pub fn write_png(path: &Path, picture: &RgbImage) -> io::Result<()> {
    write_whole(path, |file| {
        PngEncoder::new_with_quality(file, CompressionType::Fast, FilterType::Adaptive)
            .write_image(picture.as_raw(), picture.width(), picture.height(), ExtendedColorType::Rgb8)
            .map_err(io::Error::other)
    })
}

/// Writes a JPEG no wider than `max_width` pixels, whole or not at all: small enough for many of them in one page.
///
/// # Errors
/// Those of the file system.
pub fn write_jpeg(path: &Path, picture: &RgbImage, max_width: u32) -> io::Result<()> {
    let narrower = (picture.width() > max_width).then(|| {
        let height = (u64::from(picture.height()) * u64::from(max_width) / u64::from(picture.width())).max(1);
        image::imageops::resize(picture, max_width, height as u32, FilterKind::Triangle)
    });
    let picture = narrower.as_ref().unwrap_or(picture);
    write_whole(path, |file| JpegEncoder::new_with_quality(file, 90).encode_image(picture).map_err(io::Error::other))
}
