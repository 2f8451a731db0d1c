//! Reservoir arithmetic: closed forms P1-P8 and hard cases H01-H22, with statistics and planted errors.

mod common;

use afterimage::kernel::pack::{self, Stored};
use afterimage::kernel::reservoir::{self, Reservoir};
use afterimage::kernel::wrs::{self, BiasCode, GateCode, Past, SamplerCode, WrsParams};
use common::{Draws, accept, p_of_counts, p_of_rate, reject};
use glam::Vec3;
use proptest::prelude::*;

const PAPER: WrsParams = WrsParams {
    sampler: SamplerCode::AChao,
    bias: BiasCode::Bernoulli,
    exponential_survival: 1.0,
    gate: GateCode::Off,
    gate_offset: 0.0,
    inv_gate_divisor: 0.01,
};

/// History sum after one frame, with a gate of constant value `g` (as if the colours differed by 1 - g).
fn recur(a: f32, b: f32, g: f32) -> f32 {
    a * (reservoir::bernoulli_survival(a, b) * g) + b
}

/// The same in f64, from the formula of eq. 7 as printed.
fn recur64(a: f64, b: f64, g: f64) -> f64 {
    g * a * (1.0 - b / (a + b)) + b
}

fn past(w_sum: f32) -> Past {
    Past {
        color: Vec3::new(0.1, 0.2, 0.3),
        w_sum,
        log_key: f32::MIN,
    }
}

fn step(params: &WrsParams, w_sum: f32, weight: f32, draw: f32) -> wrs::Decision {
    wrs::step(Vec3::new(0.3, 0.2, 0.1), weight, past(w_sum), params, draw)
}

// ---- empty and zero ----------------------------------------------------------------------------------------------------

#[test]
fn h01_p6_an_empty_reservoir_never_wins() {
    let empty = Reservoir::default();
    let fresh = Reservoir {
        w_sum: 1e-3,
        count: 1,
    };
    for draw in [0.0, 0.5, 16_777_215.0 / 16_777_216.0] {
        let (merged, second) = reservoir::combine(empty, fresh, draw);
        assert!(second && merged.w_sum == 1e-3 && merged.count == 1);
        let mut r = empty;
        assert!(reservoir::update(&mut r, 1e-3, draw));
        assert!(step(&PAPER, 0.0, 1e-3, draw).take);
    }
    // The planted error: Alg. 2 as published keeps the first when draw * sum <= w1.
    let published = |w1: f32, w2: f32, draw: f32| draw * (w1 + w2) <= w1;
    assert!(
        published(0.0, 1e-3, 0.0),
        "the published comparison keeps the empty reservoir"
    );
}

#[test]
fn h02_two_empty_reservoirs_keep_the_newer_colour() {
    let (merged, second) = reservoir::combine(Reservoir::default(), Reservoir::default(), 0.0);
    assert!(second && merged.w_sum == 0.0);
    for sampler in [SamplerCode::AChao, SamplerCode::AEs] {
        let d = step(&WrsParams { sampler, ..PAPER }, 0.0, 0.0, 0.0);
        assert!(d.take && d.w_sum == 0.0 && d.survival == 1.0);
    }
}

#[test]
fn h03_candidates_of_weight_0_change_nothing() {
    for sampler in [SamplerCode::AChao, SamplerCode::AEs] {
        let params = WrsParams {
            sampler,
            gate: GateCode::DeltaE94,
            ..PAPER
        };
        let mut draws = Draws::new("weight 0");
        let mut state = Past {
            log_key: -0.3,
            ..past(5.42)
        };
        for _ in 0..100_000 {
            let d = wrs::step(Vec3::ONE, 0.0, state, &params, draws.uniform());
            assert!(!d.take);
            state.w_sum = d.w_sum;
            state.log_key = if sampler == SamplerCode::AEs {
                d.log_key
            } else {
                state.log_key
            };
        }
        assert_eq!((state.w_sum, state.log_key), (5.42, -0.3));
    }
}

