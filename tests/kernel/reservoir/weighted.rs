//! Sharper weights and means: the law of the exponent, survival, and no bias of the mean.

use super::law::{biased_counts, p_of_law};
use super::*;
use afterimage::kernel::acuity;

/// Weight of a candidate at `e_deg` with a fovea of 2.5 degrees.
fn weight(e_deg: f32, exponent: u32) -> f32 {
    let inverse = 1.0 / acuity::cell_density(2.5);
    wrs::sharpen(acuity::candidate_weight(e_deg, 2.5, inverse), exponent)
}

#[test]
fn samples_are_kept_by_powers_of_their_density() {
    let eccentricities = [2.0, 3.0, 3.5, 4.0, 6.0];
    let law = |exponent: i32| -> Vec<f64> {
        let powers = eccentricities.map(|e| f64::from(weight(e, 1)).powi(exponent));
        powers.iter().map(|w| w / powers.iter().sum::<f64>()).collect()
    };
    let unbiased = WrsParams { bias: BiasCode::None, ..PAPER };
    for exponent in [1, 3, 8] {
        let mut draws = Draws::new(&format!("law of exponent {exponent}"));
        let counts = biased_counts(&unbiased, &eccentricities.map(|e| weight(e, exponent)), 40_000, &mut draws);
        accept(&format!("exponent {exponent}"), p_of_law(&counts, &law(exponent as i32)));
        reject("the exponent after it", p_of_law(&counts, &law(exponent as i32 + 1)));
    }
}

#[test]
fn a_fixation_survives_longer_the_sharper_the_weights() {
    for (exponent, frames) in [(1, 25), (3, 400), (8, 400)] {
        let b = weight(10.0, exponent);
        let (mut a, mut alive_exact) = (1.0_f64, 1.0_f64);
        for _ in 0..18 {
            a = recur64(a, 1.0, 1.0);
        }
        let mut draws = Draws::new(&format!("survival with exponent {exponent}"));
        let mut pixels = vec![(a as f32, true); 20_000];
        for _ in 0..frames {
            for (w_sum, alive) in &mut pixels {
                let d = step(&PAPER, *w_sum, b, draws.uniform());
                *w_sum = d.w_sum;
                *alive &= !d.take;
            }
            let kept = a * a / (a + f64::from(b));
            alive_exact *= kept / (kept + f64::from(b));
            a = kept + f64::from(b);
        }
        let alive = pixels.iter().filter(|p| p.1).count() as u64;
        println!("exponent {exponent}: {:.4} alive after {frames} frames", alive as f64 / 20_000.0);
        accept(&format!("survivors with exponent {exponent}"), p_of_rate(alive, 20_000, alive_exact));
        // Planted error: no survival factor.
        if exponent == 1 {
            reject("survival without eq. 5", p_of_rate(alive, 20_000, 5.42 / (5.42 + f64::from(b) * 25.0)));
        }
    }
}

/// Color after a stream of (color, weight), by `sampler`.
fn shown(stream: &[(f32, f32)], sampler: SamplerCode, bias: BiasCode, draws: &mut Draws) -> f32 {
    let params = WrsParams { sampler, bias, ..PAPER };
    let mut state = Past::EMPTY;
    for &(light, weight) in stream {
        let candidate = Vec3::splat(light);
        let d = wrs::decide_sample(candidate, weight, state, &params, draws.uniform());
        state = Past { color: wrs::combined(candidate, weight, state.color, &d, sampler), w_sum: d.w_sum, ..state };
    }
    state.color.x
}

#[test]
fn the_mean_is_the_expectation_of_the_draws() {
    let mut draws = Draws::new("streams of black and white");
    for trial in 0..6 {
        let stream: Vec<_> =
            (0..24).map(|_| ((draws.bits() & 1) as f32, weight(draws.uniform() * 6.0, 1 + trial % 3))).collect();
        let mean = shown(&stream, SamplerCode::AChaoMean, BiasCode::Bernoulli, &mut draws);
        let white = (0..20_000)
            .filter(|_| shown(&stream, SamplerCode::AChao, BiasCode::Bernoulli, &mut draws) == 1.0)
            .count() as u64;
        accept(&format!("stream {trial}: white with probability {mean:.4}"), p_of_rate(white, 20_000, f64::from(mean)));
        // Planted error: the mean of another law, without survival.
        let other = shown(&stream, SamplerCode::AChaoMean, BiasCode::None, &mut draws);
        if (other - mean).abs() > 0.05 {
            reject("the mean without survival", p_of_rate(white, 20_000, f64::from(other)));
        }
    }
}

#[test]
fn the_candidates_gate_sees_changes_and_no_detail() {
    let sharp = Vec3::splat(0.9);
    let blurred = Vec3::splat(0.4);
    let reference = wrs::next_reference(blurred, 12, false, wrs::Reference { color: sharp, level: 0 });
    let params = WrsParams { gate: GateCode::DeltaE94, gate_offset: 2.0, inv_gate_divisor: 1.0 / 30.0, ..PAPER };
    let gate = |candidate: Vec3, level: u32| {
        let compared = wrs::compared(candidate, level, wrs::unpack_reference(wrs::pack_reference(reference)));
        wrs::decide_sample(candidate, 0.01, Past { color: compared, ..past(5.0) }, &params, 0.5).gate
    };
    assert_eq!(gate(blurred, 12), 1.0, "detail, at the candidate's scale, and packing are no change");
    assert!(gate(blurred * 0.5, 12) < 0.6, "light is a change");
    assert_eq!(gate(blurred * 0.5, 8), 1.0, "another level says nothing");
    // The literal gate takes the detail for a change.
    let literal = wrs::decide_sample(blurred, 0.01, Past { color: sharp, ..past(5.0) }, &params, 0.5);
    assert!(literal.gate < 0.5, "{}", literal.gate);
}

proptest! {
    #![proptest_config(afterimage_testing::property("references of the gate", 2000))]

    #[test]
    fn references_are_packed_closely_and_stay(
        color in prop::array::uniform3(0.0_f32..=65504.0), shrink in -40_i32..=0, level in 0_u32..64
    ) {
        let color = Vec3::from(color) * 2.0_f32.powi(shrink);
        let word = wrs::pack_reference(wrs::Reference { color, level });
        let read = wrs::unpack_reference(word);
        prop_assert_eq!(read.level, level);
        let bound = color.max_element() / 127.0 + 2.0_f32.powi(-22);
        prop_assert!((read.color - color).abs().max_element() <= bound, "{} {}", color, read.color);
        prop_assert_eq!(wrs::pack_reference(read), word);
    }
}

#[test]
fn rates_are_numbers_of_samples_a_pixel() {
    for exponent in 0..=4_u32 {
        for lod in 0..=8_u32 {
            let samples_per_px = 0.25_f64.powi((lod * exponent) as i32);
            let found = f64::from(wrs::at_rate(1.0, lod as f32, exponent));
            assert!((found / samples_per_px - 1.0).abs() < 1e-6, "{lod}, {exponent}: {found}");
        }
    }
    assert_eq!(wrs::at_rate(1e-30, 8.0, 4), 2.0_f32.powi(-100), "still usable");
}
