//! Frames shaded by quads: laws of the plan, and what the renderer shades beside it.

use super::*;
use crate::any_frame::{self, any_frame};
use afterimage::Gaze;
use afterimage::internal::{Foveation, Smr};
use afterimage::kernel::quads::threshold;
use afterimage_testing::holds;
use std::collections::HashMap;

/// Frames in which the even pattern visits every quad of the periphery: 4x4 quads a block, every second block a frame.
const PERIOD: u64 = 32;
pub const BUDGET: f32 = 0.03;

type Mask = Image<bool>;

fn settings(budget: f32, antialias: bool) -> Settings {
    let foveation = Foveation { fovea_deg: 8.0, mid_deg: 20.0, rate_mid: 4, budget, ..Foveation::quads() };
    let method = Method::Smr(Smr { antialias, ..Smr::default() });
    Settings { method, foveation, ..Settings::default() }
}

fn context(budget: f32, antialias: bool) -> CpuAfterimage {
    let settings = settings(budget, antialias);
    CpuAfterimage::new(&ContextDesc { settings, ..ContextDesc::new(SIZE) }).unwrap()
}

/// What a plan has to work with.
#[derive(Clone, Copy, Debug)]
pub enum Needs {
    Settled,
    Flickering,
    OneCorner,
    BadDepth,
    NoTrust,
}

/// A wall with a smooth pattern, whose need is as it is named.
pub fn wall(index: u64, needs: Needs) -> View {
    let strobe = if matches!(needs, Needs::Flickering) && index % 2 == 1 { 4.0 } else { 1.0 };
    let color =
        |[x, y]: [u32; 2]| [(0.5 * x as f32).sin(), (0.4 * y as f32).cos(), 0.2].map(|v| strobe * (0.5 + 0.3 * v));
    let corner = |[x, y]: [u32; 2]| if x < 12 && y < 12 { 0.0 } else { 1.0 };
    let depth = |[x, y]: [u32; 2]| if (x + y) % 3 == index as u32 % 3 { f32::NAN } else { 5.0 };
    View::still(Image::from_fn(SIZE, color), [30.0, 20.0]).with(|view| {
        view.depth = Some(match needs {
            Needs::BadDepth => Image::from_fn(SIZE, depth),
            _ => Image::filled(SIZE, 5.0),
        });
        view.trust = match needs {
            Needs::OneCorner => Some(Image::from_fn(SIZE, corner)),
            Needs::NoTrust => Some(Image::filled(SIZE, 0.0)),
            _ => None,
        };
    })
}

/// Mask and output of a frame, in which the renderer shades `color` of the planned pixels.
pub fn show_shaded(
    post: &mut CpuAfterimage,
    index: u64,
    view: &View,
    color: impl Fn(bool, [u32; 2]) -> [f32; 3],
) -> (Mask, Color) {
    let images = Images::of([view]);
    let frame = images.frame(index);
    let mask = post.plan(&frame).unwrap()[0].clone();
    let shaded = Image::from_fn(SIZE, |px| color(pixel(&mask, px), px));
    let mut shown = [Image::filled(SIZE, [0.0; 3])];
    post.process(&Frame { color: &[&shaded], ..frame }, &mut shown).unwrap();
    let [shown] = shown;
    (mask, shown)
}

/// Mask and output of a frame that is shaded as it was planned.
pub fn show(post: &mut CpuAfterimage, index: u64, view: &View) -> (Mask, Color) {
    show_shaded(post, index, view, |_, px| pixel(&view.color, px))
}

/// Whether a pixel of each quad of a mask is shaded.
fn quads(mask: &Mask) -> Image<bool> {
    let [width, height] = mask.size();
    Image::from_fn([width.div_ceil(2), height.div_ceil(2)], |[x, y]| {
        let of_quad = pixels([2; 2]).map(|[u, v]| [2 * x + u, 2 * y + v]);
        of_quad.filter(|px| px[0] < width && px[1] < height).any(|px| pixel(mask, px))
    })
}

fn quads_of(mask: &Mask) -> usize {
    quads(mask).pixels().iter().filter(|&&shaded| shaded).count()
}

