//! Antialiasing of jittered planned frames: laws of the means that history stores.

use super::*;
use afterimage::internal::{Foveation, Smr};
use afterimage::kernel::antialias::MOST_SAMPLES;
use afterimage::kernel::lattice::offset_px;

const SMALL: [u32; 2] = [32, 24];

/// A picture with detail below a pixel: stripes whose width is a fraction of one, and a slope.
fn picture([x, y]: [f32; 2]) -> [f32; 3] {
    let stripe = if (0.71 * x + 0.43 * y).rem_euclid(1.0) < 0.4 { 0.75 } else { 0.25 };
    [stripe, 0.2 + 0.01 * x, if (0.31 * x - 0.55 * y).rem_euclid(1.0) < 0.5 { 0.3 } else { 0.5 }]
}

/// Values where the samples lie, at the pixels minus the jitter; without jitter, at the pixels' centres.
fn sampled<T: Copy>([jx, jy]: [f32; 2], value: impl Fn([f32; 2]) -> T) -> Image<T> {
    Image::from_fn(SMALL, |[x, y]| value([x as f32 - jx, y as f32 - jy]))
}

/// Frame `index`, of which one pixel of each block of `step` pixels is shaded; of step 1 it is planned, all fovea.
fn frame(index: u64, step: u32, jitter_px: [f32; 2], color: impl Fn([f32; 2]) -> [f32; 3]) -> View {
    let offset = offset_px(index, step);
    let mask = Image::from_fn(SMALL, |px| if px.map(|v| v % step) == offset { 1.0 } else { 0.0 });
    View::still(sampled(jitter_px, color), [10.0, 10.0]).with(|view| {
        view.facts.jitter_px = jitter_px;
        view.mask = (step > 1).then_some(mask);
    })
}

/// Jitter of a frame if it changes once in a turn of the pattern.
fn jitter_of_turn(index: u64, step: u32) -> [f32; 2] {
    Foveation::jitter_px(index / u64::from(step * step))
}

/// Points of a grid of `side` by `side` in a pixel, from its centre.
fn points(side: usize) -> Vec<[f32; 2]> {
    let at = |k: usize| (k as f32 + 0.5) / side as f32 - 0.5;
    (0..side * side).map(|i| [i % side, i / side].map(at)).collect()
}

/// Mean over each pixel, and variance of one sample around it, by 32x32 points.
fn box_means() -> Vec<([f64; 3], f64)> {
    let points = points(32);
    let of = |i: u32| {
        let [x, y] = [(i % SMALL[0]) as f32, (i / SMALL[0]) as f32];
        let colors: Vec<[f64; 3]> = points.iter().map(|p| picture([x + p[0], y + p[1]]).map(f64::from)).collect();
        let mean = [0, 1, 2].map(|c| colors.iter().map(|v| v[c]).sum::<f64>() / 1024.0);
        let variance = colors.iter().flat_map(|v| [0, 1, 2].map(|c| (v[c] - mean[c]).powi(2))).sum::<f64>() / 3072.0;
        (mean, variance)
    };
    (0..SMALL[0] * SMALL[1]).map(of).collect()
}

fn antialiased() -> CpuAfterimage {
    let foveation = Foveation { fovea_deg: 180.0, mid_deg: 180.0, rate_mid: 2, rate_far: 4, ..Foveation::quads() };
    let method = Method::Smr(Smr { antialias: true, ..Smr::default() });
    let settings = Settings { method, foveation, ..Settings::default() };
    CpuAfterimage::new(&ContextDesc { settings, ..ContextDesc::new(SMALL) }).unwrap()
}

/// Shows frame `index` of the still picture.
fn show(post: &mut CpuAfterimage, index: u64, step: u32, light: f32) -> Color {
    one(post, index, &frame(index, step, jitter_of_turn(index, step), |at| picture(at).map(|v| v * light))).0
}

fn mse(shown: &Color, means: &[([f64; 3], f64)], light: f64) -> f64 {
    let of = |(s, (mean, _)): (&[f32; 3], &([f64; 3], f64))| {
        (0..3).map(|c| (f64::from(s[c]) - light * mean[c]).powi(2)).sum::<f64>() / 3.0
    };
    shown.pixels().iter().zip(means).map(of).sum::<f64>() / means.len() as f64
}

