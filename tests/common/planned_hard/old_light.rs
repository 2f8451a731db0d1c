//! H109: after a change of light, a pixel whose quad has been shaded shows the new light.

use super::{SIZE, context, frame, hash, jitter_px, wall};
use crate::depth_hard::{Color, Make};
use crate::images::{View, pixel, pixels};
use afterimage::Image;
use afterimage::internal::{ContextDesc, Foveation, Settings};
use afterimage_testing::Draws;

/// How light changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// The edge of a shadow glides over the floor, so many pixels a frame.
    Edge(f32),
    /// The same after it stood: pixels on it have become means of both lights.
    StoodEdge(f32),
    /// The light over every second strip of the floor changes within so many frames.
    Fade(u32),
}
use Change::{Edge, Fade, StoodEdge};

/// A change of light, and what it meets.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub change: Change,
    /// Share of the pixels that is shaded.
    pub share: f32,
    pub antialias: bool,
    pub textured: bool,
    /// Motion of the camera along the floor, in pixels a frame.
    pub motion_px: f32,
    /// Light before and after the change.
    pub light: [f32; 2],
    /// Frames before the change.
    pub seen: u64,
    /// What is left at the most.
    pub most: Left,
}

/// What is left of the old light: pixels that still show more than a quarter of the change.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Left {
    /// Frames since the change came to the pixel, at the most.
    pub oldest_frames: f32,
    /// Pixels a row for which it came more than a period of the pattern ago, on average over the last ten frames.
    pub px_a_row: f32,
}

const UP: [f32; 2] = [0.6, 1.0];
const DOWN: [f32; 2] = [1.0, 0.1];
/// Width of strips.
const STRIP_PX: f32 = 16.0;
/// Largest distance at which a pixel's samples lie from its centre, across an edge.
const REACH_PX: f32 = 0.65;
/// Pixels this near to an edge are not judged: they show what is interpolated over it.
const BESIDE_PX: f32 = 1.5;
/// Edges move by this much from row to row.
const SLOPE: f32 = 0.3;
/// What counts as old light: more than this share of the change.
const REST: f32 = 0.25;
/// Frames before most changes.
const SEEN: u64 = 40;
/// The last frames, in which pixels are counted.
const COUNTED: u64 = 10;

/// A case of [`Case`]'s first six, at the bar: nothing left after two periods of a quarter of the pixels, or one and a
/// half of less.
const fn case(change: Change, share: f32, antialias: bool, textured: bool, motion_px: f32, light: [f32; 2]) -> Case {
    let oldest_frames = if share >= 0.25 { 16.0 } else { 48.0 };
    let most = Left { oldest_frames, px_a_row: 0.2 };
    Case { change, share, antialias, textured, motion_px, light, seen: SEEN, most }
}

impl Case {
    const fn seen(self, frames: u64) -> Self {
        Self { seen: frames, ..self }
    }

    /// Misses the bar: what holds instead.
    const fn misses(self, oldest_frames: f32, px_a_row: f32) -> Self {
        Self { most: Left { oldest_frames, px_a_row }, ..self }
    }

    /// Whether the bar of the case is that of all.
    fn is_missed(&self) -> bool {
        let plain = case(self.change, self.share, self.antialias, self.textured, self.motion_px, self.light);
        self.most != plain.most
    }

    /// Frames of the pattern, in which every quad is shaded.
    fn period(&self) -> f32 {
        if self.share >= 0.25 { 8.0 } else { 32.0 }
    }

    /// Frames from the change on.
    fn frames(&self) -> u64 {
        match self.change {
            Edge(px_a_frame) | StoodEdge(px_a_frame) if px_a_frame < 0.5 => 96,
            Edge(_) | StoodEdge(_) => 72,
            Fade(frames) => u64::from(frames) + 64,
        }
    }

    /// Distance behind the edge, or from the nearest border of a strip, of a place on the floor, at `t` frames from
    /// the change; positive where light changes or has changed.
    fn inside_px(&self, [x, y]: [f32; 2], t: f32) -> f32 {
        match self.change {
            Edge(px_a_frame) => 20.0 + px_a_frame * t + SLOPE * y - x,
            StoodEdge(px_a_frame) => 20.0 + px_a_frame * t.max(0.0) + SLOPE * y - x,
            Fade(_) => STRIP_PX / 2.0 - ((x - SLOPE * y).rem_euclid(2.0 * STRIP_PX) - STRIP_PX / 2.0).abs(),
        }
    }

