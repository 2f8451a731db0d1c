//! Probabilities of samples on the device: histograms of streams from its own generator and reservoirs.

use super::probe::Probe;
use super::values::floats;
use afterimage::kernel::reservoir;
use afterimage::kernel::reservoir::Reservoir;
use afterimage::kernel::rng;
use afterimage_testing::holds;
use afterimage_testing::{accept, p_of_counts, reject, seed};

/// Streams of up to eight weights: the stream's number, a key, how many of them, 0 for `update`, 1 for `combine`, 2 for
/// A-ES keys, and the weights; how often each was kept.
const STREAMS: Probe = Probe {
    name: "streams of eight",
    module: "reservoir rng",
    words: [12, 8],
    wgsl: || {
        "var counts = array<u32, 8>();
    for (var trial = 0u; trial < in_u(2u); trial++) {
        var kept = Reservoir(0.0, 0u);
        var best = LOWEST;
        var sample = 0u;
        for (var i = 0u; i < 8u; i++) {
            let w = in_f(4u + i);
            let draw = unit_draw(bits(in_u(0u), 8u * trial + i, 0u, in_u(1u)));
            if in_u(3u) == 0u {
                if update(&kept, w, draw) { sample = i; }
            } else if in_u(3u) == 1u {
                let c = combine(kept, Reservoir(w, 1u), draw);
                kept = c.reservoir;
                if c.keep_second { sample = i; }
            } else {
                let log_key = a_es_log_key(draw, w);
                if log_key > best { best = log_key; sample = i; }
            }
        }
        counts[sample] += 1u;
    }
    for (var i = 0u; i < 8u; i++) { out_u(counts[i]); }"
            .into()
    },
    rust: |r, o| {
        let mut counts = [0; 8];
        for trial in 0..r.u(2) {
            let (mut kept, mut best, mut sample) = (Reservoir::default(), f32::MIN, 0);
            for i in 0..8 {
                let w = r.f(4 + i);
                let draw = rng::unit_draw(rng::bits(r.u(0), 8 * trial + i as u32, 0, r.u(1)));
                let take = match r.u(3) {
                    0 => reservoir::update(&mut kept, w, draw),
                    1 => {
                        let (merged, second) = reservoir::combine(kept, Reservoir { w_sum: w, count: 1 }, draw);
                        kept = merged;
                        second
                    }
                    _ => {
                        let log_key = reservoir::a_es_log_key(draw, w);
                        let take = log_key > best;
                        best = if take { log_key } else { best };
                        take
                    }
                };
                sample = if take { i } else { sample };
            }
            counts[sample] += 1;
        }
        counts.into_iter().for_each(|n| o.u(n));
    },
    rows: |rows| rows,
};

/// p-value of the histogram of `trials` streams of `weights` on the device against the law of `law_weights`.
fn p_of_streams(how: u32, weights: &[f32], law_weights: &[f32], trials: u32) -> Option<f64> {
    const ROWS: u32 = 1 << 16;
    let key = seed(&format!("streams {how} {weights:?}")) as u32;
    let mut eight = weights.to_vec();
    eight.resize(8, 0.0);
    let rows: Vec<_> = (0..ROWS).map(|i| [vec![i, key, trials.div_ceil(ROWS), how], floats(&eight)].concat()).collect();
    let out = STREAMS.outputs(&rows)?;
    let count = |i: usize| out.iter().map(|o| u64::from(o[i])).sum::<u64>();
    assert!((weights.len()..8).all(|i| count(i) == 0), "a sample of weight 0");
    let counts: Vec<u64> = (0..weights.len()).map(count).collect();
    let (all, total) = (counts.iter().sum::<u64>() as f64, law_weights.iter().sum::<f32>());
    assert!(all >= f64::from(trials));
    Some(p_of_counts(&counts, &law_weights.iter().map(|w| all * f64::from(w / total)).collect::<Vec<_>>()))
}

#[test]
fn h11_constant_weights_keep_every_frame_as_often() {
    let ones = [1.0; 8];
    let Some(p) = p_of_streams(0, &ones, &ones, 10_000_000) else { return };
    accept("8 frames in 1e7 streams on the device", p);
    assert!(p > 1e-4, "the significance that the case asks for");
    let off = [1.0, 1.0, 1.01, 1.0, 1.0, 1.0, 1.0, 1.0];
    reject("one weight off by 1 %", p_of_streams(0, &off, &ones, 5_000_000).unwrap());
    holds!("H11", Gpu, "p = {p:.2} for 8 frames in 1e7 trials");
}

#[test]
fn h12_samples_are_kept_in_proportion_to_their_weights() {
    let weights = [1.0, 2.0, 3.0, 4.0];
    let mut all = vec![];
    for (how, name) in [(0, "update"), (1, "combine"), (2, "A-ES")] {
        let Some(p) = p_of_streams(how, &weights, &weights, 1_000_000) else { return };
        accept(&format!("weights 1 2 3 4, {name} on the device"), p);
        let off = [1.0, 2.04, 3.0, 4.0];
        reject(&format!("{name}, a weight off by 2 %"), p_of_streams(how, &off, &weights, 1_000_000).unwrap());
        all.push(format!("{p:.2}"));
    }
    holds!("H12", Gpu, "p = {} for update, combine, A-ES; 1e6 trials each", all.join(", "));
}
