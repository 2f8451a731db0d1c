//! Still images: a source with a single frame.

use super::exr_file::{ChannelNames, ExrFrame, ExrHeader, PassFile, Vectors, guarded};
use super::limits::{ReadLimits, SMALLER};
use super::{FrameRequest, FrameSource, SourceInfo};
use crate::error::{InputError, io_error, one_line};
use crate::file_kind::kind;
use crate::frame::{RenderedFrame, SourceFrame};
use crate::scene::cameras::Cameras;
use afterimage::Image;
use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits};
use std::fs;
use std::io::{Cursor, ErrorKind};
use std::path::Path;

/// A still image, decoded once.
///
/// PNG and JPEG are read as sRGB, or by a PNG's gamma; color profiles are ignored, and grey is replicated to all three
/// channels. The orientation tag turns the picture. Transparent pixels are over black. EXR is linear; its depth is
/// used, its motion is ignored, and a `cameras.json` in its folder gives the field of view.
#[derive(Clone, Debug)]
pub struct StillSource {
    info: SourceInfo,
    frame: SourceFrame,
    albedo: Option<Image<[f32; 3]>>,
    warnings: Vec<String>,
    contents: Vec<String>,
}

impl StillSource {
    /// Opens and decodes `path`, whose channels are recognised by their names: [`open_named`](Self::open_named).
    ///
    /// # Errors
    /// As of [`open_named`](Self::open_named).
    pub fn open(path: &Path, limits: &ReadLimits) -> Result<Self, InputError> {
        Self::open_named(path, limits, &ChannelNames::default())
    }

    /// Opens and decodes `path`, by its ending: `.png`, `.jpg`, `.jpeg` (8 or 16 bit) or `.exr`; with another
    /// ending, by its first bytes.
    ///
    /// # Errors
    /// - [`Io`](InputError::Io): the file is missing or cannot be read.
    /// - [`Invalid`](InputError::Invalid): it is damaged, or an EXR without color or a channel of `names`;
    ///   or its `cameras.json` is.
    /// - [`NotSupported`](InputError::NotSupported): another extension, or a feature of the format that is not
    ///   implemented.
    /// - [`Limit`](InputError::Limit): it is larger than `limits` allows.
    /// - [`Request`](InputError::Request): it is a folder.
    pub fn open_named(path: &Path, limits: &ReadLimits, names: &ChannelNames) -> Result<Self, InputError> {
        let subject = path.display().to_string();
        if path.is_dir() {
            return Err(InputError::request(subject, "is a folder", "expected an image file"));
        }
        match kind(path).as_str() {
            "exr" => {
                let header = ExrHeader::open_passes(&[PassFile { pass: "", path }], limits, names)?;
                Self::from_header(&header, path.parent().unwrap_or(Path::new(".")))
            }
            "png" | "jpg" | "jpeg" => {
                let (color, warnings) = guarded(&subject, || decode_8_or_16_bit(path, &subject, limits))?;
                let frame = SourceFrame { color, ..SourceFrame::without_images(None, false) };
                Ok(Self { warnings, ..Self::new(subject, frame, None, None) })
            }
            _ => Err(InputError::not_supported(
                subject,
                "is a kind of file that is not supported as a still",
                "expected .png, .jpg, .jpeg or .exr",
            )),
        }
    }

    /// Decodes a frame in `folder`.
    pub(super) fn from_header(header: &ExrHeader, folder: &Path) -> Result<Self, InputError> {
        let name = header.subject().to_owned();
        let cameras = Cameras::beside(folder)?;
        if let Some(c) = &cameras {
            c.check_size(header.size())?;
        }
        let ExrFrame { color, depth, albedo, nonfinite, .. } = header.read(Vectors::Skip)?;
        let frame = SourceFrame { color, depth, nonfinite, ..SourceFrame::without_images(None, false) };
        let (warnings, contents) = (header.warnings().to_vec(), header.contents().to_vec());
        Ok(Self { warnings, contents, ..Self::new(name, frame, albedo, cameras) })
    }

