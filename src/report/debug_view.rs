//! Pixel decisions as pictures: what `--debug` writes.

use super::heat;
use crate::cpu::PixelTrace;
use crate::image::Image;
use crate::kernel::reproject::Verdict;

/// One view of the decisions of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DebugView {
    /// Weight sum of the reservoir: black 0, white 16 or more.
    Weight,
    /// Frames since the shown sample was shaded: black 0, white 255 or more, by square root.
    Age,
    /// Share of the history's weight that survived: black none, white all.
    Survival,
    /// What became of the history: grey valid, blue reset, magenta bad motion, orange off screen, yellow empty, red disoccluded.
    Flush,
    /// Gate value: white open, black shut.
    Gate,
    /// Motion: red right, cyan left, bright fast; grey none, 16 pixels are full colour.
    Motion,
}

/// The picture of a view, sRGB-encoded. `motion` is previous minus current in pixels, `None` for none.
pub fn picture(view: DebugView, trace: &Image<PixelTrace>, motion: Option<&Image<[f32; 2]>>) -> Image<[f32; 3]> {
    match view {
        DebugView::Weight => trace.map(|t| heat::color(t.w_sum / 16.0)),
        DebugView::Age => trace.map(|t| heat::color((t.age as f32 / 255.0).sqrt())),
        DebugView::Survival => trace.map(|t| heat::color(t.survival)),
        DebugView::Flush => trace.map(|t| verdict_color(t.verdict)),
        DebugView::Gate => trace.map(|t| [t.gate; 3]),
        DebugView::Motion => match motion {
            Some(motion) => motion.map(motion_color),
            None => Image::filled(trace.size(), motion_color([0.0; 2])),
        },
    }
}

fn verdict_color(verdict: Verdict) -> [f32; 3] {
    match verdict {
        Verdict::Valid => [0.35, 0.35, 0.35],
        Verdict::Reset => [0.2, 0.4, 1.0],
        Verdict::BadMotion => [1.0, 0.2, 1.0],
        Verdict::OffScreen => [1.0, 0.55, 0.1],
        Verdict::Empty => [1.0, 1.0, 0.3],
        Verdict::Disoccluded => [1.0, 0.1, 0.1],
        Verdict::Distrusted => [0.1, 0.9, 0.9],
    }
}

fn motion_color(motion: [f32; 2]) -> [f32; 3] {
    // Shown as the surface moves: current minus previous.
    let [x, y] = motion.map(|v| (-v / 16.0).clamp(-1.0, 1.0));
    if x.is_nan() || y.is_nan() {
        return [0.0, 1.0, 0.0];
    }
    [0.5 + 0.5 * x, 0.5 - 0.25 * x + 0.43 * y, 0.5 - 0.25 * x - 0.43 * y].map(|v| v.clamp(0.0, 1.0))
}
