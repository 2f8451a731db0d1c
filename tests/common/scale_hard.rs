//! Scale of light, H106: laws that hold on either executor.

use crate::depth_hard::{Color, Made, Make, Steps};
use crate::images::{View, pixel, times};
use afterimage::internal::{
    ContextDesc, Foveation, FoveationKind, Method, MethodKind, Reset, Sampler, Settings, Smr, Wrs,
};
use afterimage::kernel::debug_view::PixelTrace;
use afterimage::{Exposure, Image};
use afterimage_testing::Draws;

/// The laws as tests of an executor. `$run_law` runs one, and returns what it measured.
macro_rules! scale_laws {
    ($side:ident, $run_law:ident) => {
        crate::laws::laws! { $side, $run_law,
            h106_colors_times_a_constant_are_shown_as_the_picture_times_it: "H106", times_a_constant;
            h106_radiance_with_its_exposure_is_shown_as_the_picture_in_its_unit: "H106", radiance;
            h106_a_shadow_that_moves_leaves_as_little_light_in_dark_frames: "H106", moving_shadow;
        }
    };
}
pub(crate) use scale_laws;

/// Frames of a clip.
const FRAMES: u64 = 8;

fn settings(filter: FoveationKind) -> Settings {
    let foveation = Foveation { kind: filter, rate_mid: 4, rate_far: 8, ..Foveation::default() };
    Settings { foveation, ..Settings::default() }
}

/// What a foveating renderer delivers of a picture. Of a frame shaded by quads, only the chosen ones are read.
fn delivered(settings: &Settings, full: &Color, gaze_px: [f32; 2], index: u64) -> View {
    let mut view = View::still(full.clone(), gaze_px);
    if matches!(settings.method, Method::Smr(Smr { antialias: true, .. })) {
        view.facts.jitter_px = Foveation::jitter_px(index);
    }
    view.noise = settings.noisy.then(|| full.map(|c| [0.05 * c[1], 2.0]));
    let foveation = &settings.foveation;
    match foveation.kind {
        FoveationKind::Quads => view,
        _ => View { color: View::delivered(foveation, full, gaze_px).color, ..view },
    }
}

/// A view with its light in another unit.
fn in_unit(view: &View, factor: f32) -> View {
    let noise = view.noise.as_ref().map(|noise| noise.map(|[error, samples]| [error * factor, samples]));
    View { color: times(&view.color, factor), noise, ..view.clone() }
}

/// The frames in units that may differ, with their exposures, through an executor without history.
fn of_unit(
    post: &mut dyn Steps,
    views: &[View],
    unit: impl Fn(usize) -> f32,
    exposure: impl Fn(usize) -> Exposure,
) -> Vec<Made> {
    post.forget();
    let views = views.iter().enumerate();
    views.map(|(i, view)| post.make(i as u64, &in_unit(view, unit(i)), exposure(i), Reset::None)).collect()
}

/// A rough picture with a new gaze, light and shadow in every frame. No channel is darker than 1/16 after resampling:
/// 2^-10 of it is a normal half.
fn clip(draws: &mut Draws, settings: &Settings, speed_px: [f32; 2]) -> Vec<View> {
    const SIZE: [u32; 2] = [64, 48];
    let wall = Image::from_fn(SIZE, |_| [0; 3].map(|_| 0.5 + 0.3 * draws.uniform()));
    let frame = |index| {
        let (light, edge) = (draws.range(0.8, 1.25), draws.range(0.0, 64.0));
        let gaze_px = SIZE.map(|side| draws.range(0.0, side as f32 - 1.0));
        let lit = |x: u32| if x as f32 > edge { light } else { 0.7 * light };
        let full = Image::from_fn(SIZE, |[x, y]| pixel(&wall, [x, y]).map(|v| v * lit(x)));
        let view = delivered(settings, &full, gaze_px, index);
        if speed_px == [0.0; 2] { view } else { view.moving(speed_px) }
    };
    (0..FRAMES).map(frame).collect()
}

/// Whether pictures and decisions are those of the frames without the factor, times the factor, bit for bit.
fn scales(plain: &[Made], scaled: &[Made], factor: f32) -> bool {
    let same = |(a, b): (&Made, &Made)| times(&a.shown, factor) == b.shown && a.trace == b.trace && a.stats == b.stats;
    plain.iter().zip(scaled).all(same)
}

/// Number of pixels of all frames.
fn count(made: &[Made], is: impl Fn(&PixelTrace) -> bool) -> usize {
    made.iter().flat_map(|m| m.trace.pixels()).filter(|t| is(t)).count()
}

/// Share of channels that differ by more than a part.
fn off(plain: &[Made], scaled: &[Made], factor: f32, part: f32) -> f64 {
    let channels = |made: &[Made]| made.iter().flat_map(|m| m.shown.pixels().to_vec()).flatten().collect::<Vec<_>>();
    let (a, b) = (channels(plain), channels(scaled));
    let differs = |&(a, b): &(&f32, &f32)| (b / factor - a).abs() > part * a;
    a.iter().zip(&b).filter(differs).count() as f64 / a.len() as f64
}

