//! H110: lamps and signs that go on and off change nothing on the wall around them.

use super::{SIZE, context, frame, jitter_px};
use crate::depth_hard::{Color, Make};
use crate::images::{pixel, pixels};

/// Light of the wall.
const WALL: f32 = 0.2;

/// Square lamps on a wall that change together.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub share: f32,
    pub antialias: bool,
    /// Side of a lamp, and distance of their beginnings.
    pub side_px: u32,
    pub every_px: u32,
    /// Their light before and after.
    pub light: [f32; 2],
    /// Pixels of the wall that are off in the frame of the change, and in any later one, at the most.
    pub most: [usize; 2],
}

/// Frames before and after the change.
const SEEN: u64 = 96;
const AFTER: usize = 48;

/// Pixels that are off, frame after frame from the change on.
#[derive(Clone, Debug, Default)]
pub struct Off {
    /// Of the wall, by a quarter of its light.
    pub wall: Vec<usize>,
    /// Within lamps, by 0.1.
    pub lamps: Vec<usize>,
}

impl Case {
    /// Distance inside of the nearest lamp's border for a pixel, in pixels; negative outside.
    fn inside_px(&self, px: [u32; 2]) -> i32 {
        let inside = |v: u32| {
            let (v, side) = ((v % self.every_px) as i32, self.side_px as i32);
            let before = (v + 1).min(side - v);
            let next = v - self.every_px as i32 + 1;
            if v < side { before } else { (side - v).max(next) }
        };
        inside(px[0]).min(inside(px[1]))
    }

    fn color(&self, [x, y]: [f32; 2], light: f32) -> [f32; 3] {
        let lit = |v: f32| (v + 0.5).rem_euclid(self.every_px as f32) < self.side_px as f32;
        [if lit(x) && lit(y) { light } else { WALL }; 3]
    }
}

/// Runs a case. `wrong` changes what the renderer shades, for planted errors.
fn off_by(make: Make<'_>, case: &Case, wrong: impl Fn(&mut Color, u64)) -> Option<Off> {
    let mut post = context(make, SIZE, case.share, case.antialias)?;
    let mut off = Off::default();
    for index in 0..SEEN + AFTER as u64 {
        let light = case.light[usize::from(index >= SEEN)];
        let mut view = frame(SIZE, jitter_px(index, case.antialias), |at| case.color(at, light));
        wrong(&mut view.color, index);
        let shown = post.step(index, &view).shown;
        if index < SEEN {
            continue;
        }
        let count = |is_of: &dyn Fn(i32) -> bool, light: f32, most: f32| {
            let of = pixels(SIZE).filter(|&px| is_of(case.inside_px(px)));
            of.filter(|&px| (pixel(&shown, px)[0] - light).abs() > most).count()
        };
        off.wall.push(count(&|inside| inside < 0, WALL, 0.25 * WALL));
        let least = if case.antialias { 2 } else { 1 };
        off.lamps.push(count(&|inside| inside >= least, light, 0.1));
    }
    Some(off)
}

/// 1.6 % of the pixels in the frame of the change, and none later.
const BAR: [usize; 2] = [37, 0];
/// Frames after which all lamps must be as they are: a period of the sparsest pattern.
const PERIOD: usize = 32;

const fn lamps(share: f32, antialias: bool, side_px: u32, every_px: u32, light: [f32; 2]) -> Case {
    Case { share, antialias, side_px, every_px, light, most: BAR }
}

impl Case {
    /// Misses the bar: what holds instead.
    const fn misses(self, first: usize, later: usize) -> Self {
        Self { most: [first, later], ..self }
    }

    /// Pixels of the wall in the frame of the change and in the worst later one, and of lamps after a period.
    fn worst(off: &Off) -> ([usize; 2], usize) {
        let most = |counts: &[usize]| counts.iter().copied().max().unwrap_or(0);
        ([off.wall[0], most(&off.wall[1..])], most(&off.lamps[PERIOD..]))
    }

    fn holds(&self, off: &Off) -> bool {
        let (wall, lamps) = Self::worst(off);
        wall[0] <= self.most[0] && wall[1] <= self.most[1] && lamps == 0
    }
}

/// With antialiasing some miss the bar: jittered edges of lamps are means of lamp and wall, whose gains reach the wall.
const CASES: [Case; 12] = [
    lamps(0.1, false, 3, 16, [0.05, 1.0]),
    lamps(0.1, false, 3, 16, [1.0, 0.05]),
    lamps(0.1, false, 3, 32, [0.05, 1.0]),
    lamps(0.25, false, 3, 16, [0.05, 1.0]),
    lamps(0.25, false, 3, 32, [0.05, 4.0]),
    lamps(0.25, false, 6, 32, [0.05, 1.0]),
    lamps(0.1, true, 3, 16, [0.05, 1.0]),
    lamps(0.1, true, 6, 32, [0.05, 1.0]).misses(37, 130),
    lamps(0.1, true, 6, 32, [0.3, 0.8]).misses(55, 45),
    lamps(0.25, true, 3, 16, [0.05, 1.0]),
    lamps(0.25, true, 6, 32, [0.05, 1.0]).misses(37, 15),
    lamps(0.25, true, 6, 32, [0.3, 0.8]).misses(37, 15),
];

/// What is off in the worst of the cases, each of which must hold.
fn all_hold(make: Make<'_>, cases: &[Case]) -> Option<String> {
    let (mut most, mut missed, mut wrong) = ([0; 2], vec![], vec![]);
    for case in cases {
        let off = off_by(make, case, |_, _| ())?;
        let (wall, lamps) = Case::worst(&off);
        println!("{case:?}: wall {wall:?}, lamps {lamps} px");
        if !case.holds(&off) {
            wrong.push(format!("{case:?}: wall {wall:?}, lamps {lamps} px"));
        }
        match case.most == BAR {
            true => most = [0, 1].map(|i| most[i].max(wall[i])),
            false => missed.push(wall[1]),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let text = format!(
        "{} walls with lamps: {} of {} px off by a quarter in the frame of the change, {} later",
        cases.len(),
        most[0],
        SIZE[0] * SIZE[1],
        most[1]
    );
    Some(match missed.iter().max() {
        None => text,
        Some(px) => format!("{text}; bar missed by {}, {px} px later", missed.len()),
    })
}

pub fn lamps_table(make: Make<'_>) -> Option<String> {
    all_hold(make, &CASES)
}

const FEW: [Case; 2] = [lamps(0.25, true, 3, 16, [0.05, 1.0]), lamps(0.25, false, 3, 32, [0.05, 4.0])];

/// Two of the cases, and planted errors: a wall whose light changes by 30 % between the lamps, and a sign that stays
/// dark.
pub fn lamps_and_signs(make: Make<'_>) -> Option<String> {
    let patch = |corner: [u32; 2], factor: f32| {
        move |color: &mut Color, index: u64| {
            for [x, y] in pixels([4, 4]).filter(|_| index >= SEEN) {
                let at = (corner[1] + y) * SIZE[0] + corner[0] + x;
                let c = &mut color.pixels_mut()[at as usize];
                *c = c.map(|v| v * factor);
            }
        }
    };
    for (corner, factor) in [([8, 8], 1.3), ([16, 16], 0.05)] {
        let off = off_by(make, &FEW[0], patch(corner, factor))?;
        assert!(!FEW[0].holds(&off), "{corner:?}: {off:?}");
    }
    all_hold(make, &FEW)
}
