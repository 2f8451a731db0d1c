//! Temporal upsampling: what it makes of samples whose places it knows.

use super::*;
use afterimage::{Filter, Foveation, Lattices, Method};

const GAZE: [f32; 2] = [20.0, 20.0];

fn foveation() -> Foveation {
    Foveation { filter: Filter::Sparse, rate_mid: 2, rate_far: 4, ..Foveation::default() }
}

fn lattices(index: u64) -> Lattices {
    foveation().lattices(&geometry(SIZE), GAZE, index)
}

/// Waves of 5 to 9 pixels, moved to the right by `shift_px`.
fn waves(shift_px: f32, offset_px: [f32; 2]) -> Color {
    Image::from_fn(SIZE, |[x, y]| {
        let (x, y) = (x as f32 - shift_px - offset_px[0], y as f32 - offset_px[1]);
        [(1.2 * x).sin(), (0.9 * y + 0.3 * x).cos(), (0.7 * x - 0.8 * y).sin()].map(|v| 0.5 + 0.3 * v)
    })
}

fn squared_error(a: &Color, b: &Color) -> f64 {
    let squares = a.pixels().iter().zip(b.pixels()).flat_map(|(a, b)| (0..3).map(|c| (a[c] - b[c]).powi(2)));
    squares.map(f64::from).sum::<f64>() / (3 * a.pixels().len()) as f64
}

/// Squared error of each frame of waves that move by `speed_px` a frame, as sparse frames.
fn errors(method: MethodKind, speed_px: f32, frames: u64) -> Vec<f64> {
    let mut post = context(Settings { method: method.into(), foveation: foveation(), ..Settings::default() });
    let motion = Image::filled(SIZE, [-speed_px, 0.0]);
    let mut out = [Image::filled(SIZE, [0.0; 3])];
    let frame = |index: u64| {
        let full = waves(speed_px * index as f32, [0.0; 2]);
        let mut facts = ViewFrame::new(geometry(SIZE), Gaze::At { px: GAZE });
        facts.lattices = Some(lattices(index));
        let view = OneView { motion: Some(&motion), ..OneView::new(facts, &full) };
        post.process(&Images::of(&[view]).frame(index), &mut out).unwrap();
        squared_error(&out[0], &full)
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

#[test]
fn a_cut_starts_afresh() {
    let settings = Settings { method: Method::Taau, foveation: foveation(), ..Settings::default() };
    let (mut seen, mut fresh) = (context(settings), context(settings));
    let full = noise(SIZE, "after the cut");
    let show = |post: &mut CpuAfterimage, color: &Color, index: u64, reset: Reset| {
        let mut facts = ViewFrame::new(geometry(SIZE), Gaze::At { px: GAZE });
        facts.lattices = Some(lattices(index));
        let mut out = [Image::filled(SIZE, [0.0; 3])];
        let view = [OneView::new(facts, color)];
        let images = Images::of(&view);
        post.process(&Frame { reset, ..images.frame(index) }, &mut out).unwrap();
        let [out] = out;
        out
    };
    for index in 0..5 {
        show(&mut seen, &waves(0.0, [0.0; 2]), index, Reset::None);
    }
    for index in 5..8 {
        let reset = if index == 5 { Reset::All } else { Reset::None };
        assert_eq!(show(&mut seen, &full, index, reset), show(&mut fresh, &full, index, Reset::None));
    }
}

#[test]
fn jittered_frames_of_full_rate_are_put_where_their_samples_lie() {
    let mut post = context(Settings { method: Method::Taau, ..Settings::default() });
    let full = waves(0.0, [0.0; 2]);
    let mut out = [Image::filled(SIZE, [0.0; 3])];
    let mut last = 0.0;
    for index in 0..16_u64 {
        let jitter_px = [0, 1].map(|i| ((index * [5, 3][i]) % 8) as f32 / 8.0 - 0.4375);
        let facts = ViewFrame { jitter_px, ..ViewFrame::new(geometry(SIZE), Gaze::At { px: GAZE }) };
        let color = waves(0.0, jitter_px);
        post.process(&Images::of(&[OneView::new(facts, &color)]).frame(index), &mut out).unwrap();
        last = squared_error(&out[0], &full) / squared_error(&color, &full);
    }
    println!("squared error {last:.4} of the jittered frame's");
    assert!(last < 0.3);
}
