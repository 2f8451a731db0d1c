//! Feedback of relighting, H51 and H73: laws that hold on either executor.

use crate::depth_hard::{Color, Make, Steps};
use crate::images::{View, off, peak, pixel, times};
use afterimage::Image;
use afterimage::internal::{ContextDesc, Foveation, FoveationKind, Method, Settings, Smr};
use afterimage::kernel::surface::Surface;
use afterimage_testing::Draws;

/// The laws as tests of an executor. `$run_law` runs one, and returns what it measured.
macro_rules! feedback_laws {
    ($side:ident, $run_law:ident) => {
        crate::laws::laws! { $side, $run_law,
            h51_a_still_picture_under_a_steady_gaze_is_shown_as_it_came: "H51", steady_gaze;
            h51_what_gains_did_ends_when_pictures_and_gaze_rest: "H51", rest;
            h73_a_light_of_one_frame_leaves_no_mark: "H73", flash;
            h73_a_light_of_one_frame_leaves_no_mark_on_planned_frames: "H73", planned_flash;
        }
    };
}
pub(crate) use feedback_laws;

const SIZE: [u32; 2] = [96, 64];
const RATES: [[u32; 2]; 3] = [[2, 4], [4, 8], [8, 16]];
/// Storage rounds colors by up to 2^-10.
const ROUNDING: f32 = 1.0 / 1024.0;

fn settings(filter: FoveationKind, [rate_mid, rate_far]: [u32; 2]) -> Settings {
    Settings {
        foveation: Foveation { kind: filter, rate_mid, rate_far, ..Foveation::default() },
        ..Settings::default()
    }
}

fn executor(make: Make<'_>, settings: Settings) -> Option<Box<dyn Steps>> {
    make(ContextDesc { settings, ..ContextDesc::new(SIZE) })
}

fn anywhere(draws: &mut Draws) -> [f32; 2] {
    SIZE.map(|side| draws.range(0.0, side as f32 - 1.0))
}

/// A rough wall with lamps, some of them brighter than it by far.
fn picture(draws: &mut Draws) -> Color {
    let (floor, rough) = (draws.range(0.02, 0.4), draws.range(0.0, 0.4));
    let lamps: Vec<_> =
        (0..6).map(|_| (anywhere(draws), draws.range(0.5, 6.0), draws.range(0.0, 6.0).exp2())).collect();
    Image::from_fn(SIZE, |[x, y]| {
        let lit = |&&([u, v], radius, _): &&([f32; 2], f32, f32)| (x as f32 - u).hypot(y as f32 - v) < radius;
        let light = lamps.iter().find(lit).map_or(1.0, |lamp| lamp.2);
        [0; 3].map(|_| light * (floor + rough * draws.uniform()))
    })
}

/// The same frame again and again: what is shown differs from it by the rounding of storage alone, and what is stored
/// never changes.
pub fn steady_gaze(make: Make<'_>) -> Option<String> {
    let mut draws = Draws::new("steady gaze");
    let mut worst = 0.0_f32;
    for (filter, rates) in [FoveationKind::Mip, FoveationKind::Gauss, FoveationKind::Block].into_iter().zip(RATES) {
        let settings = settings(filter, rates);
        for _ in 0..2 {
            let view = View::delivered(&settings.foveation, &picture(&mut draws), anywhere(&mut draws));
            let mut post = executor(make, settings)?;
            let stored = post.step(0, &view).words;
            for index in 1..8 {
                let made = post.step(index, &view);
                worst = worst.max(off(&made.shown, &view.color));
                assert!(made.words == stored, "{filter:?} {rates:?}, frame {index}: what is stored changed");
            }
        }
    }
    assert!(worst <= ROUNDING, "{worst}");
    // The planted error: a first frame that claims to be finer than it is. Its blur counts as a change of light.
    let settings = settings(FoveationKind::Mip, [4, 8]);
    let full = Image::from_fn(SIZE, |[x, y]| [if x % 24 < 4 && y % 24 < 4 { 8.0 } else { 0.25 }; 3]);
    let coarse =
        View { lod: Some(Image::filled(SIZE, 3.0)), ..View::delivered(&settings.foveation, &full, [-4000.0, 0.0]) };
    let claimed = View { lod: Some(Image::filled(SIZE, 2.5)), ..coarse.clone() };
    let mut post = executor(make, settings)?;
    post.step(0, &claimed);
    let drifted = off(&post.step(1, &coarse).shown, &coarse.color);
    assert!(drifted > 0.05, "{drifted}");
    Some(format!(
        "smr: mip, gauss and block, each at another rate, with lamps up to 64 times brighter: off by {worst:.5}, rounding"
    ))
}