/// Largest number of quads beyond the even pattern's in a frame, and of the last frame; frames until the last quad was
/// shaded.
fn measured(masks: &[Mask], even: &[Mask]) -> (usize, usize, usize) {
    let spent: Vec<_> = masks.iter().zip(even).map(|(all, even)| quads_of(all) - quads_of(even)).collect();
    let all = even[0].pixels().len();
    let first = |i: usize| masks.iter().position(|mask| mask.pixels()[i]).unwrap_or(usize::MAX);
    (spent.iter().copied().max().unwrap(), spent[spent.len() - 1], (0..all).map(first).max().unwrap())
}

#[test]
fn h107_the_budget_is_never_exceeded_and_every_quad_has_its_turn() {
    let size = SIZE.map(|side| side.div_ceil(2));
    let budget = (BUDGET * (size[0] * size[1]) as f32) as usize;
    let run = |budget: f32, needs: Needs| -> Vec<Mask> {
        let mut post = context(budget, false);
        // The first frame is a quarter.
        (0..=3 * PERIOD).map(|index| show(&mut post, index, &wall(index, needs)).0).skip(1).collect()
    };
    // The pattern alone visits every quad, whatever is chosen beside it.
    let even = run(0.0, Needs::Settled);
    assert_eq!(measured(&even, &even).2 as u64, PERIOD - 1);
    let mut texts = vec![];
    for needs in [Needs::Settled, Needs::Flickering, Needs::OneCorner, Needs::BadDepth, Needs::NoTrust] {
        let (most, last, turn) = measured(&run(BUDGET, needs), &even);
        assert!(most <= budget && most > budget / 2, "{needs:?}: {most} of {budget}");
        assert!((turn as u64) < PERIOD, "{needs:?}: {turn}");
        assert_eq!(last == 0, matches!(needs, Needs::Settled), "{needs:?}");
        texts.push(format!("{needs:?} {most}"));
    }
    // Planted errors: a plan of twice the budget, and a pattern that leaves out a quad.
    let (generous, _, _) = measured(&run(2.5 * BUDGET, Needs::Flickering), &even);
    assert!(generous > budget, "{generous}");
    let hole = |mask: &Mask| Image::from_fn(SIZE, |px| px[0] + px[1] > 1 && pixel(mask, px));
    let holed: Vec<_> = even.iter().map(hole).collect();
    assert_eq!(measured(&holed, &holed).2, usize::MAX);
    holds!("H107", Cpu, "most quads by need of {budget}: {}", texts.join(", "));
}

/// Largest number of quads of a block of 4x4 quads that were chosen beyond the even pattern.
fn most_in_a_block(mask: &Mask, even: &Mask) -> usize {
    let (mask, even) = (quads(mask), quads(even));
    let mut counts = HashMap::new();
    for quad in pixels(mask.size()).filter(|&quad| pixel(&mask, quad) && !pixel(&even, quad)) {
        *counts.entry(quad.map(|v| v / 4)).or_insert(0) += 1;
    }
    counts.into_values().max().unwrap()
}

/// A frame whose history is rejected everywhere. A first frame is a quarter.
#[test]
fn without_history_the_budget_is_spread_evenly_over_the_view() {
    for index in 1..=PERIOD {
        let plan = |budget: f32| {
            let mut post = context(budget, true);
            show(&mut post, index - 1, &wall(index - 1, Needs::Settled));
            show(&mut post, index, &wall(index, Needs::NoTrust)).0
        };
        let even = plan(0.0);
        assert_eq!(most_in_a_block(&plan(BUDGET), &even), 1, "frame {index}");
        // A budget above one quad in 16 has to choose others, too.
        assert!(most_in_a_block(&plan(0.2), &even) > 1, "frame {index}");
    }
}

