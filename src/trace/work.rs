//! What is to be traced: a list of samples.

/// One sample of one pixel. Lists hold the samples of a pixel one after the other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct WorkItem {
    /// x in the low, y in the high 16 bits.
    pub pixel: u32,
    /// Which of the pixel's samples: what its random draws hang on.
    pub sample: u32,
}

impl WorkItem {
    /// Sample `sample` of pixel (`x`, `y`), both below 65,536.
    pub fn new(x: u32, y: u32, sample: u32) -> Self {
        Self { pixel: x | y << 16, sample }
    }

    /// The pixel.
    pub fn xy(self) -> [u32; 2] {
        [self.pixel & 0xffff, self.pixel >> 16]
    }
}

/// Samples `samples` of every pixel in the rows `rows` of an image `width` pixels wide.
pub fn uniform(width: u32, rows: std::ops::Range<u32>, samples: std::ops::Range<u32>) -> Vec<WorkItem> {
    let pixels = rows.flat_map(|y| (0..width).map(move |x| (x, y)));
    pixels.flat_map(|(x, y)| samples.clone().map(move |s| WorkItem::new(x, y, s))).collect()
}
