//! Masks of planned frames that have single pixels, or that the renderer chose itself.

use super::quads::{BUDGET, Needs, show, show_shaded, wall};
use super::*;
use afterimage::internal::{Foveation, FoveationKind, Smr};
use afterimage_testing::holds;

type Mask = Image<bool>;

fn single(rates: [u32; 2], budget: f32) -> Foveation {
    let [rate_mid, rate_far] = rates;
    let radii = Foveation { fovea_deg: 8.0, mid_deg: 40.0, ..Foveation::quads() };
    Foveation { rate_mid, rate_far, budget, single_pixels: true, ..radii }
}

fn smr(foveation: Foveation, antialias: bool) -> Settings {
    Settings { method: Method::Smr(Smr { antialias, ..Smr::default() }), foveation, ..Settings::default() }
}

/// Pixels of a mask by quad, as numbers of pixels.
fn counts(mask: &Mask) -> Image<usize> {
    Image::from_fn(mask.size().map(|side| side.div_ceil(2)), |[x, y]| {
        let of_quad = pixels([2; 2]).map(|[u, v]| [2 * x + u, 2 * y + v]);
        of_quad.filter(|px| px[0] < SIZE[0] && px[1] < SIZE[1] && pixel(mask, *px)).count()
    })
}

fn count(mask: &Mask) -> usize {
    mask.pixels().iter().filter(|&&shaded| shaded).count()
}

/// Pixels outside the fovea, of a frame whose mask is even.
fn is_outside(foveation: &Foveation, view: &View) -> Mask {
    let fovea_px = match view.facts.gaze {
        afterimage::Gaze::At { px } => px,
        _ => unreachable!(),
    };
    let e_deg = |px: [u32; 2]| {
        let quad = px.map(|v| (2 * (v / 2)) as f32);
        foveation.region_angle_deg(&view.facts.geometry, quad, fovea_px)
    };
    Image::from_fn(SIZE, |px| e_deg(px) >= 0.5 * foveation.fovea_deg)
}

/// Frames after the first in which the last pixel outside the fovea is shaded; `None` if one never is.
fn turn(masks: &[Mask], outside: &Mask) -> Option<usize> {
    let of = pixels(SIZE).filter(|&px| pixel(outside, px));
    let first = of.map(|px| masks.iter().position(|mask| pixel(mask, px)));
    first.max_by_key(|at| at.unwrap_or(usize::MAX)).flatten()
}

/// The mask with the first pixel of each quad in place of the shaded one: a pattern that forgets to take turns.
fn without_turns(mask: &Mask) -> Mask {
    let counts = counts(mask);
    Image::from_fn(SIZE, |px| match pixel(&counts, px.map(|v| v / 2)) {
        4 => true,
        1 => px.map(|v| v % 2) == [0, 0],
        _ => false,
    })
}

#[test]
fn single_pixels_have_their_turn_within_the_budget() {
    let mut texts = vec![];
    for rates in [[2, 2], [2, 4], [4, 4], [4, 8], [8, 8]] {
        // In the periphery a frame has every second block.
        let period = (rates[0] * rates[0]).max(2 * rates[1] * rates[1]) as usize;
        let run = |budget: f32, needs: Needs, frames: usize| -> Vec<Mask> {
            let settings = smr(single(rates, budget), false);
            let mut post = context(settings);
            // The first frame is a quarter.
            (0..=frames as u64).map(|index| show(&mut post, index, &wall(index, needs)).0).skip(1).collect()
        };
        let even = run(0.0, Needs::Settled, period);
        let outside = is_outside(&single(rates, 0.0), &wall(0, Needs::Settled));
        let last = turn(&even, &outside).expect("a pixel without a turn");
        assert!(last < period, "{rates:?}: {last}");
        let stuck: Vec<_> = even.iter().map(without_turns).collect();
        assert_eq!(turn(&stuck, &outside), None, "the planted error");
        for mask in &even {
            let counts = counts(mask);
            let alone = pixels(counts.size()).filter(|quad| pixel(&outside, quad.map(|v| 2 * v)));
            assert!(alone.map(|quad| pixel(&counts, quad)).all(|n| n <= 1), "{rates:?}");
        }
        // The budget is a share of the pixels.
        let budget = (BUDGET * (SIZE[0] * SIZE[1]) as f32) as usize;
        let spent = |budget: f32| {
            let all = run(budget, Needs::Flickering, 32);
            all.iter().zip(&even).map(|(all, even)| count(all) - count(even)).max().unwrap()
        };
        let most = spent(BUDGET);
        assert!(most <= budget && 2 * most > budget, "{rates:?}: {most} of {budget}");
        assert!(spent(2.5 * BUDGET) > budget, "the planted error");
        texts.push(format!("blocks of {rates:?}: turn {last}, {most} px"));
    }
    holds!(
        "H107",
        Cpu,
        "single pixels, of {} px by need: {}",
        (BUDGET * (SIZE[0] * SIZE[1]) as f32) as u32,
        texts.join("; ")
    );
}