/// A quarter first, which a plan takes by itself: smr's history stays, and every pixel is nearer to the full-rate frame
/// than after a first frame of the quads that the budget pays for.
#[test]
fn a_first_frame_at_a_quarter_stays_in_history() {
    for antialias in [false, true] {
        let view = wall(0, Needs::Settled);
        // What is chosen in frame `index` without history, if it is no quarter.
        let by_need = |index: u64| {
            let mut post = context(BUDGET, antialias);
            show(&mut post, 0, &view);
            let mask = show(&mut post, index, &wall(index, Needs::NoTrust)).0;
            Some(mask.map(|chosen| if chosen { 1.0 } else { 0.0 }))
        };
        let error = |mask: Option<Image<f32>>, reset: Reset| {
            let mut post = context(BUDGET, antialias);
            post.step(0, &View { mask, ..view.clone() });
            let second = View { mask: by_need(1), ..view.clone() };
            let shown = post.make(1, &second, Exposure::Same, reset).shown;
            let off = |(a, b): (&[f32; 3], &[f32; 3])| (0..3).map(|c| f64::from(a[c] - b[c]).powi(2)).sum::<f64>();
            shown.pixels().iter().zip(view.color.pixels()).map(off).sum::<f64>()
        };
        let by_quads = error(by_need(0), Reset::None);
        let by_a_quarter = error(None, Reset::None);
        let forgotten = error(None, Reset::All);
        println!(
            "squared error in the second frame: {by_quads:.2}, after a quarter {by_a_quarter:.2}, reset {forgotten:.2}"
        );
        assert!(by_a_quarter < 0.5 * by_quads && by_a_quarter < 0.5 * forgotten);
    }
}

/// Bars of 0.6 and 1.1 pixels before a wall that moves with them, jittered. History antialiases them: a sample of a bar
/// or of the wall beside it does not contradict the mean of both.
#[test]
fn thin_bars_become_means() {
    const COLORS: [f32; 2] = [0.6, 0.03];
    let is_bar = |x: f32, y: f32| {
        let (across, width) = if y < 20.0 { (x - 0.02 * y, 0.6) } else { (x + 0.3 * y, 1.1) };
        across.rem_euclid(9.0) < width
    };
    // Mean squared errors of square roots, of eight frames: the samples', and history's.
    let errors = |speed_px: f32| {
        let point = |px: [u32; 2], place: [f32; 2], index: u64| {
            is_bar(px[0] as f32 + place[0] - speed_px * index as f32, px[1] as f32 + place[1])
        };
        let settings = Settings { foveation: Foveation::uniform(0.25), ..settings(0.0, true) };
        let mut post = CpuAfterimage::new(&ContextDesc { settings, ..ContextDesc::new(SIZE) }).unwrap();
        let mut sums = [0.0; 2];
        for index in 0..64 {
            let jitter_px = Foveation::jitter_px(index + 1);
            let bars = Image::from_fn(SIZE, |px| point(px, jitter_px.map(|jitter| 0.5 - jitter), index));
            let color = bars.map(|bar| [COLORS[usize::from(bar)]; 3]);
            let view = View::still(color.clone(), [30.0, 20.0]).with(|view| {
                view.facts.jitter_px = jitter_px;
                view.depth = Some(bars.map(|bar| if bar { 3.0 } else { 9.0 }));
                view.motion = Some(Image::filled(SIZE, [-speed_px, 0.0]));
            });
            let (_, shown) = show(&mut post, index, &view);
            let mean = Image::from_fn(SIZE, |px| {
                let inside = |i: u32| point(px, [i % 8, i / 8].map(|v| (v as f32 + 0.5) / 8.0), index);
                let share = (0..64).filter(|&i| inside(i)).count() as f32 / 64.0;
                [COLORS[0] + (COLORS[1] - COLORS[0]) * share; 3]
            });
            for (sum, image) in sums.iter_mut().zip([&color, &shown]).filter(|_| index >= 56) {
                let off = |(a, b): (&[f32; 3], &[f32; 3])| f64::from(a[0].sqrt() - b[0].sqrt()).powi(2);
                *sum += image.pixels().iter().zip(mean.pixels()).map(off).sum::<f64>();
            }
        }
        sums
    };
    // If samples at silhouettes were compared, and thin surfaces stored as they are, it would be 4.4 and 3.0 dB;
    // without samples beside a pixel 5.6 dB if they move.
    for (speed_px, least_db) in [(0.0, 8.0), (0.8, 6.2)] {
        let [samples, history] = errors(speed_px);
        let db = 10.0 * (samples / history).log10();
        println!("{speed_px} px a frame: {db:.1} dB better than samples");
        assert!(db > least_db);
    }
}