/// Colors times a constant give decisions as without it, and the picture times it.
pub fn times_a_constant(make: Make<'_>) -> Option<String> {
    let mut draws = Draws::new("scale of light");
    let mut worst = 0.0_f64;
    let moving = [0.3, -1.4];
    let moved = [FoveationKind::Mip, FoveationKind::Gauss, FoveationKind::Block].map(|filter| (filter, moving));
    for (filter, speed_px) in [(FoveationKind::Mip, [0.0; 2])].into_iter().chain(moved) {
        let settings = settings(filter);
        let views = clip(&mut draws, &settings, speed_px);
        let mut post = make(ContextDesc { settings, ..ContextDesc::new(views[0].color.size()) })?;
        let mut run = |factor: f32| of_unit(&mut *post, &views, |_| factor, |_| Exposure::Same);
        let plain = run(1.0);
        let (reused, gated) = (count(&plain, |t| t.history_share > 0.5), count(&plain, |t| t.agreement < 1.0));
        assert!(reused > 1000 && gated > 1000, "{filter:?}: {reused} and {gated}");
        for factor in [-10, 12].map(|exponent| 2.0_f32.powi(exponent)) {
            assert!(scales(&plain, &run(factor), factor), "{filter:?} {speed_px:?}: {factor}");
        }
        for factor in [1.0 / 700.0, 50.0] {
            let scaled = run(factor);
            worst = worst.max(off(&plain, &scaled, factor, 0.01));
            // The planted error: a factor that halves round.
            assert!(!scales(&plain, &scaled, factor), "{filter:?} {speed_px:?}: {factor}");
        }
    }
    assert!(worst < 0.01, "{worst}");
    Some(format!(
        "smr: mip, gauss and block, light and gaze new in each frame: bit for bit from 2^-10 to 2^12; by other factors \
         {:.3} % of the channels differ by 1 %",
        100.0 * worst
    ))
}

/// Settings of all methods and kinds of frames, and whether they compare colors by constants.
fn all_settings() -> Vec<(Settings, bool)> {
    let regions = Foveation { fovea_deg: 20.0, mid_deg: 40.0, rate_mid: 2, rate_far: 4, ..Foveation::default() };
    let quads = Foveation { fovea_deg: 20.0, mid_deg: 40.0, ..Foveation::quads() };
    let single = Foveation { single_pixels: true, ..quads };
    let of = |method, foveation| Settings { method, foveation, ..Settings::default() };
    let smr = |antialias| Method::Smr(Smr { antialias, ..Smr::default() });
    let wrs = |sampler| Method::Wrs(Wrs { sampler, ..Wrs::default() });
    let absolute = [
        of(smr(false), single),
        of(smr(true), single),
        of(smr(false), quads),
        of(smr(true), quads),
        Settings { foveation: regions, ..Settings::traced() },
        Settings { foveation: single, ..Settings::traced() },
        of(wrs(Sampler::AChao), regions),
        of(wrs(Sampler::AEs), regions),
        Settings { foveation: regions, ..Settings::weighted() },
        Settings { foveation: single, ..Settings::weighted() },
        Settings { foveation: regions, ..Settings::paper() },
    ];
    let others = [of(smr(false), regions), of(Method::Taa, quads), of(Method::Taau, single), of(Method::None, single)];
    absolute.map(|settings| (settings, true)).into_iter().chain(others.map(|settings| (settings, false))).collect()
}

/// Radiance with its exposure is decided on as the exposed colors are, and shown in its own unit.
pub fn radiance(make: Make<'_>) -> Option<String> {
    let mut draws = Draws::new("exposure of a scene");
    let (mut worst, all) = (0.0_f64, all_settings());
    for (settings, is_absolute) in &all {
        let views = clip(&mut draws, settings, [0.3, -1.4]);
        let mut post = make(ContextDesc { settings: *settings, ..ContextDesc::new(views[0].color.size()) })?;
        let same = |_: usize| Exposure::Same;
        let plain = of_unit(&mut *post, &views, |_| 1.0, same);
        let reused = count(&plain, |t| t.history_share > 0.5);
        assert!(reused > 1000 || settings.method.kind() == MethodKind::None, "{settings:?}: {reused}");
        let stored = |a: &[Made], b: &[Made]| a.iter().zip(b).all(|(a, b)| a.words == b.words);
        for exponent in [-30, -3, 24] {
            let unit = 2.0_f32.powi(exponent);
            let scaled = of_unit(&mut *post, &views, |_| unit, |_| Exposure::Scene { exposure: 1.0 / unit });
            assert!(scales(&plain, &scaled, unit) && stored(&plain, &scaled), "{settings:?}: 2^{exponent}");
        }
        // An exposure that changes: as if the renderer multiplied its colors, and said so.
        let exposure = |i: usize| 2.0_f32.powi([0, -1, -1, 2, 5, -3][i % 6]);
        let changed = |i: usize| Exposure::Changed { ratio: if i == 0 { 1.0 } else { exposure(i) / exposure(i - 1) } };
        let by_hand = of_unit(&mut *post, &views, exposure, changed);
        let said = |i| if exposure(i) == 1.0 { Exposure::Same } else { Exposure::Scene { exposure: exposure(i) } };
        let given = of_unit(&mut *post, &views, |_| 1.0, said);
        let is_same = |i: usize| scales(&given[i..=i], &by_hand[i..=i], exposure(i));
        assert!((0..views.len()).all(is_same) && stored(&by_hand, &given), "{settings:?}: exposures that change");
        let odd = of_unit(&mut *post, &views, |_| 700.0, |_| Exposure::Scene { exposure: 1.0 / 700.0 });
        worst = worst.max(off(&plain, &odd, 700.0, 0.001));
        // The planted error: no exposure.
        let dark = 2.0_f32.powi(-10);
        assert!(!is_absolute || !scales(&plain, &of_unit(&mut *post, &views, |_| dark, same), dark), "{settings:?}");
    }
    assert!(worst < 0.001, "{worst}");
    Some(format!(
        "radiance with its exposure, {} settings of all methods, on whole frames, single pixels and quads: at 2^-30 to \
         2^24, and with exposures that change, pictures, decisions and history as of exposed colors, bit for bit; at \
         1/700 {:.3} % of the channels differ by 0.1 %",
        all.len(),
        100.0 * worst
    ))
}

