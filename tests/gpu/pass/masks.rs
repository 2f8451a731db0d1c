//! Masks of planned frames that have single pixels, or that the renderer chose itself: both executors bit for bit,
//! whole and at half the size, with noise or without it, and planted errors.

use super::quads::{reset_of, settings, views};
use super::sparse::{SIZE, desc};
use super::*;
use crate::images::{Images, pixel, planned};

const FRAMES: u64 = 10;
/// Kinds of own masks, each of which lasts for some frames.
const KINDS: u64 = 6;
const EACH: u64 = 2;

/// With single pixels outside the fovea, in blocks of these sides.
fn single(antialias: bool, [rate_mid, rate_far]: [u32; 2], budget: f32) -> Settings {
    let settings = settings(antialias);
    let foveation = Foveation { rate_mid, rate_far, budget, single_pixels: true, ..settings.foveation };
    Settings { foveation, ..settings }
}

fn of_method(method: MethodKind, settings: Settings) -> Settings {
    Settings { method: method.into(), ..settings }
}

fn noisy_of(method: Method, settings: Settings) -> Settings {
    Settings { method, noisy: true, ..settings }
}

/// The gliding views, with noise if the settings have it.
fn seen(index: u64, settings: &Settings) -> [View; 2] {
    let mut draws = Draws::new(&format!("noise of masks {index}"));
    views(index, settings).map(|view| {
        let noise = Image::from_fn(SIZE, |[x, _]| {
            let error = [0.0, 0.02, 0.2][(x / 11) as usize % 3] * draws.uniform();
            [if draws.uniform() < 0.02 { f32::NAN } else { error }, 1.0 + (draws.bits() % 4) as f32]
        });
        View { noise: settings.noisy.then_some(noise), ..view }
    })
}

/// A mask of the renderer's own in frame `index`. Pixels that are not chosen are NaN, 0 or just not above 0.5.
fn own_mask(index: u64, v: u64, size: [u32; 2]) -> Image<f32> {
    let mut draws = Draws::new(&format!("own mask {index} {v}"));
    let place = Foveation::quarter_place_px(index + v);
    Image::from_fn(size, |[x, y]| {
        let is_chosen = match index / EACH % KINDS {
            0 => (u64::from(x + y) + index).is_multiple_of(2),
            1 => [x % 2, y % 2] == place,
            2 => (u64::from(y) + index).is_multiple_of(3),
            3 => draws.uniform() < 0.4 && !(20..45).contains(&x),
            4 => true,
            _ => false,
        };
        let no = [f32::NAN, 0.0, 0.5, -1.0][draws.bits() as usize % 4];
        if is_chosen { 0.51 + draws.uniform() } else { no }
    })
}

/// At most one pixel of each quad, in another place in each; none of some quads.
fn one_of_each(index: u64, v: u64, size: [u32; 2]) -> Image<f32> {
    let mut draws = Draws::new(&format!("one of each {index} {v}"));
    let places = Image::from_fn(size.map(|side| side.div_ceil(2)), |_| draws.bits() % 5);
    Image::from_fn(size, |[x, y]| {
        let place = pixel(&places, [x / 2, y / 2]);
        if place == x % 2 + 2 * (y % 2) { 1.0 } else { 0.0 }
    })
}

fn with_own(index: u64, settings: &Settings) -> [View; 2] {
    let mut v = 0;
    seen(index, settings).map(|view| {
        v += 1;
        View { mask: Some(own_mask(index, v, SIZE)), ..view }
    })
}

fn pixels_shaded(made: &Made) -> u32 {
    made.quads.iter().map(|mask| mask.count_ones()).sum()
}

/// Frames of one rig, in regions of textures or not. Returns the pixels that are shaded, frame by frame.
fn run_both(settings: Settings, frames: u64, views: impl Fn(u64, &Settings) -> [View; 2]) -> Option<Vec<u32>> {
    let mut rig = Rig::new(desc(), settings)?;
    let counts = (0..frames).map(|index| {
        let reset = reset_of(index, &mut rig);
        pixels_shaded(&rig.both(index, reset, &views(index, &settings)).0)
    });
    let counts = counts.collect();
    println!("{settings:?}: {counts:?} pixels shaded");
    Some(counts)
}

#[test]
fn single_pixels_are_bit_equal_on_both_executors() {
    let of_smr = [
        single(false, [2, 2], 0.0),
        single(true, [2, 4], 0.1),
        single(false, [4, 8], 0.1),
        single(true, [8, 8], 0.02),
        single(true, [4, 8], 0.0),
    ];
    let others = [MethodKind::None, MethodKind::Taau, MethodKind::Wrs];
    let others = others.map(|method| of_method(method, single(false, [4, 8], 0.1)));
    for settings in of_smr.into_iter().chain(others) {
        let Some(counts) = run_both(settings, FRAMES, seen) else { return };
        assert!(counts.iter().all(|&n| n > 100 && n < 3600));
    }
}

