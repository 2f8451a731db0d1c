//! What renderers deliver, on planned frames: depth, motion vectors, gaze, cuts, sizes and colors of hard cases that
//! were first met on full-size frames.

use super::jitter_px;
use crate::depth_hard::{Color, Made, Make, SIZE, Steps, desc, still};
use crate::images::{View, noise, off, pixel, pixels, times};
use afterimage::internal::{ContextDesc, Foveation, Method, Reset, Settings, Smr};
use afterimage::{DepthConvention, Exposure, Gaze, Image, Verdict};

/// Frames after which every pixel has been shaded: those without history have a high need.
const SEEN: u64 = 48;
/// Largest relative error of a stored color: half a step of its 9 bits, and of decoding.
const STORED: f32 = 1.0 / 256.0;

/// A quarter of the pixels, without antialiasing and with it, and a tenth around a gaze.
fn plans() -> [Settings; 3] {
    let smr = |antialias| Method::Smr(Smr { antialias, ..Smr::default() });
    let of = |antialias, foveation| Settings { method: smr(antialias), foveation, ..Settings::default() };
    [of(false, Foveation::uniform(0.25)), of(true, Foveation::uniform(0.25)), Settings::screen()]
}

fn is_antialiased(settings: &Settings) -> bool {
    matches!(settings.method, Method::Smr(Smr { antialias: true, .. }))
}

/// Colors of one surface that differ from pixel to pixel.
fn texture(name: &str) -> Color {
    noise(SIZE, name).map(|c| c.map(|v| 0.25 + 0.5 * v))
}

fn at(depth: f32, color: Color) -> View {
    still(color).with(|view| view.depth = Some(Image::filled(SIZE, depth)))
}

fn run(post: &mut dyn Steps, frames: std::ops::Range<u64>, view: impl Fn(u64) -> View) -> Option<Made> {
    frames.map(|index| post.step(index, &view(index))).last()
}

/// Colors that are negative or brighter than what is stored, at every seventh pixel.
pub fn colors(make: Make<'_>) -> Option<String> {
    let picture = texture("colors");
    let (mut hurt, mut most) = (0, 0);
    for settings in plans() {
        for strange in [-1.0, -65504.0, 1e4, 65504.0, 1e30] {
            let mut post = make(desc(settings))?;
            let mut left = 0;
            for index in 0..SEEN + 40 {
                let is_strange = (8..16).contains(&index);
                let mut color = picture.clone();
                for c in color.pixels_mut().iter_mut().step_by(7).filter(|_| is_strange) {
                    *c = [strange, 0.5, -strange];
                }
                let shown = post.step(index, &at(4.0, color)).shown;
                assert!(shown.pixels().iter().flatten().all(|v| v.abs() <= 65504.0), "{strange}, frame {index}");
                hurt += u32::from(is_strange && off(&shown, &picture) > 0.5);
                let pairs = shown.pixels().iter().zip(picture.pixels());
                let is_off = |(a, b): &(&[f32; 3], &[f32; 3])| (0..3).any(|i| (a[i] / b[i] - 1.0).abs() > 0.1);
                left = pairs.filter(is_off).count();
            }
            most = most.max(left);
        }
    }
    assert!(hurt > 0, "the planted error is seen");
    assert!(most < 460, "{most}");
    Some(format!(
        "planned, -65504 to 1e30 at 439 of 3072 px in 8 frames: all finite; up to {most} px off by 10 % 32 frames later"
    ))
}