/// Without history a pixel of the fovea shows the color of the samples around at its centre: that of a slope, and on
/// detail below a pixel nearer to the mean over the pixel than its sample.
#[test]
fn a_first_frame_of_the_fovea_shows_the_samples_around_the_centres() {
    let slope = |[x, y]: [f32; 2]| [0.2 + 0.01 * x, 0.8 - 0.02 * y, 0.3 + 0.005 * (x + y)];
    let means = box_means();
    let inner = || pixels(SMALL).filter(|&[x, y]| x > 0 && y > 0 && x + 1 < SMALL[0] && y + 1 < SMALL[1]);
    let (mut samples, mut shown) = (0.0, 0.0);
    for index in 1..=16 {
        let jitter_px = Foveation::jitter_px(index);
        // Largest distance from the slope's colors at the centres.
        let off = |told_px: [f32; 2]| {
            let view = frame(index, 1, jitter_px, slope).with(|view| view.facts.jitter_px = told_px);
            let first = one(&mut antialiased(), index, &view).0;
            let of_px = |px: [u32; 2]| {
                let (shown, right) = (pixel(&first, px), slope(px.map(|v| v as f32)));
                (0..3).map(|c| (shown[c] - right[c]).abs()).fold(0.0, f32::max)
            };
            inner().map(of_px).fold(0.0, f32::max)
        };
        // A planted error: jitter of the wrong sign.
        let (right, planted) = (off(jitter_px), off(jitter_px.map(|px| -px)));
        assert!(right < 1e-6 && planted > 1e-4, "frame {index}: {right:e}, planted error {planted:e}");
        samples += mse(&sampled(jitter_px, picture), &means, 1.0);
        shown += mse(&show(&mut antialiased(), index, 1, 1.0), &means, 1.0);
    }
    let db = 10.0 * (samples / shown).log10();
    println!("{db:.2} dB better than the samples");
    assert!(db > 2.0);
}

/// What is not there does not count around a pixel's centre: one color stays that color bit for bit, also beside
/// pixels that are not finite, and with any jitter.
#[test]
fn one_color_stays_that_color_around_the_centres() {
    const COLOR: [f32; 3] = [0.7, 0.1, 1.0 / 3.0];
    let is_bad = |[x, y]: [u32; 2]| x % 4 == 1 && y % 3 == 1;
    for (index, jitter_px) in [[0.0, 0.0], [0.5, -0.5], [-0.31, 0.17], [0.6, 0.0], [-9.0, 16.0]].into_iter().enumerate()
    {
        let view = frame(index as u64, 1, jitter_px, |_| COLOR).with(|view| {
            view.color = Image::from_fn(SMALL, |px| if is_bad(px) { [f32::NAN, f32::INFINITY, 0.5] } else { COLOR });
        });
        let first = one(&mut antialiased(), index as u64, &view).0;
        let changed = pixels(SMALL).filter(|&px| !is_bad(px) && pixel(&first, px) != COLOR).count();
        assert_eq!(changed, 0, "jitter {jitter_px:?}");
    }
}

/// The mean of N independent samples has 1/N of the variance of one sample. Samples of low discrepancy have a lower
/// variance. With a step of 4, neighbours that judge a sample lie 4 pixels apart: this picture's detail makes some
/// means start again, and the last number is a lower bound instead of 1/N.
#[test]
fn the_mean_of_a_still_is_the_mean_over_the_pixel_within_its_statistics() {
    let means = box_means();
    let variance = variance_of(&means);
    for (step, frames, samples) in [(1, 60, MOST_SAMPLES), (2, 240, MOST_SAMPLES), (4, 480, 8.0)] {
        let mut post = antialiased();
        let shown = (0..frames).map(|index| show(&mut post, index, step, 1.0)).last().unwrap();
        let error = mse(&shown, &means, 1.0);
        println!(
            "step {step}: mean squared error {error:.2e}, of one sample {variance:.2e}: 1/{:.0}",
            variance / error
        );
        assert!(error < variance / f64::from(samples), "step {step}");
    }
}

/// Mean variance of one sample around the means.
fn variance_of(means: &[([f64; 3], f64)]) -> f64 {
    means.iter().map(|m| m.1).sum::<f64>() / means.len() as f64
}

#[test]
fn a_still_does_not_drift_over_two_thousand_frames() {
    let mut post = antialiased();
    let mut sums = [[0.0; 3]; 2];
    for index in 0..2_000 {
        let shown = show(&mut post, index, 1, 1.0);
        // Whole periods of the jitter.
        let part = match index {
            100..325 => 0,
            1_775..2_000 => 1,
            _ => continue,
        };
        for c in shown.pixels() {
            (0..3).for_each(|i| sums[part][i] += f64::from(c[i]) / (225.0 * shown.pixels().len() as f64));
        }
    }
    let drift = [0, 1, 2].map(|i| sums[1][i] - sums[0][i]);
    println!("drift over 2,000 frames: {drift:?}");
    assert!(drift.iter().all(|d| d.abs() < 5e-4), "{drift:?}");
}

