//! Synthetic scanpaths against their documented distributions.
//!
//! Seeds are independent of one another and chosen before the first run. A test fails below p = 1e-4: with the ten
//! p-values here, a correct generator with other seeds fails one time in a thousand.

use afterimage_lab::scanpath::*;
use afterimage_testing::{p_of_counts, p_of_z};
use std::sync::LazyLock;

const RUNS: u64 = 30;
const DURATION_S: f64 = 60.0;
const P_LEAST: f64 = 1e-4;

static MADE: LazyLock<Vec<Synthetic>> = LazyLock::new(|| {
    let make = |i: u64| {
        let seed = i.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x5ca1_ab1e;
        generate(&SyntheticOptions { seed, duration_s: DURATION_S, ..Default::default() }).unwrap()
    };
    (0..RUNS).map(make).collect()
});

fn of(kind: EventKind) -> Vec<Event> {
    let all = MADE.iter().flat_map(|made| &made.events);
    all.filter(|e| e.kind == kind).copied().collect()
}

fn length_s(e: &Event) -> f64 {
    e.end_s - e.start_s
}

/// Samples during an event.
fn during(samples: &[Sample], e: &Event) -> std::ops::Range<usize> {
    samples.partition_point(|s| s.t_s < e.start_s)..samples.partition_point(|s| s.t_s < e.end_s)
}

/// Two-sided test of a sum of independent draws with known mean and standard deviation.
fn check_z(what: &str, found: f64, expected: f64, sd: f64) {
    let z = (found - expected) / sd;
    let p = p_of_z(z);
    println!("{what}: {found:.6}, expected {expected:.6} +- {sd:.6}, z = {z:.2}, p = {p:.4}");
    assert!(p > P_LEAST, "{what}: p = {p:e}");
}

/// Tests for a uniform distribution: range, mean, and shape by chi-squared over ten bins.
pub fn check_uniform(what: &str, draws: &[f64], [low, high]: [f64; 2]) {
    let slack = 1e-9;
    assert!(draws.iter().all(|d| (low - slack..=high + slack).contains(d)), "{what}");
    let sd = (high - low) / 12f64.sqrt() / (draws.len() as f64).sqrt();
    check_z(what, draws.iter().sum::<f64>() / draws.len() as f64, 0.5 * (low + high), sd);
    let mut bins = [0; 10];
    for d in draws {
        bins[(((d - low) / (high - low) * 10.0).max(0.0) as usize).min(9)] += 1;
    }
    let p = p_of_counts(&bins, &[draws.len() as f64 / 10.0; 10]);
    println!("{what}: shape, p = {p:.4}");
    assert!(p > P_LEAST, "{what}: shape, p = {p:e}");
}

#[test]
fn fixations_landings_undershoot_and_microsaccades_are_distributed_as_claimed() {
    let lengths = |kind| of(kind).iter().map(length_s).collect::<Vec<_>>();
    check_uniform("fixation / s", &lengths(EventKind::Fixation), [0.2, 0.4]);
    check_uniform("landing / s", &lengths(EventKind::Landing), [0.12, 0.18]);
    let short = |e: &Event| 1.0 - e.amplitude_deg / e.intended_deg;
    let undershoot: Vec<_> = of(EventKind::Saccade).iter().map(short).collect();
    check_uniform("undershoot", &undershoot, [0.04, 0.12]);
    let micro: Vec<_> = of(EventKind::Microsaccade).iter().map(|e| e.amplitude_deg).collect();
    check_uniform("microsaccade / deg", &micro, [0.2, 1.0]);
    // One per fixation with probability 2 Hz x length: a sum of independent Bernoulli draws.
    let chances: Vec<f64> = of(EventKind::Fixation).iter().map(|e| 2.0 * length_s(e)).collect();
    let sd = chances.iter().map(|p| p * (1.0 - p)).sum::<f64>().sqrt();
    let fixated_s = chances.iter().sum::<f64>() / 2.0;
    check_z("microsaccades / s of fixation", micro.len() as f64 / fixated_s, 2.0, sd / fixated_s);
}

