//! Hard cases of reservoirs and random numbers on the device: its results, equal to Rust's in every bit.

use super::probe::{Probe, named};
use super::values::floats;
use super::{decisions, state};
use afterimage::kernel::wrs;
use afterimage::kernel::wrs::{BiasCode, GateCode, Past, SamplerCode, WrsParams};
use afterimage::kernel::{reservoir, rng};
use afterimage_testing::holds;
use afterimage_testing::{accept, p_of_z};
use glam::Vec3;

const LARGEST_DRAW: f32 = 16_777_215.0 / 16_777_216.0;

/// Words of the probe of `step`: A-Chao or A-ES, Bernoulli survival and the gate of the paper.
fn step_row(sampler: u32, candidate: [f32; 3], weight: f32, color: [f32; 3], w_sum: f32, draw: f32) -> Vec<u32> {
    let numbers = [&[1.0, 0.0, 0.01][..], &candidate, &[weight], &color, &[w_sum, -0.3, draw]].concat();
    [vec![sampler, 2, 1], floats(&numbers)].concat()
}

/// Result of `step` on the device: taken, weight sum, log key, gate, survival.
fn steps(rows: &[Vec<u32>]) -> Option<Vec<(bool, [f32; 4])>> {
    let out = named(decisions::PROBES, "step").outputs(rows)?;
    Some(out.iter().map(|o| (o[0] != 0, [1, 2, 3, 4].map(|k| f32::from_bits(o[k])))).collect())
}

/// Result of `combine` on the device: whether the second is kept, weight sum, count.
fn combined(rows: &[([f32; 2], f32)]) -> Option<Vec<(bool, f32, u32)>> {
    let words = |&([a, b], draw): &([f32; 2], f32)| vec![a.to_bits(), 7, b.to_bits(), 1, draw.to_bits()];
    let out = named(state::PROBES, "combine").outputs(&rows.iter().map(words).collect::<Vec<_>>())?;
    Some(out.iter().map(|o| (o[0] != 0, f32::from_bits(o[1]), o[2])).collect())
}

/// Result of `update` on a sum of 2 and a count: taken, weight sum, count.
fn updated(w_sum: f32, count: u32, weights: &[f32], draw: f32) -> Option<Vec<(bool, f32, u32)>> {
    let words = |w: &f32| vec![w_sum.to_bits(), count, w.to_bits(), draw.to_bits()];
    let out = named(state::PROBES, "update").outputs(&weights.iter().map(words).collect::<Vec<_>>())?;
    Some(out.iter().map(|o| (o[0] != 0, f32::from_bits(o[1]), o[2])).collect())
}

#[test]
fn h01_an_empty_reservoir_never_wins() {
    let draws = [0.0, 0.5, LARGEST_DRAW];
    let Some(merged) = combined(&draws.map(|d| ([0.0, 1e-3], d))) else { return };
    assert!(merged.iter().all(|&m| m == (true, 1e-3, 8)), "{merged:?}");
    assert!(draws.iter().all(|&d| updated(0.0, 0, &[1e-3], d) == Some(vec![(true, 1e-3, 1)])));
    let rows: Vec<_> =
        draws.iter().flat_map(|&d| [0, 1].map(|s| step_row(s, [0.3; 3], 1e-3, [0.0; 3], 0.0, d))).collect();
    let decided = steps(&rows).unwrap();
    assert!(decided.iter().all(|d| d.0 && d.1[0] == 1e-3), "{decided:?}");
    holds!("H01", Gpu, "R2 chosen by update, combine and step at draws 0, 1/2 and 1 - 2^-24");
}

#[test]
fn h02_two_empty_reservoirs_keep_the_newer_color() {
    let Some(merged) = combined(&[([0.0, 0.0], 0.0), ([0.0, 0.0], 0.5)]) else { return };
    assert!(merged.iter().all(|&m| m == (true, 0.0, 8)), "{merged:?}");
    let decided = steps(&[0, 1].map(|s| step_row(s, [0.3; 3], 0.0, [0.1; 3], 0.0, 0.0))).unwrap();
    assert!(
        decided.iter().all(|&(take, [w_sum, _, gate, survival])| take && [w_sum, gate, survival] == [0.0, 1.0, 1.0])
    );
    holds!("H02", Gpu, "the second's color, w_sum 0, survival 1, for both samplers");
}

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
    assert!((s - 1412.7).abs() < 0.5, "{s}");
    holds!("H08", Gpu, "s = {s:.2} after 1e6 frames, sqrt(2n) = {:.2}", 2e6_f32.sqrt());
}