#[test]
fn a_step_of_light_is_followed() {
    let means = box_means();
    for light in [0.5, 2.0] {
        let mut post = antialiased();
        let settled = (0..128).map(|index| show(&mut post, index, 2, 1.0)).last().unwrap();
        let after: Vec<Color> = (128..136).map(|index| show(&mut post, index, 2, light)).collect();
        let relative = |shown: &Color| (mse(shown, &means, f64::from(light)) / f64::from(light * light)).sqrt();
        println!(
            "light times {light}: error before {:.4}, after 1 frame {:.4}, 8 frames {:.4}",
            mse(&settled, &means, 1.0).sqrt(),
            relative(&after[0]),
            relative(&after[7])
        );
        // Each pixel has two samples of the new light: without history, the error would be above half of one sample's.
        assert!(relative(&after[7]) < 0.5 * variance_of(&means).sqrt(), "times {light}");
    }
}

/// Coverage of the nearer one of two surfaces that meet in a slanted edge.
fn nearer([x, y]: [f32; 2]) -> bool {
    0.83 * x + 0.55 * y < 17.3
}

/// Depth and motion of an edge tremble with the jitter. If history were rejected as disoccluded whenever the trembling
/// edge moves across a pixel, the pixels of the edge would stay single samples.
#[test]
fn a_silhouette_is_a_mean_of_both_surfaces() {
    let points = points(32);
    for (step, samples) in [(1, 16.0), (2, 16.0), (4, 4.0)] {
        let mut post = antialiased();
        let frame = |index| {
            let jitter_px = jitter_of_turn(index, step);
            let depth = sampled(jitter_px, |at| if nearer(at) { 2.0 } else { 5.0 });
            let view = frame(index, step, jitter_px, |at| if nearer(at) { [0.8; 3] } else { picture(at) });
            View { depth: Some(depth), ..view }
        };
        let frames = 0..u64::from(240 * step / 2);
        let shown = frames.map(|index| one(&mut post, index, &frame(index)).0).last().unwrap();
        let (mut error, mut variance, mut edge) = (0.0, 0.0, 0);
        for (i, shown) in shown.pixels().iter().enumerate() {
            let [x, y] = [i % 32, i / 32].map(|v| v as f32);
            // Pixels whose nearest surface, or that of a neighbour, trembles.
            if !(-1.5..1.5).contains(&(0.83 * x + 0.55 * y - 17.3)) {
                continue;
            }
            let color =
                |p: &[f32; 2]| if nearer([x + p[0], y + p[1]]) { 0.8 } else { picture([x + p[0], y + p[1]])[0] };
            let mean = points.iter().map(|p| f64::from(color(p))).sum::<f64>() / 1024.0;
            variance += points.iter().map(|p| (f64::from(color(p)) - mean).powi(2)).sum::<f64>() / 1024.0;
            error += (f64::from(shown[0]) - mean).powi(2);
            edge += 1;
        }
        println!("step {step}: {edge} pixels, squared error {:.1e} of {:.1e}", error, variance);
        assert!(edge > 20 && error < variance / samples, "step {step}: {error} of {variance}");
    }
}

/// Two surfaces with bars of a pixel and a half that glide past each other, and the edge between them, in a frame.
struct Gliding {
    edge_px: f32,
    /// Position of the bars of the nearer surface, and of the other one.
    bars_px: [f32; 2],
    /// Velocities in pixels a frame.
    velocity_px: [f32; 2],
}

impl Gliding {
    fn at(index: u64, velocity_px: [f32; 2]) -> Self {
        let bars_px = velocity_px.map(|v| v * index as f32);
        Self { edge_px: 16.0 - 10.0 * velocity_px[0].signum() + bars_px[0], bars_px, velocity_px }
    }

    fn surface(&self, [x, y]: [f32; 2]) -> usize {
        usize::from(x + 0.1 * y >= self.edge_px)
    }

    fn color(&self, [x, y]: [f32; 2]) -> [f32; 3] {
        let surface = self.surface([x, y]);
        let phase = (x - self.bars_px[surface] + 0.13 * y).rem_euclid(5.0);
        [[0.6, 0.2][surface] + if phase < 1.5 { 0.2 } else { 0.0 }; 3]
    }
}

