//! H113: what slides over a surface at its depth, as a foot over ground, leaves nothing of itself there.

use super::{DISTANCE, SIZE, context, frame, jitter_px, wall};
use crate::depth_hard::Make;
use crate::images::{View, pixel, pixels};
use afterimage::Image;

/// A square that stands before a wall, at its depth, and then slides over it.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub share: f32,
    pub antialias: bool,
    /// Motion of the square in the world, in pixels a frame.
    pub speed_px: f32,
    /// Motion of the camera along the wall, in pixels a frame.
    pub camera_px: f32,
    /// What is left at the most.
    pub most: Left,
}

/// Pixels that the square has left, and which still show more than a quarter of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Left {
    /// Frames since the square left the pixel, at the most.
    pub oldest_frames: f32,
    /// Pixels a row, on average over the frames.
    pub px_a_row: f32,
}

const SIDE_PX: f32 = 12.0;
const TOP_PX: f32 = 10.0;
/// Frames for which the square stands.
const SEEN: u64 = 40;
/// Light of the square.
const LIGHT: [f32; 3] = [0.9, 0.3, 0.1];
/// What counts as a rest of the square: more than this share of the difference.
const REST: f32 = 0.25;
/// Pixels this near to the square are not judged: they show what is interpolated over its edge.
const BESIDE_PX: f32 = 1.5;

/// What a renderer says of the camera and of the square's motion.
#[derive(Clone, Copy, PartialEq)]
enum Told {
    All,
    /// Vectors without the square's motion, the planted error.
    NoVectors,
    /// No motion of the camera: history of any surface at this depth is accepted.
    NoCamera,
}

impl Case {
    /// Left edge of the square on the screen, `t` frames after it began to slide.
    fn left_px(&self, t: f32) -> f32 {
        2.0 + (self.speed_px - self.camera_px) * t.max(0.0)
    }

    fn is_on(&self, [x, y]: [f32; 2], t: f32) -> bool {
        (0.0..SIDE_PX).contains(&(x - self.left_px(t))) && (TOP_PX..TOP_PX + SIDE_PX).contains(&y)
    }

    fn color(&self, at: [f32; 2], t: f32) -> [f32; 3] {
        if self.is_on(at, t) { LIGHT } else { wall([at[0] + self.camera_px * t.max(0.0), at[1]]) }
    }

    fn view(&self, index: u64, t: f32, told: Told) -> View {
        let jitter = jitter_px(index, self.antialias);
        let slides = if t > 0.0 { 1.0 } else { 0.0 };
        let of_wall = self.camera_px * slides;
        let of_square = of_wall - if told == Told::NoVectors { 0.0 } else { self.speed_px * slides };
        frame(SIZE, jitter, |at| self.color(at, t)).with(|view| {
            view.motion = Some(Image::from_fn(SIZE, |[x, y]| {
                let at = [x as f32 - jitter[0], y as f32 - jitter[1]];
                [if self.is_on(at, t) { of_square } else { of_wall }, 0.0]
            }));
            let ([tangent_a_px, _], _) = view.facts.geometry.scale_offset();
            let moved = of_wall * tangent_a_px * DISTANCE;
            let camera = [[1.0, 0.0, 0.0, moved], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
            view.facts.previous_from_current = (told != Told::NoCamera).then_some(camera);
        })
    }

    fn holds(&self, left: Left) -> bool {
        left.oldest_frames <= self.most.oldest_frames && left.px_a_row <= self.most.px_a_row
    }
}

fn left_by(make: Make<'_>, case: &Case, told: Told) -> Option<Left> {
    let mut post = context(make, SIZE, case.share, case.antialias)?;
    let mut left = Left::default();
    let on_screen_px = case.speed_px - case.camera_px;
    let frames = ((SIZE[0] as f32 - SIDE_PX) / on_screen_px) as u64;
    let mut rows = 0.0;
    for index in 0..SEEN + frames {
        let t = index as f32 - SEEN as f32;
        let shown = post.step(index, &case.view(index, t, told)).shown;
        if t < 1.0 {
            continue;
        }
        rows += SIDE_PX - 2.0 * BESIDE_PX;
        for px in pixels(SIZE) {
            let [x, y] = px.map(|v| v as f32);
            let behind_px = case.left_px(t) - BESIDE_PX - x;
            let is_in_its_way = x >= 2.0 && (TOP_PX + BESIDE_PX..TOP_PX + SIDE_PX - BESIDE_PX).contains(&y);
            if behind_px < 0.0 || !is_in_its_way {
                continue;
            }
            let [shown, expected] = [pixel(&shown, px)[0], case.color([x, y], t)[0]];
            if (shown - expected) / (LIGHT[0] - expected) > REST {
                left.oldest_frames = left.oldest_frames.max((behind_px / on_screen_px).ceil());
                left.px_a_row += 1.0;
            }
        }
    }
    left.px_a_row /= rows;
    Some(left)
}

/// A case at the bar.
const fn case(share: f32, antialias: bool, speed_px: f32, camera_px: f32) -> Case {
    Case { share, antialias, speed_px, camera_px, most: Left { oldest_frames: 8.0, px_a_row: 0.4 } }
}

impl Case {
    /// Misses the bar: what holds instead.
    const fn misses(self, oldest_frames: f32, px_a_row: f32) -> Self {
        Self { most: Left { oldest_frames, px_a_row }, ..self }
    }
}

/// Frames of rests that are still there at the end.
const STAYS: f32 = f32::INFINITY;

/// Two miss the bar: pixels that the square leaves as it begins to slide, when it was still a frame ago, and those
/// beside its fast edge.
const CASES: [Case; 10] = [
    case(0.25, true, 3.0, 0.0),
    case(0.1, true, 3.0, 0.0),
    case(0.25, false, 3.0, 0.0),
    case(0.1, false, 3.0, 0.0),
    case(0.25, true, 1.0, 0.0),
    case(0.1, true, 1.0, 0.0).misses(STAYS, 0.4),
    case(0.25, true, 6.0, 0.0).misses(8.0, 0.8),
    case(0.1, true, 6.0, 0.0),
    case(0.25, true, 4.0, 1.0),
    case(0.1, false, 4.0, 1.0),
];

/// What is left in the worst of the cases, each of which must hold.
fn all_hold(make: Make<'_>, cases: &[Case]) -> Option<String> {
    let (mut worst, mut wrong) = (Left::default(), vec![]);
    for case in cases {
        let left = left_by(make, case, Told::All)?;
        println!("{case:?}: {left:?}");
        if !case.holds(left) {
            wrong.push(format!("{case:?}: {left:?}"));
        }
        worst.oldest_frames = worst.oldest_frames.max(left.oldest_frames);
        worst.px_a_row = worst.px_a_row.max(left.px_a_row);
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let Left { oldest_frames, px_a_row } = worst;
    Some(format!(
        "{} squares of {SIDE_PX} px: at most {px_a_row:.2} px a row, {oldest_frames:.0} frames old",
        cases.len()
    ))
}

pub fn sliding_table(make: Make<'_>) -> Option<String> {
    all_hold(make, &CASES)
}

/// Three of the cases, and planted errors: vectors without the square's motion, and a renderer that does not say how
/// its camera moves.
pub fn sliding(make: Make<'_>) -> Option<String> {
    let few = [CASES[0], CASES[3], CASES[8]];
    for (case, told) in [(few[0], Told::NoVectors), (few[1], Told::NoCamera)] {
        let left = left_by(make, &case, told)?;
        println!("planted: {left:?}");
        assert!(!case.holds(left));
    }
    all_hold(make, &few)
}