#[test]
fn h04_denormal_weights_count_as_0_everywhere() {
    let tiny = Reservoir {
        w_sum: 1e-40,
        count: 1,
    };
    let (merged, second) = reservoir::combine(tiny, tiny, 0.5);
    assert!(second && merged.w_sum == 0.0);
    let mut r = Reservoir::default();
    assert!(!reservoir::update(&mut r, 1e-40, 0.0) && r.w_sum == 0.0);
    assert_eq!(pack::unpack(pack::pack(stored(1e-40, 0))).w_sum, 0.0);
}

#[test]
fn h17_h18_bad_weights_leave_the_reservoir_as_it_was() {
    for bad in [-1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut r = Reservoir {
            w_sum: 2.0,
            count: 7,
        };
        assert!(!reservoir::update(&mut r, bad, 0.0));
        assert_eq!(
            r,
            Reservoir {
                w_sum: 2.0,
                count: 8
            }
        );
        let (merged, second) = reservoir::combine(
            Reservoir {
                w_sum: 2.0,
                count: 7,
            },
            Reservoir {
                w_sum: bad,
                count: 1,
            },
            0.0,
        );
        assert!(!second && merged.w_sum == 2.0);
        // H19: a corrupt history is as good as none.
        let (merged, second) = reservoir::combine(
            Reservoir {
                w_sum: bad,
                count: 9,
            },
            Reservoir {
                w_sum: 0.5,
                count: 1,
            },
            0.999,
        );
        assert!(second && merged.w_sum == 0.5);
    }
}

#[test]
fn h15_counts_and_ages_saturate() {
    let mut r = Reservoir {
        w_sum: 1.0,
        count: u32::MAX,
    };
    reservoir::update(&mut r, 1.0, 0.5);
    assert_eq!(r.count, u32::MAX);
    assert_eq!(reservoir::combine(r, r, 0.5).0.count, u32::MAX);
    assert_eq!(pack::unpack(pack::pack(stored(1.0, 1_000_000))).age, 255);
}

#[test]
fn h21_survival_does_not_cancel() {
    let mut draws = Draws::new("survival");
    let mut worst = 0.0_f64;
    let mut worst_printed = 0.0_f64;
    for _ in 0..100_000 {
        let a = 10.0_f32.powf(draws.range(-6.0, 6.0));
        let b = a * 10.0_f32.powf(draws.range(-7.0, 7.0));
        let exact = f64::from(a) / (f64::from(a) + f64::from(b));
        worst = worst.max((f64::from(reservoir::bernoulli_survival(a, b)) / exact - 1.0).abs());
        worst_printed = worst_printed.max((f64::from(1.0 - b / (a + b)) / exact - 1.0).abs());
    }
    println!("survival: {worst:.1e} relative, as printed in eq. 5 {worst_printed:.1e}");
    assert!(worst < 4.0 * f64::from(f32::EPSILON));
    assert!(
        worst_printed > 0.1,
        "the printed form must show its cancellation"
    );
}

#[test]
fn h20_a_shut_gate_takes_the_candidate_for_certain() {
    let params = WrsParams {
        gate: GateCode::DeltaE94,
        inv_gate_divisor: 1.0,
        ..PAPER
    };
    for draw in [0.0, 0.5, 16_777_215.0 / 16_777_216.0] {
        let d = step(&params, 1e6, 0.02, draw);
        assert_eq!(
            (d.gate, d.survival, d.take, d.w_sum),
            (0.0, 0.0, true, 0.02)
        );
    }
}

// ---- recurrence --------------------------------------------------------------------------------------------------------