#[test]
fn h04_denormal_weights_count_as_0() {
    let tiny = 1e-40;
    let Some(merged) = combined(&[([tiny, tiny], 0.5), ([tiny, 1.0], LARGEST_DRAW), ([1.0, tiny], 0.0)]) else {
        return;
    };
    assert_eq!(merged, [(true, 0.0, 8), (true, 1.0, 8), (false, 1.0, 8)]);
    assert_eq!(updated(0.0, 0, &[tiny], 0.0), Some(vec![(false, 0.0, 1)]));
    // A denormal product of survival counts as 0, whether or not the device flushes denormals.
    let sum = 4.0 * f32::MIN_POSITIVE;
    let decided = steps(&[step_row(0, [0.3; 3], 0.5, [0.3; 3], sum, LARGEST_DRAW)]).unwrap();
    assert!(decided[0].0 && decided[0].1[0] == 0.5);
    holds!("H04", Gpu, "1e-40 counts as 0 in combine, update and survival");
}

#[test]
fn h15_h17_h18_bad_weights_leave_the_reservoir_as_it_was_and_counts_saturate() {
    let bad = [-1.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    let Some(after) = updated(2.0, u32::MAX, &bad, 0.0) else { return };
    assert!(after.iter().all(|&a| a == (false, 2.0, u32::MAX)), "{after:?}");
    let merged = combined(&bad.map(|b| ([2.0, b], 0.0))).unwrap();
    assert!(merged.iter().all(|&m| m == (false, 2.0, 8)), "{merged:?}");
    let healed = combined(&bad.map(|b| ([b, 0.5], LARGEST_DRAW))).unwrap();
    assert!(healed.iter().all(|&m| m == (true, 0.5, 8)), "{healed:?}");
    holds!("H15", Gpu, "count stays at 2^32-1");
    holds!("H17", Gpu, "-1 counts as 0: w_sum stays 2, the first is kept");
    holds!("H18", Gpu, "NaN and +-Inf count as 0: w_sum stays 2, the first is kept at a draw of 0");
}

#[test]
fn h19_a_corrupt_key_loses_to_the_next_candidate() {
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 5.0];
    let row = |key: f32| {
        let mut row = step_row(1, [0.3; 3], 0.02, [0.3; 3], 5.42, 0.0);
        row[14] = key.to_bits();
        row
    };
    let Some(decided) = steps(&bad.map(row)) else { return };
    assert!(decided.iter().all(|d| d.0 && (f32::MIN..=0.0).contains(&d.1[1])), "{decided:?}");
    holds!("H19", Gpu, "NaN, +-Inf and 5 as A-ES keys lose to the next candidate at a draw of 0");
}

#[test]
fn h20_a_difference_beyond_100_takes_the_candidate_for_certain() {
    // Delta E 94 of 150, the most in sRGB, and L* of 276.
    let bright = [((276.0_f32 + 16.0) / 116.0).powi(3); 3];
    let rows = [([0.0; 3], bright), (bright, [0.0; 3]), ([0.0; 3], [65504.0; 3])]
        .map(|(a, b)| step_row(0, a, 0.25, b, 1e6, LARGEST_DRAW));
    let Some(decided) = steps(&rows) else { return };
    assert!(
        decided.iter().all(|&(take, [w_sum, _, gate, survival])| take && [w_sum, gate, survival] == [0.25, 0.0, 0.0])
    );
    holds!("H20", Gpu, "gate 0 and w_sum the candidate's 0.25 for L* 276 and 4660 against black");
}

#[test]
fn h21_survival_does_not_cancel() {
    let mut draws = afterimage_testing::Draws::new("survival on the device");
    let rows: Vec<[f32; 2]> = (0..100_000)
        .map(|i| {
            let a = 10.0_f32.powf(draws.range(-6.0, 6.0));
            [a, a * if i % 4 == 0 { 1e7 } else { 10.0_f32.powf(draws.range(-7.0, 7.0)) }]
        })
        .collect();
    let words: Vec<_> = rows.iter().map(|r| floats(r)).collect();
    let Some(out) = named(state::PROBES, "bernoulli_survival").outputs(&words) else { return };
    let worst = rows.iter().zip(&out).fold(0.0_f64, |worst, ([a, b], o)| {
        let exact = f64::from(*a) / (f64::from(*a) + f64::from(*b));
        let spacing = f64::from((exact as f32).next_up()) - f64::from(exact as f32);
        worst.max((f64::from(f32::from_bits(o[0])) - exact).abs() / spacing)
    });
    assert!(worst < 4.0, "{worst} ulp");
    assert!(reservoir::bernoulli_survival(1.0, 1e7) > 0.0);
    holds!("H21", Gpu, "{worst:.2} ulp for ratios 1e-7 to 1e7");
}

#[test]
fn h23_draws_stay_below_1() {
    let top: Vec<_> = (0..1000).map(|k| vec![u32::MAX - k]).chain([vec![0]]).collect();
    let Some(out) = named(state::PROBES, "unit_draw").outputs(&top) else { return };
    let largest = out.iter().map(|o| f32::from_bits(o[0])).fold(0.0, f32::max);
    assert_eq!(largest, LARGEST_DRAW);
    assert_eq!(out[1000], [0]);
    holds!("H23", Gpu, "largest draw 1 - {:.2e}", 1.0 - f64::from(largest));
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
