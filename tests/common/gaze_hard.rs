//! Hard cases of gaze, H63 and H66: laws that hold on either executor.

use crate::depth_hard::{Color, METHODS, Made, Make, SIZE, desc, of, still};
use crate::images::{View, noise};
use crate::settings::ungated;
use afterimage::Gaze;
use afterimage::internal::ContextDesc;

/// The laws as tests of an executor. `$run_law` runs one, and returns what it measured.
macro_rules! gaze_laws {
    ($side:ident, $run_law:ident) => {
        crate::laws::laws! { $side, $run_law,
            h63_a_lost_gaze_is_held_then_centred_at_the_start: "H63", lost_gaze;
            h66_a_saccade_keeps_the_old_fovea_and_it_decays_as_theory_says: "H66", saccade;
        }
    };
}
pub(crate) use gaze_laws;

fn at(x: f32, y: f32) -> Gaze {
    Gaze::At { px: [x, y] }
}

fn gazing(color: Color, gaze: Gaze) -> View {
    let mut view = still(color);
    view.facts.gaze = gaze;
    view
}

/// A gaze that is lost, not a number, or far away.
pub fn lost_gaze(make: Make<'_>) -> Option<String> {
    let weights = |gazes: &[Gaze]| -> Option<Vec<f32>> {
        let mut post = make(desc(ungated()))?;
        let mut weights = vec![];
        for (index, &gaze) in (0..).zip(gazes) {
            let trace = post.step(index, &gazing(noise(SIZE, "gaze"), gaze)).trace;
            weights = trace.pixels().iter().map(|t| t.weight).collect();
            assert!(weights.iter().all(|w| w.is_finite() && *w > 0.0));
        }
        Some(weights)
    };
    let (here, nan, infinite) = (at(9.0, 9.0), at(f32::NAN, 3.0), at(f32::INFINITY, 3.0));
    let there = weights(&[here])?;
    for held in [&[Gaze::Lost][..], &[Gaze::Lost, Gaze::Lost], &[nan], &[nan, infinite], &[Gaze::Lost, infinite]] {
        assert_eq!(weights(&[&[here], held].concat())?, there, "{held:?}");
    }
    assert_eq!(weights(&[Gaze::Lost])?, weights(&[at(31.5, 23.5)])?);
    assert_ne!(weights(&[at(-5000.0, 1e30)])?, there);
    // The output depends on the resolved gaze position, and on that alone.
    for method in METHODS {
        let shown = |gazes: &[Gaze]| -> Option<Vec<Color>> {
            let mut post = make(of(method))?;
            let frames = (0..).zip(gazes);
            Some(
                frames.map(|(i, &gaze)| post.step(i, &gazing(noise(SIZE, &format!("gaze {i}")), gaze)).shown).collect(),
            )
        };
        let expected = shown(&[at(31.5, 23.5), here, here, here])?;
        assert!(shown(&[Gaze::Lost, here, Gaze::Lost, at(3.0, f32::NAN)])? == expected, "{method:?}");
        assert!(shown(&[Gaze::Lost, here, Gaze::Lost, at(50.0, 9.0)])? != expected, "{method:?}");
    }
    Some("wrs and smr: lost, NaN and infinite are held, the middle before any; 1e30 px off: weights finite".into())
}

/// Watson's density in f64, up to constant factors.
pub fn density64(e_deg: f64) -> f64 {
    (0.9851 / (1.0 + e_deg / 1.058).powi(2) + 0.0149 * (-e_deg / 22.14).exp()) / (1.0 + e_deg / 41.03)
}

/// A gaze that moves by 20 degrees.
pub fn saccade(make: Make<'_>) -> Option<String> {
    // Degrees are 6 pixels, so that a fovea of 5 degrees is some 700 of them.
    const WIDE: [u32; 2] = [480, 48];
    let geometry = View::still(noise(WIDE, ""), [0.0; 2]).facts.geometry;
    let [old, new] = [20.0_f32, 0.0].map(|e| geometry.project([-e.to_radians().tan(), 0.0, 1.0]).unwrap());
    let mut post = make(ContextDesc { settings: ungated(), ..ContextDesc::new(WIDE) })?;
    let frame = |index: u64, px| View::still(noise(WIDE, &format!("h66 {index}")), px);
    let before: Vec<_> = (0..18).map(|index| frame(index, old)).collect();
    for (index, view) in (0..).zip(&before) {
        post.step(index, view);
    }
    let ecc = [old, new].map(|px| geometry.eccentricity_map(px));
    let fovea: Vec<usize> = (0..480 * 48).filter(|&i| ecc[0].pixels()[i] < 2.5).collect();
    // Sums and survival of each pixel in f64: 18 candidates of weight 1, then those of its new eccentricity b: a = a^2
    // / (a + b) + b.
    let weight = |e: f64| (density64(e) / density64(2.5)).min(1.0);
    let b: Vec<f64> = fovea.iter().map(|&i| weight(ecc[1].pixels()[i].into())).collect();
    let mut sums = vec![(0..17).fold(1.0_f64, |a, _| a * a / (a + 1.0) + 1.0); fovea.len()];
    let mut alive = vec![1.0_f64; fovea.len()];
    let spread = |shares: &[f64]| shares.iter().fold((0.0, 0.0), |(m, v), s| (m + s, v + s * (1.0 - s)));
    let mut half_life = None;
    for n in 1..=150_u64 {
        let Made { shown: out, trace, .. } = post.step(17 + n, &frame(17 + n, new));
        for ((a, s), b) in sums.iter_mut().zip(&mut alive).zip(&b) {
            *a = *a * *a / (*a + b) + b;
            *s *= 1.0 - b / *a;
        }
        // The sample is from one of the 18 frames, so at least as old as the saccade.
        let kept: Vec<usize> = fovea.iter().copied().filter(|&i| u64::from(trace.pixels()[i].age) >= n).collect();
        for &i in &kept {
            let shown = out.pixels()[i];
            assert!(before.iter().any(|view| view.color.pixels()[i] == shown), "frame {n}, pixel {i}");
        }
        let kept = kept.len() as f64;
        let (mean, variance) = spread(&alive);
        if [1, 10, 30, 63, 100, 150].contains(&n) {
            afterimage_testing::accept(
                &format!("{n} frames after: {kept} of {mean:.1} kept"),
                afterimage_testing::p_of_z((kept - mean) / f64::sqrt(variance)),
            );
        }
        if n == 63 {
            // Plain sums, without decay: 18 of 18 + n b.
            let (mean, variance) = spread(&b.iter().map(|b| 18.0 / (18.0 + 63.0 * b)).collect::<Vec<_>>());
            afterimage_testing::reject("without bias", afterimage_testing::p_of_z((kept - mean) / f64::sqrt(variance)));
        }
        if kept < 0.5 * fovea.len() as f64 {
            half_life.get_or_insert(n);
        }
    }
    let half_life = half_life.expect("half of it is gone in 100 frames");
    // n50 = ln 2 (a0 + b) / b + (ln 2)^2 / 2 with a0 = 5.42 and b of 20 degrees.
    let ln2 = std::f64::consts::LN_2;
    let theory = ln2 * (5.42 + weight(20.0)) / weight(20.0) + ln2 * ln2 / 2.0;
    assert!((half_life as f64 - theory).abs() < 10.0, "{half_life} for {theory}");
    let count = fovea.len();
    Some(format!("wrs: {count} px of the old fovea, half of them gone after {half_life} frames, by theory {theory:.1}"))
}
