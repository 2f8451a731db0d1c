//! Temporal upsampling: its output from samples at known places.

use super::*;
use crate::mask_hard::{Mask, pattern};
use afterimage::internal::{Foveation, Method};
use afterimage::kernel::lattice::offset_px;

const GAZE: [f32; 2] = [20.0, 20.0];

fn settings(method: Method) -> Settings {
    Settings { method, foveation: Foveation::quads(), ..Settings::default() }
}

fn masked(view: View, mask: &Mask) -> View {
    View { mask: Some(mask.map(|chosen| if chosen { 1.0 } else { 0.0 })), ..view }
}

/// Waves of 5 to 9 pixels, moved to the right by `shift_px`.
fn waves(shift_px: f32, offset_px: [f32; 2]) -> Color {
    Image::from_fn(SIZE, |[x, y]| crate::mask_hard::wave([x as f32 - shift_px - offset_px[0], y as f32 - offset_px[1]]))
}

fn squared_error(a: &Color, b: &Color) -> f64 {
    let squares = a.pixels().iter().zip(b.pixels()).flat_map(|(a, b)| (0..3).map(|c| (a[c] - b[c]).powi(2)));
    squares.map(f64::from).sum::<f64>() / (3 * a.pixels().len()) as f64
}

/// Squared error of each frame of waves that move by `speed_px` a frame, one pixel of each block.
fn errors(method: MethodKind, speed_px: f32, frames: u64) -> Vec<f64> {
    let mut post = context(settings(method.into()));
    let frame = |index: u64| {
        let full = waves(speed_px * index as f32, [0.0; 2]);
        let view = View::still(full.clone(), GAZE).moving([speed_px, 0.0]);
        let view = masked(view, &pattern(SIZE, GAZE, index));
        squared_error(&one(&mut post, index, &view).0, &full)
    };
    (0..frames).map(frame).collect()
}

#[test]
fn a_still_converges_and_what_moves_is_sharper_than_with_taa() {
    for (speed_px, of_first, of_taa) in [(0.0, 0.06, 0.07), (0.3, 0.6, 0.7)] {
        let [taau, taa] = [MethodKind::Taau, MethodKind::Taa].map(|method| errors(method, speed_px, 48));
        let late = |errors: &[f64]| errors[32..].iter().sum::<f64>() / 16.0;
        println!(
            "{speed_px} px a frame: squared error {:.6} of the first frame, {:.6} later, {:.6} with taa",
            taau[0],
            late(&taau),
            late(&taa)
        );
        assert!(late(&taau) < of_first * taau[0] && late(&taau) < of_taa * late(&taa));
    }
}

/// A grey slanted pattern with hard edges of contrast 3 to 7, point by point.
fn hard(x: f32, y: f32) -> f32 {
    if (0.9 * x + 0.37 * y).sin() + (0.23 * x - 0.61 * y).cos() > 0.2 { 0.7 } else { 0.3 }
}

/// Its frame with a jitter: what is at p is drawn at p + jitter.
fn hard_frame([dx, dy]: [f32; 2], light: f32) -> Color {
    Image::from_fn(SIZE, |[x, y]| [light * hard(x as f32 - dx, y as f32 - dy); 3])
}

/// Squared errors of jittered frames of a still against means over pixels. One pixel of each block of `step` pixels is
/// shaded. The light changes by a factor in a frame.
fn still_errors(method: Method, step: u32, trust: f32, frames: u64, [at, light]: [f32; 2]) -> Vec<f64> {
    let mut post = context(settings(method));
    let places = (0..16).flat_map(|i| (0..16).map(move |j| [i, j].map(|k| (k as f32 + 0.5) / 16.0 - 0.5)));
    let means = places.map(|at| hard_frame(at, 1.0 / 256.0)).reduce(|a, b| {
        Image::from_fn(SIZE, |[x, y]| [a.at(x as usize, y as usize)[0] + b.at(x as usize, y as usize)[0]; 3])
    });
    let means = means.unwrap();
    let frame = |index: u64| {
        let light = if index as f32 >= at { light } else { 1.0 };
        let jitter_px = Foveation::jitter_px(index);
        let offset = offset_px(index, step);
        let mask = Image::from_fn(SIZE, |px| px.map(|v| v % step) == offset);
        let mut view = masked(View::still(hard_frame(jitter_px, light), GAZE), &mask);
        (view.facts.jitter_px, view.trust) = (jitter_px, Some(Image::filled(SIZE, trust)));
        squared_error(&one(&mut post, index, &view).0, &means.map(|c| c.map(|v| v * light)))
    };
    (0..frames).map(frame).collect()
}

#[test]
fn a_jittered_still_converges_and_a_step_of_light_is_followed() {
    for (method, step) in [(Method::Taa, 1), (Method::Taau, 1), (Method::Taau, 2)] {
        // A trust of 2/3 holds history to two samples.
        let [long, short] = [1.0, 2.0 / 3.0].map(|trust| still_errors(method, step, trust, 104, [96.0, 0.5]));
        let mean = |errors: &[f64]| errors.iter().sum::<f64>() / errors.len() as f64;
        let [one, still, held] = [mean(&long[..1]), mean(&long[64..96]), mean(&short[64..96])];
        let [after, held_after] = [mean(&long[96..]), mean(&short[96..])];
        println!("{method:?}, step {step}: squared error {one:.5} of the first frame, {still:.6} later ({held:.6} if");
        println!("held to two samples); after a step of light {after:.6} ({held_after:.6})");
        // Between samples a frame is filled, so that a sample counts beside its pixel, too.
        let bar = if step == 1 { 0.1 } else { 0.2 };
        assert!(still < bar * one && still < 0.5 * held, "it converges");
        // Between samples, trust replaces history by interpolation, which is another method.
        let last = long[103] / long[96];
        println!("{last:.3} of the step's first error is left after 7 frames");
        assert!(last < 0.1 && (step > 1 || after < 1.2 * held_after), "light is followed as fast");
    }
}
