//! What is to be traced: samples of pixels, as a list or as spans that a device makes the list of.

use std::ops::Range;

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
pub fn uniform(width: u32, rows: Range<u32>, samples: Range<u32>) -> Vec<WorkItem> {
    let pixels = rows.flat_map(|y| (0..width).map(move |x| (x, y)));
    pixels.flat_map(|(x, y)| samples.clone().map(move |s| WorkItem::new(x, y, s))).collect()
}

/// Pixels of a row, side by side. Twin of `Span` in `shaders/trace/expand_pass.wgsl`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Span {
    /// First pixel, as in [`WorkItem::pixel`].
    pub pixel: u32,
    /// How many.
    pub count: u32,
    /// How many pixels all earlier spans have.
    pub before: u32,
}

/// The same samples of every pixel of a set.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Spans {
    spans: Vec<Span>,
    samples: Range<u32>,
}

impl Spans {
    /// Samples `samples` of pixels that come row by row, left to right.
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

    /// Samples `samples` of runs of pixels, each columns and a row, that come row by row, left to right.
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

    /// Samples `samples` of every pixel in the rows `rows` of an image `width` pixels wide.
    pub fn uniform(width: u32, rows: Range<u32>, samples: Range<u32>) -> Self {
        let first = rows.start;
        let span = |y: u32| Span { pixel: y << 16, count: width, before: (y - first) * width };
        Self { spans: if width == 0 { vec![] } else { rows.map(span).collect() }, samples }
    }

    /// The corner and the size of the smallest window that holds all the pixels of all `work`.
    pub fn window(work: &[Self]) -> ([u32; 2], [u32; 2]) {
        let spans = || work.iter().flat_map(|w| &w.spans);
        let columns = |s: &Span| (s.pixel & 0xffff, (s.pixel & 0xffff) + s.count);
        let left = spans().map(|s| columns(s).0).min().unwrap_or(0);
        let right = spans().map(|s| columns(s).1).max().unwrap_or(0);
        let top = spans().map(|s| s.pixel >> 16).min().unwrap_or(0);
        let bottom = spans().map(|s| (s.pixel >> 16) + 1).max().unwrap_or(0);
        ([left, top], [right - left, bottom - top])
    }

    /// The pixels, span by span.
    pub fn spans(&self) -> &[Span] {
        &self.spans
    }

    /// The samples of each.
    pub fn samples(&self) -> Range<u32> {
        self.samples.clone()
    }

    /// Number of pixels.
    pub fn pixels(&self) -> u32 {
        self.spans.last().map_or(0, |s| s.before + s.count)
    }

    /// Number of samples of all pixels.
    pub fn len(&self) -> u64 {
        u64::from(self.pixels()) * self.samples.len() as u64
    }

    /// Whether there is nothing to do.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Something to trace.
#[derive(Clone, Copy, Debug)]
pub enum Work<'a> {
    /// Item by item.
    List(&'a [WorkItem]),
    /// Pixels by spans; the list is made where it is worked off.
    Spans(&'a Spans),
}

impl<'a> From<&'a [WorkItem]> for Work<'a> {
    fn from(items: &'a [WorkItem]) -> Self {
        Self::List(items)
    }
}

impl<'a, const N: usize> From<&'a [WorkItem; N]> for Work<'a> {
    fn from(items: &'a [WorkItem; N]) -> Self {
        Self::List(items)
    }
}

impl<'a> From<&'a Vec<WorkItem>> for Work<'a> {
    fn from(items: &'a Vec<WorkItem>) -> Self {
        Self::List(items)
    }
}

impl<'a> From<&'a Spans> for Work<'a> {
    fn from(spans: &'a Spans) -> Self {
        Self::Spans(spans)
    }
}

/// A pixel's samples.
#[derive(Clone)]
pub(super) enum Samples<'a> {
    Listed(&'a [WorkItem]),
    Range(Range<u32>),
}

impl Samples<'_> {
    /// Their numbers.
    pub fn numbers(&self) -> impl Iterator<Item = u32> + '_ {
        let (listed, range) = match self {
            Self::Listed(items) => (*items, 0..0),
            Self::Range(range) => (&[][..], range.clone()),
        };
        listed.iter().map(|i| i.sample).chain(range)
    }
}

impl<'a> Work<'a> {
    /// Pixel after pixel with its samples.
    pub(super) fn by_pixel(self) -> Vec<(u32, Samples<'a>)> {
        match self {
            Self::List(items) => {
                items.chunk_by(|a, b| a.pixel == b.pixel).map(|s| (s[0].pixel, Samples::Listed(s))).collect()
            }
            Self::Spans(spans) => {
                let pixels = spans.spans.iter().flat_map(|s| s.pixel..s.pixel + s.count);
                pixels.map(|pixel| (pixel, Samples::Range(spans.samples()))).collect()
            }
        }
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
        assert_eq!(Spans::window(std::slice::from_ref(&spans)), ([0, 0], [65536, 4]));
        let runs = [(3..5, 0), (6..7, 0), (9..9, 0), (0..2, 1), (65535..65536, 2), (0..1, 3)];
        assert_eq!(Spans::of_runs(runs, 2..5), spans);
        assert_eq!(Spans::window(&[Spans::of_runs([(7..9, 4), (5..6, 6)], 0..1)]), ([5, 4], [4, 3]));
    }

    #[test]
    fn spans_and_lists_are_the_same_work() {
        let items = uniform(5, 2..4, 1..4);
        let spans = Spans::uniform(5, 2..4, 1..4);
        let flat = |work: Work<'_>| {
            let pixels = work.by_pixel();
            pixels.iter().flat_map(|(p, s)| s.numbers().map(|n| (*p, n)).collect::<Vec<_>>()).collect::<Vec<_>>()
        };
        assert_eq!(flat((&items).into()), flat((&spans).into()));
        assert_eq!(spans.len(), items.len() as u64);
        assert!(Spans::new([], 0..4).is_empty() && Spans::uniform(0, 0..3, 0..4).is_empty());
    }
}