#[test]
fn own_masks_are_bit_equal_on_both_executors() {
    let others = [MethodKind::None, MethodKind::Taau, MethodKind::Wrs].map(|method| of_method(method, settings(false)));
    for settings in [settings(false), settings(true)].into_iter().chain(others) {
        let Some(counts) = run_both(settings, EACH * KINDS, with_own) else { return };
        let all = SIZE[0] * SIZE[1] * 2;
        assert!(counts.contains(&all) && counts.contains(&0), "everything, and nothing");
    }
}

#[test]
fn noisy_pixels_are_bit_equal_on_both_executors() {
    let smr = Settings::traced().method;
    let all = [
        noisy_of(smr, single(false, [2, 4], 0.1)),
        noisy_of(smr, single(false, [4, 8], 0.1)),
        noisy_of(smr, settings(false)),
        noisy_of(Method::Wrs(Wrs::default()), single(false, [4, 8], 0.1)),
    ];
    for settings in all {
        let Some(counts) = run_both(settings, FRAMES, seen) else { return };
        assert!(counts.iter().all(|&n| n > 100 && n < 3600));
    }
    run_both(noisy_of(smr, settings(false)), EACH * KINDS, with_own);
}

/// Sizes of an odd number of pixels, of a single one, too.
#[test]
fn odd_sizes_are_bit_equal_on_both_executors() {
    for (i, size) in [[37, 23], [1, 1], [3, 2], [2, 5]].into_iter().enumerate() {
        for settings in [single(true, [2, 4], 0.2), single(false, [4, 4], 0.0), settings(true)] {
            let desc = ContextDesc::new(size);
            let Some(mut rig) = Rig::new(desc, settings) else { return };
            for index in 0..8 {
                let view = noise_view(&format!("odd {i} {index}"), &desc);
                let own = (index >= 4).then(|| own_mask(index, 0, size));
                rig.both(index, Reset::None, &[View { mask: own, ..view }]);
            }
        }
    }
}

/// The mask of a planned frame, view by view.
fn mask_of(rig: &Rig, index: u64, reset: Reset, views: &[View]) -> Vec<Image<bool>> {
    let images = Images::of(views);
    planned(&mut rig.cpu.clone(), &afterimage::cpu::Frame { reset, exposure: rig.exposure, ..images.frame(index) })
}

/// Processes frames at half the size and whole: the results are equal, and those of both executors.
fn at_half_and_whole(settings: Settings, views: impl Fn(u64, &Settings) -> [View; 2]) -> Option<()> {
    let [mut whole, mut half] = Rig::each([(desc(), settings); 2])?;
    for index in 0..FRAMES {
        let reset = reset_of(index, &mut whole);
        reset_of(index + 1, &mut half);
        half.exposure = whole.exposure;
        let views = views(index, &settings);
        let (expected, _) = whole.both(index, reset, &views);
        let masks = mask_of(&half, index, reset, &views);
        let halves: Vec<View> = views.into_iter().zip(&masks).map(|(view, mask)| view.at_half(mask)).collect();
        let (made, _) = half.both(index, reset, &halves);
        assert_eq!(made, expected, "{settings:?}, frame {index}");
    }
    Some(())
}

#[test]
fn colors_of_half_the_size_are_bit_equal_on_both_executors() {
    let quarter = |settings: Settings| Settings { foveation: Foveation::quarter(), ..settings };
    let own = |index: u64, settings: &Settings| {
        let mut v = 0;
        seen(index, settings).map(|view| {
            v += 1;
            View { mask: Some(one_of_each(index, v, SIZE)), ..view }
        })
    };
    let noisy = noisy_of(Settings::traced().method, settings(false));
    for settings in [settings(false), settings(true), noisy] {
        if at_half_and_whole(quarter(settings), seen).is_none() {
            return;
        }
        at_half_and_whole(settings, own);
    }
    for method in [MethodKind::None, MethodKind::Taau, MethodKind::Wrs] {
        at_half_and_whole(of_method(method, settings(false)), own);
    }
}

/// Frames after a cut at half the size, and whole ones in between: what a rasteriser delivers.
#[test]
fn a_quarter_after_a_cut_may_be_given_at_half_the_size() {
    for settings in [settings(false), settings(true)] {
        let Some(mut rig) = Rig::new(desc(), settings) else { return };
        for index in 0..FRAMES {
            let reset = if index % 4 == 2 { Reset::All } else { Reset::None };
            let mut views = seen(index, &settings).to_vec();
            let is_quarter = index == 0 || index % 4 == 2;
            if is_quarter {
                let masks = mask_of(&rig, index, reset, &views);
                views = views.into_iter().zip(&masks).map(|(view, mask)| view.at_half(mask)).collect();
            }
            let (made, _) = rig.both(index, reset, &views);
            assert_eq!(made.quads.iter().all(|mask| *mask > 0), is_quarter, "frame {index}");
        }
    }
}

const PASSES: [&str; 5] = ["quad_key_pass", "quad_given_pass", "quad_observe_pass", "quad_rectify_pass", "quad_pass"];