/// Lights and gaze that change in every frame, and then rest. Each gain costs a stored step of detail at least, so that
/// a sample gets few of them: a color that does not move towards the candidate becomes coarser.
pub fn rest(make: Make<'_>) -> Option<String> {
    let mut draws = Draws::new("gains rest");
    let (mut most, mut moved) = (0.0_f32, [0; 2]);
    for (filter, rates) in [FoveationKind::Mip, FoveationKind::Gauss, FoveationKind::Mip].into_iter().zip(RATES) {
        let settings = settings(filter, rates);
        let full = picture(&mut draws);
        let mut post = executor(make, settings)?;
        let mut brightest = 0.0_f32;
        for index in 0..30 {
            let light = draws.range(-2.0, 2.0).exp2();
            let lit = times(&full, light);
            let view = View::delivered(&settings.foveation, &lit, anywhere(&mut draws));
            brightest = brightest.max(peak(&lit));
            most = most.max(peak(&post.step(index, &view).shown) / brightest);
        }
        let view = View::delivered(&settings.foveation, &full, anywhere(&mut draws));
        let mut before = post.step(30, &view).surfaces();
        for index in 31..50 {
            let surfaces = post.step(index, &view).surfaces();
            let [toward, away] = moved_colors(&before, &surfaces, &view.color);
            moved = [moved[0] + toward, moved[1] + away];
            before = surfaces;
        }
    }
    // A sample pays a level of detail for each doubling, and has four at these rates.
    assert!(most < 16.0, "{most}");
    let [toward, away] = moved;
    assert!(toward > 1000 && away > 0, "{moved:?}");
    Some(format!(
        "smr: lights of 1/4 to 4 and a new gaze a frame show at the most {most:.2} of the brightest input; at rest \
         {toward} stored colors move towards the candidate, {away} away from it, at a stored step each"
    ))
}

/// Number of stored colors that moved towards the candidate, and away from it. No sample becomes finer, and one that
/// moves away becomes coarser by a stored step at least.
fn moved_colors(before: &[Surface], after: &[Surface], candidate: &Color) -> [usize; 2] {
    let mut moved = [0; 2];
    for ((old, new), c) in before.iter().zip(after).zip(candidate.pixels()) {
        assert!(new.lod >= old.lod, "{old:?} to {new:?}");
        let is_away = (0..3).any(|i| (new.color[i] - c[i]).abs() > (old.color[i] - c[i]).abs());
        assert!(!is_away || new.lod > old.lod + 0.1, "{old:?} to {new:?}, candidate {c:?}");
        moved[usize::from(is_away)] += usize::from(old.color != new.color);
    }
    moved
}

/// A wall, and the wall with a lamp.
fn wall_and_lamp(draws: &mut Draws, light: f32) -> [Color; 2] {
    let wall = Image::from_fn(SIZE, |_| [0.2 + 0.2 * draws.uniform(); 3]);
    let lamp = |x: u32, y: u32| (60..68).contains(&x) && (30..38).contains(&y);
    let lit = Image::from_fn(SIZE, |[x, y]| if lamp(x, y) { [light; 3] } else { pixel(&wall, [x, y]) });
    [wall, lit]
}