#[test]
fn events_tile_the_time_and_follow_the_grammar() {
    for made in MADE.iter() {
        let main: Vec<_> = made.events.iter().filter(|e| e.kind != EventKind::Microsaccade).collect();
        assert_eq!((main[0].kind, main[0].start_s), (EventKind::Fixation, 0.0));
        for pair in main.windows(2) {
            assert!((pair[1].start_s - pair[0].end_s).abs() < 1e-9);
            use EventKind::*;
            let kinds = (pair[0].kind, pair[1].kind);
            let may_follow = match kinds.0 {
                Fixation => &[Saccade][..],
                Saccade => &[Fixation, Landing],
                Landing => &[Corrective],
                _ => &[Fixation],
            };
            assert!(may_follow.contains(&kinds.1), "{kinds:?}");
            let error_deg = pair[0].intended_deg - pair[0].amplitude_deg;
            assert_eq!(kinds == (Saccade, Landing), pair[0].kind == Saccade && error_deg > 0.5);
        }
        assert!(main.last().unwrap().end_s >= DURATION_S - 1.0 / 500.0);
        let fixations = main.iter().filter(|e| e.kind == EventKind::Fixation);
        let inside = |m: &&Event| fixations.clone().any(|f| f.start_s <= m.start_s && m.end_s <= f.end_s + 1e-9);
        assert!(made.events.iter().filter(|e| e.kind == EventKind::Microsaccade).all(|m| inside(&m)));
        let amplitudes = main.iter().filter(|e| e.kind == EventKind::Saccade).map(|e| e.intended_deg);
        assert!(amplitudes.into_iter().all(|a| (2.5 - 1e-9..=18.0 + 1e-9).contains(&a)));
    }
}

/// Ray of a sample, from the screen's size in centimetres: shares no code with the generator.
fn ray(path: &Scanpath, sample: &Sample) -> [f64; 3] {
    let (screen, px) = (path.screen(), sample.px.unwrap());
    let cm = |i: usize| (f64::from(px[i]) / f64::from(screen.size_px[i]) - 0.5) * f64::from(screen.size_cm.unwrap()[i]);
    let v = [cm(0), cm(1), f64::from(screen.distance_cm.unwrap())];
    let length = v.iter().map(|c| c * c).sum::<f64>().sqrt();
    v.map(|c| c / length)
}

/// Angle between unit vectors, from their chord.
fn angle_deg(a: [f64; 3], b: [f64; 3]) -> f64 {
    let chord = (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
    (2.0 * (0.5 * chord).asin()).to_degrees()
}

/// From the samples alone: squared steps within fixations, in units of half their claimed mean, are chi-squared with
/// two degrees of freedom each.
#[test]
fn drift_moves_0_035_degrees_rms_in_a_sixtieth_of_a_second() {
    let (mut sum_deg2, mut steps) = (0.0, 0.0);
    for made in MADE.iter() {
        let samples = made.path.samples();
        let rest = |e: &&Event| matches!(e.kind, EventKind::Fixation | EventKind::Landing);
        let turns: Vec<_> = made.events.iter().filter(|e| !rest(e)).collect();
        for e in made.events.iter().filter(rest) {
            for pair in samples[during(samples, e)].windows(2) {
                if turns.iter().any(|t| t.start_s < pair[1].t_s && pair[0].t_s < t.end_s) {
                    continue;
                }
                sum_deg2 += angle_deg(ray(&made.path, &pair[0]), ray(&made.path, &pair[1])).powi(2);
                steps += 1.0;
            }
        }
    }
    // One squared step has mean m and standard deviation m.
    let step_deg2 = 0.035f64.powi(2) * 60.0 / 500.0;
    let found = sum_deg2 / steps / step_deg2;
    check_z("drift, squared step / claimed one", found, 1.0, 1.0 / f64::sqrt(steps));
    println!("drift: {:.5} deg rms in 1/60 s, {steps} steps", (sum_deg2 / steps * 500.0 / 60.0).sqrt());
}

#[test]
fn gaze_stays_on_the_screen_and_visits_all_of_it() {
    for (size_cm, distance) in [([84.0, 47.3], 60.0), ([38.0, 30.0], 67.0), ([8.5, 8.5], 60.0)] {
        let screen = Screen { size_px: [1000, 800], size_cm: Some(size_cm), distance_cm: Some(distance) };
        // Many hours at a low rate, because excursions to the edge are rare.
        let made = generate(&SyntheticOptions { seed: 7, screen, duration_s: 5_000.0, rate_hz: 50.0 }).unwrap();
        let mut quarters = [0usize; 4];
        for sample in made.path.samples() {
            let r = ray(&made.path, sample);
            for i in 0..2 {
                let half = (0.5 * size_cm[i] / distance).atan().to_degrees();
                assert!(((r[i] / r[2]).atan().to_degrees()).abs() <= f64::from(half) - 0.499, "{r:?}");
            }
            quarters[usize::from(r[0] > 0.0) + 2 * usize::from(r[1] > 0.0)] += 1;
        }
        println!("{size_cm:?} cm at {distance} cm: samples per quarter {quarters:?}");
        assert!(quarters.iter().all(|n| n * 10 > made.path.samples().len()), "{quarters:?}");
    }
}