    fn new(name: String, frame: SourceFrame, albedo: Option<Image<[f32; 3]>>, cameras: Option<Cameras>) -> Self {
        let info = SourceInfo {
            name,
            size: frame.color.size(),
            frames: Some(1),
            fps: cameras.as_ref().and_then(|c| c.fps),
            hfov_deg: cameras.as_ref().and_then(|c| c.hfov_deg),
            still: true,
            has_albedo: albedo.is_some(),
        };
        Self { info, frame, albedo, warnings: vec![], contents: vec![] }
    }

    /// Replaces the name.
    pub(super) fn named(mut self, name: String) -> Self {
        self.info.name = name;
        self
    }
}

impl FrameSource for StillSource {
    fn info(&self) -> &SourceInfo {
        &self.info
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn contents(&self) -> &[String] {
        &self.contents
    }

    fn render(&mut self, request: &FrameRequest) -> Result<RenderedFrame, InputError> {
        let frame = SourceFrame { cut: request.index == 0, ..self.frame.clone() };
        let albedo = self.albedo.clone().filter(|_| request.albedo);
        Ok(RenderedFrame { albedo, ..RenderedFrame::full_rate(request.index, request.gaze_px, frame) })
    }
}

/// Memory of the decoders: their buffers and a 16-bit RGBA result take at most this for each pixel.
const PIXEL_BYTES: u64 = 24;
/// Memory of the decoders that does not depend on the image's size.
const FIXED_BYTES: u64 = 1 << 24;

/// Linear color, and what was assumed.
fn decode_8_or_16_bit(
    path: &Path,
    subject: &str,
    limits: &ReadLimits,
) -> Result<(Image<[f32; 3]>, Vec<String>), InputError> {
    let io = |e: std::io::Error| io_error(subject, &e);
    let most_bytes = limits.max_pixels.saturating_mul(PIXEL_BYTES).saturating_add(FIXED_BYTES);
    let mut allowed = Limits::no_limits();
    allowed.max_alloc = Some(most_bytes);
    let file_bytes = fs::metadata(path).map_err(io)?.len();
    if file_bytes > most_bytes {
        return Err(InputError::limit(
            limits.exceeded(Some((file_bytes - FIXED_BYTES).div_ceil(PIXEL_BYTES))),
            subject,
            format!("has {} MB, more than the largest allowed image", file_bytes >> 20),
            SMALLER,
        ));
    }
    let bytes = fs::read(path).map_err(io)?;
    let mut reader = ImageReader::new(Cursor::new(bytes.as_slice())).with_guessed_format().map_err(io)?;
    match reader.format() {
        Some(ImageFormat::Png) => {}
        Some(ImageFormat::Jpeg) if jpeg_is_whole(&bytes) => {}
        Some(ImageFormat::Jpeg) => return Err(io_error(subject, &ErrorKind::UnexpectedEof.into())),
        _ => {
            return Err(InputError::invalid(
                subject,
                "holds neither a PNG nor a JPEG image",
                "export it again as PNG, JPEG or EXR",
            ));
        }
    }
    reader.limits(allowed.clone());
    let error = |e: ImageError| image_error(subject, e, limits);
    let mut decoder = reader.into_decoder().map_err(error)?;
    let (w, h) = decoder.dimensions();
    limits.check(subject, u64::from(w), u64::from(h))?;
    decoder.set_limits(allowed).map_err(error)?;
    // A damaged tag says nothing.
    let orientation = decoder.orientation().unwrap_or(Orientation::NoTransforms);
    let mut decoded = DynamicImage::from_decoder(decoder).map_err(error)?;
    decoded.apply_orientation(orientation);
    let mut warnings = vec![];
    let gamma = png_gamma(&bytes);
    if let Some(gamma) = gamma {
        warnings.push(format!("its gamma is {gamma}, not that of sRGB; it is read by it"));
    }
    let size = [decoded.width(), decoded.height()];
    let (pixels, is_transparent) = linear(decoded, gamma);
    if is_transparent {
        warnings.push("it has transparent pixels, which are read over black".into());
    }
    let image = Image::from_pixels(size, pixels);
    let image = image.map_err(|e| InputError::invalid(subject, e.to_string(), "export it again"))?;
    Ok((image, warnings))
}

/// Exponent of a PNG that states one other than that of sRGB: its values are light to the power of it. A chunk of sRGB
/// or of a color profile takes precedence.
fn png_gamma(bytes: &[u8]) -> Option<f64> {
    let mut rest = bytes.strip_prefix(b"\x89PNG\r\n\x1a\n")?;
    let mut gamma = None;
    while let Some((head, after)) = rest.split_first_chunk::<8>() {
        let length = u32::from_be_bytes([head[0], head[1], head[2], head[3]]) as usize;
        match &head[4..] {
            b"sRGB" | b"iCCP" => return None,
            b"gAMA" => gamma = after.first_chunk::<4>().map(|value| f64::from(u32::from_be_bytes(*value)) / 1e5),
            b"IDAT" => break,
            _ => {}
        }
        rest = after.get(length.checked_add(4)?..)?;
    }
    // 1/2.2 stands for sRGB.
    gamma.filter(|gamma| (0.1..=10.0).contains(gamma) && (gamma - 1.0 / 2.2).abs() > 0.01)
}

/// Whether a JPEG has an end marker after its first scan. The decoder silently fills missing data with grey.
fn jpeg_is_whole(bytes: &[u8]) -> bool {
    const START_OF_SCAN: u8 = 0xDA;
    const END: [u8; 2] = [0xFF, 0xD9];
    let mut at = 2;
    // Skip segments by their length: a thumbnail inside one has its own end marker.
    while let Some(&[0xFF, marker, high, low]) = bytes.get(at..at + 4) {
        if marker == START_OF_SCAN {
            // Entropy-coded data never contain 0xFF followed by a marker code.
            return bytes[at..].windows(2).any(|w| w == END);
        }
        // Fill bytes of 0xFF may precede a marker.
        at += match marker {
            0xFF => 1,
            _ => 2 + usize::from(u16::from_be_bytes([high, low])),
        };
    }
    false
}

/// Linear pixels of a decoded image, over black, and whether any was transparent. `gamma`: exponent of its values, if
/// they are not sRGB.
fn linear(decoded: DynamicImage, gamma: Option<f64>) -> (Vec<[f32; 3]>, bool) {
    let color = decoded.color();
    if color.bytes_per_pixel() > color.channel_count() {
        over_black(decoded.into_rgba16().as_raw(), u16::MAX.into(), gamma)
    } else {
        over_black(decoded.into_rgba8().as_raw(), u8::MAX.into(), gamma)
    }
}

/// Linear values of encoded RGBA samples from 0 to `max`, over black, and whether any is transparent.
fn over_black<T: Copy + Into<u32>>(encoded: &[T], max: u32, gamma: Option<f64>) -> (Vec<[f32; 3]>, bool) {
    let decode = |v: f64| gamma.map_or_else(|| srgb_to_linear(v), |gamma| v.powf(1.0 / gamma));
    let table: Vec<f32> = (0..=max).map(|i| decode(f64::from(i) / f64::from(max)) as f32).collect();
    let mut is_transparent = false;
    let pixels = encoded.chunks_exact(4).map(|p| {
        let alpha: u32 = p[3].into();
        is_transparent |= alpha < max;
        let coverage = alpha as f32 / max as f32;
        [p[0], p[1], p[2]].map(|c| table[c.into() as usize] * coverage)
    });
    (pixels.collect(), is_transparent)
}

/// IEC 61966-2-1, for values from 0 to 1.
pub(super) fn srgb_to_linear(v: f64) -> f64 {
    if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

fn image_error(subject: &str, error: ImageError, limits: &ReadLimits) -> InputError {
    match error {
        ImageError::IoError(e) => io_error(subject, &e),
        ImageError::Limits(e) => InputError::limit(
            limits.exceeded(None),
            subject,
            one_line(&format!("needs more memory than allowed ({e})")),
            SMALLER,
        ),
        ImageError::Unsupported(e) => InputError::not_supported(
            subject,
            one_line(&format!("uses a feature that is not supported ({e})")),
            "export it again as 8 or 16 bit PNG",
        ),
        other => InputError::invalid(
            subject,
            one_line(&format!("is damaged or truncated ({other})")),
            "copy or export it again",
        ),
    }
}
