//! Size limits of image files, checked against the header before memory for pixels is allocated.

use crate::error::{Bound, Exceeded, InputError};

/// Bytes of a decoded block for each pixel of the largest image: four floats.
pub(crate) const BLOCK_BYTES_PER_PIXEL: u64 = 16;

/// Remedy for images above the limit.
pub(crate) const SMALLER: &str = "use a smaller image, or raise the limit";

/// Limits on image size. A higher limit admits larger images, and lets a damaged or hostile header claim as much
/// memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReadLimits {
    /// Largest width x height of an image, in pixels. Default 64 million: an 8K frame has 33 million.
    pub max_pixels: u64,
}

impl Default for ReadLimits {
    fn default() -> Self {
        Self::from_megapixels(64)
    }
}

impl ReadLimits {
    /// A limit of `megapixels` million pixels.
    pub const fn from_megapixels(megapixels: u32) -> Self {
        Self { max_pixels: megapixels as u64 * 1_000_000 }
    }

    /// Checks the size in an image's header, and returns it.
    pub(crate) fn check(&self, subject: &str, width: u64, height: u64) -> Result<[u32; 2], InputError> {
        if width == 0 || height == 0 {
            return Err(InputError::invalid(
                subject,
                format!("its header claims {width}x{height} pixels"),
                "expected at least one pixel; export the image again",
            ));
        }
        let pixels = width.saturating_mul(height);
        match (u32::try_from(width), u32::try_from(height)) {
            (Ok(w), Ok(h)) if pixels <= self.max_pixels => Ok([w, h]),
            _ => Err(InputError::limit(
                self.exceeded(Some(pixels)),
                subject,
                format!(
                    "its header claims {width}x{height} pixels, above the limit of {} million pixels",
                    self.max_pixels as f64 / 1e6
                ),
                SMALLER,
            )),
        }
    }

    /// Numbers of the error for an input that a limit of `needed` pixels would admit.
    pub(crate) fn exceeded(&self, needed: Option<u64>) -> Exceeded {
        Exceeded { bound: Bound::Pixels, needed, allowed: self.max_pixels }
    }

    /// Largest decoded block (a tile or a band of scan lines with all its channels) in bytes: that of an image at the
    /// limit with four floats per pixel.
    pub(crate) fn max_block_bytes(&self) -> u64 {
        self.max_pixels.saturating_mul(BLOCK_BYTES_PER_PIXEL)
    }
}
