//! Alpha of planned frames: it has the history that color has.

use super::*;
use crate::images::traced_alpha;
use afterimage::internal::{Foveation, Smr};

const SMALL: [u32; 2] = [96, 96];

/// Of a quarter of the pixels, without a gaze.
fn quarter(antialias: bool, single_pixels: bool) -> CpuAfterimage {
    let method = Method::Smr(Smr { antialias, ..Smr::default() });
    let foveation = Foveation { single_pixels, ..Foveation::uniform(0.25) };
    let settings = Settings { method, foveation, ..Settings::default() };
    CpuAfterimage::new(&ContextDesc { settings, ..ContextDesc::new(SMALL) }).unwrap()
}

/// Output color and alpha of a frame without optional inputs but `trust`.
fn show(post: &mut CpuAfterimage, index: u64, jitter_px: [f32; 2], trust: f32, given: &Given) -> (Color, Image<f32>) {
    let view = View::still(given.color.clone(), [48.0, 48.0]).with(|view| {
        view.facts.jitter_px = jitter_px;
        view.trust = Some(Image::filled(SMALL, trust));
    });
    let images = Images::of([&view]);
    let frame = images.frame(index);
    post.plan(&frame).unwrap();
    let (mut shown, .., mut alpha) = traced_alpha(post, &frame, std::slice::from_ref(&given.alpha));
    (shown.remove(0), alpha.remove(0))
}

struct Given {
    color: Color,
    alpha: Image<f32>,
}

/// A disc over a transparent background, sampled at the pixels minus the jitter.
fn disc([jx, jy]: [f32; 2]) -> Given {
    let is_inside = |[x, y]: [u32; 2]| (x as f32 - jx - 47.3).hypot(y as f32 - jy - 48.6) < 30.0;
    Given {
        color: Image::from_fn(SMALL, |px| if is_inside(px) { [0.8, 0.6, 0.4] } else { [0.0; 3] }),
        alpha: Image::from_fn(SMALL, |px| f32::from(is_inside(px))),
    }
}

/// Means over 64 points of each pixel.
fn disc_means() -> Image<f32> {
    let points = (0..64).map(|i| [i % 8, i / 8].map(|k| (k as f32 + 0.5) / 8.0 - 0.5));
    let all: Vec<_> = points.map(|at| disc(at).alpha).collect();
    Image::from_fn(SMALL, |px| all.iter().map(|image| pixel(image, px)).sum::<f32>() / 64.0)
}

fn off_by_a_tenth(shown: &Image<f32>, expected: &Image<f32>) -> usize {
    shown.pixels().iter().zip(expected.pixels()).filter(|(a, b)| (*a - *b).abs() > 0.1).count()
}

/// The edge of an object over a transparent background is as still and as sharp as its color. Jittered frames have 16
/// samples of each pixel, whose mean is off by a tenth in some pixels of the edge, in color as in alpha.
#[test]
fn alpha_of_a_still_picture_converges() {
    let all =
        [false, true].map(|single_pixels| [(false, false), (true, false), (true, true)].map(|a| (a, single_pixels)));
    for ((antialias, is_jittered), single_pixels) in all.concat() {
        let expected = if is_jittered { disc_means() } else { disc([0.0; 2]).alpha };
        let run = |trust: f32| {
            let mut post = quarter(antialias, single_pixels);
            let frames = (0..64).map(|index| {
                let jitter_px = if is_jittered { Foveation::jitter_px(index) } else { [0.0; 2] };
                show(&mut post, index, jitter_px, trust, &disc(jitter_px))
            });
            let [before, last]: [(Color, Image<f32>); 2] = frames.skip(62).collect::<Vec<_>>().try_into().unwrap();
            let by_color = last.0.map(|c| c[0] * (1.0 / 0.8));
            let count = |image| off_by_a_tenth(image, &expected);
            [count(&last.1), count(&by_color), off_by_a_tenth(&last.1, &before.1)]
        };
        let [off, color_off, flickering] = run(1.0);
        // The planted error: alpha of this frame's samples alone, as without history.
        let [off_without, _, flickering_without] = run(0.0);
        println!(
            "antialias {antialias}, jitter {is_jittered}, single pixels {single_pixels}: {off} px off ({color_off} in color), {flickering} flicker; without history {off_without}, {flickering_without}"
        );
        assert!(off < if is_jittered { color_off + 10 } else { 20 } && flickering < 20);
        assert!(off_without > 100 && flickering_without > 100);
    }
}

/// Alpha that is the same everywhere stays, whatever the color does, and no alpha exceeds those that were given.
#[test]
fn alpha_stays_within_what_was_given() {
    for antialias in [false, true] {
        for (low, high) in [(0.4, 0.4), (0.1, 0.7)] {
            let mut post = quarter(antialias, false);
            for index in 0..24 {
                let jitter_px = if antialias { Foveation::jitter_px(index) } else { [0.0; 2] };
                let light = if index % 7 < 3 { 0.3 } else { 1.0 };
                let given = Given {
                    color: noise(SMALL, "alpha").map(|c| c.map(|v| v * light)),
                    alpha: Image::from_fn(SMALL, |[x, y]| if (x / 5 + y / 3) % 2 == 0 { low } else { high }),
                };
                let (_, alpha) = show(&mut post, index, jitter_px, 1.0, &given);
                let is_within = |&&v: &&f32| (low - 1e-6..=high + 1e-6).contains(&v);
                assert_eq!(alpha.pixels().iter().filter(is_within).count(), alpha.pixels().len(), "frame {index}");
            }
        }
    }
}

/// Where history is rejected, alpha is that of a frame without history.
#[test]
fn rejected_history_has_no_alpha() {
    for antialias in [false, true] {
        let mut post = quarter(antialias, false);
        for index in 0..9 {
            show(&mut post, index, [0.0; 2], 1.0, &disc([0.0; 2]));
        }
        let moved = disc([9.0, -4.0]);
        let mut rejecting = post.clone();
        let (_, alpha) = show(&mut rejecting, 9, [0.0; 2], 0.0, &moved);
        let (_, kept) = show(&mut post, 9, [0.0; 2], 1.0, &disc([0.0; 2]));
        // Every alpha lies between those of the samples of this frame: where all around is 0 or 1, it is.
        let is_same = |reach: i32, [x, y]: [u32; 2], image: &Image<f32>| {
            let at = |dx, dy| pixel(image, [x.saturating_add_signed(dx).min(95), y.saturating_add_signed(dy).min(95)]);
            let offsets = (-reach..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| (dx, dy)));
            offsets.map(|(dx, dy)| at(dx, dy)).all(|v| v == at(0, 0))
        };
        let flat: Vec<_> = pixels(SMALL).filter(|px| is_same(8, *px, &moved.alpha)).collect();
        assert!(flat.len() > 2000);
        assert!(flat.iter().all(|px| (pixel(&alpha, *px) - pixel(&moved.alpha, *px)).abs() < 1e-6));
        // History that is not rejected has the old one.
        assert!(flat.iter().any(|px| (pixel(&kept, *px) - pixel(&moved.alpha, *px)).abs() > 0.9));
    }
}