proptest! {
    #![proptest_config(common::property("reservoir", 2000))]

    #[test]
    fn p1_p2_recurrence_and_bounds(a0 in 0f32..100., b in 1e-3f32..1., n in 1usize..300) {
        let a0 = a0.max(b);
        let (mut a, mut a64) = (a0, f64::from(a0));
        let b64 = f64::from(b);
        for i in 1..=n {
            let d = step(&PAPER, a, b, 0.5);
            prop_assert_eq!(d.w_sum.to_bits(), recur(a, b, 1.0).to_bits(), "the scalar reference, bit for bit");
            prop_assert!(d.w_sum >= b && d.w_sum <= a + b);
            let growth = f64::from(d.w_sum) - f64::from(a);
            prop_assert!(growth <= b64 / 2.0 + 1e-5 * f64::from(a));
            a = d.w_sum;
            a64 = recur64(a64, b64, 1.0);
            let rounding = 4.0 * f64::from(f32::EPSILON) * (i as f64 + 1.0);
            prop_assert!((f64::from(a) / a64 - 1.0).abs() < rounding, "f32 follows f64");
            let base = (f64::from(a0) + b64).powi(2);
            let low = (base + 2.0 * b64 * b64 * i as f64).sqrt() - b64;
            let high = (base + 2.25 * b64 * b64 * i as f64).sqrt() - b64;
            prop_assert!(a64 >= low * (1.0 - 1e-12) && a64 <= high * (1.0 + 1e-12));
        }
    }

    #[test]
    fn p3_a_constant_gate_leads_to_a_fixed_point(a0 in 1e-2f32..1e3, b in 1e-2f32..1., d in 0.02f32..0.9) {
        let mut a = a0;
        for _ in 0..5000 {
            a = recur(a, b, 1.0 - d);
        }
        prop_assert!((a * d.sqrt() / b - 1.0).abs() < 1e-3);
        prop_assert!((b / a - d.sqrt()).abs() < 1e-3, "replacement rate");
    }

    #[test]
    fn p4_weights_may_be_scaled(a in 1e-2f32..1e3, b in 1e-3f32..1., exponent in -8i32..8, draw in 0f32..1.) {
        let c = 2.0_f32.powi(exponent);
        for sampler in [SamplerCode::AChao, SamplerCode::AEs] {
            let params = WrsParams { sampler, ..PAPER };
            let key = -0.7;
            let x = wrs::step(Vec3::ONE, b, Past { log_key: key, ..past(a) }, &params, draw);
            let y = wrs::step(Vec3::ONE, c * b, Past { log_key: key / c, ..past(c * a) }, &params, draw);
            prop_assert_eq!(x.take, y.take);
            prop_assert_eq!(x.w_sum * c, y.w_sum);
        }
    }

    #[test]
    fn h16_a_capped_history_answers_a_step_in_the_time_theory_says(cap in prop::sample::select(vec![8.0f32, 32.0])) {
        // Weights 1, history capped at M before each combine: every old sample survives a frame with M / (M + 1).
        let half_life = (0.5_f64).ln() / (f64::from(cap) / (f64::from(cap) + 1.0)).ln();
        let mut survival = 1.0_f64;
        let mut r = Reservoir { w_sum: 1000.0, count: 0 };
        let mut frames = 0.0;
        while survival > 0.5 {
            r.w_sum = r.w_sum.min(cap);
            let (merged, _) = reservoir::combine(r, Reservoir { w_sum: 1.0, count: 1 }, 0.5);
            survival *= f64::from(r.w_sum / merged.w_sum);
            r = merged;
            frames += 1.0;
        }
        prop_assert!((frames - half_life).abs() <= 1.0);
    }
}

#[test]
fn h08_h09_f32_keeps_growing_where_half_stalls() {
    // A power of two scales exactly; other weights round differently on the way.
    for (w, tolerance) in [(1.0_f32, 4e-4), (1.0 / 16.0, 4e-4), (0.05, 2e-3)] {
        let (mut a, mut exact) = (w, f64::from(w));
        for _ in 1..1_000_000 {
            a = recur(a, w, 1.0);
            exact = recur64(exact, f64::from(w), 1.0);
        }
        println!(
            "after 1e6 frames of weight {w}: {:.3} w, in f64 {:.3} w",
            a / w,
            exact / f64::from(w)
        );
        assert!((f64::from(a) / exact - 1.0).abs() < tolerance);
        if tolerance < 1e-3 {
            assert!((a / w - 1412.7).abs() < 0.5);
        }
    }
}

