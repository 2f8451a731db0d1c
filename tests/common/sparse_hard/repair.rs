//! Frames whose planned pixels are shaded, beside the same frames without repair.

use super::*;
use afterimage::kernel::repair::asked_px;
use afterimage::{Method, Repair, Smr};

const GAZE: [f32; 2] = [30.0, 25.0];
/// Degrees of a ring around the gaze, within which the order is that of a hash.
const RING_DEG: f32 = 2.0;

fn repairing(budget: f32) -> ContextDesc {
    let desc = smr(SIZE);
    let method = Method::Smr(Smr { repair: Some(Repair { budget }), ..Smr::default() });
    ContextDesc { settings: Settings { method, ..desc.settings }, ..desc }
}

/// A frame with a known gaze, whose color also contains the samples of planned pixels.
fn shot(color: Color, index: u64) -> Shot {
    let mut shot = Shot::foveated(color.clone(), &foveation(), GAZE, index);
    shot.facts.gaze = Gaze::At { px: GAZE };
    shot.moving([0.0; 2]).with(|view| view.repaired = Some(color))
}

/// The same frames with and without repair.
struct Pair {
    with: Box<dyn Shows>,
    without: Box<dyn Shows>,
    budget: f32,
}

/// One frame of a pair.
struct Shown {
    with: Color,
    without: Color,
    mask: Mask,
}

impl Pair {
    fn new(make: Make, budget: f32) -> Option<Self> {
        Some(Self { with: make(repairing(budget))?, without: make(smr(SIZE))?, budget })
    }

    /// Shows a frame; its plan must keep to the budget, and its colors must be finite.
    fn show(&mut self, index: u64, shot: &Shot) -> Shown {
        let mask = self.with.plan(index, shot);
        let (chosen, all) = (quads().filter(|&quad| pixel(&mask, quad)).count(), quads().count());
        assert!(chosen as f64 <= f64::from(self.budget) * all as f64, "frame {index}: {chosen} of {all} quads");
        let with = self.with.one(index, shot);
        let without = self.without.one(index, &shot.clone().with(|view| view.repaired = None));
        assert_finite(&with, "repaired");
        Shown { with, without, mask }
    }
}

impl Shown {
    /// Mean squared errors with and without repair.
    fn errors(&self, full: &Color, counts: impl Fn([u32; 2]) -> bool + Copy) -> [f64; 2] {
        [&self.with, &self.without].map(|shown| squared_error(shown, full, counts))
    }
}

/// First pixels of all quads.
fn quads() -> impl Iterator<Item = [u32; 2]> {
    pixels().filter(|[x, y]| x % 2 == 0 && y % 2 == 0)
}

fn is_sample(shot: &Shot, px: [u32; 2]) -> bool {
    shot.lattices().at(px).is_some_and(|lattice| lattice.samples(px))
}

/// Ring around the gaze, the inmost 0.
fn ring([x, y]: [u32; 2]) -> u32 {
    (geometry(SIZE).eccentricity_deg([x as f32, y as f32], GAZE) / RING_DEG) as u32
}

/// Whether errors with repair are at most those without, except for rounding.
fn no_worse([with, without]: [f64; 2]) -> bool {
    with <= without + 1e-8
}

