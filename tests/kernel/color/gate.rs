//! The gate: differences that it must and must not react to.

use super::*;
use afterimage::kernel::wrs::{BiasCode, Past, SamplerCode, WrsParams};
use afterimage_testing::holds;

/// Decision for a history of color `sample` and sum `w_sum`, with a gate of `offset`.
fn step(candidate: Vec3, weight: f32, sample: Vec3, w_sum: f32, offset: f32, draw: f32) -> wrs::Decision {
    let params = WrsParams {
        sampler: SamplerCode::AChao,
        bias: BiasCode::Bernoulli,
        exponential_survival: 1.0,
        gate: DELTA_E,
        gate_offset: offset,
        inv_gate_divisor: 0.01,
    };
    wrs::decide_sample(candidate, weight, Past { color: sample, w_sum, log_key: f32::MIN }, &params, draw)
}

#[test]
fn h34_a_gate_with_an_offset_for_noise_does_not_see_dark_noise() {
    let differs = |a: f32, b: f32| wrs::difference(Vec3::splat(a), Vec3::splat(b), DELTA_E);
    let one_sigma = differs(0.0, 0.002);
    assert_abs_diff_eq!(one_sigma, 1.81, epsilon = 0.01);
    // Candidates around 0.01 with that noise, at the weight of 10 degrees, over a history of 18 foveal frames: how open
    // the gate is, how often it all but shuts, and how likely the sample is kept for 25 frames (about half, if nothing
    // but eq. 5 forgets).
    let run = |offset: f32| {
        let mut draws = Draws::new("dark noise");
        let mut normal = || (0..12).map(|_| draws.uniform()).sum::<f32>() - 6.0;
        let (mut open, mut shut, mut left) = (0_u32, 0_u32, 0.0);
        for _ in 0..4_000 {
            let (sample, mut a, mut alive) = (Vec3::splat(0.01 + 0.002 * normal()), 5.42, 1.0);
            for _ in 0..25 {
                let d = step(Vec3::splat(0.01 + 0.002 * normal()), 0.157, sample, a, offset, 0.0);
                alive *= 1.0 - 0.157 / d.w_sum;
                a = d.w_sum;
                open += u32::from(d.gate == 1.0);
                shut += u32::from(d.gate < 0.5);
            }
            left += alive / 4_000.0;
        }
        (f64::from(open) / 100_000.0, shut, left)
    };
    // Three standard deviations of the difference of two such candidates.
    let (published, offset, ungated) = (run(0.0), run(7.7), run(f32::MAX));
    assert_eq!((published.1, offset.1), (0, 0), "never rejected");
    assert!(offset.0 > 0.99 && (offset.2 - ungated.2).abs() < 1e-3, "as if there were no noise");
    assert!(published.2 < ungated.2 - 0.05, "the case must really occur");
    holds!(
        "H34",
        Cpu,
        "dL* {one_sigma:.2}, none rejected; {:.1} % kept for 25 frames with offset 7.7, {:.1} % without, {:.1} % ungated",
        100.0 * offset.2,
        100.0 * published.2,
        100.0 * ungated.2
    );
}

#[test]
fn h35_an_8_bit_step_near_black_closes_the_gate_by_a_few_percent_or_not_at_all() {
    let differs = |a: f32, b: f32| wrs::difference(Vec3::splat(a), Vec3::splat(b), DELTA_E);
    let linear = differs(0.0, 1.0 / 255.0);
    assert_abs_diff_eq!(linear, 3.54, epsilon = 0.01);
    assert!(wrs::gate(linear, 0.0, 0.01) > 0.96);
    assert_eq!(wrs::gate(linear, 3.6, 0.01), 1.0);
    // Steps of 8-bit sRGB, the usual quantisation, at any level.
    let code = |i: u32| color::srgb_decode(i as f32 / 255.0);
    let encoded = (0..255).map(|i| differs(code(i), code(i + 1))).fold(0.0, f32::max);
    assert!(encoded < 0.6 && wrs::gate(encoded, 0.0, 0.01) > 0.994, "{encoded}");
    holds!(
        "H35",
        Cpu,
        "dL* {linear:.2}: gate 0.965, with offset 3.6 it is 1; 8-bit sRGB steps are {encoded:.2} at most"
    );
}
