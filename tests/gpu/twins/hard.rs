//! Hard cases of the kernel's functions on the device: its results, equal to Rust's in every bit.

use super::library::probes;
use super::probe::{Probe, named};
use super::state;
use crate::kernel_hard::*;
use crate::laws::laws;
use afterimage::kernel::wrs::{BiasCode, GateCode, Past, SamplerCode, WrsParams};
use afterimage::kernel::{rng, wrs};
use afterimage::shader::SHADERS;
use afterimage_testing::gpu::rounds_as_the_cpu;
use afterimage_testing::{accept, holds, p_of_z};
use glam::Vec3;

/// What a law measured; `None`, after a message, without an adapter.
fn held(law: fn(Call<'_>) -> Option<String>) -> Option<String> {
    law(&|function, rows| probes().find(|probe| probe.name == function).expect(function).outputs(rows))
}

kernel_laws!(Gpu, held);

/// A stream of candidates of one weight on a history: frames, then sampler, weight, weight sum and log key; how many
/// were taken, weight sum and log key after.
const STREAM: Probe = Probe {
    name: "a stream of one weight",
    module: "wrs rng",
    words: [5, 3],
    wgsl: || {
        "var past = Past(vec3<f32>(0.5), in_f(3u), in_f(4u));
    let params = WrsParams(in_u(1u), BIAS_BERNOULLI, 1.0, GATE_OFF, 0.0, 0.01);
    var taken = 0u;
    for (var n = 0u; n < in_u(0u); n++) {
        let d = step(vec3<f32>(0.25), in_f(2u), past, params, unit_draw(bits(n, 0u, 0u, 0u)));
        taken += select(0u, 1u, d.take);
        past.w_sum = d.w_sum;
        past.log_key = d.log_key;
    }
    out_u(taken); out_f(past.w_sum); out_f(past.log_key);"
            .into()
    },
    rust: |r, o| {
        let mut past = Past { color: Vec3::splat(0.5), w_sum: r.f(3), log_key: r.f(4) };
        let params = WrsParams {
            sampler: [SamplerCode::AChao, SamplerCode::AEs][r.u(1) as usize],
            bias: BiasCode::Bernoulli,
            exponential_survival: 1.0,
            gate: GateCode::Off,
            gate_offset: 0.0,
            inv_gate_divisor: 0.01,
        };
        let mut taken = 0;
        for n in 0..r.u(0) {
            let draw = rng::unit_draw(rng::bits(n, 0, 0, 0));
            let d = wrs::step(Vec3::splat(0.25), r.f(2), past, &params, draw);
            taken += u32::from(d.take);
            past = Past { w_sum: d.w_sum, log_key: d.log_key, ..past };
        }
        o.u(taken);
        o.f(past.w_sum);
        o.f(past.log_key);
    },
    rows: |rows| rows,
};

/// `frames` of a stream; software devices end a loop after 65,535 rounds, so in pieces. Taken, weight sum, log key.
fn streamed(frames: u32, sampler: u32, weight: f32, w_sum: f32, log_key: f32) -> Option<(u32, f32, f32)> {
    let (mut taken, mut state, mut left) = (0, [w_sum, log_key].map(f32::to_bits), frames);
    while left > 0 {
        let piece = left.min(50_000);
        let out = STREAM.outputs(&[vec![piece, sampler, weight.to_bits(), state[0], state[1]]])?;
        (taken, state, left) = (taken + out[0][0], [out[0][1], out[0][2]], left - piece);
    }
    Some((taken, f32::from_bits(state[0]), f32::from_bits(state[1])))
}

#[test]
fn h03_candidates_of_weight_0_change_nothing() {
    let Some(by_sums) = streamed(100_000, 0, 0.0, 5.42, -0.3) else { return };
    let by_keys = streamed(100_000, 1, 0.0, 5.42, -0.3).unwrap();
    assert_eq!((by_sums.0, by_sums.1), (0, 5.42));
    assert_eq!(by_keys, (0, 5.42, -0.3));
    holds!("H03", Gpu, "w_sum {}, key {} after 1e5 frames, none taken", by_keys.1, by_keys.2);
}

#[test]
fn h08_a_million_frames_in_f32_follow_the_closed_form() {
    let Some((_, s, _)) = streamed(999_999, 0, 1.0, 1.0, 0.0) else { return };
    // Rounding in f32 sums up to -1.5 on the CPU; elsewhere it may fall otherwise.
    let (expected, within) = if rounds_as_the_cpu() { (1412.7, 0.5) } else { (2e6_f32.sqrt(), 2.0) };
    assert!((s - expected).abs() < within, "{s}");
    holds!("H08", Gpu, "s = {s:.2} after 1e6 frames, sqrt(2n) = {:.2}", 2e6_f32.sqrt());
}

#[test]
fn h26_no_period_at_the_row_length() {
    let key = rng::stream_key(1, 0, rng::Purpose::Select, 0);
    let mut least = 1.0_f64;
    for width in [1_u32, 3, 4095, 4097] {
        let rows = (100_000 / width).clamp(16, 65_536);
        let words: Vec<_> = (0..=rows).flat_map(|y| (0..width).map(move |x| vec![x, y, 0, key])).collect();
        let Some(out) = named(state::PROBES, "bits").outputs(&words) else { return };
        let centred = |i: usize| f64::from(rng::unit_draw(out[i][0])) - 0.5;
        let n = (rows * width) as usize;
        let sum: f64 = (0..n).map(|i| 12.0 * centred(i) * centred(i + width as usize)).sum();
        let p = p_of_z(sum / (n as f64).sqrt());
        accept(&format!("width {width}"), p);
        least = least.min(p);
    }
    holds!("H26", Gpu, "p >= {least:.2} between rows of widths 1, 3, 4095, 4097");
}

#[test]
fn h38_no_power_is_called() {
    // The accuracy of the device's own powers and logarithms is implementation-defined.
    let passes = ["wrs_pass", "smr_pass", "taa_pass"];
    for pass in passes {
        let source = SHADERS.compose(pass).source;
        let code: String = source.lines().map(|l| l.split("//").next().unwrap()).collect::<Vec<_>>().join("\n");
        let called = |name: &str| {
            code.match_indices(name).any(|(i, _)| !code[..i].ends_with(|c: char| c.is_alphanumeric() || c == '_'))
        };
        assert!(!["pow(", "log2(", "log("].into_iter().any(called), "{pass}");
        assert!(called("cbrt(") || pass != "wrs_pass");
    }
    holds!("H38", Gpu, "no pow in {} passes", passes.len());
}
