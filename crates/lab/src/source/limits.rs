//! How much a file may ask for, checked from its header before memory is set aside for pixels.

use crate::error::InputError;

/// Bounds on what is read. More admits larger images, and lets a damaged or hostile header ask for as much memory.
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
    /// A limit of `megapixels` million pixels, as `--max-megapixels` states it.
    pub const fn from_megapixels(megapixels: u32) -> Self {
        Self { max_pixels: megapixels as u64 * 1_000_000 }
    }

    /// The size, if an image of `width` x `height` pixels may be read.
    pub(crate) fn check(&self, subject: &str, width: u64, height: u64) -> Result<[u32; 2], InputError> {
        if width == 0 || height == 0 {
            return Err(InputError::new(
                subject,
                format!("its header claims {width}x{height} pixels"),
                "expected at least one pixel; export the image again",
            ));
        }
        let pixels = width.saturating_mul(height);
        match (u32::try_from(width), u32::try_from(height)) {
            (Ok(w), Ok(h)) if pixels <= self.max_pixels => Ok([w, h]),
            _ => Err(InputError::new(
                subject,
                format!(
                    "its header claims {width}x{height} pixels, above the limit of {} million pixels",
                    self.max_pixels as f64 / 1e6
                ),
                format!("use a smaller image, or raise the limit with --max-megapixels {}", pixels.div_ceil(1_000_000)),
            )),
        }
    }

    /// Largest decoded block (a tile or a band of scan lines with all its channels) in bytes: four floats for every pixel
    /// of the largest image.
    pub(crate) fn max_block_bytes(&self) -> u64 {
        self.max_pixels.saturating_mul(16)
    }
}