/// Share of the contrast of bars that is shown: the slope of the shown values over the means over the pixels, 2.5
/// to 6.5 pixels from the edge and farther away, each on the nearer surface and on the other one.
fn shown_contrast(velocity_px: [f32; 2]) -> [[f64; 2]; 2] {
    let (mut post, points) = (antialiased(), points(8));
    let mut sums = [[[0.0; 5]; 2]; 2];
    for index in 0..80 {
        let now = Gliding::at(index, velocity_px);
        let view = View {
            depth: Some(sampled([0.0; 2], |at| [2.0, 5.0][now.surface(at)])),
            motion: Some(sampled([0.0; 2], |at| [-now.velocity_px[now.surface(at)], 0.0])),
            ..frame(index, 1, Foveation::jitter_px(index + 1), |at| now.color(at))
        };
        let out = one(&mut post, index, &view).0;
        for (i, shown) in out.pixels().iter().enumerate().filter(|_| index >= 40) {
            let at = [i % SMALL[0] as usize, i / SMALL[0] as usize].map(|v| v as f32);
            let edge_px = (at[0] + 0.1 * at[1] - now.edge_px).abs();
            // Surfaces that come into view from the sides have little history.
            if edge_px < 2.5 || !(4.0..28.0).contains(&at[0]) {
                continue;
            }
            let of = |p: &[f32; 2]| f64::from(now.color([at[0] + p[0], at[1] + p[1]])[0]);
            let expected = points.iter().map(of).sum::<f64>() / points.len() as f64;
            let shown = f64::from(shown[0]);
            let add = [1.0, expected, shown, expected * expected, expected * shown];
            let sum = &mut sums[usize::from(edge_px >= 6.5)][now.surface(at)];
            (0..5).for_each(|k| sum[k] += add[k]);
        }
    }
    sums.map(|sums| sums.map(|[n, x, y, xx, xy]| (n * xy - x * y) / (n * xx - x * x)))
}

/// At full rate, bars beside an edge show as much contrast as bars elsewhere, within 15 %. It was a tenth while the
/// samples around a pixel did not count: beside an edge means are shorter, so that they count more there, and soften.
#[test]
fn bars_beside_an_edge_are_not_softer_than_elsewhere() {
    for velocity_px in [[0.3, 0.1], [-0.3, 0.1]] {
        let [beside, elsewhere] = shown_contrast(velocity_px);
        println!("{velocity_px:?}: {beside:?}, elsewhere {elsewhere:?}");
        let is_sharp = (0..2).all(|k| beside[k] >= 0.85 * elsewhere[k]);
        assert!(is_sharp, "{velocity_px:?}: {beside:?}, elsewhere {elsewhere:?}");
    }
}

/// Pixels beside a silhouette that glides, and those of them that do not show the farther surface. Depth and motion are
/// those of the samples, or of the pixels' centres.
fn dots(step: u32, is_of_samples: bool) -> [usize; 2] {
    let mut post = antialiased();
    let (mut dots, mut pixels) = (0, 0);
    for index in 0..60 {
        // The nearer surface, whose color is another, glides to the left.
        let edge_px = 28.0 - 0.4 * index as f32;
        let near = |[x, y]: [f32; 2]| x + 0.2 * y < edge_px;
        let jitter_px = Foveation::jitter_px(index + 1);
        let of_depth = if is_of_samples { jitter_px } else { [0.0; 2] };
        let view = View {
            depth: Some(sampled(of_depth, |at| if near(at) { 2.0 } else { 5.0 })),
            motion: Some(sampled(of_depth, |at| [if near(at) { 0.4 } else { 0.0 }, 0.0])),
            ..frame(index, step, jitter_px, |at| if near(at) { [0.8; 3] } else { [0.2; 3] })
        };
        let shown = one(&mut post, index, &view).0;
        for (i, c) in shown.pixels().iter().enumerate().filter(|_| index >= 20) {
            let [x, y] = [i % SMALL[0] as usize, i / SMALL[0] as usize].map(|v| v as f32);
            if x + 0.2 * y > edge_px + 1.5 {
                pixels += 1;
                dots += usize::from((c[0] - 0.2).abs() > 0.02);
            }
        }
    }
    [dots, pixels]
}

/// A sample beside a silhouette that was stored with the depth of another surface stays as a dot where the silhouette
/// moves away: the planted error. Where a sample is rare, some pixels beside it show the nearer surface in any case.
#[test]
fn a_moving_silhouette_leaves_few_dots() {
    for (step, share, least) in [(2, 0.001, 4.0), (4, 0.02, 1.2)] {
        let [[dots, pixels], [planted, _]] = [true, false].map(|is_of_samples| dots(step, is_of_samples));
        println!("step {step}: {dots} of {pixels} pixels beside the silhouette are not of the farther surface,");
        println!("{planted} with depth of other places than the samples'");
        let [dots, pixels, planted] = [dots, pixels, planted].map(|count| count as f64);
        assert!(dots <= share * pixels && planted > least * dots, "step {step}: {dots}, {planted} of {pixels}");
    }
}
