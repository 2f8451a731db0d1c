//! Images as files people can open: 8-bit PNG, written whole or not at all.

use crate::image::Image;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, RgbImage};
use std::fs;
use std::io;
use std::path::Path;

/// 8-bit image of sRGB-encoded values in \[0, 1\].
pub fn to_rgb8(encoded: &Image<[f32; 3]>) -> RgbImage {
    let [width, height] = encoded.size();
    let bytes = encoded
        .pixels()
        .iter()
        .flat_map(|c| c.map(|v| (v * 255.0 + 0.5) as u8))
        .collect();
    RgbImage::from_raw(width, height, bytes).expect("three bytes a pixel")
}

/// Writes `path` with what `fill` puts into it: under a temporary name beside it first, so that no half-written file is ever
/// seen under the final one.
///
/// # Errors
/// Those of the file system and of `fill`.
pub fn write_whole(
    path: &Path,
    fill: impl FnOnce(&mut dyn io::Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".partial");
    let partial = path.with_file_name(name);
    let write = || {
        let mut file = io::BufWriter::new(fs::File::create(&partial)?);
        fill(&mut file)?;
        io::Write::flush(&mut file)?;
        fs::rename(&partial, path)
    };
    write().inspect_err(|_| {
        // The error that matters is the first one.
        let _ = fs::remove_file(&partial);
    })
}

/// Writes a PNG, whole or not at all. Fast compression: frames are many.
///
/// # Errors
/// Those of the file system.
pub fn write_png(path: &Path, picture: &RgbImage) -> io::Result<()> {
    write_whole(path, |file| {
        PngEncoder::new_with_quality(file, CompressionType::Fast, FilterType::Adaptive)
            .write_image(
                picture.as_raw(),
                picture.width(),
                picture.height(),
                ExtendedColorType::Rgb8,
            )
            .map_err(io::Error::other)
    })
}