    /// Light that falls on a place on the floor.
    fn light(&self, at: [f32; 2], t: f32) -> f32 {
        let [before, after] = self.light;
        let changed = match self.change {
            Edge(_) | StoodEdge(_) => 1.0,
            Fade(frames) => ((t + 1.0) / (frames as f32 + 1.0)).clamp(0.0, 1.0),
        };
        if self.inside_px(at, t) > 0.0 { before + (after - before) * changed } else { before }
    }

    /// Frames for which all samples of a pixel have had the new light; `None` for pixels that are not judged.
    fn age_frames(&self, [x, y]: [f32; 2], t: f32) -> Option<f32> {
        let inside_px = self.inside_px([x + self.motion_px * t, y], t);
        let age = match self.change {
            Edge(px_a_frame) | StoodEdge(px_a_frame) => (inside_px - REACH_PX) / px_a_frame,
            Fade(frames) => t - frames as f32,
        };
        // A pixel that came into view later has no older light.
        let seen_frames = (SIZE[0] as f32 - 1.0 - x) / self.motion_px.max(1e-6);
        let judged = inside_px > BESIDE_PX && (0.0..=t).contains(&age);
        judged.then(|| age.min(seen_frames))
    }

    fn floor(&self, at: [f32; 2]) -> [f32; 3] {
        if self.textured { wall(at).map(|v| v + 0.3) } else { [0.8, 0.8, 0.75] }
    }

    /// The frame `t` frames from the change, with `light` on the floor.
    fn view(&self, index: u64, t: f32, light: impl Fn([f32; 2]) -> f32) -> View {
        let view = frame(SIZE, jitter_px(index, self.antialias), |[x, y]| {
            let at = [x + self.motion_px * t, y];
            self.floor(at).map(|v| v * light(at))
        });
        view.moving([-self.motion_px, 0.0])
    }

    fn holds(&self, left: Left) -> bool {
        left.oldest_frames <= self.most.oldest_frames && left.px_a_row <= self.most.px_a_row
    }
}

/// Runs a case. `wrong` changes what the renderer shades, for planted errors.
fn left_by(make: Make<'_>, case: &Case, wrong: impl Fn(&mut Color, u64)) -> Option<Left> {
    let mut post = context(make, SIZE, case.share, case.antialias)?;
    // Texture is as blurred where light is constant.
    let mut plain_post = if case.textured { Some(context(make, SIZE, case.share, case.antialias)?) } else { None };
    let [old, new] = case.light;
    let mut left = Left::default();
    let frames = case.seen + case.frames();
    for index in 0..frames {
        let t = index as f32 - case.seen as f32;
        let mut view = case.view(index, t, |at| case.light(at, t));
        wrong(&mut view.color, index);
        let shown = post.step(index, &view).shown;
        let plain = plain_post.as_mut().map(|post| post.step(index, &case.view(index, t, |_| 1.0)).shown);
        let plain = plain.unwrap_or_else(|| Image::filled(SIZE, case.floor([0.0; 2])));
        for px in pixels(SIZE) {
            let Some(age) = case.age_frames(px.map(|v| v as f32), t) else { continue };
            let [shown, plain] = [&shown, &plain].map(|image| pixel(image, px)[1]);
            if (plain * new - shown) / (plain * (new - old)) > REST {
                left.oldest_frames = left.oldest_frames.max(age);
                let counts = age > case.period() && index + COUNTED >= frames;
                left.px_a_row += if counts { 1.0 } else { 0.0 };
            }
        }
    }
    left.px_a_row /= SIZE[1] as f32 * COUNTED as f32;
    Some(left)
}

