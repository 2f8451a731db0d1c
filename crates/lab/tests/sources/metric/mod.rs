//! Metrics against hand-calculated cases and an oracle in f64, and the cost of gaze latency (H68).

mod crop;
mod flip;
mod weighted;

use afterimage::internal::{Foveation, Pyramid};
use afterimage::{Image, ViewGeometry};
use afterimage_lab::frame::SourceFrame;
use afterimage_lab::metric::{self, Band, Flip, NO_PAST, References, Scorer, Scores, Tracker};
use afterimage_testing::{Draws, holds};
use approx::assert_abs_diff_eq;

fn noise(size: [u32; 2], name: &str) -> Image<[f32; 3]> {
    let mut draws = Draws::new(name);
    Image::from_fn(size, |_| [draws.uniform(), draws.uniform(), draws.uniform()])
}

/// Reference and output, both encoded, and the frame's correspondence.
type Frame = (Image<[f32; 3]>, Image<[f32; 3]>, SourceFrame);

/// Scores of frames with the gaze at `gaze`. `flip`: where it is asked for.
fn score(frames: &[Frame], gaze: [f32; 2], flip: Option<Flip>) -> Scores {
    let view = ViewGeometry::flat(frames[0].0.size(), 70.0).unwrap();
    let ecc = view.eccentricity_map(gaze);
    let (mut tracker, mut scorer) = (Tracker::default(), Scorer::default());
    let mut references = flip.map_or_else(References::default, References::with_flip);
    for (reference, shown, frame) in frames {
        let tracked = tracker.advance(frame, &view, &ecc, &ecc);
        scorer.push(&references.next(reference, &tracked, &ecc), shown, &tracked, &ecc);
    }
    scorer.scores()
}

fn foveate(foveation: &Foveation, image: &Image<[f32; 3]>, gaze: [f32; 2]) -> Image<[f32; 3]> {
    let geometry = ViewGeometry::flat(image.size(), 70.0).unwrap();
    let lods = foveation.lod_map(&geometry, gaze);
    foveation.render(&Pyramid::new(image.clone(), foveation.max_level()), &lods)
}

#[test]
fn h68_the_error_at_the_true_gaze_grows_with_latency() {
    let size = [640, 360];
    let image = noise(size, "latency");
    let reference = metric::encode(&image, 0.0);
    // The gaze moves at 30 degrees a second; the foveation lags.
    let latencies_ms = [0.0, 10.0, 20.0, 30.0, 45.0, 60.0, 80.0, 100.0, 125.0, 150.0];
    let scores = latencies_ms.map(|latency_ms| {
        let lag_px = 30.0 * latency_ms / 1000.0 * 8.0;
        let shown = metric::encode(&foveate(&Foveation::default(), &image, [320.0 - lag_px, 180.0]), 0.0);
        let frame = SourceFrame { cut: true, ..source_frame(image.clone()) };
        let scores = score(&[(reference.clone(), shown, frame)], [320.0, 180.0], None);
        (scores.bands[0].mse.unwrap(), scores.weighted_psnr_db.unwrap())
    });
    for (ms, (mse, db)) in latencies_ms.iter().zip(scores) {
        println!("{ms} ms: mean squared error in the true fovea {mse:.4}, weighted {db:.2} dB");
    }
    assert_eq!(scores[0].0, 0.0);
    assert!(scores.windows(2).all(|w| w[0].0 <= w[1].0 && w[0].1 > w[1].1), "{scores:?}");
    let [none, half, all] = [0, 5, 9].map(|i| scores[i].1);
    let falls = "weighted PSNR falls at each of 10 latencies";
    holds!("H68", Cpu, "{falls}: {none:.2} dB at 0 ms, {half:.2} at 60, {all:.2} at 150");
}

fn source_frame(color: Image<[f32; 3]>) -> SourceFrame {
    SourceFrame { color, depth: None, motion: None, trust: None, previous_from_current: None, cut: false, nonfinite: 0 }
}