fn unlit(settings: Settings) -> Settings {
    Settings { method: Method::Smr(Smr { relight: false, ..Smr::default() }), ..settings }
}

/// A lamp of one frame under a steady gaze: relighting adds nothing to it, and little of it is left.
pub fn flash(make: Make<'_>) -> Option<String> {
    let mut worst = 0;
    let mut draws = Draws::new("flash");
    let lights = [(FoveationKind::Mip, 1.0), (FoveationKind::Gauss, 4.0), (FoveationKind::Mip, 32.0)];
    for ((filter, light), rates) in lights.into_iter().zip(RATES) {
        let relit = settings(filter, rates);
        let [wall, lit] = wall_and_lamp(&mut draws, light);
        // The planted error: history of the lamp's place is finer, because the eye was there. It is relit.
        for (first, steady) in [([20.0, 20.0], true), ([64.0, 34.0], false)] {
            let before = View::delivered(&relit.foveation, &wall, first);
            let [plain, lit] = [&wall, &lit].map(|c| View::delivered(&relit.foveation, c, [20.0, 20.0]));
            let mut posts = [executor(make, relit)?, executor(make, unlit(relit))?];
            let mut same = true;
            for index in 0..25 {
                let view = match index {
                    0..10 => &before,
                    20 => &lit,
                    _ => &plain,
                };
                let [relit, unlit] = posts.each_mut().map(|post| post.step(index, view).shown);
                same &= relit == unlit;
                if steady && index >= 20 {
                    let marks = marks(&relit, &plain.color);
                    assert!(index > 20 || marks > 40, "the lamp itself shows in {marks} pixels");
                    worst = if index == 24 { worst.max(marks) } else { worst };
                }
            }
            assert_eq!(same, steady, "{filter:?} {rates:?}");
        }
    }
    assert!(worst <= 2, "{worst}");
    Some(format!(
        "smr, steady gaze: a lamp of one frame, up to 100 times the wall, leaves {worst} px off by 0.05 after 4 frames"
    ))
}

/// The same on planned frames: with relighting no more is left of the lamp than without.
pub fn planned_flash(make: Make<'_>) -> Option<String> {
    let mut draws = Draws::new("planned flash");
    let mut most = i64::MIN;
    let quads = Settings { foveation: Foveation::quads(), ..Settings::default() };
    let [fine, coarse] = [[2, 2], [4, 8]].map(|[rate_mid, rate_far]| {
        let foveation = Foveation { rate_mid, rate_far, single_pixels: true, ..Foveation::quads() };
        Settings { foveation, ..Settings::default() }
    });
    let left = |settings: Settings, [wall, lit]: &[Color; 2], until: u64| -> Option<i64> {
        let mut post = executor(make, settings)?;
        let mut shown = wall.clone();
        for index in 0..79 {
            let full = if (74..until).contains(&index) { lit } else { wall };
            shown = post.step(index, &View::still(full.clone(), [20.0, 20.0])).shown;
        }
        Some(marks(&shown, wall) as i64)
    };
    for (relit, light) in [(fine, 1.0), (coarse, 4.0), (quads, 4.0)] {
        let frames = wall_and_lamp(&mut draws, light);
        let without = left(unlit(relit), &frames, 75)?;
        most = most.max(left(relit, &frames, 75)? - without);
        // The planted error: a lamp that stays on.
        assert!(light > 1.0 || left(relit, &frames, 79)? - without > 8);
    }
    assert!(most <= 8, "{most}");
    Some(format!(
        "planned frames, by single pixels and by quads, steady gaze: a lamp of one frame leaves {most} px more off by 0.05 after 4 \
         frames with relighting than without"
    ))
}

/// Number of pixels that are off by 0.05.
fn marks(image: &Color, expected: &Color) -> usize {
    let off = |(a, b): &(&[f32; 3], &[f32; 3])| (0..3).any(|i| (a[i] - b[i]).abs() > 0.05);
    image.pixels().iter().zip(expected.pixels()).filter(off).count()
}