/// The oblique edge of a surface before a wall, jittered, both moving by parallax: its pixels become means of both. A
/// sample of the same surface beside a pixel counts there, and an own sample does not contradict history.
#[test]
fn an_edge_that_moves_by_parallax_becomes_a_mean() {
    const COLORS: [f32; 2] = [0.6, 0.03];
    const SPEEDS_PX: [f32; 2] = [0.8, 0.2];
    const FRAMES: u64 = 64;
    // PSNR of square roots in the pixels that show both, of the last half.
    let quality_db = |has_depth: bool| {
        let is_front = |px: [u32; 2], place: [f32; 2], index: u64| {
            px[0] as f32 + place[0] < 2.0 + 0.3 * (px[1] as f32 + place[1]) + SPEEDS_PX[0] * index as f32
        };
        let settings = Settings { foveation: Foveation::uniform(0.1), ..settings(0.0, true) };
        let mut post = CpuAfterimage::new(&ContextDesc { settings, ..ContextDesc::new(SIZE) }).unwrap();
        let (mut sum, mut count) = (0.0, 0);
        for index in 0..FRAMES {
            let jitter_px = Foveation::jitter_px(index + 1);
            let front = Image::from_fn(SIZE, |px| is_front(px, jitter_px.map(|jitter| 0.5 - jitter), index));
            let view = View::still(front.map(|front| [COLORS[usize::from(front)]; 3]), [30.0, 20.0]).with(|view| {
                view.facts.jitter_px = jitter_px;
                view.depth = Some(front.map(|front| if front && has_depth { 3.0 } else { 9.0 }));
                view.motion = Some(front.map(|front| [-SPEEDS_PX[usize::from(!front)], 0.0]));
            });
            let (_, shown) = show(&mut post, index, &view);
            for px in pixels(SIZE).filter(|_| index >= FRAMES / 2) {
                let inside = |i: u32| is_front(px, [i % 8, i / 8].map(|v| (v as f32 + 0.5) / 8.0), index);
                let share = (0..64).filter(|&i| inside(i)).count() as f32 / 64.0;
                if share > 0.0 && share < 1.0 {
                    let mean = COLORS[0] + (COLORS[1] - COLORS[0]) * share;
                    sum += f64::from(pixel(&shown, px)[0].sqrt() - mean.sqrt()).powi(2);
                    count += 1;
                }
            }
        }
        10.0 * (f64::from(count) / sum).log10()
    };
    // Without samples beside a pixel it would be 18.9 dB.
    const LEAST_DB: f64 = 19.4;
    let [edge, planted] = [true, false].map(quality_db);
    println!("{edge:.1} dB, planted error of a depth without the edge {planted:.1}");
    assert!(edge > LEAST_DB && planted < LEAST_DB);
}

#[test]
fn h108_what_was_not_asked_for_is_not_read_and_what_is_missing_is_not_shown() {
    for antialias in [false, true] {
        let [mut whole, mut bare, mut short, mut planted] = [(); 4].map(|()| context(BUDGET, antialias));
        let (mut missing, mut caught) = (0, false);
        for index in 0..PERIOD {
            let view = wall(index, Needs::OneCorner);
            let (mask, shown) = show(&mut whole, index, &view);
            let at = |px| pixel(&view.color, px);
            // The renderer leaves its clear color, or shades more than was asked for.
            let beside = |[x, _]: [u32; 2]| [[9.0; 3], [f32::NAN; 3]][x as usize % 2];
            let bare_color = |asked, px| if asked { at(px) } else { beside(px) };
            let (same, bare_shown) = show_shaded(&mut bare, index, &view, bare_color);
            assert!(same == mask && bare_shown == shown, "frame {index}");
            // It leaves out some of what was asked for.
            let is_left_out = |[x, y]: [u32; 2]| (x / 2 + y / 2) % 5 == 0;
            let (_, without) = show_shaded(&mut short, index, &view, |asked, px| match asked {
                true if is_left_out(px) => [f32::NAN; 3],
                true => at(px),
                false => beside(px),
            });
            let finite = without.pixels().iter().flatten().all(|v| v.is_finite() && (0.0..9.0).contains(v));
            assert!(finite, "frame {index}: the clear color shows");
            missing += without.pixels().iter().zip(shown.pixels()).filter(|(a, b)| a != b).count();
            // A planted error: a renderer whose clear color counts.
            let clear = |asked, px| if asked && !is_left_out(px) { at(px) } else { [9.0; 3] };
            let (_, wrong) = show_shaded(&mut planted, index, &view, clear);
            caught |= !wrong.pixels().iter().flatten().all(|v| (0.0..9.0).contains(v));
        }
        assert!(missing > 0 && caught, "what is missing makes a difference");
        holds!("H108", Cpu, "antialias {antialias}: outputs equal bit for bit; with a fifth missing, none of it shows");
    }
}

