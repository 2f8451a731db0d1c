//! Noisy candidates: the mean of many frames has the variance that its weights predict, and no bias; noise does not
//! count as a change, nor a change as noise.

use super::rig::{Draws, SIZE, Steps, View, context_of, settings, sharp};
use crate::pass::mask_noise::{self, moments, promised};
use afterimage::cpu::CpuAfterimage;
use afterimage::internal::{Method, MethodKind, Settings, Smr};
use afterimage_testing::{accept, p_of_z, reject};

const PIXELS: f64 = (SIZE[0] * SIZE[1]) as f64;

fn noisy() -> Settings {
    Settings { noisy: true, ..settings(MethodKind::Smr) }
}

fn post(settings: Settings) -> CpuAfterimage {
    context_of(SIZE, settings)
}

/// Sharp pixels, each the mean of two draws of `sample`.
fn sampled(draws: &mut Draws, sample: impl Fn(&mut Draws, [u32; 2]) -> f32) -> View {
    let View { color, noise, .. } = mask_noise::sampled(SIZE, |px| sample(draws, px));
    View { noise, ..sharp(color) }
}

#[test]
fn a_still_view_has_the_variance_that_its_weights_predict() {
    let even = |d: &mut Draws, _| d.range(0.2, 0.8);
    let of_one_frame = 0.6 * 0.6 / 12.0 / 2.0;
    for (frames, accumulate) in [(5, 0.9), (60, 0.9), (60, 0.5)] {
        let mut draws = Draws::new(&format!("still {frames} {accumulate}"));
        let method = Method::Smr(Smr { accumulate, ..Smr::default() });
        let mut post = post(Settings { method, ..noisy() });
        let shown = (0..frames).map(|i| post.step(i, &sampled(&mut draws, even)).shown).last().unwrap();
        let (mean, variance) = moments(&shown);
        let expected = of_one_frame * promised(frames, f64::from(accumulate)).0;
        println!("{frames} frames, share {accumulate}: variance {variance:.2e}, promised {expected:.2e}");
        // Rounding in storage adds less than a thousandth of the color each frame.
        let rounding = f64::from(2.0_f32.powi(-10)).powi(2) * 0.25;
        let z = (variance - expected) / (expected * (2.0 / PIXELS).sqrt());
        let allowed = rounding / (1.0 - f64::from(accumulate)).powi(2) / (expected * (2.0 / PIXELS).sqrt());
        accept("variance", p_of_z((z.abs() - allowed).max(0.0)));
        accept("mean", p_of_z((mean - 0.5) / (expected / PIXELS).sqrt()));
        if frames > 5 {
            let other = of_one_frame * promised(frames, 0.8 * f64::from(accumulate)).0;
            reject("variance, other weights", p_of_z((variance - other) / (other * (2.0 / PIXELS).sqrt())));
        }
    }
}

#[test]
fn a_change_beyond_the_noise_is_followed_within_frames() {
    let mut draws = Draws::new("change");
    let mut post = post(noisy());
    let around = |level: f32| move |d: &mut Draws, _: [u32; 2]| level + d.range(-0.1, 0.1);
    for index in 0..30 {
        post.step(index, &sampled(&mut draws, around(0.2)));
    }
    let after: Vec<f64> =
        (30..36).map(|index| moments(&post.step(index, &sampled(&mut draws, around(0.6))).shown).0).collect();
    assert!((after[1] - 0.6).abs() < 0.02, "{after:?}");
    // In half of the picture alone, the other half keeps its history.
    let half = |d: &mut Draws, [x, _]: [u32; 2]| if x < SIZE[0] / 2 { 0.6 } else { 0.1 } + d.range(-0.05, 0.05);
    for index in 36..42 {
        let shown = post.step(index, &sampled(&mut draws, half)).shown;
        let errors = |range: std::ops::Range<usize>, truth: f32| -> f32 {
            let row: Vec<f32> = range.map(|x| (shown.at(x, 20)[0] - truth).abs()).collect();
            row.iter().sum::<f32>() / row.len() as f32
        };
        println!(
            "frame {index}: kept half off by {:.3}, changed half by {:.3}",
            errors(0..18, 0.6),
            errors(34..52, 0.1)
        );
        assert!(index < 38 || (errors(0..18, 0.6) < 0.02 && errors(34..52, 0.1) < 0.03));
    }
}