/// Depth beyond the ends of its range.
pub fn depth_ends(make: Make<'_>) -> Option<String> {
    let reversed = DepthConvention::Reversed { near: 0.1, far: f32::INFINITY };
    let forward = DepthConvention::Forward { near: 0.1, far: 100.0 };
    for settings in plans() {
        for (depth, end, beyond) in [
            (reversed, 0.0, [-1e-7, -3.0, f32::NEG_INFINITY]),
            (forward, 1.0, [1.000_000_1, 7.0, f32::INFINITY]),
            (forward, 0.0, [-1e-7, -3.0, f32::NEG_INFINITY]),
        ] {
            let shown = |stored: f32| -> Option<Vec<Made>> {
                let mut post = make(ContextDesc { depth, ..desc(settings) })?;
                let view = |index: u64| {
                    let view = still(texture(&format!("ends {}", index / 3)));
                    let depth = Image::from_fn(SIZE, |[x, _]| if x < 30 { stored } else { 0.5 });
                    view.with(|view| view.depth = Some(depth))
                };
                Some((0..9).map(|index| post.step(index, &view(index))).collect())
            };
            let expected = shown(end)?;
            for stored in beyond {
                assert!(shown(stored)? == expected, "{settings:?}, {depth:?}: {stored}");
            }
            // The planted error: another surface.
            assert!(shown(0.3)? != expected);
        }
    }
    Some("planned: two encodings, by 1 ulp to infinity beyond either end: as at the end, bit for bit".into())
}

/// Vectors that end just inside the view, and just outside.
pub fn edge_of_the_view(make: Make<'_>) -> Option<String> {
    let picture = texture("edge");
    for settings in plans() {
        // The last texel's centre is 63, and the edge of the view 63.5.
        for (x, is_seen) in [(63.0, true), (63.49, true), (63.51, false)] {
            let mut post = make(desc(settings))?;
            run(post.as_mut(), 0..8, |_| at(4.0, picture.clone()));
            let motion = Image::from_fn(SIZE, |[at, _]| [x - at as f32, 0.0]);
            let view = at(4.0, picture.clone()).with(|view| view.motion = Some(motion));
            let trace = post.step(8, &view).trace;
            let expected = if is_seen { Verdict::Valid } else { Verdict::OffScreen };
            assert!(trace.pixels().iter().all(|t| t.verdict == expected), "{settings:?}, {x}");
        }
    }
    Some("planned: 0.01 px outside the view is rejected, 0.01 px inside and the last centre are accepted".into())
}

/// Depth that is not a number, in one pixel of one frame.
pub fn nan_depth(make: Make<'_>) -> Option<String> {
    let [plain, ..] = plans();
    nan_depth_of(make, &[plain])
}

/// The same of all plans, on the CPU. On software Vulkan the last bit of some colors beside the pixel differs.
pub fn nan_depth_antialiased(make: Make<'_>) -> Option<String> {
    nan_depth_of(make, &plans())
}

fn nan_depth_of(make: Make<'_>, plans: &[Settings]) -> Option<String> {
    let hurt = [20, 20];
    let (mut widest, mut longest, mut largest) = (0, 0, 0.0_f32);
    for &settings in plans {
        let [mut clean, mut broken] = [make(desc(settings))?, make(desc(settings))?];
        let view = |_: u64| at(4.0, texture("nan"));
        for post in [&mut clean, &mut broken] {
            run(post.as_mut(), 0..SEEN, view);
        }
        for index in SEEN..SEEN + 16 {
            let input = view(index);
            let planted = input.clone().with(|view| {
                if index == SEEN {
                    view.depth.as_mut().unwrap().pixels_mut()[(hurt[1] * SIZE[0] + hurt[0]) as usize] = f32::NAN;
                }
            });
            let (a, b) = (clean.step(index, &input), broken.step(index, &planted));
            assert_eq!(b.stats.bad_depth, u64::from(index == SEEN));
            let mut is_same = true;
            for px in pixels(SIZE) {
                let (expected, found) = (pixel(&a.shown, px), pixel(&b.shown, px));
                assert!(found.iter().all(|v| v.is_finite()), "{settings:?}, frame {index}, {px:?}");
                if found != expected {
                    is_same = false;
                    largest = (0..3).map(|i| (found[i] - expected[i]).abs()).fold(largest, f32::max);
                    widest = widest.max((0..2).map(|i| px[i].abs_diff(hurt[i])).max().unwrap());
                }
            }
            if !is_same {
                longest = longest.max(index - SEEN + 1);
            }
        }
    }
    assert!(largest > 0.0 && widest <= 8 && longest <= 8, "{largest}, {widest} px, {longest} frames");
    Some(format!(
        "planned: never shown; colors within {widest} px change by {largest:.4} at the most, {longest} frames long"
    ))
}