/// Light left behind the edge of a shadow that moves by 2 px a frame without vectors, as a share of the step of light.
fn light_left(make: Make<'_>, settings: Settings, exponent: i32, exposure: Exposure) -> Option<f64> {
    let (size, factor) = ([160, 40], 2.0_f32.powi(exponent));
    let mut post = make(ContextDesc { settings, ..ContextDesc::new(size) })?;
    let (mut left, mut step) = (0.0, 0.0);
    for index in 0..56_u64 {
        // The eye sees the wall in light, and rests while the shadow comes.
        let gaze_px = if index < 16 { [10.0 * index as f32, 20.0] } else { [10.0, 20.0] };
        let edge = 60 + 2 * index.saturating_sub(16) as u32;
        let light = |x: u32| if x > 50 && x < edge { 0.1 } else { 0.4 };
        let full = Image::from_fn(size, |[x, y]| [light(x) * (0.75 + 0.25 * ((x + y) % 3) as f32); 3]);
        let view = in_unit(&delivered(&settings, &full, gaze_px, index), factor);
        let shown = post.make(index, &view, exposure, Reset::None).shown;
        if index >= 30 {
            for (x, y) in (edge - 10..edge - 4).flat_map(|x| (0..40).map(move |y| (x as usize, y))) {
                left += f64::from(shown.at(x, y)[1] / factor - full.at(x, y)[1]);
                step += f64::from(full.at(x, y)[1]) * 3.0;
            }
        }
    }
    Some(left / step)
}

/// The same in a bright frame and in dark ones.
pub fn moving_shadow(make: Make<'_>) -> Option<String> {
    let left = |settings: Settings, exponents: &[i32]| -> Option<Vec<_>> {
        exponents.iter().map(|&exponent| light_left(make, settings, exponent, Exposure::Same)).collect()
    };
    let smr = left(settings(FoveationKind::Mip), &[4, -10])?;
    assert!(smr.iter().all(|&l| l < 0.06), "{smr:?}");
    // The planted error: below the smallest normal half the gate does not follow light.
    let absolute = light_left(make, settings(FoveationKind::Mip), -20, Exposure::Same)?;
    assert!(absolute > 0.3, "{absolute}");
    // Gates that are absolute: they hold in this range, and below it with an exposure.
    let gated = Settings { foveation: settings(FoveationKind::Mip).foveation, ..Settings::weighted() };
    let weighted = left(gated, &[0, -2, -4])?;
    assert!(weighted[0] < 0.1 && weighted[1] < 0.1, "{weighted:?}");
    let planned = left(settings(FoveationKind::Quads), &[0, -6, -10])?;
    assert!((planned[0] - planned[1]).abs() < 0.05, "{planned:?}");
    let exposure = Exposure::Scene { exposure: 1024.0 };
    let exposed = |settings: Settings| light_left(make, settings, -10, exposure);
    assert_eq!([exposed(gated)?, exposed(settings(FoveationKind::Quads))?], [weighted[0], planned[0]]);
    // The planted error: no exposure.
    assert!(weighted[2] > 0.5 && planned[2] > planned[0] + 0.2, "{weighted:?}, {planned:?}");
    let percent = |left: &[f64]| left.iter().map(|l| format!("{:.1}", 100.0 * l)).collect::<Vec<_>>().join(", ");
    Some(format!(
        "percent of the light left behind the edge: smr at 2^4 to 2^-10 of the light {:.1}, at 2^-20 {:.0}; weighted \
         wrs at 1, 1/4, 1/16 {}; smr on quads at 1, 2^-6, 2^-10 {}; both at 2^-10 with its exposure as at 1",
        100.0 * smr.iter().copied().fold(0.0, f64::max),
        100.0 * absolute,
        percent(&weighted),
        percent(&planned)
    ))
}
