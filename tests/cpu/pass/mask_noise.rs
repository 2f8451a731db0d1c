//! Noisy planned frames: averaging lowers the variance and keeps the mean; noise does not count as a change, nor a
//! change as noise.

use super::*;
use crate::mask_hard::Mask;
use afterimage::internal::{Foveation, Method, Smr};
use afterimage::kernel::lattice::offset_px;
use afterimage::kernel::noise::unpack_noise;
use afterimage_testing::{accept, p_of_z, reject};

const PIXELS: f64 = (SIZE[0] * SIZE[1]) as f64;

fn settings() -> Settings {
    let foveation = Foveation { rate_mid: 2, rate_far: 4, ..Foveation::quads() };
    Settings { foveation, ..Settings::traced() }
}

fn masked(view: View, mask: &Mask) -> View {
    View { mask: Some(mask.map(|chosen| if chosen { 1.0 } else { 0.0 })), ..view }
}

/// Shows frame `index` of a still view: a sample is the mean of two draws.
fn frame(post: &mut CpuAfterimage, index: u64, mask: &Mask, draw: impl FnMut([u32; 2]) -> f32) -> Color {
    one(post, index, &masked(sampled(SIZE, draw), mask)).0
}

fn full() -> Mask {
    Image::filled(SIZE, true)
}

/// One pixel of each block of 4x4.
fn coarse(index: u64) -> Mask {
    Image::from_fn(SIZE, |px| px.map(|v| v % 4) == offset_px(index, 4))
}

/// Every pixel of the left half, one of each block of 4x4 in the right one.
fn both(index: u64) -> Mask {
    let coarse = coarse(index);
    Image::from_fn(SIZE, |px| px[0] < 32 || pixel(&coarse, px))
}

/// Grey pixels, each the mean of two draws, with the standard error that these draws themselves suggest.
pub fn sampled(size: [u32; 2], mut draw: impl FnMut([u32; 2]) -> f32) -> View {
    let drawn = Image::from_fn(size, |px| [0; 2].map(|_| draw(px)));
    let color = drawn.map(|[a, b]| [0.5 * (a + b); 3]);
    View { noise: Some(drawn.map(|[a, b]| [0.5 * (a - b).abs(), 2.0])), ..still(color) }
}

/// Mean of the shown pixels, and the variance between them.
pub fn moments(shown: &Color) -> (f64, f64) {
    let pixels = shown.pixels().len() as f64;
    let mean = shown.pixels().iter().map(|c| f64::from(c[0])).sum::<f64>() / pixels;
    let squares: f64 = shown.pixels().iter().map(|c| (f64::from(c[0]) - mean).powi(2)).sum();
    (mean, squares / (pixels - 1.0))
}

/// Variance of a still pixel after `frames` of variance 1, by the weights that `docs/method.md` states, and how many
/// frames it then counts for.
pub fn promised(frames: u64, most: f64) -> (f64, f64) {
    (1..frames).fold((1.0, 1.0), |(variance, known), _| {
        let share = f64::min(known / (known + 1.0), most);
        (share * share * variance + (1.0 - share) * (1.0 - share), 1.0 / (1.0 - share))
    })
}

#[test]
fn pixels_that_are_always_shaded_have_the_variance_that_their_weights_predict() {
    let of_one_frame = 0.003 * 0.003 / 12.0 / 2.0;
    for (frames, most) in [(5, 0.95), (60, 0.95), (60, 0.5)] {
        let mut draws = Draws::new(&format!("planned still {frames} {most}"));
        // Noise that is not visible, so that no pixel borrows from its neighbours.
        let smr = Smr { accumulate: most as f32, ..Smr::traced() };
        let mut post = context(Settings { method: Method::Smr(smr), ..settings() });
        let shown = (0..frames).map(|i| frame(&mut post, i, &full(), |_| draws.range(0.0105, 0.0135))).last().unwrap();
        let (variance, known) = promised(frames, most);
        let expected = of_one_frame * variance;
        let (mean, variance) = moments(&shown);
        println!("{frames} frames, share {most}: variance {variance:.2e}, predicted {expected:.2e}");
        // Storage rounds to multiples of 2^-15, which adds a twelfth of a step's square each frame.
        let rounding = f64::from(2.0_f32.powi(-15)).powi(2) / 12.0 / (1.0 - most * most);
        let scale = expected * (2.0 / PIXELS).sqrt();
        accept("variance", p_of_z((((variance - expected).abs() - rounding) / scale).max(0.0)));
        accept("mean", p_of_z((mean - 0.012) / (expected / PIXELS).sqrt()));
        if frames > 5 {
            reject("variance, of one frame fewer", p_of_z((variance - 1.3 * expected) / scale));
        }
        let words = post.history().noise();
        let samples = words.iter().map(|&w| f64::from(unpack_noise(w).samples)).sum::<f64>() / PIXELS;
        assert!((samples / (2.0 * known) - 1.0).abs() < 0.01, "{samples} samples are known, of {}", 2.0 * known);
    }
}