#[test]
fn psnr_ssim_and_flicker_of_known_errors() {
    let size = [96, 64];
    let reference = Image::filled(size, [0.5; 3]);
    let frame = |(i, offset): (usize, f32)| {
        let frame = SourceFrame { cut: i == 0, ..source_frame(reference.clone()) };
        (reference.clone(), reference.map(|c| c.map(|v| v + offset)), frame)
    };
    let frames: Vec<_> = [0.1_f32, -0.1, 0.1].into_iter().enumerate().map(frame).collect();
    let scores = score(&frames, [48.0, 32.0], None);
    assert_abs_diff_eq!(scores.whole.psnr_db.unwrap(), 20.0, epsilon = 1e-4);
    assert_abs_diff_eq!(scores.bands[2].psnr_db.unwrap(), 20.0, epsilon = 1e-4);
    assert_abs_diff_eq!(scores.flicker.unwrap(), 200.0, epsilon = 1e-2);
    // On flat patches SSIM reduces to its luminance term: (2 ab + c1) / (a^2 + b^2 + c1).
    let luminance = |a: f64, b: f64| (2.0 * a * b + 6.5025) / (a * a + b * b + 6.5025);
    let expected = (2.0 * luminance(127.5, 153.0) + luminance(127.5, 102.0)) / 3.0;
    assert_abs_diff_eq!(scores.whole.ssim.unwrap(), expected, epsilon = 1e-4);
    // An exact image has no PSNR.
    let scores = score(&[(reference.clone(), reference.clone(), source_frame(reference))], [48.0, 32.0], None);
    assert_eq!((scores.whole.psnr_db, scores.whole.mse), (None, Some(0.0)));
    assert_abs_diff_eq!(scores.whole.ssim.unwrap(), 1.0, epsilon = 1e-6);
}

/// SSIM by its definition in f64, window by window.
fn ssim64(a: &Image<[f32; 3]>, b: &Image<[f32; 3]>, x0: usize, y0: usize) -> f64 {
    let luma = |c: [f32; 3]| 255.0 * (0.2126 * f64::from(c[0]) + 0.7152 * f64::from(c[1]) + 0.0722 * f64::from(c[2]));
    let gauss = |d: usize| (-0.5 * ((d as f64 - 5.0) / 1.5).powi(2)).exp();
    let (mut sum, mut moments) = (0.0, [0.0; 5]);
    for (x, y) in (0..11).flat_map(|y| (0..11).map(move |x| (x, y))) {
        let w = gauss(x) * gauss(y);
        let (p, q) = (luma(a.at(x0 + x, y0 + y)), luma(b.at(x0 + x, y0 + y)));
        sum += w;
        moments.iter_mut().zip([p, q, p * p, q * q, p * q]).for_each(|(moment, v)| *moment += w * v);
    }
    let [ma, mb, aa, bb, ab] = moments.map(|moment| moment / sum);
    let (va, vb, cov) = (aa - ma * ma, bb - mb * mb, ab - ma * mb);
    let (c1, c2) = (2.55_f64.powi(2), 7.65_f64.powi(2));
    (2.0 * ma * mb + c1) * (2.0 * cov + c2) / ((ma * ma + mb * mb + c1) * (va + vb + c2))
}

#[test]
fn ssim_is_the_published_formula_at_full_resolution() {
    // Taller than a strip, and larger than the size above which the authors' script downsamples.
    let (a, mut b) = (noise([400, 420], "ssim a"), noise([400, 420], "ssim b"));
    for (p, q) in b.pixels_mut().iter_mut().zip(a.pixels()) {
        *p = [0, 1, 2].map(|i| 0.6 * q[i] + 0.4 * p[i]);
    }
    let map = metric::ssim_map(&a, &b).unwrap();
    assert_eq!(map.size(), [390, 410]);
    for (x, y) in [(0, 0), (389, 409), (17, 127), (17, 128), (200, 255), (3, 300)] {
        assert_abs_diff_eq!(f64::from(map.at(x, y)), ssim64(&a, &b, x, y), epsilon = 1e-3);
    }
    assert!(metric::ssim_map(&noise([10, 40], "s"), &noise([10, 40], "t")).is_none());
}

