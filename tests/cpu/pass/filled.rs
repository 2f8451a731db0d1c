//! Planned frames, filled for the methods that read whole frames.

use super::*;
use crate::mask_hard::Mask;
use afterimage::internal::Foveation;

const METHODS: [MethodKind; 5] =
    [MethodKind::None, MethodKind::Taa, MethodKind::Wrs, MethodKind::Smr, MethodKind::Taau];

fn settings(method: MethodKind) -> Settings {
    Settings { method: method.into(), foveation: Foveation::quads(), ..Settings::paper() }
}

fn masked(color: Color, mask: &Mask) -> View {
    View { mask: Some(mask.map(|chosen| if chosen { 1.0 } else { 0.0 })), ..still(color) }
}

/// First frame of a context with the pixels of a mask.
fn first(method: MethodKind, color: &Color, mask: &Mask) -> (Color, FrameStats) {
    let made = context(settings(method)).step(0, &masked(color.clone(), mask));
    (made.shown, made.stats)
}

/// One pixel of each block of 8x8, and of 2x2 in a rectangle.
fn blocks(offset: [u32; 2]) -> Mask {
    Image::from_fn(SIZE, |px| {
        let step = if (16..40).contains(&px[0]) && (8..30).contains(&px[1]) { 2 } else { 8 };
        px.map(|v| v % step) == offset.map(|v| v % step)
    })
}

#[test]
fn samples_are_shown_unchanged_and_nothing_else_is_read() {
    let full = noise(SIZE, "samples");
    for method in METHODS {
        for offset in [[0, 0], [3, 6], [7, 7]] {
            let mask = blocks(offset);
            let holed = Image::from_fn(SIZE, |px| if pixel(&mask, px) { pixel(&full, px) } else { [f32::NAN; 3] });
            let (out, stats) = first(method, &holed, &mask);
            assert_eq!((stats.nonfinite, stats.pixels), (0, 64 * 48), "{method:?}");
            assert_eq!(out, first(method, &full, &mask).0, "{method:?}");
            assert!(pixels(SIZE).filter(|&px| pixel(&mask, px)).all(|px| pixel(&out, px) == pixel(&full, px)));
        }
    }
}

#[test]
fn a_constant_is_shown_everywhere() {
    let color = [0.25, 0.5, 0.75];
    for offset in [[0, 0], [5, 2]] {
        let (out, _) = first(MethodKind::None, &Image::filled(SIZE, color), &blocks(offset));
        let off = |c: &[f32; 3]| (0..3).fold(0.0, |m: f32, i| m.max((c[i] - color[i]).abs()));
        assert!(out.pixels().iter().map(off).fold(0.0, f32::max) < 1e-6);
    }
}

#[test]
fn samples_that_are_not_finite_are_left_out() {
    let far = Image::from_fn(SIZE, |px| px.map(|v| v % 8) == [4, 4]);
    let bad = Image::from_fn(SIZE, |px| if px == [20, 20] { [0.5, f32::INFINITY, 0.5] } else { [0.5; 3] });
    let (out, stats) = first(MethodKind::None, &bad, &far);
    // The pixels around it have other samples; its own has none.
    assert_eq!(stats.nonfinite, 1);
    let black = |c: &[f32; 3]| *c == [0.0; 3];
    assert_eq!(out.pixels().iter().position(black), Some(20 * 64 + 20));
    assert!(out.pixels().iter().filter(|c| !black(c)).all(|c| (c[0] - 0.5).abs() < 1e-6));
    let (_, stats) = first(MethodKind::None, &Image::filled(SIZE, [f32::NAN; 3]), &far);
    assert_eq!(stats.nonfinite, 64 * 48);
}

/// A candidate counts by the place of its sample: 1 at the sample, 2^-12 beside it, and the noise is read there.
#[test]
fn weights_of_wrs_are_those_of_the_nearest_samples() {
    let foveation = Foveation { fovea_deg: 180.0, mid_deg: 180.0, ..Foveation::quads() };
    let mask = Image::from_fn(SIZE, |px| px.map(|v| v % 8) == [3, 4]);
    let view = masked(noise(SIZE, "places"), &mask);
    let weight =
        |settings: Settings, view: &View, [x, y]: [usize; 2]| context(settings).step(0, view).trace.at(x, y).weight;
    let calm = Settings { foveation, ..Settings::paper() };
    let plain = [[11, 12], [12, 12], [13, 13], [8, 9]].map(|px| weight(calm, &view, px));
    // (1 + 8 d^2)^-4, with 1 + 8 d^2 rounded down to a power of two.
    assert_eq!(plain, [1.0, (-12.0_f32).exp2(), (-20.0_f32).exp2(), (-28.0_f32).exp2()]);
    // Four samples a pixel in the noise input, but for the pixels without a sample, which have none.
    let noise = mask.map(|chosen| [0.0, if chosen { 4.0 } else { f32::NAN }]);
    let noisy = Settings { noisy: true, ..calm };
    let view = View { noise: Some(noise), ..view };
    assert_eq!([[11, 12], [12, 12]].map(|px| weight(noisy, &view, px)), [4.0, 4.0 * (-12.0_f32).exp2()]);
    // Without samples around, the pixel itself counts, and it is not usable.
    let nothing = View { noise: None, ..masked(view.color.clone(), &Image::filled(SIZE, false)) };
    assert_eq!(weight(calm, &nothing, [11, 12]), 0.0);
}

#[test]
fn levels_of_detail_of_planned_frames_are_refused() {
    let mut post = context(settings(MethodKind::Wrs));
    let view = View { lod: Some(Image::filled(SIZE, 1.0)), ..masked(noise(SIZE, "lod"), &blocks([0, 0])) };
    let images = Images::of([&view]);
    let error = post.process(&images.frame(0), &mut [Image::filled(SIZE, [0.0; 3])]).unwrap_err().to_string();
    assert_eq!(error, "lod of view 0 is given: expected None: the places of the samples say how coarse the frame is");
    assert!(!post.history().is_filled());
}
