//! Empty reservoirs, weights of 0, bad weights, and one step of the recurrence.

use super::*;
use afterimage_testing::holds;

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
