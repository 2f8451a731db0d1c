//! Still images: the same frame for ever.

use super::cameras::Cameras;
use super::exr_file::{ExrHeader, Vectors, guarded, io_error, one_line};
use super::limits::ReadLimits;
use super::{FrameSource, SourceFrame, SourceInfo};
use crate::error::InputError;
use crate::image::Image;
use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits};
use std::path::Path;

/// A still image, decoded once.
///
/// PNG and JPEG are taken as sRGB (gamma and colour profiles in the file are ignored, and so is its orientation tag), grey
/// counts for all three channels, alpha is ignored. EXR is linear; its depth is used, its motion is not, and a `cameras.json`
/// beside it gives the field of view.
#[derive(Clone, Debug)]
pub struct StillSource {
    info: SourceInfo,
    frame: SourceFrame,
}

impl StillSource {
    /// Opens and decodes `path`, by its ending: `.png`, `.jpg`, `.jpeg` (8 or 16 bit) or `.exr`.
    ///
    /// # Errors
    /// If the file is missing, damaged, larger than the limits, of another kind, or an EXR without colour.
    pub fn open(path: &Path, limits: &ReadLimits) -> Result<Self, InputError> {
        let subject = path.display().to_string();
        if path.is_dir() {
            return Err(InputError::new(
                subject,
                "is a folder",
                "expected an image file",
            ));
        }
        match super::extension(path).as_str() {
            "exr" => Self::open_exr(path, subject, limits),
            "png" | "jpg" | "jpeg" => {
                let color = guarded(&subject, || decode_8_or_16_bit(path, &subject, limits))?;
                let frame = SourceFrame {
                    color,
                    depth: None,
                    motion: None,
                    previous_from_current: None,
                    cut: false,
                    nonfinite: 0,
                };
                Ok(Self::new(subject, frame, None))
            }
            _ => Err(InputError::new(
                subject,
                "is not of a kind that is read as a still",
                "expected .png, .jpg, .jpeg or .exr",
            )),
        }
    }

    fn open_exr(path: &Path, name: String, limits: &ReadLimits) -> Result<Self, InputError> {
        let header = ExrHeader::open(path, limits)?;
        let folder = path.parent().unwrap_or(Path::new("."));
        let cameras = Cameras::beside(folder)?;
        if let Some(c) = &cameras {
            c.check_size(header.size())?;
        }
        let exr = header.read(Vectors::Skip)?;
        let frame = SourceFrame {
            color: exr.color,
            depth: exr.depth,
            motion: None,
            previous_from_current: None,
            cut: false,
            nonfinite: exr.nonfinite,
        };
        Ok(Self::new(name, frame, cameras))
    }

    fn new(name: String, frame: SourceFrame, cameras: Option<Cameras>) -> Self {
        let info = SourceInfo {
            name,
            size: frame.color.size(),
            frames: Some(1),
            fps: cameras.as_ref().and_then(|c| c.fps),
            hfov_deg: cameras.as_ref().and_then(|c| c.hfov_deg),
            still: true,
        };
        Self { info, frame }
    }

    /// The same still under the name that the user gave.
    pub(super) fn named(mut self, name: String) -> Self {
        self.info.name = name;
        self
    }
}

impl FrameSource for StillSource {
    fn info(&self) -> &SourceInfo {
        &self.info
    }

    fn frame(&mut self, index: u64) -> Result<SourceFrame, InputError> {
        Ok(SourceFrame {
            cut: index == 0,
            ..self.frame.clone()
        })
    }
}

fn decode_8_or_16_bit(
    path: &Path,
    subject: &str,
    limits: &ReadLimits,
) -> Result<Image<[f32; 3]>, InputError> {
    let io = |e: std::io::Error| io_error(subject, &e);
    let mut reader = ImageReader::open(path)
        .map_err(io)?
        .with_guessed_format()
        .map_err(io)?;
    match reader.format() {
        Some(ImageFormat::Png | ImageFormat::Jpeg) => {}
        _ => {
            return Err(InputError::new(
                subject,
                "holds neither a PNG nor a JPEG image",
                "export it again as PNG, JPEG or EXR",
            ));
        }
    }
    // The decoder's own buffers and the 16-bit RGBA result, for the largest image that is allowed.
    let mut allowed = Limits::no_limits();
    allowed.max_alloc = Some(limits.max_pixels.saturating_mul(24).saturating_add(1 << 24));
    reader.limits(allowed.clone());
    let error = |e: ImageError| image_error(subject, e);
    let mut decoder = reader.into_decoder().map_err(error)?;
    let (w, h) = decoder.dimensions();
    let size = limits.check(subject, u64::from(w), u64::from(h))?;
    decoder.set_limits(allowed).map_err(error)?;
    let decoded = DynamicImage::from_decoder(decoder).map_err(error)?;
    let deep = matches!(
        decoded,
        DynamicImage::ImageLuma16(_)
            | DynamicImage::ImageLumaA16(_)
            | DynamicImage::ImageRgb16(_)
            | DynamicImage::ImageRgba16(_)
    );
    let pixels = if deep {
        linear_pixels(decoded.into_rgb16().as_raw(), u32::from(u16::MAX))
    } else {
        linear_pixels(decoded.into_rgb8().as_raw(), u32::from(u8::MAX))
    };
    Image::from_pixels(size, pixels)
        .map_err(|e| InputError::new(subject, e.to_string(), "export it again"))
}

/// Linear values of encoded RGB samples from 0 to `max`.
fn linear_pixels<T: Copy + Into<u32>>(encoded: &[T], max: u32) -> Vec<[f32; 3]> {
    let table: Vec<f32> = (0..=max)
        .map(|i| srgb_to_linear(f64::from(i) / f64::from(max)) as f32)
        .collect();
    let pixels = encoded.chunks_exact(3);
    pixels
        .map(|p| [p[0], p[1], p[2]].map(|c| table[c.into() as usize]))
        .collect()
}

/// IEC 61966-2-1, for values from 0 to 1.
fn srgb_to_linear(v: f64) -> f64 {
    if v <= 0.04045 {
        v / 12.92
    } else {
        ((v + 0.055) / 1.055).powf(2.4)
    }
}

fn image_error(subject: &str, error: ImageError) -> InputError {
    match error {
        ImageError::IoError(e) => io_error(subject, &e),
        ImageError::Limits(e) => InputError::new(
            subject,
            one_line(&format!("needs more memory than allowed ({e})")),
            "use a smaller image, or raise the limit with --max-megapixels N",
        ),
        ImageError::Unsupported(e) => InputError::new(
            subject,
            one_line(&format!("uses a feature that is not supported ({e})")),
            "export it again as 8 or 16 bit PNG",
        ),
        other => InputError::new(
            subject,
            one_line(&format!("is damaged or truncated ({other})")),
            "copy or export it again",
        ),
    }
}