#[test]
fn wrong_single_pixels_are_caught() {
    let settings = single(true, [4, 8], 0.1);
    let planted = [
        ("select(probed, even_place(region_now), even)", "even_place(region_now)"),
        ("pixels = 1u <<", "pixels = WHOLE; // "),
        ("select(frame.pattern_px.zw, frame.pattern_px.xy,", "select(frame.pattern_px.xy, frame.pattern_px.zw,"),
        ("let quadrant = quadrant_of(offset.x, offset.y);", "let quadrant = 0u;"),
        ("return nearest_px(mask, quad, px);", "return 2u * quad;"),
        ("15u & ~shaded", "0u"),
        ("select(1u << (i & 3u), shaded, is_single)", "1u << (i & 3u)"),
        ("select(4u, 5u, is_own)", "4u"),
    ];
    rig::all_caught_in(PASSES, desc(), settings, FRAMES, &planted, |index, rig| {
        (reset_of(index, rig), seen(index, &settings).to_vec())
    });
}

#[test]
fn wrong_masks_are_caught() {
    let settings = settings(false);
    let planted = [
        (".x > 0.5;", ".x >= 0.5;"),
        ("select(all_bits & inside_bits, WHOLE, all_bits == WHOLE)", "all_bits & inside_bits"),
        ("select(all_bits & inside_bits, WHOLE, all_bits == WHOLE)", "all_bits"),
        ("let at = texel_of(min(px, frame.size - 1u), view, MASK_IN);", "let at = min(px, frame.size - 1u);"),
        ("key_word(0u, IN_PERIPHERY,", "key_word(0u, IN_MIDDLE,"),
        ("level == 0u || !is_shaded(mask_word, px)", "level == 0u"),
    ];
    rig::all_caught_in(PASSES, desc(), settings, EACH * KINDS, &planted, |index, rig| {
        (reset_of(index, rig), with_own(index, &settings).to_vec())
    });
}

#[test]
fn wrong_noise_of_pixels_is_caught() {
    let settings = noisy_of(Settings::traced().method, single(false, [2, 4], 0.1));
    let planted = [
        ("candidate.noise = noise_at(px, view);", ""),
        ("candidate.noise = mean_noise(noises);", ""),
        ("candidate.around = mean_around(around, px, view, codes);", ""),
        ("candidate.color = borrowed.color;", ""),
        ("candidate.around, past_noise.samples)", "candidate.around, 0.0)"),
        ("noisy_share(n.samples, px2)", "noisy_share(1.0, px2)"),
        ("(around.w - n.variance) * share", "0.0"),
        ("code_of(around.quads, tap - 4u)", "code_of(around.quads, (tap - 4u) & 3u)"),
        ("select(outside, NOISY, region_now == IN_FOVEA)", "select(outside, 0u, region_now == IN_FOVEA)"),
        ("share_in_block(needs, i) + noise_needs[i]", "share_in_block(needs, i)"),
        ("past.variance = mean_noise(noises).variance;", ""),
        ("known_samples(past.samples)", "1u"),
        ("(!even || NOISY != 0u)", "!even"),
        ("atomicAdd(&state.further[key_of_path], 1u);", ""),
        ("atomicLoad(&state.further[key]), budget_quads.y != 0u)", "0u, budget_quads.y != 0u)"),
        ("word >> 27u, is_even,", "1u, is_even,"),
        ("confidence = noisy_lod_confidence(", "confidence = 0.0 * noisy_lod_confidence("),
    ];
    let passes = [&PASSES[..], &["quad_threshold_pass", "quad_mask_pass"]].concat();
    let passes: [&str; 7] = passes.try_into().unwrap();
    rig::all_caught_in(passes, desc(), settings, FRAMES, &planted, |index, rig| {
        (reset_of(index, rig), seen(index, &settings).to_vec())
    });
}

/// A color of half the size that is read as if it were whole, in the pass of smr and in the one that fills.
#[test]
fn a_wrong_size_of_colors_is_caught() {
    let own = |index: u64, settings: &Settings| {
        seen(index, settings).map(|view| {
            let mask = one_of_each(index, 0, SIZE);
            let shaded = mask.map(|chosen| chosen > 0.5);
            View { mask: Some(mask), ..view.at_half(&shaded) }
        })
    };
    let planted = [
        ("frame.has_half != 0u", "false"),
        ("texel_of(px >> vec2u(1u), view, HALF_IN)", "texel_of(px, view, HALF_IN)"),
        ("(mask_at(px, view) & 15u) != WHOLE", "(mask_at(px, view) & 15u) == WHOLE"),
    ];
    for settings in [settings(true), of_method(MethodKind::Taau, settings(false))] {
        let passes = ["quad_observe_pass", "quad_rectify_pass", "quad_pass", "quad_fill_pass"];
        rig::all_caught_in(passes, desc(), settings, FRAMES, &planted, |index, rig| {
            (reset_of(index, rig), own(index, &settings).to_vec())
        });
    }
}
