//! Empty reservoirs, bad weights, the recurrence and its closed forms.

use super::*;

#[test]
fn h01_p6_an_empty_reservoir_never_wins() {
    let empty = Reservoir::default();
    let fresh = Reservoir { w_sum: 1e-3, count: 1 };
    for draw in [0.0, 0.5, 16_777_215.0 / 16_777_216.0] {
        let (merged, second) = reservoir::combine(empty, fresh, draw);
        assert!(second && merged.w_sum == 1e-3 && merged.count == 1);
        let mut r = empty;
        assert!(reservoir::update(&mut r, 1e-3, draw));
        assert!(step(&PAPER, 0.0, 1e-3, draw).take);
    }
    // The planted error: Alg. 2 as published keeps the first when draw * sum <= w1.
    let published = |w1: f32, w2: f32, draw: f32| draw * (w1 + w2) <= w1;
    assert!(published(0.0, 1e-3, 0.0), "the published comparison keeps the empty reservoir");
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
        let params = WrsParams { sampler, gate: GateCode::DeltaE94, ..PAPER };
        let mut draws = Draws::new("weight 0");
        let mut state = Past { log_key: -0.3, ..past(5.42) };
        for _ in 0..100_000 {
            let d = wrs::step(Vec3::ONE, 0.0, state, &params, draws.uniform());
            assert!(!d.take);
            state.w_sum = d.w_sum;
            state.log_key = if sampler == SamplerCode::AEs { d.log_key } else { state.log_key };
        }
        assert_eq!((state.w_sum, state.log_key), (5.42, -0.3));
    }
}

#[test]
fn h04_denormal_weights_count_as_0_everywhere() {
    let tiny = Reservoir { w_sum: 1e-40, count: 1 };
    let (merged, second) = reservoir::combine(tiny, tiny, 0.5);
    assert!(second && merged.w_sum == 0.0);
    let mut r = Reservoir::default();
    assert!(!reservoir::update(&mut r, 1e-40, 0.0) && r.w_sum == 0.0);
    assert_eq!(pack::unpack(pack::pack(stored(1e-40, 0))).w_sum, 0.0);
    // What survival makes so small is gone for any draw, not only on devices that flush it.
    let d = step(&PAPER, 4.0 * f32::MIN_POSITIVE, 0.5, 16_777_215.0 / 16_777_216.0);
    assert!(d.take && d.w_sum == 0.5);
}

#[test]
fn h17_h18_bad_weights_leave_the_reservoir_as_it_was() {
    for bad in [-1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut r = Reservoir { w_sum: 2.0, count: 7 };
        assert!(!reservoir::update(&mut r, bad, 0.0));
        assert_eq!(r, Reservoir { w_sum: 2.0, count: 8 });
        let (merged, second) =
            reservoir::combine(Reservoir { w_sum: 2.0, count: 7 }, Reservoir { w_sum: bad, count: 1 }, 0.0);
        assert!(!second && merged.w_sum == 2.0);
        // H19: a corrupt history is as good as none.
        let (merged, second) =
            reservoir::combine(Reservoir { w_sum: bad, count: 9 }, Reservoir { w_sum: 0.5, count: 1 }, 0.999);
        assert!(second && merged.w_sum == 0.5);
    }
}

#[test]
fn h15_counts_and_ages_saturate() {
    let mut r = Reservoir { w_sum: 1.0, count: u32::MAX };
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
    assert!(worst_printed > 0.1, "the printed form must show its cancellation");
}

#[test]
fn h03_a_candidate_of_weight_0_is_not_taken_by_a_draw_of_0() {
    for sampler in [SamplerCode::AChao, SamplerCode::AEs] {
        let params = WrsParams { sampler, ..PAPER };
        let d = wrs::step(Vec3::ONE, 0.0, Past { log_key: -0.3, ..past(5.42) }, &params, 0.0);
        assert!(!d.take && d.w_sum == 5.42, "{sampler:?}");
    }
}

#[test]
fn eq7_survival_uses_the_sum_before_the_gate() {
    let params = WrsParams { gate: GateCode::DeltaE94, ..PAPER };
    let (a, b) = (3.0_f32, 0.4_f32);
    let d = step(&params, a, b, 0.5);
    assert!(d.gate > 0.1 && d.gate < 0.9, "the gate is half open: {}", d.gate);
    let exact = f64::from(d.gate) * f64::from(a) * f64::from(a) / f64::from(a + b) + f64::from(b);
    assert!((f64::from(d.w_sum) - exact).abs() < 1e-6);
}

#[test]
fn h20_a_shut_gate_takes_the_candidate_for_certain() {
    let params = WrsParams { gate: GateCode::DeltaE94, inv_gate_divisor: 1.0, ..PAPER };
    for draw in [0.0, 0.5, 16_777_215.0 / 16_777_216.0] {
        let d = step(&params, 1e6, 0.02, draw);
        assert_eq!((d.gate, d.survival, d.take, d.w_sum), (0.0, 0.0, true, 0.02));
    }
}

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
        println!("after 1e6 frames of weight {w}: {:.3} w, in f64 {:.3} w", a / w, exact / f64::from(w));
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
    assert!(stall(&|a| half(recur(a, 1.0, 1.0))) < 64.0, "stored as half");
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
