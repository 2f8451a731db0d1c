//! 8-bit PNG output, written atomically.

use crate::whole_file::write_whole;
use afterimage::Image;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, RgbImage};
use std::io;
use std::path::Path;

/// 8-bit image of sRGB-encoded values in \[0, 1\].
pub fn to_rgb8(encoded: &Image<[f32; 3]>) -> RgbImage {
    let [width, height] = encoded.size();
    let pixels: Vec<[u8; 3]> = encoded.pixels().iter().map(|c| c.map(|v| (v * 255.0 + 0.5) as u8)).collect();
    RgbImage::from_raw(width, height, pixels.into_flattened()).expect("three bytes a pixel")
}

/// Writes a PNG atomically. Compression is fast rather than small, because clips have many frames.
///
/// # Errors
/// Errors of the file system.
pub fn write_png(path: &Path, picture: &RgbImage) -> io::Result<()> {
    write_whole(path, |file| {
        PngEncoder::new_with_quality(file, CompressionType::Fast, FilterType::Adaptive)
            .write_image(picture.as_raw(), picture.width(), picture.height(), ExtendedColorType::Rgb8)
            .map_err(io::Error::other)
    })
}