#[test]
fn h06_h07_half_floats_would_stall() {
    let half = |x: f32| pack::half_value(pack::half_bits(x));
    let stall = |next: &dyn Fn(f32) -> f32| {
        let (mut a, mut frames) = (1.0, 0);
        while next(a) != a {
            a = next(a);
            frames += 1;
        }
        println!("a half stalls at {a:.1} after {frames} frames");
        a
    };
    assert_eq!(stall(&|a| half(a + 1.0)), 2048.0, "plain A-Chao");
    assert!(
        stall(&|a| half(recur(a, 1.0, 1.0))) < 64.0,
        "stored as half"
    );
    let all_half = |a: f32| half(half(a * half(1.0 - half(1.0 / half(a + 1.0)))) + 1.0);
    assert!(stall(&all_half) < 33.0, "computed in half");
}

#[test]
fn h07_stored_weight_sums_keep_the_stated_floor_of_replacement() {
    let mut draws = Draws::new("floor");
    for _ in 0..20 {
        let w = 10.0_f32.powf(draws.range(-3.0, 0.0));
        let mut a = w;
        for _ in 0..200_000 {
            a = pack::unpack(pack::pack(stored(recur(a, w, 1.0), 0))).w_sum;
        }
        assert!(a / w <= 363.0 && a / w >= 250.0, "stalls at {} w", a / w);
    }
}

#[test]
fn h05_h06_the_weight_sum_saturates_and_does_not_stall_at_2048() {
    let packed = pack::unpack(pack::pack(stored(f32::MAX, 3)));
    assert!(packed.w_sum.is_finite() && packed.w_sum > 0.99 * pack::MAX_W_SUM);
    // Plain A-Chao, weight 1: 16 significant bits count to 65536 before they stall, a half to 2048.
    let mut a = 0.0;
    for _ in 0..3000 {
        a = pack::unpack(pack::pack(stored(a + 1.0, 0))).w_sum;
    }
    assert_eq!(a, 3000.0);
}

#[test]
fn h10_a_billion_frames_follow_the_closed_form() {
    // In blocks: (a_next + b)^2 = (a + b)^2 + 2 b^2 + b^4 / (a + b)^2, summed as 2 n + ln(1 + 2 n / s0) / 2 for b = 1.
    let closed = |n: f64, s0: f64| (s0 + 2.0 * n + 0.5 * (2.0 * n / s0).ln_1p()).sqrt() - 1.0;
    let (mut a, mut n) = (1.0_f64, 0.0);
    let check = |a: f64, n: f64| assert!((a / closed(n, 4.0) - 1.0).abs() < 1e-3, "{a} after {n}");
    while n < 1e7 {
        a = recur64(a, 1.0, 1.0);
        n += 1.0;
    }
    check(a, n);
    // On to 1e9 with the exact increment of s = (a + 1)^2 over blocks in which 1/s moves by less than 1e-5.
    while n < 1e9 {
        let s = (a + 1.0).powi(2);
        let block = (1e-6 * s).max(1.0).floor().min(1e9 - n);
        a = (s + block * (2.0 + 1.0 / s)).sqrt() - 1.0;
        n += block;
    }
    check(a, n);
}

// ---- law of the sample -------------------------------------------------------------------------------------------------

/// Index of the sample after a stream of `weights` through `update`.
fn stream(weights: &[f32], draws: &mut Draws) -> usize {
    let mut r = Reservoir::default();
    let mut sample = 0;
    for (i, &w) in weights.iter().enumerate() {
        if reservoir::update(&mut r, w, draws.uniform()) {
            sample = i;
        }
    }
    sample
}

/// The same through `combine` with one-candidate reservoirs.
fn stream_by_combine(weights: &[f32], draws: &mut Draws) -> usize {
    let mut r = Reservoir::default();
    let mut sample = 0;
    for (i, &w) in weights.iter().enumerate() {
        let (merged, second) =
            reservoir::combine(r, Reservoir { w_sum: w, count: 1 }, draws.uniform());
        r = merged;
        sample = if second { i } else { sample };
    }
    sample
}

/// The same through A-ES keys.
fn stream_by_keys(weights: &[f32], draws: &mut Draws) -> usize {
    let keys = weights
        .iter()
        .map(|&w| reservoir::a_es_log_key(draws.uniform(), w));
    keys.enumerate()
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .unwrap()
        .0
}