/// A still picture.
pub fn still_picture(make: Make<'_>) -> Option<String> {
    let mut worst = 0.0_f32;
    let settings = plans()[0];
    let mut post = make(desc(settings))?;
    let picture = texture("still");
    let first = run(post.as_mut(), 0..SEEN, |_| at(4.0, picture.clone()))?;
    // The planted error: before all pixels had their turn.
    let early = run(make(desc(settings))?.as_mut(), 0..2, |_| at(4.0, picture.clone()))?;
    assert!(off(&early.shown, &picture) > 0.1);
    assert!(off(&first.shown, &picture) <= STORED);
    for index in SEEN..400 {
        let made = post.step(index, &at(4.0, picture.clone()));
        worst = worst.max(off(&made.shown, &picture));
        assert_eq!(made.stats.rejected(), 0);
    }
    assert!(worst <= STORED, "{worst}");
    Some(format!("planned, 400 frames: within {worst:.4} of the picture from frame {SEEN} on"))
}

/// History that moves by whole pixels.
pub fn whole_shift(make: Make<'_>) -> Option<String> {
    let settings = plans()[0];
    let picture = texture("shift");
    let mut worst = [0.0_f32; 2];
    for (worst, shift) in worst.iter_mut().zip([[3.0, -2.0], [-3.0, 2.0]]) {
        let mut post = make(desc(settings))?;
        run(post.as_mut(), 0..SEEN, |_| at(4.0, picture.clone()));
        let source = |[x, y]: [u32; 2]| [x + 3, y.wrapping_sub(2)];
        let inside = |px: [u32; 2]| source(px)[0] < SIZE[0] && source(px)[1] < SIZE[1];
        let moved = Image::from_fn(SIZE, |px| if inside(px) { pixel(&picture, source(px)) } else { [0.5; 3] });
        let view = at(4.0, moved.clone()).with(|view| view.motion = Some(Image::filled(SIZE, shift)));
        let made = post.step(SEEN, &view);
        let mut is_off = 0;
        for px in pixels(SIZE).filter(|&px| inside(px)) {
            let error = (0..3).map(|i| (pixel(&made.shown, px)[i] / pixel(&moved, px)[i] - 1.0).abs());
            let error = error.fold(0.0, f32::max);
            *worst = worst.max(error);
            is_off += u32::from(error > STORED);
        }
        let outside: Vec<_> = pixels(SIZE).filter(|&px| !inside(px)).collect();
        let is_new = outside.iter().filter(|px| pixel(&made.trace, **px).verdict == Verdict::OffScreen).count();
        // The planted error: the other sign.
        let is_right = shift == [3.0, -2.0];
        assert!(if is_right { is_off == 0 } else { is_off > 1000 }, "{is_off} px are off");
        assert_eq!(is_new == outside.len(), is_right, "{is_new} px of the border are new");
    }
    Some(format!(
        "planned: history within {:.4} of the picture where it came from; the other sign is off by {:.1}",
        worst[0], worst[1]
    ))
}

/// A picture that moves by half a pixel a frame.
pub fn half_pixels(make: Make<'_>) -> Option<String> {
    let f = std::f64::consts::PI / 16.0;
    let mut kept = vec![];
    for settings in plans() {
        let antialias = is_antialiased(&settings);
        let wave = |x: f64| 0.5 + 0.3 * (2.0 * f * x).sin();
        let view = |index: u64| {
            let jitter = jitter_px(index, antialias);
            let shift = 0.5 * index as f64 + f64::from(jitter[0]);
            at(4.0, Image::from_fn(SIZE, |[x, _]| [wave(f64::from(x) - shift) as f32; 3])).with(|view| {
                view.motion = Some(Image::filled(SIZE, [-0.5, 0.0]));
                view.facts.jitter_px = jitter;
            })
        };
        let mut post = make(desc(settings))?;
        let shown = run(post.as_mut(), 0..200, view)?.shown;
        let amplitude = |image: &Color| {
            let at = |x: usize| f64::from(image.at(x, 24)[0]) * (2.0 * f * (x as f64 - 0.5 * 199.0)).sin();
            (24..56).map(at).sum::<f64>() / 16.0 / 0.3
        };
        kept.push(amplitude(&shown));
    }
    assert!(kept.iter().all(|kept| (0.95..1.01).contains(kept)), "{kept:?}");
    Some(format!(
        "planned, 0.5 px x 200: {:.3}, antialiased {:.3}, around a gaze {:.3} of a wave of 16 px left",
        kept[0], kept[1], kept[2]
    ))
}

