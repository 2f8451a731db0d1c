//! Samples to trace: spans of pixels, and the sample numbers of each pixel. The GPU tracer expands them on the device.

use std::ops::Range;

/// Adjacent pixels of a row. Twin of `Span` in `shaders/trace/expand_pass.wgsl`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Span {
    /// First pixel: x in the low 16 bits, y in the high 16 bits.
    pub pixel: u32,
    /// Number of pixels.
    pub count: u32,
    /// Number of pixels in all earlier spans.
    pub before: u32,
}

/// A set of pixels, each with the same range of sample numbers, which seed the samples' random draws.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Spans {
    spans: Vec<Span>,
    samples: Range<u32>,
}

impl Spans {
    /// Samples `samples` of `pixels`, which are ordered by row, then by column.
    pub fn new(pixels: impl IntoIterator<Item = [u32; 2]>, samples: Range<u32>) -> Self {
        let mut spans: Vec<Span> = vec![];
        for [x, y] in pixels {
            let pixel = x | y << 16;
            match spans.last_mut() {
                Some(last) if last.pixel + last.count == pixel && pixel >> 16 == last.pixel >> 16 => last.count += 1,
                last => {
                    let before = last.map_or(0, |l| l.before + l.count);
                    spans.push(Span { pixel, count: 1, before });
                }
            }
        }
        Self { spans, samples }
    }

    /// Samples `samples` of pixel runs (columns, row), which are ordered by row, then by column.
    pub fn of_runs(runs: impl IntoIterator<Item = (Range<u32>, u32)>, samples: Range<u32>) -> Self {
        let mut before = 0;
        let span = |(columns, y): (Range<u32>, u32)| {
            let span = Span { pixel: columns.start | y << 16, count: columns.len() as u32, before };
            before += span.count;
            span
        };
        let spans = runs.into_iter().filter(|(columns, _)| !columns.is_empty()).map(span).collect();
        Self { spans, samples }
    }

    /// Samples `samples` of every pixel in rows `rows` of an image `width` pixels wide.
    pub fn uniform(width: u32, rows: Range<u32>, samples: Range<u32>) -> Self {
        let first = rows.start;
        let span = |y: u32| Span { pixel: y << 16, count: width, before: (y - first) * width };
        Self { spans: if width == 0 { vec![] } else { rows.map(span).collect() }, samples }
    }

    /// Corner and size in pixels of the smallest window that contains all pixels.
    pub fn window(&self) -> ([u32; 2], [u32; 2]) {
        let spans = || self.spans.iter();
        let columns = |s: &Span| (s.pixel & 0xffff, (s.pixel & 0xffff) + s.count);
        let left = spans().map(|s| columns(s).0).min().unwrap_or(0);
        let right = spans().map(|s| columns(s).1).max().unwrap_or(0);
        let top = spans().map(|s| s.pixel >> 16).min().unwrap_or(0);
        let bottom = spans().map(|s| (s.pixel >> 16) + 1).max().unwrap_or(0);
        ([left, top], [right - left, bottom - top])
    }

    /// Spans of the pixels.
    pub fn spans(&self) -> &[Span] {
        &self.spans
    }

    /// Sample numbers of each pixel.
    pub fn samples(&self) -> Range<u32> {
        self.samples.clone()
    }

    /// All pixels, as in [`Span::pixel`].
    pub(super) fn each_pixel(&self) -> impl Iterator<Item = u32> + '_ {
        self.spans.iter().flat_map(|s| s.pixel..s.pixel + s.count)
    }

    /// Number of pixels.
    pub fn pixels(&self) -> u32 {
        self.spans.last().map_or(0, |s| s.before + s.count)
    }

    /// Number of samples over all pixels.
    pub fn len(&self) -> u64 {
        u64::from(self.pixels()) * self.samples.len() as u64
    }

    /// Whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_of_pixels_become_spans() {
        let spans = Spans::new([[3, 0], [4, 0], [6, 0], [0, 1], [1, 1], [65535, 2], [0, 3]], 2..5);
        let expected = [(3, 0, 2), (6, 0, 1), (0, 1, 2), (65535, 2, 1), (0, 3, 1)];
        let got: Vec<_> = spans.spans().iter().map(|s| (s.pixel & 0xffff, s.pixel >> 16, s.count)).collect();
        assert_eq!(got, expected);
        assert_eq!(spans.spans().iter().map(|s| s.before).collect::<Vec<_>>(), [0, 2, 3, 5, 6]);
        assert_eq!((spans.pixels(), spans.len()), (7, 21));
        assert_eq!(spans.window(), ([0, 0], [65536, 4]));
        let runs = [(3..5, 0), (6..7, 0), (9..9, 0), (0..2, 1), (65535..65536, 2), (0..1, 3)];
        assert_eq!(Spans::of_runs(runs, 2..5), spans);
        assert_eq!(Spans::of_runs([(7..9, 4), (5..6, 6)], 0..1).window(), ([5, 4], [4, 3]));
        assert_eq!(
            Spans::uniform(2, 4..6, 2..5).each_pixel().collect::<Vec<_>>(),
            [4 << 16, 4 << 16 | 1, 5 << 16, 5 << 16 | 1]
        );
        assert!(Spans::new([], 0..4).is_empty() && Spans::uniform(0, 0..3, 0..4).is_empty());
    }
}