fn p_of_stream(weights: &[f32], trials: u64, mut one: impl FnMut() -> usize) -> f64 {
    let mut counts = vec![0_u64; weights.len()];
    for _ in 0..trials {
        counts[one()] += 1;
    }
    let total: f32 = weights.iter().sum();
    let expected: Vec<f64> = weights
        .iter()
        .map(|w| f64::from(w / total) * trials as f64)
        .collect();
    p_of_counts(&counts, &expected)
}

#[test]
fn h11_h12_samples_are_kept_in_proportion_to_their_weights() {
    let cases: [(&str, &[f32], u64); 3] = [
        ("constant weights", &[1.0; 10], 1_000_000),
        ("weights 1 2 3 4", &[1.0, 2.0, 3.0, 4.0], 2_500_000),
        (
            "paper's weights",
            &[1.0, 0.535, 0.229, 0.092, 0.03],
            2_000_000,
        ),
    ];
    for (name, weights, trials) in cases {
        let mut draws = Draws::new(name);
        accept(
            &format!("{name}, update"),
            p_of_stream(weights, trials, || stream(weights, &mut draws)),
        );
        accept(
            &format!("{name}, combine"),
            p_of_stream(weights, trials, || stream_by_combine(weights, &mut draws)),
        );
        accept(
            &format!("{name}, A-ES"),
            p_of_stream(weights, trials, || stream_by_keys(weights, &mut draws)),
        );
    }
    // Negative control: a weight off by 1 %.
    let off = [1.0, 2.0, 3.0, 4.04];
    let mut draws = Draws::new("off by 1 %");
    reject(
        "weight off by 1 %",
        p_of_stream(&[1.0, 2.0, 3.0, 4.0], 4_000_000, || {
            stream(&off, &mut draws)
        }),
    );
}

#[test]
fn h12_exact_enumeration_of_the_law() {
    // Probability of each sample from the acceptance probabilities alone, in f64: prod (1 - p_later) p_i = w_i / sum.
    let weights = [1.0_f64, 2.0, 3.0, 4.0];
    for i in 0..4 {
        let mut sum = 0.0;
        let mut p = 0.0;
        for (j, w) in weights.iter().enumerate() {
            sum += w;
            let accept = w / sum;
            p = if j == i { accept } else { p * (1.0 - accept) };
        }
        assert!((p - weights[i] / 10.0).abs() < 1e-15);
    }
}

#[test]
fn h13_order_is_forgotten_without_bias_and_recency_wins_with_it() {
    let shuffled = [4.0, 1.0, 3.0, 2.0];
    let mut draws = Draws::new("order");
    accept(
        "shuffled weights",
        p_of_stream(&shuffled, 1_000_000, || stream(&shuffled, &mut draws)),
    );
    // Bernoulli survival, weights 1: acceptance of frame k is 1 / (a_k' + 1), more than 1 / k, so later ones are likelier.
    let n = 10;
    let mut accept_p = vec![];
    let mut a = 0.0_f64;
    for _ in 0..n {
        let kept = if a == 0.0 { 0.0 } else { a * a / (a + 1.0) };
        accept_p.push(1.0 / (kept + 1.0));
        a = kept + 1.0;
    }
    let law: Vec<f64> = (0..n)
        .map(|i| accept_p[i] * accept_p[i + 1..].iter().map(|p| 1.0 - p).product::<f64>())
        .collect();
    assert!(
        law.windows(2).all(|w| w[0] <= w[1] + 1e-12),
        "recency order: {law:?}"
    );
    let mut draws = Draws::new("recency");
    let trials = 1_000_000;
    let mut counts = vec![0_u64; n];
    for _ in 0..trials {
        let (mut w_sum, mut sample) = (0.0, 0);
        for i in 0..n {
            let d = step(&PAPER, w_sum, 1.0, draws.uniform());
            w_sum = d.w_sum;
            sample = if d.take { i } else { sample };
        }
        counts[sample] += 1;
    }
    // The first sample is never kept (a' = 0 after the first frame would need a0 > 0): drop empty cells.
    let (mut c, mut e) = (vec![], vec![]);
    for (i, &p) in law.iter().enumerate() {
        if p * trials as f64 >= 5.0 {
            c.push(counts[i]);
            e.push(p * trials as f64);
        } else {
            assert_eq!(counts[i], 0);
        }
    }
    accept("biased stream against its law", p_of_counts(&c, &e));
}