/// A near wall before the right half is gone from frame `TURN` on; and the first frames of a context.
pub fn half_uncovered(make: Make) -> Option<String> {
    let behind = waves(SIZE, [0.0; 2]);
    let mut figures = vec![];
    let at_first = [0.002, 0.05, 0.1, 0.2].map(|budget| (budget, 0, 1.0));
    for (budget, from, share) in [0.05, 0.1, 0.2].map(|budget| (budget, TURN, 0.5)).into_iter().chain(at_first) {
        let is_uncovered = |[x, _]: [u32; 2]| from == 0 || x >= SIZE[0] / 2;
        let mut pair = Pair::new(make, budget)?;
        // Pixels that no sample has shown yet.
        let mut unseen = Image::from_fn(SIZE, is_uncovered);
        let mut whole = None;
        let mut gain = vec![];
        for index in 0..3 * TURN {
            let is_covered = |px| index < from && is_uncovered(px);
            let color = Image::from_fn(SIZE, |px| if is_covered(px) { [0.9, 0.1, 0.2] } else { pixel(&behind, px) });
            let depth = Image::from_fn(SIZE, |px| if is_covered(px) { 2.0 } else { 6.0 });
            let shot = shot(color.clone(), index).with(|view| view.depth = Some(depth));
            let shown = pair.show(index, &shot);
            if index < from {
                continue;
            }
            // A quad has the priority of the pixel nearest to the gaze, among its tested pixels that have had no sample
            // so far and have none in this frame.
            let wants = |px| pixel(&unseen, px) && !is_sample(&shot, px);
            let ring_of = |[x, y]: [u32; 2]| {
                let asked = [0, 1].map(|i| asked_px(i, x / 2, y / 2, index as u32)).into_iter();
                asked.filter(|&px| px[0] < SIZE[0] && px[1] < SIZE[1] && wants(px)).map(ring).min()
            };
            let chosen: Vec<_> = quads().filter(|&quad| pixel(&shown.mask, quad)).map(ring_of).collect();
            let used = chosen.len() as f32 / quads().count() as f32;
            assert!(index > from || used > 0.5 * budget, "{used} of {budget} is used");
            let last = chosen.into_iter().map(|ring| ring.expect("a chosen quad wants something")).max();
            let first_left = quads().filter(|&quad| !pixel(&shown.mask, quad)).filter_map(ring_of).min();
            assert!(
                first_left.is_none_or(|left| last.is_some_and(|last| last <= left)),
                "frame {index}: ring {last:?} is repaired before {first_left:?}"
            );
            let errors = shown.errors(&color, is_uncovered);
            assert!(no_worse(errors), "frame {index}: {errors:?}");
            gain.push(psnr(errors[0]) - psnr(errors[1]));
            unseen = Image::from_fn(SIZE, |px| wants(px) && !pixel(&shown.mask, px));
            let off = wrong(&shown.with, &color, |px| !pixel(&unseen, px));
            assert_eq!(off, 0, "frame {index}: pixels that were sampled are lost");
            if whole.is_none() && unseen.pixels().iter().all(|&unseen| !unseen) {
                whole = Some(index - from);
            }
        }
        let whole = whole.expect("never whole");
        // The lattices alone take all but one frame of a turn; that share of the quads was uncovered. The last pixels
        // may be those that are asked one frame later.
        let most = (TURN - 1).min((share / budget).ceil() as u64 + 1);
        println!(
            "budget {budget} for {share} from frame {from} on: whole after {whole} frames, {most} at the most; gain {gain:.2?}"
        );
        assert!(whole <= most, "budget {budget}: whole after {whole} frames instead of {most}");
        let what = if from == 0 { " at first" } else { "" };
        figures.push(format!("{:.1} %{what}: {whole} ({:+.1}, {:+.1})", 100.0 * budget, gain[0], gain[4]));
    }
    Some(format!(
        "frames after the uncovering until whole, by budget, and dB there against no repair in its frame and 4 later: {}",
        figures.join("; ")
    ))
}

/// Mean absolute difference.
fn change(a: &Color, b: &Color) -> f64 {
    let pairs = a.pixels().iter().flatten().zip(b.pixels().iter().flatten());
    pairs.map(|(&a, &b)| f64::from((a - b).abs())).sum::<f64>() / (3 * a.pixels().len()) as f64
}

/// A still after a cut, while the order of a ring's quads changes in each frame.
pub fn order_without_flicker(make: Make) -> Option<String> {
    let mut figures = vec![];
    for (name, full) in [("waves", waves(SIZE, [0.0; 2])), ("noise", noise(SIZE, "order"))] {
        let mut pair = Pair::new(make, 0.05)?;
        let mut last: Option<Shown> = None;
        let mut kept = Image::filled(SIZE, false);
        let mut changes = vec![];
        let mut orders = 0;
        for index in 0..2 * TURN {
            let shot = shot(full.clone(), index);
            let other = pair.with.plan(index + 1000, &shot);
            let shown = pair.show(index, &shot);
            orders += u32::from(other != shown.mask);
            kept = Image::from_fn(SIZE, |px| pixel(&kept, px) || pixel(&shown.mask, px));
            let lost = wrong(&shown.with, &full, |px| pixel(&kept, px));
            assert_eq!(lost, 0, "{name}, frame {index}: repaired pixels change again");
            if let Some(last) = &last {
                changes.push([change(&last.with, &shown.with), change(&last.without, &shown.without)]);
            }
            last = Some(shown);
        }
        println!("{name}: another order in {orders} frames; changes {changes:.5?}");
        // While the budget does not pay for all.
        assert!(orders >= 10, "{name}: the order differs in {orders} frames");
        let sums = |from: usize, to: usize| [0, 1].map(|i| changes[from..to].iter().map(|c| c[i]).sum::<f64>());
        let parts: Vec<_> = (0..8).map(|i| sums(4 * i, (4 * i + 4).min(changes.len()))).collect();
        println!("{name}: by four frames {parts:.5?}");
        let rounding = 4.0 / 511.0;
        assert!(parts.windows(2).all(|p| p[1][0] <= p[0][0] || p[1][0] < rounding), "{name}: {parts:?}");
        let [with, without] = sums(0, changes.len());
        assert!(with <= without, "{name}: {with} and {without}");
        let most = changes.iter().map(|c| c[0] - c[1]).fold(0.0, f64::max);
        figures.push(format!(
            "{name}: sum of mean changes {with:.3}, without repair {without:.3}; a frame by at most {most:.4} more; from frame {TURN} on {:.5} a frame",
            sums(TURN as usize, changes.len())[0] / (changes.len() - TURN as usize) as f64
        ));
    }
    Some(figures.join("; "))
}