/// Wherever the gaze is, also where some of the view is more than 90 degrees away from it.
#[test]
fn a_quarter_has_a_pixel_of_every_quad() {
    for gaze_px in [[30.0, 20.0], [-1e6, 1e5], [1e30, 0.0]] {
        let view = wall(3, Needs::Settled).with(|view| view.facts.gaze = afterimage::Gaze::At { px: gaze_px });
        let mut post = context(smr(Foveation { fovea_deg: 0.0, ..Foveation::quads() }, true));
        let (mask, _) = show(&mut post, 3, &view);
        let place = Foveation::quarter_place_px(3);
        assert!(pixels(SIZE).all(|px| pixel(&mask, px) == (px.map(|v| v % 2) == place)), "{gaze_px:?}");
    }
}

/// What the renderer leaves at pixels beside those that were asked for, in the same quads, too, is not read.
#[test]
fn h108_pixels_beside_single_ones_are_not_read() {
    for antialias in [false, true] {
        let settings = smr(single([2, 4], BUDGET), antialias);
        let [mut whole, mut bare, mut planted] = [(); 3].map(|()| context(settings));
        let mut caught = false;
        for index in 0..24 {
            let view = wall(index, Needs::OneCorner);
            let (mask, shown) = show(&mut whole, index, &view);
            let at = |px| pixel(&view.color, px);
            let beside = |[x, _]: [u32; 2]| [[9.0; 3], [f32::NAN; 3]][x as usize % 2];
            let (same, bare_shown) =
                show_shaded(&mut bare, index, &view, |asked, px| if asked { at(px) } else { beside(px) });
            assert!(same == mask && bare_shown == shown, "frame {index}");
            // A planted error: a renderer that misplaces each sample by a pixel.
            let misplaced = |_, [x, y]: [u32; 2]| at([x ^ 1, y].map(|v| v.min(SIZE[1] - 1)));
            caught |= show_shaded(&mut planted, index, &view, misplaced).1 != shown;
        }
        assert!(caught);
        holds!("H108", Cpu, "single pixels, antialias {antialias}: outputs equal bit for bit");
    }
}

/// Every method on a mask of the renderer's own.
fn all_methods() -> Vec<Settings> {
    let of = |method: MethodKind| Settings { method: method.into(), ..smr(Foveation::quads(), false) };
    let noisy = Settings { foveation: Foveation::quads(), ..Settings::traced() };
    let others = [MethodKind::None, MethodKind::Wrs, MethodKind::Taa, MethodKind::Taau].map(of);
    [smr(Foveation::quads(), false), smr(Foveation::quads(), true), noisy].into_iter().chain(others).collect()
}

/// One pixel of most quads, in another place in each.
fn one_of_each(index: u64) -> Mask {
    let mut draws = Draws::new(&format!("one of each {index}"));
    let places = Image::from_fn(SIZE.map(|side| side.div_ceil(2)), |_| draws.bits() % 5);
    Image::from_fn(SIZE, |[x, y]| pixel(&places, [x / 2, y / 2]) == x % 2 + 2 * (y % 2))
}

