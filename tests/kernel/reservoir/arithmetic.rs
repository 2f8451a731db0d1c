//! Empty reservoirs, weights of 0, bad weights, and one step of the recurrence.

use super::*;
use afterimage_testing::holds;

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
    let per_frame = 3840.0 * 2160.0 / 16_777_216.0;
    assert!((per_frame - 0.494_f64).abs() < 1e-3);
    holds!("H01", Cpu, "R2 chosen by update, combine and step; `<=` would keep {per_frame:.2} empty px a 4K frame");
}

#[test]
fn h02_two_empty_reservoirs_keep_the_newer_color() {
    let (merged, second) = reservoir::combine(Reservoir::default(), Reservoir::default(), 0.0);
    assert!(second && merged.w_sum == 0.0);
    for sampler in [SamplerCode::AChao, SamplerCode::AEs] {
        let d = step(&WrsParams { sampler, ..PAPER }, 0.0, 0.0, 0.0);
        assert!(d.take && d.w_sum == 0.0 && d.survival == 1.0);
        // Stored and read again it is still empty, and the next candidate is taken for certain.
        let read = pack::unpack(pack::pack(stored(d.w_sum, 0)));
        assert_eq!((read.w_sum, read.color), (0.0, stored(0.0, 0).color));
        assert!(step(&WrsParams { sampler, ..PAPER }, read.w_sum, 0.02, 0.999_999).take);
    }
    let (shown, old, new) = (second, Vec3::ZERO, Vec3::new(0.25, 0.5, 1.0));
    assert_eq!(if shown { new } else { old }, new, "not black");
    holds!("H02", Cpu, "the second's color, w_sum {}, survival 1, for both samplers", merged.w_sum);
}

#[test]
fn h03_candidates_of_weight_0_change_nothing() {
    for sampler in [SamplerCode::AChao, SamplerCode::AEs] {
        let params = WrsParams { sampler, gate: GateCode::DeltaE94, ..PAPER };
        let mut draws = Draws::new("weight 0");
        let mut state = Past { log_key: -0.3, ..past(5.421_875) };
        for _ in 0..100_000 {
            let d = wrs::step(Vec3::ONE, 0.0, state, &params, draws.uniform());
            assert!(!d.take);
            // As stored, frame by frame.
            state.w_sum = pack::unpack(pack::pack(stored(d.w_sum, 3))).w_sum;
            state.log_key = if sampler == SamplerCode::AEs { d.log_key } else { state.log_key };
        }
        assert_eq!((state.w_sum, state.log_key), (5.421_875, -0.3));
    }
    holds!("H03", Cpu, "w_sum 5.421875 and key -0.3 after 1e5 frames through storage, none taken");
}

#[test]
fn h04_denormal_weights_count_as_0_everywhere() {
    let tiny = Reservoir { w_sum: 1e-40, count: 1 };
    let (merged, second) = reservoir::combine(tiny, tiny, 0.5);
    assert!(second && merged.w_sum == 0.0);
    let mut r = Reservoir::default();
    assert!(!reservoir::update(&mut r, 1e-40, 0.0) && r.w_sum == 0.0);
    assert_eq!(pack::unpack(pack::pack(stored(1e-40, 0))).w_sum, 0.0);
    // A denormal product of survival counts as 0 for any draw, not only on devices that flush denormals.
    let d = step(&PAPER, 4.0 * f32::MIN_POSITIVE, 0.5, 16_777_215.0 / 16_777_216.0);
    assert!(d.take && d.w_sum == 0.5);
    holds!("H04", Cpu, "1e-40 counts as 0 in update, combine, storage and survival");
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
        // H19: a corrupt history counts as empty.
        let (merged, second) =
            reservoir::combine(Reservoir { w_sum: bad, count: 9 }, Reservoir { w_sum: 0.5, count: 1 }, 0.999);
        assert!(second && merged.w_sum == 0.5);
    }
    holds!("H17", Cpu, "-1 counts as 0: w_sum stays 2, the first is kept");
    holds!("H18", Cpu, "NaN and +-Inf count as 0: w_sum stays 2, the first is kept at a draw of 0");
}

/// A stored key that no candidate's key can exceed would keep its sample for ever.
#[test]
fn h19_a_corrupt_key_loses_to_the_next_candidate() {
    let params = WrsParams { sampler: SamplerCode::AEs, ..PAPER };
    for bad in [f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MIN_POSITIVE, 5.0, f32::MAX] {
        for draw in [0.0, 0.5, 16_777_215.0 / 16_777_216.0] {
            let d = wrs::step(Vec3::ONE, 0.02, Past { log_key: bad, ..past(5.42) }, &params, draw);
            assert!(d.take && (f32::MIN..=0.0).contains(&d.log_key), "{bad}: {d:?}");
        }
    }
    for sound in [0.0, -0.0, -1e-30] {
        assert!(!wrs::step(Vec3::ONE, 0.02, Past { log_key: sound, ..past(5.42) }, &params, 0.5).take);
    }
}

#[test]
fn h15_counts_and_ages_saturate() {
    let mut r = Reservoir { w_sum: 1.0, count: u32::MAX };
    reservoir::update(&mut r, 1.0, 0.5);
    assert_eq!(r.count, u32::MAX);
    assert_eq!(reservoir::combine(r, r, 0.5).0.count, u32::MAX);
    let mut age = 250;
    for _ in 0..1000 {
        age = pack::unpack(pack::pack(stored(1.0, age + 1))).age;
    }
    assert_eq!(age, 255);
    assert_eq!(pack::unpack(pack::pack(stored(1.0, u32::MAX))).age, 255);
    holds!("H15", Cpu, "count stays at 2^32-1, stored age at {age} after 1000 frames more");
}

#[test]
fn h21_survival_does_not_cancel() {
    let mut draws = Draws::new("survival");
    let ulps = |x: f32, exact: f64| {
        let spacing = f64::from((exact as f32).next_up()) - f64::from(exact as f32);
        (f64::from(x) - exact).abs() / spacing
    };
    let (mut worst, mut worst_printed) = (0.0_f64, 0.0_f64);
    for i in 0..100_000 {
        let a = 10.0_f32.powf(draws.range(-6.0, 6.0));
        let ratio = if i % 4 == 0 { 1e7 } else { 10.0_f32.powf(draws.range(-7.0, 7.0)) };
        let b = a * ratio;
        let exact = f64::from(a) / (f64::from(a) + f64::from(b));
        worst = worst.max(ulps(reservoir::bernoulli_survival(a, b), exact));
        worst_printed = worst_printed.max((f64::from(1.0 - b / (a + b)) / exact - 1.0).abs());
    }
    println!("survival: {worst:.2} ulp, as printed in eq. 5 {worst_printed:.1e} relative");
    assert!(worst < 4.0);
    assert!(worst_printed > 0.1, "the printed form must show its cancellation");
    holds!("H21", Cpu, "{worst:.2} ulp for ratios 1e-7 to 1e7; eq. 5 as printed is {:.0} % off", 100.0 * worst_printed);
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