#[test]
fn h14_combine_is_associative_in_law() {
    let (wa, wb, wc) = (0.7_f32, 0.2, 0.4);
    let leaf = |w: f32| Reservoir { w_sum: w, count: 1 };
    let mut draws = Draws::new("associative");
    let mut counts = [[0_u64; 3]; 2];
    for _ in 0..1_000_000 {
        let (bc, c) = reservoir::combine(leaf(wb), leaf(wc), draws.uniform());
        let (_, second) = reservoir::combine(leaf(wa), bc, draws.uniform());
        counts[0][if second { 1 + usize::from(c) } else { 0 }] += 1;
        let (ab, b) = reservoir::combine(leaf(wa), leaf(wb), draws.uniform());
        let (_, second) = reservoir::combine(ab, leaf(wc), draws.uniform());
        counts[1][if second { 2 } else { usize::from(b) }] += 1;
    }
    let expected = [wa, wb, wc].map(|w| f64::from(w / 1.3) * 1e6);
    accept("A (B C)", p_of_counts(&counts[0], &expected));
    accept("(A B) C", p_of_counts(&counts[1], &expected));
}

#[test]
fn p5_the_expected_sample_is_the_weighted_mean() {
    let (a, b) = (3.0_f32, 0.4);
    let kept = f64::from(a) * f64::from(a) / f64::from(a + b);
    let p = f64::from(b) / (kept + f64::from(b));
    for sampler in [SamplerCode::AChao, SamplerCode::AEs] {
        let params = WrsParams { sampler, ..PAPER };
        let mut draws = Draws::new("expected sample");
        let trials = 1_000_000;
        let mut taken = 0;
        for _ in 0..trials {
            // A history of sum a has the key law of one sample of weight a.
            let log_key = reservoir::a_es_log_key(draws.uniform(), a);
            let d = wrs::step(
                Vec3::ONE,
                b,
                Past { log_key, ..past(a) },
                &params,
                draws.uniform(),
            );
            taken += u64::from(d.take);
        }
        accept(
            &format!("replacement rate, {sampler:?}"),
            p_of_rate(taken, trials, p),
        );
        reject("rate off by 2 %", p_of_rate(taken, trials, 1.02 * p));
    }
}

#[test]
fn p8_survival_follows_the_half_life_formula() {
    for (name, b) in [
        ("4 deg", 0.535_f64),
        ("10 deg", 0.157),
        ("20 deg", 0.061),
        ("30 deg", 0.030),
    ] {
        let mut a = 1.0_f64;
        for _ in 0..18 {
            a = recur64(a, 1.0, 1.0);
        }
        assert!((a - 5.42).abs() < 0.02, "18 foveal frames give {a}");
        let formula = std::f64::consts::LN_2 * (a + b) / b + 0.5 * std::f64::consts::LN_2.powi(2);
        let pixels = 20_000_u64;
        let mut draws = Draws::new(name);
        let mut states = vec![(a as f32, true); pixels as usize];
        let mut alive_exact = 1.0;
        let mut a_exact = a;
        for _ in 0..formula.round() as usize {
            for (w_sum, alive) in &mut states {
                let d = step(&PAPER, *w_sum, b as f32, draws.uniform());
                *w_sum = d.w_sum;
                *alive &= !d.take;
            }
            let kept = a_exact * a_exact / (a_exact + b);
            alive_exact *= kept / (kept + b);
            a_exact = kept + b;
        }
        let alive = states.iter().filter(|s| s.1).count() as u64;
        println!(
            "{name}: formula {formula:.1} frames, {:.3} alive",
            alive as f64 / pixels as f64
        );
        accept(
            &format!("survivors at {name}"),
            p_of_rate(alive, pixels, alive_exact),
        );
        // The formula itself is good to a frame.
        let per_frame = b / (a + b);
        assert!(
            (alive_exact - 0.5).abs() < 1.2 * per_frame,
            "{name}: {alive_exact}"
        );
    }
}