#[test]
fn plans_of_other_frames_are_refused() {
    let mut post = CpuAfterimage::new(&ContextDesc::new(SIZE)).unwrap();
    let view = wall(0, Needs::Settled);
    let images = Images::of([&view]);
    let error = post.plan(&images.frame(0)).unwrap_err().to_string();
    assert_eq!(error, "plan of view 0 is asked for: expected FoveationKind::Quads in Settings::foveation");
}

proptest! {
    #![proptest_config(afterimage_testing::property("quads", 200))]

    #[test]
    fn a_budget_is_never_exceeded_and_used_up_to_one_key(counts in prop::collection::vec(0u32..50, 2..200), budget in 0u32..3000) {
        let key = threshold(&counts, budget) as usize;
        let chosen = |key: usize| counts[key..].iter().sum::<u32>();
        prop_assert!(key >= 1 && chosen(key) <= budget);
        prop_assert!(key == 1 || chosen(key - 1) > budget);
    }

    #[test]
    fn any_frames_are_within_the_budget(name in any::<u64>(), wild in prop::sample::select(vec![0.0, 0.1, 1.0]), budget in 0.0f32..=1.0, antialias in any::<bool>()) {
        let mut draws = Draws::new(&name.to_string());
        let size = any_frame::SIZE;
        let made = |budget| {
            let desc = ContextDesc { settings: settings(budget, antialias), view_count: 2, ..ContextDesc::new(size) };
            CpuAfterimage::new(&desc).unwrap()
        };
        let (mut post, mut even) = (made(budget), made(0.0));
        // Its frames are no quarter, which a first frame is.
        let before = View::still(Image::filled(size, [0.0; 3]), [0.0; 2]).with(|view| view.facts.gaze = Gaze::Lost);
        let mut out = vec![Image::filled(size, [f32::NAN; 3]); 2];
        let before = [before.clone(), before];
        even.plan(&Images::of(&before).frame(9)).unwrap();
        even.process(&Images::of(&before).frame(9), &mut out).unwrap();
        for index in 0..4 {
            let views = [0; 2].map(|_| View { lod: None, noise: None, ..any_frame(&mut draws, wild) });
            let images = Images::of(&views);
            let reset = if draws.uniform() < 0.2 { Reset::All } else { Reset::None };
            let frame = Frame { reset, ..images.frame(index) };
            let before = post.clone();
            let masks = post.plan(&frame).unwrap().to_vec();
            prop_assert_eq!(post.plan(&Frame { color: &[], ..frame }).unwrap(), &masks);
            prop_assert!(post.history() == before.history());
            let is_quarter = post.is_quarter();
            prop_assert!(!is_quarter || index == 0 || reset == Reset::All);
            for (mask, even) in masks.iter().zip(even.plan(&Frame { reset: Reset::None, ..frame }).unwrap()) {
                if is_quarter {
                    prop_assert!(4 * quads_of(mask) >= mask.pixels().len());
                    continue;
                }
                let by_need = quads_of(mask) - quads_of(even);
                let all = size.map(|side| f64::from(side.div_ceil(2))).iter().product::<f64>();
                prop_assert!(by_need as f64 <= f64::from(budget) * all);
            }
            for post in [&mut post, &mut even] {
                post.process(&frame, &mut out).unwrap();
                prop_assert!(out.iter().flat_map(|o| o.pixels()).flatten().all(|v| v.is_finite()));
            }
        }
    }
}
