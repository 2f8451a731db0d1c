//! JPEGs that are small enough to embed many of them in a page.

use afterimage_lab::whole_file::write_whole;
use image::RgbImage;
use image::codecs::jpeg::JpegEncoder;
use image::imageops::FilterType;
use std::io;
use std::path::Path;

/// Writes a JPEG at most `max_width` pixels wide, atomically.
///
/// # Errors
/// If a file cannot be read or written.
pub fn write_jpeg(path: &Path, picture: &RgbImage, max_width: u32) -> io::Result<()> {
    let narrower = (picture.width() > max_width).then(|| {
        let height = (u64::from(picture.height()) * u64::from(max_width) / u64::from(picture.width())).max(1);
        image::imageops::resize(picture, max_width, height as u32, FilterType::Triangle)
    });
    let picture = narrower.as_ref().unwrap_or(picture);
    write_whole(path, |file| JpegEncoder::new_with_quality(file, 90).encode_image(picture).map_err(io::Error::other))
}
