//! Properties that hold for any number, and for any bit pattern.

use super::*;
use afterimage::kernel::sanitize;

proptest! {
    #![proptest_config(afterimage_testing::property("reservoir", 2000))]

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
            let x = wrs::decide_sample(Vec3::ONE, b, Past { log_key: key, ..past(a) }, &params, draw);
            let y = wrs::decide_sample(Vec3::ONE, c * b, Past { log_key: key / c, ..past(c * a) }, &params, draw);
            prop_assert_eq!(x.take, y.take);
            prop_assert_eq!(x.w_sum * c, y.w_sum);
        }
    }
}

/// Either sampler under any bias with any gate.
fn any_params() -> impl Strategy<Value = WrsParams> {
    let sampler = prop::sample::select(vec![SamplerCode::AChao, SamplerCode::AEs]);
    let bias = prop::sample::select(vec![BiasCode::None, BiasCode::Exponential, BiasCode::Bernoulli]);
    let gate = prop::sample::select(vec![GateCode::Off, GateCode::DeltaE94, GateCode::Lightness]);
    (sampler, bias, gate, 0f32..=1.0, 0f32..10.).prop_map(|(sampler, bias, gate, exponential_survival, gate_offset)| {
        WrsParams { sampler, bias, exponential_survival, gate, gate_offset, ..PAPER }
    })
}

proptest! {
    #![proptest_config(afterimage_testing::property("reservoir, any bits", 20_000))]

    /// One frame of a pixel for any bit pattern of color, weight, trust, key and stored words.
    #[test]
    fn any_bits_give_finite_output(color in any::<[u32; 3]>(), others in any::<[u32; 3]>(), words in any::<[u32; 3]>(), draw in 0u32..1 << 24, params in any_params()) {
        let [weight, trust, key] = others.map(f32::from_bits);
        let (candidate, usable) = sanitize::color(Vec3::from(color.map(f32::from_bits)));
        let weight = if usable { sanitize::weight(weight).min(1.0) } else { 0.0 };
        let history = stored_reservoir::unpack(words);
        let past = Past { color: history.color, w_sum: history.w_sum, log_key: key };
        let past = wrs::scale_by_trust(past, trust, params.sampler);
        prop_assert!(past.w_sum >= 0.0 && past.w_sum <= history.w_sum);
        let d = wrs::decide_sample(candidate, weight, past, &params, draw as f32 / 16_777_216.0);
        prop_assert!(d.w_sum.is_finite() && d.w_sum >= 0.0 && d.log_key.is_finite() && d.log_key <= 0.0);
        prop_assert!((0.0..=1.0).contains(&d.gate) && (0.0..=1.0).contains(&d.survival));
        let shown = if d.take { candidate } else { past.color };
        let next = stored_reservoir::unpack(stored_reservoir::pack(Stored { color: shown, disparity: history.disparity, w_sum: d.w_sum, age: 1 }));
        prop_assert!(shown.is_finite() && next.color.is_finite() && next.w_sum.is_finite() && next.w_sum >= 0.0);
    }
}