fn of_mask(mask: &Mask) -> Image<f32> {
    mask.map(|chosen| if chosen { 1.0 } else { 0.0 })
}

#[test]
fn colors_of_half_the_size_are_as_whole_ones() {
    for settings in all_methods() {
        let [mut whole, mut half, mut planted] = [(); 3].map(|()| context(settings));
        let mut caught = false;
        for index in 0..12 {
            let noise = settings.noisy.then(|| Image::filled(SIZE, [0.02, 2.0]));
            let mask = one_of_each(index);
            let view = wall(index, Needs::OneCorner);
            let view = View { noise, mask: Some(of_mask(&mask)), ..view };
            let expected = whole.step(index, &view);
            let made = half.step(index, &view.clone().at_half(&mask));
            assert!(made.shown == expected.shown && made.stats == expected.stats, "{settings:?}, frame {index}");
            assert!(half.history() == whole.history(), "{settings:?}, frame {index}");
            // A planted error: a color of half the size that shows the first pixel of each quad.
            let first = Image::from_fn(SIZE, |px| px.map(|v| v % 2) == [0, 0]);
            caught |= planted.step(index, &view.clone().at_half(&first)).shown != expected.shown;
        }
        assert!(caught, "{settings:?}: the planted error");
    }
}

/// The mask that a plan chose, given as the renderer's own.
#[test]
fn an_own_mask_of_a_plan_gives_its_picture() {
    // Without a fovea the pictures are the same; with one, own masks compare what the fovea shows with history.
    // Of so many pixels that no frame is a quarter, whose samples are nearer to each other than the foveation says.
    let even = Foveation { budget: 0.3, ..Foveation::uniform(0.25) };
    let with_fovea = Foveation { fovea_deg: 10.0, mid_deg: 20.0, ..even };
    for (foveation, antialias) in [(even, false), (even, true), (with_fovea, false), (with_fovea, true)] {
        let [mut planned, mut own, mut planted] = [(); 3].map(|()| context(smr(foveation, antialias)));
        let [mut most, mut wrong] = [0.0_f32; 2];
        for index in 0..24 {
            let view = wall(index, Needs::OneCorner);
            let outside = is_outside(&foveation, &view);
            let (mask, expected) = show(&mut planned, index, &view);
            let with = |mask: &Mask| View { mask: Some(of_mask(mask)), ..view.clone() };
            let shown = own.step(index, &with(&mask)).shown;
            let all = expected.pixels().iter().zip(shown.pixels()).zip(outside.pixels());
            let largest = |(a, b): (&[f32; 3], &[f32; 3])| (0..3).fold(0.0, |m: f32, c| m.max((a[c] - b[c]).abs()));
            most = all.filter(|(_, outside)| **outside).map(|(pair, _)| largest(pair)).fold(most, f32::max);
            // A planted error: a mask that leaves out a column of quads.
            let holed = Image::from_fn(SIZE, |[x, y]| x / 2 != 7 && pixel(&mask, [x, y]));
            let shown = planted.step(index, &with(&holed)).shown;
            wrong = expected.pixels().iter().zip(shown.pixels()).map(largest).fold(wrong, f32::max);
        }
        println!("fovea {}, antialias {antialias}: off by {most}, with an error {wrong}", foveation.fovea_deg);
        let bar = if foveation == even { 0.0 } else { 0.02 };
        assert!(most <= bar && wrong > bar);
    }
}

#[test]
fn masks_of_frames_without_a_plan_are_refused() {
    let mut post = context(Settings::default());
    let view = View { mask: Some(Image::filled(SIZE, 1.0)), ..wall(0, Needs::Settled) };
    let refused = |post: &mut CpuAfterimage, view: &View| {
        let images = Images::of([view]);
        let mut shown = [Image::filled(SIZE, [0.0; 3])];
        post.process(&images.frame(0), &mut shown).unwrap_err().to_string()
    };
    let expected = "mask of view 0 is given: expected set FoveationKind::Quads in Settings::foveation";
    assert_eq!(refused(&mut post, &view), expected);
    let mut post = context(Settings { foveation: Foveation::quads(), ..Settings::default() });
    assert_eq!(post.desc().settings.foveation.kind, FoveationKind::Quads);
    let error = post.plan(&Images::of([&view]).frame(0)).unwrap_err().to_string();
    assert_eq!(error, "plan of view 0 is asked for: expected no plan, or no mask: a mask says which pixels are shaded");
    // Of another size.
    let small = View { mask: Some(Image::filled([3, 3], 1.0)), ..view.clone() };
    assert!(refused(&mut post, &small).starts_with("mask"), "{}", refused(&mut post, &small));
    let whole = View { half: Some(view.color.clone()), ..view };
    assert!(refused(&mut post, &whole).starts_with("half"), "{}", refused(&mut post, &whole));
}