// ---- storage -----------------------------------------------------------------------------------------------------------

fn stored(w_sum: f32, age: u32) -> Stored {
    Stored {
        color: Vec3::new(0.25, 0.5, 1.0),
        disparity: 0.1,
        w_sum,
        age,
    }
}

#[test]
fn packing_halves_matches_the_exr_crate_s_halves() {
    // All 63,488 finite halves come back; conversions of floats agree with an independent implementation.
    for bits in (0..=0xffff_u32).filter(|b| b & 0x7c00 != 0x7c00) {
        let value = pack::half_value(bits);
        assert_eq!(value.to_bits(), half_oracle(bits).to_bits());
        assert_eq!(pack::half_bits(value), bits);
    }
    let mut draws = Draws::new("halves");
    for _ in 0..2_000_000 {
        let x = f32::from_bits(draws.bits());
        if !x.is_finite() {
            continue;
        }
        let nearest = pack::half_value(pack::half_bits(x));
        if x.abs() >= 65504.0 {
            assert_eq!(nearest, 65504.0_f32.copysign(x));
            continue;
        }
        // No half is nearer, and a tie goes to the even one.
        let bits = pack::half_bits(x);
        let error = (f64::from(nearest) - f64::from(x)).abs();
        for other in [bits.wrapping_sub(1), bits + 1] {
            if other & 0x7c00 != 0x7c00 && other & 0x8000 == bits & 0x8000 && other <= 0xffff {
                let distance = (f64::from(half_oracle(other)) - f64::from(x)).abs();
                assert!(
                    distance > error || (distance == error && bits & 1 == 0),
                    "{x:e}"
                );
            }
        }
    }
}

/// Value of a half from its definition, in f64.
fn half_oracle(bits: u32) -> f32 {
    let (e, m) = ((bits >> 10) & 0x1f, f64::from(bits & 0x3ff));
    let magnitude = if e == 0 {
        m * 2.0_f64.powi(-24)
    } else {
        (1.0 + m / 1024.0) * 2.0_f64.powi(e as i32 - 15)
    };
    (if bits & 0x8000 != 0 {
        -magnitude
    } else {
        magnitude
    }) as f32
}

proptest! {
    #![proptest_config(common::property("storage", 5000))]

    #[test]
    fn h19_any_words_unpack_to_something_finite(words in any::<[u32; 3]>()) {
        let s = pack::unpack(words);
        prop_assert!(s.color.is_finite() && s.w_sum.is_finite() && s.w_sum >= 0.0 && s.disparity.is_finite());
        prop_assert!(s.color.abs().max_element() <= 65504.0 && s.age <= 255);
        // Packing what was unpacked changes nothing more.
        let again = pack::unpack(pack::pack(s));
        prop_assert_eq!(again, s);
    }

    #[test]
    fn storage_is_as_precise_as_stated(w in 1e-20f32..1e20, d in 1e-9f32..1e9, age in 0u32..256, c in -65504f32..65504.) {
        let s = pack::unpack(pack::pack(Stored { color: Vec3::splat(c), disparity: d, w_sum: w, age }));
        prop_assert!((s.w_sum / w - 1.0).abs() <= 2.0_f32.powi(-16));
        prop_assert!((s.disparity / d - 1.0).abs() <= 2.0_f32.powi(-11));
        prop_assert!((s.color.x - c).abs() <= (c.abs() * 2.0_f32.powi(-11)).max(2.0_f32.powi(-25)));
        prop_assert_eq!(s.age, age);
    }
}

#[test]
fn special_disparities_survive_storage() {
    for (d, back) in [
        (0.0, 0.0),
        (-1.0, -1.0),
        (1e-12, 0.0),
        (f32::MAX, pack::disparity_value(0xfffe)),
    ] {
        assert_eq!(pack::disparity_value(pack::disparity_code(d)), back);
    }
    assert_eq!(pack::unpack([0; 3]).w_sum, 0.0, "zeroed memory is empty");
}
