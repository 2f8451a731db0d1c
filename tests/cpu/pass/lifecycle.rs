//! Determinism, reset, resize, errors.

use super::depth::run_law;
use super::*;
use crate::lifecycle_hard::*;
use afterimage::FrameValue;
use afterimage_testing::holds;

lifecycle_laws!(Cpu, run_law);

fn run(post: &mut CpuAfterimage, frames: std::ops::Range<u64>) -> Vec<Color> {
    frames.map(|i| one(post, i, &still(noise(SIZE, &format!("run {i}")))).0).collect()
}

#[test]
fn h29_the_same_bytes_whatever_the_number_of_threads() {
    for settings in [
        Settings::paper(),
        wrs(Wrs { sampler: Sampler::AEs, bias: Bias::Exponential { lambda: 0.05 }, ..Wrs::default() }),
    ] {
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut post = context(settings);
                (run(&mut post, 0..20), post.history().words().to_vec())
            })
        };
        let of_two = with(2);
        assert!([1, 7, 2].into_iter().all(|threads| with(threads) == of_two), "{:?}", settings.method);
    }
    let other_seed = run(&mut context(Settings { seed: 1, ..Settings::paper() }), 0..20);
    assert_ne!(other_seed, run(&mut context(Settings::paper()), 0..20));
    afterimage_testing::holds!("H29", Cpu, "20 frames of two samplers bit-equal on 1, 2 and 7 threads, and again");
}

#[test]
fn a_frame_that_is_refused_changes_nothing() {
    let settings = ungated();
    let (mut good, mut mixed) = (context(settings), context(settings));
    let expected = run(&mut good, 0..6);
    let mut got = run(&mut mixed, 0..3);
    let words = mixed.history().words().to_vec();
    let bad = |view: &View, exposure: Exposure, out: &mut [Color], mixed: &mut CpuAfterimage| {
        let images = Images::of([view]);
        mixed.process(&Frame { reset: Reset::All, exposure, ..images.frame(3) }, out).unwrap_err()
    };
    let right = still(noise(SIZE, "right"));
    let small = Some(Image::filled([3, 4], 1.0));
    for (view, out_size) in [
        (View { color: noise([3, 4], "small"), ..right.clone() }, SIZE),
        (View { depth: small.clone(), ..right.clone() }, SIZE),
        (View { trust: small.clone(), ..right.clone() }, SIZE),
        (View { lod: small, ..right.clone() }, SIZE),
        (right.clone().with(|view| view.facts.previous_from_current = Some([[f32::NAN; 4]; 4])), SIZE),
        (right.clone(), [9, 9]),
    ] {
        let mut out = [Image::filled(out_size, [0.5; 3])];
        let error = bad(&view, Exposure::Same, &mut out, &mut mixed);
        println!("{error}");
        assert!(out[0].pixels().iter().all(|&c| c == [0.5; 3]), "nothing was written");
    }
    let none = bad(&right, Exposure::Same, &mut [], &mut mixed);
    assert_eq!(none, FrameError::ViewCount { found: 0, expected: 1 });
    let changed = [0.0, -1.0, f32::NAN, f32::INFINITY].map(|ratio| Exposure::Changed { ratio });
    let of_scene = [0.0, -1.0, f32::NAN, f32::INFINITY, 2.0_f32.powi(-41), 2.0_f32.powi(41)];
    for exposure in changed.into_iter().chain(of_scene.map(|exposure| Exposure::Scene { exposure })) {
        let error = bad(&right, exposure, &mut [right.color.clone()], &mut mixed);
        assert!(matches!(error, FrameError::Value { value: FrameValue::Exposure, .. }), "{error}");
    }
    assert_eq!(mixed.history().words(), words);
    got.extend(run(&mut mixed, 3..6));
    assert_eq!(got, expected);
}

#[test]
fn h76_empty_and_huge_sizes_are_refused_and_a_pixel_is_enough() {
    for size in [[0, 0], [0, 5], [5, 0], [1 << 20, 1]] {
        assert!(CpuAfterimage::new(&ContextDesc { settings: Settings::paper(), ..ContextDesc::new(size) }).is_err());
        let mut post = context(Settings::paper());
        assert!(matches!(post.resize(size), Err(FrameError::Extent { .. })));
        assert_eq!(post.desc().size_px, SIZE);
    }
    let mut post =
        CpuAfterimage::new(&ContextDesc { settings: Settings::paper(), ..ContextDesc::new([1, 1]) }).unwrap();
    let input = View { depth: Some(Image::filled([1, 1], 1.0)), ..still(noise([1, 1], "one")) };
    assert_eq!(one(&mut post, 0, &input).0, input.color);
    assert_eq!(one(&mut post, 1, &input).0, input.color);
    holds!("H76", Cpu, "0x0, 0x5, 5x0 and 2^20 x 1 are refused, the context stays as it was; 1x1 works");
}