/// A wall of one color with strong noise in its right quarter, and hardly any elsewhere.
fn noisy_wall(index: u64, needs: Needs) -> View {
    wall(index, needs).with(|view| {
        view.color = view.color.map(|[_, _, blue]| [blue, blue, blue]);
        view.noise = Some(Image::from_fn(SIZE, |[x, _]| [if 4 * x >= 3 * SIZE[0] { 1.0 } else { 0.001 }, 1.0]));
    })
}

/// Paths of frames after the first, by pixel, of smr on noisy frames.
fn paths_of(foveation: Foveation, needs: Needs, frames: u64) -> Vec<Image<u8>> {
    let mut post = context(Settings { foveation, ..Settings::traced() });
    let mut paths = |index| {
        let view = noisy_wall(index, needs);
        post.plan(&Images::of([&view]).frame(index)).unwrap();
        let paths = post.paths()[0].clone();
        show(&mut post, index, &view);
        paths
    };
    (0..=frames).map(&mut paths).skip(1).collect()
}

fn sum(paths: &Image<u8>) -> usize {
    paths.pixels().iter().map(|&paths| usize::from(paths)).sum()
}

#[test]
fn noisy_pixels_have_paths_by_need_within_the_budget() {
    let mut texts = vec![];
    for single_pixels in [true, false] {
        for needs in [Needs::Settled, Needs::Flickering, Needs::OneCorner, Needs::BadDepth, Needs::NoTrust] {
            let of = |budget: f32| {
                let foveation = Foveation { single_pixels, ..single([4, 8], budget) };
                paths_of(foveation, needs, 24)
            };
            let budget = (BUDGET * (SIZE[0] * SIZE[1]) as f32) as usize;
            let even = of(0.0);
            assert!(even.iter().all(|paths| paths.pixels().iter().all(|&n| n <= 1)));
            let spent = |budget: f32| {
                let all = of(budget);
                let most = all.iter().zip(&even).map(|(all, even)| sum(all) - sum(even)).max().unwrap();
                (most, all)
            };
            let (most, all) = spent(BUDGET);
            assert!(most <= budget && 2 * most > budget, "{needs:?}: {most} of {budget}");
            let largest = all.iter().flat_map(Image::pixels).max().unwrap();
            assert!(*largest <= 16);
            if matches!(needs, Needs::Settled) && single_pixels {
                assert!(*largest > 1, "some pixels have several paths");
                let of_columns = |from: u32, to: u32| {
                    let in_columns = |paths: &Image<u8>| {
                        pixels(SIZE)
                            .filter(|px| (from..to).contains(&px[0]))
                            .map(|px| usize::from(pixel(paths, px)))
                            .sum::<usize>()
                    };
                    all.iter().map(in_columns).sum::<usize>()
                };
                let quarter = SIZE[0] / 4;
                let [calm, noisy] = [of_columns(0, quarter), of_columns(SIZE[0] - quarter, SIZE[0])];
                assert!(noisy > calm, "{noisy} paths where noise is strong, {calm} where it is weak");
            }
            assert!(spent(2.5 * BUDGET).0 > budget, "the planted error");
            texts.push(format!("{needs:?} {most}"));
        }
    }
    holds!(
        "H107",
        Cpu,
        "most paths by need, of {}: {}",
        (BUDGET * (SIZE[0] * SIZE[1]) as f32) as u32,
        texts.join(", ")
    );
}