/// Vectors that are not numbers, or far too long.
pub fn garbage_motion(make: Make<'_>) -> Option<String> {
    for settings in plans() {
        let mut post = make(desc(settings))?;
        let picture = texture("garbage");
        run(post.as_mut(), 0..SEEN, |_| at(4.0, picture.clone()));
        let all_bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e9, -1e9, f32::MAX];
        for (index, bad) in (SEEN..).zip(all_bad) {
            let mut motion = Image::filled(SIZE, [0.0; 2]);
            motion.pixels_mut()[5 * 64 + 7] = [bad, 0.0];
            motion.pixels_mut()[6 * 64 + 7] = [0.0, bad];
            let view = at(4.0, picture.clone()).with(|view| view.motion = Some(motion));
            let Made { shown, stats, trace, .. } = post.step(index, &view);
            assert_eq!((stats.verdicts[Verdict::BadMotion as usize], stats.rejected()), (2, 2), "{bad}");
            let bad_at = pixels(SIZE).filter(|&px| pixel(&trace, px).verdict == Verdict::BadMotion).collect::<Vec<_>>();
            assert!(bad_at.iter().all(|at| [[7, 5], [7, 6]].contains(at)), "{bad_at:?}");
            assert!(shown.pixels().iter().flatten().all(|v| (0.2..0.8).contains(v)));
        }
    }
    Some("planned: NaN, infinities, +-1e9, 3e38 on either axis reject their pixels' history alone, and return".into())
}

/// A bright square that moves before a dark wall, 8 times as far.
pub fn depth_edge(make: Make<'_>) -> Option<String> {
    let mut worst = [0.0_f32; 2];
    for settings in plans() {
        let antialias = is_antialiased(&settings);
        let mut post = make(desc(settings))?;
        for index in 0..30_u64 {
            let jitter = jitter_px(index, antialias);
            let left = 4.0 + 1.5 * index as f32;
            let is_near = |[x, y]: [u32; 2], margin: f32| {
                let (x, y) = (x as f32 - jitter[0], y as f32 - jitter[1]);
                (left - margin..left + 10.0 + margin).contains(&x) && (10.0 - margin..30.0 + margin).contains(&y)
            };
            let near = |px| is_near(px, 0.0);
            let view = still(Image::from_fn(SIZE, |px| if near(px) { [1.0; 3] } else { [0.125; 3] })).with(|view| {
                view.depth = Some(Image::from_fn(SIZE, |px| if near(px) { 1.0 } else { 8.0 }));
                view.motion = Some(Image::from_fn(SIZE, |px| if near(px) { [-1.5, 0.0] } else { [0.0; 2] }));
                view.facts.jitter_px = jitter;
            });
            let shown = post.step(index, &view).shown;
            for px in pixels(SIZE) {
                let error = |expected: f32| {
                    pixel(&shown, px).map(|v| (v / expected - 1.0).abs()).into_iter().fold(0.0, f32::max)
                };
                if is_near(px, -1.0) {
                    worst[0] = worst[0].max(error(1.0));
                } else if !is_near(px, 1.0) {
                    worst[1] = worst[1].max(error(0.125));
                }
            }
        }
    }
    assert!(worst[0] < 0.02 && worst[1] < 0.05, "{worst:?}");
    Some(format!(
        "planned, a square at 1.5 px a frame over a wall: more than 1 px from its edge off by {:.3} in it, {:.3} beside",
        worst[0], worst[1]
    ))
}

