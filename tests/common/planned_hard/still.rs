//! H111 and H112: still pictures under jitter settle. Moire is no change of light, and texture stays sharp.

use super::{context, context_of, frame, jitter_px, wall};
use crate::depth_hard::{Color, Make, Steps};
use crate::images::View;
use afterimage::Image;
use afterimage::internal::MethodKind;

const SIZE: [u32; 2] = [96, 64];
/// Light of dark and bright stripes.
const STRIPES: [f32; 2] = [0.1, 0.9];

fn stripes(index: u64, period_px: f32) -> View {
    frame(SIZE, jitter_px(index, true), |[x, _]| {
        [STRIPES[usize::from(((x + 0.5) / period_px).rem_euclid(1.0) < 0.5)]; 3]
    })
}

/// Mean change of a pixel of stripes from frame to frame, of the 32 frames after 80.
fn change_of(mut post: Box<dyn Steps>, period_px: f32) -> f64 {
    let (mut sum, mut last) = (0.0, None::<Color>);
    for index in 0..112 {
        let shown = post.step(index, &stripes(index, period_px)).shown;
        if let Some(last) = last.filter(|_| index > 80) {
            let pairs = shown.pixels().iter().zip(last.pixels());
            sum += pairs.map(|(a, b)| f64::from((a[1] - b[1]).abs())).sum::<f64>();
        }
        last = Some(shown);
    }
    sum / (31.0 * (SIZE[0] * SIZE[1]) as f64)
}

/// PSNR of square roots against the mean over the area of each pixel, in dB, on average over the frames from 96 to 128.
fn quality_by(make: Make<'_>, share: f32, wrong: impl Fn(&mut Color, u64)) -> Option<f64> {
    let mut post = context(make, SIZE, share, true)?;
    let mean = Image::from_fn(SIZE, |px| {
        let of = |s: u32| [s % 4, s / 4].map(|v| v as f32 / 4.0 - 0.375);
        let points: Vec<[f32; 3]> = (0..16).map(|s| wall([0, 1].map(|i| px[i] as f32 + of(s)[i]))).collect();
        [0, 1, 2].map(|i| points.iter().map(|c| c[i]).sum::<f32>() / 16.0)
    });
    let mut sum = 0.0;
    for index in 0..128 {
        let mut view = frame(SIZE, jitter_px(index, true), wall);
        wrong(&mut view.color, index);
        let shown = post.step(index, &view).shown;
        sum += if index >= 96 { psnr(&shown, &mean) } else { 0.0 };
    }
    Some(sum / 32.0)
}

fn psnr(shown: &Color, expected: &Color) -> f64 {
    let pairs = shown.pixels().iter().flatten().zip(expected.pixels().iter().flatten());
    let squared = pairs.map(|(a, b)| f64::from(a.sqrt() - b.sqrt()).powi(2)).sum::<f64>();
    -10.0 * (squared / (3 * SIZE[0] * SIZE[1]) as f64).log10()
}

/// Largest mean change from frame to frame at a share of the pixels.
fn most_change(share: f32) -> f64 {
    if share < 1.0 { 0.1 } else { 0.05 }
}

fn moire_of(make: Make<'_>, cases: &[(f32, f32)]) -> Option<String> {
    let mut texts = vec![];
    for &(share, period_px) in cases {
        let change = change_of(context(make, SIZE, share, true)?, period_px);
        assert!(change <= most_change(share), "{share}, {period_px} px: {change:.4}");
        texts.push(format!("{change:.4} (stripes of {period_px} px, {:.0} % of the pixels)", 100.0 * share));
    }
    Some(format!("mean change from frame to frame, of stripes of 0.1 and 0.9: {}", texts.join(", ")))
}

/// Stripes, and a planted error: samples that are shown as they come.
pub fn moire(make: Make<'_>) -> Option<String> {
    let bare = change_of(context_of(make, SIZE, 0.25, MethodKind::None.into())?, 1.05);
    println!("without history: {bare:.4}");
    assert!(bare > most_change(0.25));
    moire_of(make, &[(0.25, 1.05)])
}

pub fn moire_table(make: Make<'_>) -> Option<String> {
    moire_of(make, &[(0.25, 2.1), (1.0, 1.05), (1.0, 2.1)])
}

/// The wall at two shares, and a planted error: a renderer whose light flickers by 2 %.
pub fn still_wall(make: Make<'_>) -> Option<String> {
    let flicker = |color: &mut Color, index: u64| {
        let factor = if index.is_multiple_of(2) { 1.02 } else { 0.98 };
        color.pixels_mut().iter_mut().for_each(|c| *c = c.map(|v| v * factor));
    };
    let mut texts = vec![];
    for (share, least_db) in [(0.25, 55.5), (0.1, 51.5)] {
        let db = quality_by(make, share, |_, _| ())?;
        assert!(db >= least_db, "{share}: {db:.2} dB");
        texts.push(format!("{db:.2} dB at {:.0} %", 100.0 * share));
    }
    let flickering = quality_by(make, 0.25, flicker)?;
    println!("a renderer that flickers: {flickering:.2} dB");
    assert!(flickering < 55.5);
    Some(format!("still, textured wall: {} of the pixels", texts.join(", ")))
}