/// Bars of a pixel's width at 2 m that move over a wall at 6 m.
pub fn thin_occluders(make: Make) -> Option<String> {
    let wall = waves(SIZE, [0.0; 2]);
    let bar = [0.9, 0.2, 0.05];
    let mut figures = vec![];
    for speed in [1, 3, 7] {
        let mut pair = Pair::new(make, 0.1)?;
        let is_bar = |[x, _]: [u32; 2], index: u64| (x + 500 - speed * index as u32) % 23 == 5;
        let mut parts = [[0.0; 2]; 3];
        let mut ghosts = [0; 2];
        for index in 0..2 * TURN {
            let is_near = |px| is_bar(px, index);
            let color = Image::from_fn(SIZE, |px| if is_near(px) { bar } else { pixel(&wall, px) });
            let depth = Image::from_fn(SIZE, |px| if is_near(px) { 2.0 } else { 6.0 });
            let motion = Image::from_fn(SIZE, |px| if is_near(px) { [-(speed as f32), 0.0] } else { [0.0; 2] });
            let shot = shot(color.clone(), index).with(|view| (view.depth, view.motion) = (Some(depth), Some(motion)));
            let shown = pair.show(index, &shot);
            if index < TURN {
                continue;
            }
            let in_trail = |px| is_bar(px, index - 1) && !is_near(px);
            let errors =
                [shown.errors(&color, in_trail), shown.errors(&color, is_near), shown.errors(&color, everywhere)];
            for (sum, error) in parts.iter_mut().zip(errors) {
                (0..2).for_each(|i| sum[i] += error[i] / TURN as f64);
            }
            // Nearer to the bar's color than to the wall's.
            let distance = |a: [f32; 3], b: [f32; 3]| (0..3).map(|c| (a[c] - b[c]).powi(2)).sum::<f32>();
            for (count, shown) in ghosts.iter_mut().zip([&shown.with, &shown.without]) {
                let off = |px, color| distance(pixel(shown, px), color);
                let is_ghost = |&px: &[u32; 2]| off(px, bar) < off(px, pixel(&wall, px));
                *count += pixels().filter(|&px| in_trail(px)).filter(is_ghost).count();
            }
        }
        let [trail, bars, all] = parts.map(|part| part.map(psnr));
        println!("{speed} px: trail {trail:.2?} dB, bars {bars:.2?}, all {all:.2?}; ghosts {ghosts:?}");
        assert!(trail[0] > trail[1] + 10.0, "{speed} px a frame: trails {trail:?} dB");
        assert!(bars[0] > 60.0 && all[0] > all[1], "{speed} px a frame: bars {bars:?} dB, all {all:?}");
        assert!(10 * ghosts[0] <= ghosts[1], "{speed} px a frame: {ghosts:?} pixels show the bar");
        figures.push(format!(
            "{speed} px a frame: trails {:.1} dB and {:.1} without repair, bars {:.1} and {:.1}, pixels of trails that look like the bar {} and {}",
            trail[0], trail[1], bars[0], bars[1], ghosts[0], ghosts[1]
        ));
    }
    Some(figures.join("; "))
}

/// Light that changes in one frame, in which history may be distrusted in every second square of 4 pixels.
pub fn light_and_contradictions(make: Make) -> Option<String> {
    let budget = 0.1;
    let mut figures = vec![];
    for (light, distrusts) in [(0.4, false), (0.4, true), (1.5, false), (1.5, true)] {
        let mut pair = Pair::new(make, budget)?;
        let picture = waves(SIZE, [0.0; 2]);
        let mut last_wanted = None;
        let mut largest = 0;
        let mut gains = vec![];
        for index in 0..4 * TURN {
            let color = if index < TURN { picture.clone() } else { picture.map(|c| c.map(|v| v * light)) };
            let is_distrusted = |[x, y]: [u32; 2]| distrusts && index == TURN && (x / 4 + y / 4).is_multiple_of(2);
            let trust = Image::from_fn(SIZE, |px| if is_distrusted(px) { 0.0 } else { 1.0 });
            let shot = shot(color.clone(), index).with(|view| view.trust = Some(trust));
            let shown = pair.show(index, &shot);
            if index < TURN {
                continue;
            }
            let chosen = quads().filter(|&quad| pixel(&shown.mask, quad)).count();
            largest = largest.max(chosen);
            if chosen > 0 {
                last_wanted = Some(index - TURN);
            }
            let errors = shown.errors(&color, everywhere);
            assert!(no_worse(errors), "light {light}, {distrusts}, frame {index}: {errors:?}");
            gains.push(psnr(errors[0]) - psnr(errors[1]));
        }
        let empty = last_wanted.map_or(0, |last| last + 1);
        println!("light {light}, distrusted {distrusts}: empty from {empty} on, {largest} quads; gain {gains:.2?}");
        assert!(!distrusts || 10 * largest > 9 * (budget * quads().count() as f32) as usize, "the budget is used up");
        // All quads, one frame after history was found coarse, and one more for the pixels that are asked then.
        assert!(empty <= (1.0 / budget) as u64 + 2, "light {light}: wanted for {empty} frames");
        let after = if distrusts { ", half distrusted" } else { "" };
        figures.push(format!("x{light}{after}: {empty} frames, {:+.1} dB after 4", gains[4]));
    }
    Some(format!("frames until nothing is wanted, and gain against no repair: {}", figures.join("; ")))
}