/// Steps towards a picture and away from it.
pub fn zoom(make: Make<'_>) -> Option<String> {
    let picture = noise(SIZE, "zoom").map(|c| c.map(|v| 0.5 + 0.125 * v));
    let mut range = [1.0_f32, 0.0];
    for settings in plans() {
        for factor in [0.5, 2.0] {
            let mut post = make(desc(settings))?;
            run(post.as_mut(), 0..SEEN, |_| at(4.0, picture.clone()));
            let motion = Image::from_fn(SIZE, |[x, y]| [x as f32 - 32.0, y as f32 - 24.0].map(|v| v * (factor - 1.0)));
            let view = at(4.0, noise(SIZE, "zoom 2").map(|c| c.map(|v| 0.5 + 0.125 * v)))
                .with(|view| view.motion = Some(motion));
            let made = post.step(SEEN, &view);
            for v in made.shown.pixels().iter().flatten() {
                range = [range[0].min(*v), range[1].max(*v)];
            }
            let kept = made.trace.pixels().iter().filter(|t| t.verdict == Verdict::Valid).count();
            assert!(if factor < 1.0 { kept == 64 * 48 } else { kept < 1000 }, "{factor}: {kept}");
        }
    }
    assert!(range[0] >= 0.5 - STORED && range[1] <= 0.625 + STORED, "{range:?}");
    Some(format!("planned, in and out x2: all shown in {:.3} to {:.3} of samples in 0.5 to 0.625", range[0], range[1]))
}

/// A turn after which nothing is seen that was seen before.
pub fn turn(make: Make<'_>) -> Option<String> {
    let mut left = 0.0_f32;
    for settings in plans() {
        let mut post = make(desc(settings))?;
        run(post.as_mut(), 0..SEEN, |_| at(4.0, Image::filled(SIZE, [0.8, 0.0, 0.0])));
        let green = at(4.0, Image::filled(SIZE, [0.0, 0.8, 0.0]));
        let view = green.with(|view| view.motion = Some(Image::filled(SIZE, [5000.0, 0.0])));
        let made = post.step(SEEN, &view);
        assert_eq!(made.stats.rejected(), u64::from(SIZE[0] * SIZE[1]), "{settings:?}");
        left = made.shown.pixels().iter().fold(left, |left, c| left.max(c[0]).max((c[1] - 0.8).abs()));
    }
    assert!(left < 1e-3, "{left}");
    Some(format!("planned: all history rejected; {left:.4} of the old color or lack of the new one, everywhere"))
}

/// A gaze that is lost, not a number, or far away.
pub fn lost_gaze(make: Make<'_>) -> Option<String> {
    let to = |x: f32, y: f32| Gaze::At { px: [x, y] };
    let run_with = |gazes: &[Gaze]| -> Option<Vec<Made>> {
        let mut post = make(desc(Settings::screen()))?;
        let frames = (0..).zip(gazes).map(|(index, &gaze)| {
            let view = at(4.0, texture(&format!("gaze {index}"))).with(|view| view.facts.gaze = gaze);
            post.step(index, &view)
        });
        Some(frames.collect())
    };
    let here = to(9.0, 9.0);
    let expected = run_with(&[to(31.5, 23.5), here, here, here])?;
    assert!(run_with(&[Gaze::Lost, here, Gaze::Lost, to(3.0, f32::NAN)])? == expected);
    assert!(run_with(&[to(f32::INFINITY, 0.0), here, to(f32::NAN, 3.0), Gaze::Lost])? == expected);
    assert!(run_with(&[Gaze::Lost, here, Gaze::Lost, to(50.0, 9.0)])? != expected);
    for far in [to(-5000.0, 1e30), to(1e30, 1e30), to(-1e9, 20.0)] {
        let all = run_with(&[far, here, far, far])?;
        assert!(all.iter().all(|made| made.shown.pixels().iter().flatten().all(|v| v.is_finite())));
    }
    Some(
        "planned: a lost gaze, NaN and infinity are the last one known, first the middle, bit for bit; far ones finite"
            .into(),
    )
}