/// What is left in the worst of the cases, each of which must hold.
fn all_hold(make: Make<'_>, cases: &[Case]) -> Option<String> {
    let (mut oldest, mut missed, mut wrong) = ([0.0_f32; 2], vec![], vec![]);
    for case in cases {
        let left = left_by(make, case, |_, _| ())?;
        println!("{case:?}: {left:?}");
        if !case.holds(left) {
            wrong.push(format!("{case:?}: {left:?}"));
        }
        if case.is_missed() {
            missed.push(left.px_a_row);
            continue;
        }
        let kind = usize::from(case.share < 0.25);
        oldest[kind] = oldest[kind].max(left.oldest_frames);
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let [quarter, less] = oldest;
    let of = cases.len();
    let text = format!("gone after {quarter:.0} frames at 25 and 100 % of the pixels, {less:.0} at 5 and 10 %");
    let most = missed.iter().fold(0.0_f32, |a, &b| a.max(b));
    Some(match missed.len() {
        0 => format!("{of} changes of light: {text}"),
        n => format!("{of} changes of light: {text}; bar missed by {n}, {most:.2} px a row at the end"),
    })
}

/// Share of a fall of light that single pixels of a contrasted floor do not show, `after` frames later. Their few
/// samples differ from history by as much as the light does.
fn fall_left(make: Make<'_>, after: u64, wrong: impl Fn(&mut Color, u64)) -> Option<f64> {
    let foveation = Foveation { single_pixels: true, ..Foveation::uniform(0.065) };
    let mut post =
        make(ContextDesc { settings: Settings { foveation, ..Settings::screen() }, ..ContextDesc::new(SIZE) })?;
    let tiles = |[x, y]: [f32; 2]| [0.1 + 0.9 * hash((x / 3.0).floor() as i64, (y / 3.0).floor() as i64); 3];
    let [old, new] = [1.0, 0.45];
    let mut shown = Image::filled(SIZE, [0.0; 3]);
    for index in 0..=2 * SEEN + after {
        let light = if index < 2 * SEEN { old } else { new };
        let mut view = frame(SIZE, jitter_px(index, true), |at| tiles(at).map(|v| v * light));
        wrong(&mut view.color, index);
        shown = post.step(index, &view).shown;
    }
    let sum = |of: &dyn Fn([u32; 2]) -> f32| pixels(SIZE).map(|px| f64::from(of(px))).sum::<f64>();
    let lit = sum(&|px| tiles(px.map(|v| v as f32))[1]);
    Some((sum(&|px| pixel(&shown, px)[1]) / lit - f64::from(new)) / f64::from(old - new))
}

pub fn contrasted_floor(make: Make<'_>) -> Option<String> {
    let left = fall_left(make, 4, |_, _| ())?;
    let old = fall_left(make, 4, |color, index| {
        if index >= 2 * SEEN {
            color.pixels_mut().iter_mut().flatten().for_each(|v| *v /= 0.45);
        }
    })?;
    assert!(old > 0.9, "the planted error is seen: {old}");
    // 0.13 without gains of blocks.
    assert!(left < 0.05, "{left}");
    Some(format!("a fall of light to 0.45 on single pixels of a contrasted floor: {left:.2} of it left after 4 frames"))
}

/// Frames of old light that is still there at the end.
const STAYS: f32 = f32::INFINITY;

/// Slow edges. With antialiasing, five miss the bar: a mean of samples of both lights has a deviation that explains the
/// new samples, too, so that old light goes with the mean's length, some pixels late.
const SLOW: [Case; 9] = [
    case(Edge(0.05), 0.25, true, false, 0.0, UP).misses(STAYS, 0.3),
    case(Edge(0.05), 1.0, true, true, 0.0, DOWN).misses(STAYS, 0.2),
    case(Edge(0.05), 0.1, false, true, 0.0, UP),
    case(Edge(0.05), 0.25, false, false, 0.3, DOWN),
    case(Edge(0.2), 0.25, true, false, 0.0, UP).misses(36.0, 0.2),
    case(Edge(0.2), 0.1, true, false, 0.0, UP).misses(STAYS, 0.2),
    case(Edge(0.2), 1.0, true, true, 0.3, UP),
    case(Edge(0.2), 0.05, false, false, 0.0, DOWN),
    case(Edge(0.7), 0.25, true, true, 0.0, DOWN).misses(22.0, 0.2),
];

/// Fast edges. One misses the bar, in single pixels.
const FAST: [Case; 9] = [
    case(Edge(0.7), 0.1, false, false, 0.3, UP),
    case(Edge(0.7), 0.05, true, false, 0.0, UP),
    case(Edge(0.7), 0.25, true, false, 1.7, UP),
    case(Edge(2.0), 0.25, true, false, 0.0, UP).misses(25.0, 0.2),
    case(Edge(2.0), 0.1, true, true, 0.0, DOWN),
    case(Edge(2.0), 0.25, false, true, 0.3, UP),
    case(Edge(8.0), 0.25, true, true, 0.0, UP),
    case(Edge(8.0), 0.1, false, false, 0.0, UP),
    case(Edge(8.0), 0.05, true, false, 0.0, UP),
];

/// Edges that stood for a while. With antialiasing all miss the bar, for the reason of slow edges: pixels on the edge
/// had become means of both lights.
const STOOD: [Case; 7] = [
    case(StoodEdge(0.05), 0.25, true, false, 0.0, UP).misses(STAYS, 0.3),
    case(StoodEdge(0.2), 0.25, true, false, 0.0, UP).misses(STAYS, 0.2),
    case(StoodEdge(0.2), 0.1, true, false, 0.0, UP).misses(STAYS, 0.35),
    case(StoodEdge(0.2), 0.25, false, false, 0.0, UP),
    case(StoodEdge(2.0), 0.25, true, false, 0.0, UP).misses(STAYS, 0.2),
    case(StoodEdge(2.0), 0.25, true, false, 0.0, UP).seen(250).misses(38.0, 0.2),
    case(StoodEdge(8.0), 0.25, true, true, 0.0, UP).misses(24.0, 0.2),
];

/// Steps, at once or by one frame in between. Two miss the bar, in single pixels.
const STEPS: [Case; 8] = [
    case(Fade(0), 0.25, true, false, 0.0, UP).misses(24.0, 0.2),
    case(Fade(0), 0.1, true, true, 0.0, DOWN),
    case(Fade(0), 0.25, false, true, 1.7, UP),
    case(Fade(0), 0.05, false, false, 0.3, UP),
    case(Fade(1), 0.25, true, true, 0.3, UP).misses(32.0, 0.2),
    case(Fade(1), 0.1, true, false, 0.0, UP),
    case(Fade(1), 0.05, true, false, 0.0, DOWN),
    case(Fade(1), 1.0, false, true, 0.0, UP),
];

/// Fades. One misses the bar, in single pixels of a still texture at a twentieth of the pixels.
const FADES: [Case; 8] = [
    case(Fade(4), 0.25, true, false, 0.0, UP),
    case(Fade(4), 0.1, false, true, 0.0, UP),
    case(Fade(4), 0.25, true, false, 1.7, DOWN),
    case(Fade(4), 0.05, true, true, 0.0, UP).misses(STAYS, 0.2),
    case(Fade(30), 0.25, true, false, 0.0, UP),
    case(Fade(30), 0.1, true, true, 0.0, UP),
    case(Fade(30), 1.0, true, true, 0.3, DOWN),
    case(Fade(30), 0.05, false, false, 0.0, UP),
];

/// Means of few and of many samples. Two miss the bar, in single pixels.
const LENGTHS: [Case; 6] = [
    case(Edge(2.0), 0.25, true, false, 0.0, UP).seen(2),
    case(Fade(0), 0.25, true, false, 0.0, UP).seen(2),
    case(Edge(2.0), 0.25, true, false, 0.0, UP).seen(12).misses(22.0, 0.2),
    case(Fade(4), 0.25, true, false, 0.0, UP).seen(12),
    case(Edge(2.0), 0.25, true, false, 0.0, UP).seen(250).misses(20.0, 0.2),
    case(Fade(4), 0.25, true, false, 0.0, UP).seen(250),
];

pub fn slow_edges(make: Make<'_>) -> Option<String> {
    all_hold(make, &SLOW)
}

pub fn fast_edges(make: Make<'_>) -> Option<String> {
    all_hold(make, &FAST)
}

pub fn standing_edges(make: Make<'_>) -> Option<String> {
    all_hold(make, &STOOD)
}

pub fn steps(make: Make<'_>) -> Option<String> {
    all_hold(make, &STEPS)
}

pub fn fades(make: Make<'_>) -> Option<String> {
    all_hold(make, &FADES)
}

pub fn lengths_of_means(make: Make<'_>) -> Option<String> {
    all_hold(make, &LENGTHS)
}

const FEW: [Case; 3] = [
    case(Edge(0.7), 0.25, true, false, 1.7, UP),
    case(Edge(8.0), 0.1, false, false, 0.0, UP),
    case(Fade(4), 0.25, true, false, 0.0, UP),
];

/// Three of the cases, and planted errors: a renderer that goes on to shade one quad in the old light, and means that
/// have so large a deviation, from frames of noise before the change, that they explain the new light.
pub fn old_light(make: Make<'_>) -> Option<String> {
    let case = FEW[2];
    let stuck = |color: &mut Color, _: u64| {
        for [x, y] in [[8, 4], [9, 4], [8, 5], [9, 5]] {
            color.pixels_mut()[(y * SIZE[0] + x) as usize] = case.floor([0.0; 2]).map(|v| v * case.light[0]);
        }
    };
    let doubtful = |color: &mut Color, index: u64| {
        let mut draws = Draws::new(&format!("doubtful {index}"));
        for c in color.pixels_mut().iter_mut().filter(|_| index < case.seen) {
            let factor = if draws.uniform() < 0.5 { 0.3 } else { 1.7 };
            *c = c.map(|v| v * factor);
        }
    };
    for left in [left_by(make, &case, stuck)?, left_by(make, &case, doubtful)?] {
        println!("planted: {left:?}");
        assert!(!case.holds(left));
    }
    all_hold(make, &FEW)
}