#[test]
fn coarse_masks_are_averaged_without_bias() {
    // A lamp that one sample in 16 hits.
    let truth = 4.0 / 16.0 + 0.05 * 15.0 / 16.0;
    let mut draws = Draws::new("planned rare");
    let mut rare = |_: [u32; 2]| if draws.bits().is_multiple_of(16) { 4.0 } else { 0.05 };
    for mask in [coarse as fn(u64) -> Mask, both] {
        let mut post = context(settings());
        let (mut sum, mut squares, mut frames) = (0.0, 0.0, 0.0);
        // Of the samples, each of two draws.
        let first = (4.0_f64 - 0.05).powi(2) * (15.0 / 256.0) / 2.0;
        let mut last = 0.0;
        for index in 0..320 {
            let (mean, variance) = moments(&frame(&mut post, index, &mask(index), &mut rare));
            last = variance;
            if index >= 60 && index % 40 == 0 {
                (sum, squares, frames) = (sum + mean, squares + mean * mean, frames + 1.0);
            }
        }
        let mean: f64 = sum / frames;
        let error = ((squares / frames - mean * mean) / (frames - 1.0)).sqrt();
        assert!((mean - truth).abs() < 5.0 * error + 0.01 * truth, "{mean} for {truth}");
        assert!(last * 40.0 < first, "noise is averaged: {first} becomes {last}");
    }
}

#[test]
fn a_change_beyond_the_noise_is_followed() {
    for mask in [coarse as fn(u64) -> Mask, both] {
        let mut draws = Draws::new("planned change");
        let mut post = context(settings());
        let mut around = |level: f32| draws.range(level - 0.1, level + 0.1);
        for index in 0..40 {
            frame(&mut post, index, &mask(index), |_| around(0.2));
        }
        let change = |index: u64, around: &mut dyn FnMut(f32) -> f32, post: &mut CpuAfterimage| {
            moments(&frame(post, index, &mask(index), |_| around(0.6))).0
        };
        let after: Vec<f64> = (40..46).map(|index| change(index, &mut around, &mut post)).collect();
        assert!((after[2] - 0.6).abs() < 0.03, "{after:?}");
    }
}

#[test]
fn what_is_known_exactly_becomes_as_sharp_as_without_noise() {
    let picture = noise(SIZE, "planned, no noise");
    let run = |settings: Settings| {
        let mut post = context(settings);
        let frame = |index| {
            let noise = settings.noisy.then(|| Image::filled(SIZE, [0.0, 4.0]));
            masked(View { noise, ..still(picture.clone()) }, &coarse(index))
        };
        let shown = (0..40).map(|index| one(&mut post, index, &frame(index)).0).last().unwrap();
        let error: f64 = shown
            .pixels()
            .iter()
            .zip(picture.pixels())
            .flat_map(|(a, b)| (0..3).map(move |i| f64::from(a[i] - b[i]).powi(2)))
            .sum();
        (error / (3.0 * PIXELS)).sqrt()
    };
    let (noisy, calm) = (run(settings()), run(Settings { noisy: false, ..settings() }));
    assert!(noisy < calm * 1.5 + 2e-3, "{noisy}, {calm}");
}