/// A fovea that has moved on.
pub fn saccade(make: Make<'_>) -> Option<String> {
    let settings = Settings { method: Method::Smr(Smr::default()), ..Settings::screen() };
    let picture = texture("saccade");
    let mut post = make(desc(settings))?;
    let gazing = |x: f32| at(4.0, picture.clone()).with(|view| view.facts.gaze = Gaze::At { px: [x, 24.0] });
    run(post.as_mut(), 0..4, |_| gazing(10.0));
    let (mut worst, mut count) = (0.0_f32, 0);
    let geometry = gazing(10.0).facts.geometry;
    for index in 4..124 {
        let shown = post.step(index, &gazing(54.0)).shown;
        for px in pixels(SIZE).filter(|px| geometry.eccentricity_deg(px.map(|v| v as f32), [10.0, 24.0]) < 2.0) {
            worst = (0..3).map(|i| (pixel(&shown, px)[i] / pixel(&picture, px)[i] - 1.0).abs()).fold(worst, f32::max);
            count += u32::from(index == 4);
        }
    }
    assert!(worst <= STORED && count > 5, "{worst} of {count}");
    // The planted error: no history.
    let fresh = make(desc(settings))?.step(124, &gazing(54.0)).shown;
    assert!(off(&fresh, &picture) > 0.1);
    Some(format!("planned: {count} px of the old fovea within {worst:.4} of the picture for 120 frames"))
}

/// Exposure that changes by x256 in one frame, declared and undeclared. Undeclared darkness is compared by constants
/// for white at 1: less than these see stays.
pub fn exposure(make: Make<'_>) -> Option<String> {
    const FRAMES: u64 = 64;
    let (mut declared_off, mut longest, mut too_bright) = (0.0_f32, 0, 0.0_f32);
    for settings in plans() {
        for ratio in [256.0, 1.0 / 256.0] {
            let [mut declared, mut undeclared] = [make(desc(settings))?, make(desc(settings))?];
            let picture = texture("exposure");
            for post in [&mut declared, &mut undeclared] {
                run(post.as_mut(), 0..SEEN, |_| at(4.0, picture.clone()));
            }
            let exposed = at(4.0, times(&picture, ratio));
            let made = declared.make(SEEN, &exposed, Exposure::Changed { ratio }, Reset::None);
            declared_off = declared_off.max(off(&made.shown, &exposed.color));
            let shown: Vec<_> = (SEEN..SEEN + FRAMES).map(|index| undeclared.step(index, &exposed).shown).collect();
            let offs: Vec<f32> = shown.iter().map(|shown| off(shown, &exposed.color)).collect();
            assert!(offs[0] > 1.0, "the planted error: undeclared, the first frame shows old light");
            if ratio > 1.0 {
                longest = longest.max(offs.iter().rposition(|&off| off > 0.1).map_or(0, |last| last + 1));
            } else {
                let last = shown.last()?.pixels().iter().flatten();
                let pairs = last.zip(exposed.color.pixels().iter().flatten());
                too_bright = pairs.map(|(shown, color)| shown - color).fold(too_bright, f32::max);
            }
        }
    }
    let is_right = declared_off <= 2.0 * STORED && longest <= 32 && too_bright < 0.02;
    assert!(is_right, "{declared_off}, {longest} frames, {too_bright}");
    Some(format!(
        "planned: declared, within {declared_off:.4} of the picture at once; undeclared, x256 after {longest} frames, \
         /256 up to {too_bright:.4} of white too bright after {FRAMES}"
    ))
}

/// Light that flickers for a while: what is left of it, as a share of the light of a flash, this many frames later.
fn left_of_flicker(make: Make<'_>, settings: Settings, [on, off]: [f32; 2], after: &[u64]) -> Option<Vec<f64>> {
    const FLASHES: u64 = 20;
    let mut post = make(desc(settings))?;
    let [lit, unlit] = [on, off].map(|light| at(4.0, Image::filled(SIZE, [light; 3])));
    let mut left = vec![];
    for index in 0..=FLASHES + after.last()? {
        let made = post.step(index, if index < FLASHES && index % 2 == 1 { &lit } else { &unlit });
        assert!(made.shown.pixels().iter().flatten().all(|v| (0.0..=1.01 * on.max(off)).contains(v)));
        if index >= FLASHES && after.contains(&(index - FLASHES)) {
            let sum: f64 = made.shown.pixels().iter().map(|c| f64::from((c[0] - off).abs())).sum();
            left.push(sum / f64::from(SIZE[0] * SIZE[1]) / f64::from((on - off).abs()));
        }
    }
    Some(left)
}