#[test]
fn bands_and_retention_follow_the_eye() {
    assert_eq!([0.0, 2.49, 2.5, 7.5, 7.51].map(|e| Band::of(e) as usize), [0, 0, 1, 1, 2]);
    let size = [320, 180];
    let geometry = ViewGeometry::flat(size, 70.0).unwrap();
    let foveation = Foveation::default();
    let mut tracker = Tracker::default();
    let mut look = |frame: &SourceFrame, gaze| {
        let ecc = geometry.eccentricity_map(gaze);
        let lods = foveation.lod_map(&geometry, gaze);
        tracker.advance(frame, &geometry, &ecc, &lods)
    };
    let mut frame = source_frame(noise(size, "track"));
    frame.cut = true;
    let first = look(&frame, [100.0, 90.0]);
    assert!(first.past.pixels().iter().all(|&p| p == NO_PAST) && !first.retained.pixels().contains(&true));
    frame.cut = false;
    let second = look(&frame, [220.0, 90.0]);
    assert!(second.retained.at(100, 90) && !second.retained.at(220, 90) && !second.retained.at(160, 20));
    assert_eq!(second.past.at(7, 3), 3 * 320 + 7);
    // Everything moves right by 5 px: retention follows.
    frame.motion = Some(Image::filled(size, [-5.0, 0.0]));
    let third = look(&frame, [220.0, 90.0]);
    let left_edge = |t: &metric::Tracked| (0..320).find(|&x| t.retained.at(x, 90)).unwrap();
    assert_eq!(left_edge(&third), left_edge(&second) + 5);
    assert_eq!(third.past.at(2, 0), NO_PAST, "came from outside");
    // Another surface is there now: retention ends.
    frame.motion = Some(Image::filled(size, [0.0; 2]));
    frame.depth = Some(Image::filled(size, 5.0));
    look(&frame, [220.0, 90.0]);
    frame.depth.as_mut().unwrap().pixels_mut()[90 * 320 + 105] = 1.0;
    assert!(!look(&frame, [220.0, 90.0]).retained.at(105, 90));
}

#[test]
fn flip_is_pooled_by_band_and_left_out_without_being_asked() {
    let size = [320, 180];
    let view = ViewGeometry::flat(size, 70.0).unwrap();
    let ecc = view.eccentricity_map([90.0, 100.0]);
    let reference = noise(size, "flip bands");
    let shown = foveate(&Foveation::default(), &reference, [90.0, 100.0]);
    let flip = Flip::for_view(&view);
    let frame = (reference.clone(), shown.clone(), source_frame(reference.clone()));
    let frames = [frame.clone(), frame];
    let scores = score(&frames, [90.0, 100.0], Some(flip.clone()));
    let map = flip.map(&reference, &shown);
    let mean_of = |band: Option<Band>| {
        let of_band = map.pixels().iter().zip(ecc.pixels()).filter(|(_, e)| band.is_none_or(|b| Band::of(**e) == b));
        let values: Vec<f64> = of_band.map(|(v, _)| f64::from(*v)).collect();
        values.iter().sum::<f64>() / values.len() as f64
    };
    for band in Band::ALL {
        assert_abs_diff_eq!(scores.bands[band as usize].flip.unwrap(), mean_of(Some(band)), epsilon = 1e-9);
    }
    assert_abs_diff_eq!(scores.whole.flip.unwrap(), mean_of(None), epsilon = 1e-9);
    // The fovea has full rate, but the filters include pixels around it.
    assert!(scores.bands[0].flip.unwrap() < 0.1 * scores.bands[2].flip.unwrap());
    let scores = score(&frames[..1], [90.0, 100.0], None);
    assert!(scores.whole.flip.is_none() && scores.bands.iter().all(|b| b.flip.is_none()));
}