/// A light that is on in every other frame, and then stays off.
pub fn strobe(make: Make<'_>) -> Option<String> {
    let mut most = [0.0_f64; 3];
    for settings in plans() {
        for on in [1.0, 0.0625] {
            let left = left_of_flicker(make, settings, [on, 0.031_25], &[0, 16, 64])?;
            most = std::array::from_fn(|i| most[i].max(left[i]));
        }
    }
    assert!(most[0] > 0.05 && most[1] < 0.06 && most[2] < 0.015, "{most:?}");
    Some(format!("planned: {:.4}, {:.4} of the light left after 16, 64 frames", most[1], most[2]))
}

/// Black and white by turns, and then black.
pub fn black_and_white(make: Make<'_>) -> Option<String> {
    let mut most = [0.0_f64; 3];
    for settings in plans() {
        let left = left_of_flicker(make, settings, [1.0, 0.0], &[0, 16, 64])?;
        most = std::array::from_fn(|i| most[i].max(left[i]));
    }
    assert!(most[0] > 0.05 && most[1] < 0.015 && most[2] < 0.002, "{most:?}");
    Some(format!("planned: {:.4}, {:.4} of the white left after 16, 64 black frames", most[1], most[2]))
}

/// Resets, said once or twice, and at the start.
pub fn resets(make: Make<'_>) -> Option<String> {
    for settings in plans() {
        let view = |index: u64| at(4.0, texture(&format!("reset {}", index / 4)));
        let mut fresh = make(desc(settings))?;
        let expected: Vec<Made> = (SEEN..SEEN + 12).map(|index| fresh.step(index, &view(index))).collect();
        for times in 1..=2 {
            let mut used = make(desc(settings))?;
            run(used.as_mut(), 0..SEEN, view);
            for _ in 0..times {
                let made = used.make(SEEN, &view(SEEN), Exposure::Same, Reset::All);
                assert!(made == expected[0], "{settings:?}");
            }
            let rest: Vec<Made> = (SEEN + 1..SEEN + 12).map(|index| used.step(index, &view(index))).collect();
            assert!(rest == expected[1..], "{settings:?}, {times} resets");
        }
        // The planted error: no reset.
        let mut used = make(desc(settings))?;
        run(used.as_mut(), 0..SEEN, view);
        assert!(used.step(SEEN, &view(SEEN)) != expected[0]);
    }
    Some("planned: 12 frames after a reset, said once or twice, equal a fresh context, bit for bit".into())
}

/// Other sizes, and back.
pub fn other_sizes(make: Make<'_>) -> Option<String> {
    for settings in plans() {
        let view = |index: u64| at(4.0, texture(&format!("size {}", index / 4)));
        let mut fresh = make(desc(settings))?;
        let expected: Vec<Made> = (8..20).map(|index| fresh.step(index, &view(index))).collect();
        let mut resized = make(desc(settings))?;
        run(resized.as_mut(), 0..8, view);
        for size in [[3, 5], [64, 64], [1, 1], [65, 47], [53, 41]] {
            resized.resize(size);
            for index in 0..2 {
                let color = noise(size, "resized");
                let small = View::still(color, [20.0, 20.0]).with(|view| view.depth = Some(Image::filled(size, 4.0)));
                let shown = resized.step(index, &small).shown;
                assert!(shown.pixels().iter().flatten().all(|v| (0.0..=1.0).contains(v)), "{size:?}");
            }
        }
        resized.resize(SIZE);
        let rest: Vec<Made> = (8..20).map(|index| resized.step(index, &view(index))).collect();
        assert!(rest == expected, "{settings:?}");
    }
    Some("planned: 5 sizes, odd, even and 1x1, then back: 12 frames as of a fresh context, bit for bit".into())
}
