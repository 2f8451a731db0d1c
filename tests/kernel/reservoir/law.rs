//! The law by which samples are kept: frequencies against probabilities.

use super::*;
use afterimage_testing::holds;

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

/// Index of the sample after a stream of `weights` through `combine` with one-candidate reservoirs.
fn stream_by_combine(weights: &[f32], draws: &mut Draws) -> usize {
    let mut r = Reservoir::default();
    let mut sample = 0;
    for (i, &w) in weights.iter().enumerate() {
        let (merged, second) = reservoir::combine(r, Reservoir { w_sum: w, count: 1 }, draws.uniform());
        r = merged;
        sample = if second { i } else { sample };
    }
    sample
}

/// Index of the sample after a stream of `weights`, by A-ES keys.
fn stream_by_keys(weights: &[f32], draws: &mut Draws) -> usize {
    let keys = weights.iter().map(|&w| reservoir::a_es_log_key(draws.uniform(), w));
    keys.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap().0
}

fn p_of_stream(weights: &[f32], trials: u64, mut one: impl FnMut() -> usize) -> f64 {
    let mut counts = vec![0_u64; weights.len()];
    for _ in 0..trials {
        counts[one()] += 1;
    }
    let total: f32 = weights.iter().sum();
    let expected: Vec<f64> = weights.iter().map(|w| f64::from(w / total) * trials as f64).collect();
    p_of_counts(&counts, &expected)
}

#[test]
fn h11_constant_weights_keep_every_frame_as_often() {
    let (weights, trials) = ([1.0; 10], 10_000_000);
    let mut draws = Draws::new("constant weights");
    let p = p_of_stream(&weights, trials, || stream(&weights, &mut draws));
    accept("constant weights, update", p);
    assert!(p > 1e-4, "the significance that the case asks for");
    accept("constant weights, combine", p_of_stream(&weights, 1_000_000, || stream_by_combine(&weights, &mut draws)));
    accept("constant weights, A-ES", p_of_stream(&weights, 1_000_000, || stream_by_keys(&weights, &mut draws)));
    let off = [1.0, 1.0, 1.0, 1.0, 1.01, 1.0, 1.0, 1.0, 1.0, 1.0];
    reject("one weight off by 1 %", p_of_stream(&weights, trials, || stream(&off, &mut draws)));
    holds!("H11", Cpu, "p = {p:.2} for 10 frames in 1e7 trials");
}

/// Chooses one of a stream with these weights.
type Chooser<'a> = &'a mut dyn FnMut(&[f32], &mut Draws) -> usize;

#[test]
fn h12_samples_are_kept_in_proportion_to_their_weights() {
    let mut first = 0.0;
    for (name, weights) in
        [("weights 1 2 3 4", [1.0, 2.0, 3.0, 4.0].as_slice()), ("paper's weights", &[1.0, 0.535, 0.229, 0.092, 0.03])]
    {
        let (mut draws, trials) = (Draws::new(name), 2_500_000);
        let mut off = weights.to_vec();
        off[1] *= 1.02;
        let all: [(&str, Chooser); 3] = [
            ("update", &mut |w, d| stream(w, d)),
            ("combine", &mut |w, d| stream_by_combine(w, d)),
            ("A-ES", &mut |w, d| stream_by_keys(w, d)),
        ];
        for (how, one) in all {
            let p = p_of_stream(weights, trials, || one(weights, &mut draws));
            accept(&format!("{name}, {how}"), p);
            first = if first == 0.0 { p } else { first };
            reject(&format!("{how}, a weight off by 2 %"), p_of_stream(weights, trials, || one(&off, &mut draws)));
        }
    }
    holds!("H12", Cpu, "p = {first:.2} against the enumerated law w_i / 10, 2.5e6 trials");
}

/// Exact probability of each sample of a biased stream: its acceptance, and that no later one is accepted.
fn biased_law(params: &WrsParams, weights: &[f32]) -> Vec<f64> {
    let mut a = 0.0_f64;
    let mut accepted = vec![];
    for w in weights.iter().map(|&w| f64::from(w)) {
        let kept = match params.bias {
            BiasCode::None => a,
            BiasCode::Exponential => a * f64::from(params.exponential_survival),
            BiasCode::Bernoulli => a * a / (a + w),
        };
        a = kept + w;
        accepted.push(w / a);
    }
    (0..weights.len()).map(|i| accepted[i] * accepted[i + 1..].iter().map(|p| 1.0 - p).product::<f64>()).collect()
}

/// How often each sample of a stream through `step` is kept.
pub fn biased_counts(params: &WrsParams, weights: &[f32], trials: usize, draws: &mut Draws) -> Vec<u64> {
    let mut counts = vec![0_u64; weights.len()];
    for _ in 0..trials {
        let (mut state, mut sample) = (past(0.0), 0);
        for (i, &w) in weights.iter().enumerate() {
            let d = wrs::decide_sample(Vec3::ONE, w, state, params, draws.uniform());
            state = Past { w_sum: d.w_sum, log_key: d.log_key, ..state };
            sample = if d.take { i } else { sample };
        }
        counts[sample] += 1;
    }
    counts
}

/// p-value of counts against a law. Samples of negligible probability are left out and must not occur.
pub fn p_of_law(counts: &[u64], law: &[f64]) -> f64 {
    let trials = counts.iter().sum::<u64>() as f64;
    let (possible, forbidden): (Vec<_>, Vec<_>) = counts.iter().zip(law).partition(|(_, p)| **p * trials >= 5.0);
    assert!(forbidden.iter().all(|(n, p)| **n as f64 <= 10.0 * (**p * trials) + 1e-9), "{counts:?} by {law:?}");
    let (c, e): (Vec<u64>, Vec<f64>) = possible.into_iter().map(|(n, p)| (*n, p * trials)).unzip();
    p_of_counts(&c, &e)
}

#[test]
fn every_bias_keeps_samples_by_its_own_law() {
    let weights = [1.0, 1.0, 0.535, 0.2, 1.0, 0.09, 0.3, 0.3];
    for (name, bias) in
        [("no bias", BiasCode::None), ("exponential", BiasCode::Exponential), ("Bernoulli", BiasCode::Bernoulli)]
    {
        for sampler in [SamplerCode::AChao, SamplerCode::AEs] {
            let params = WrsParams { sampler, bias, exponential_survival: 0.8, ..PAPER };
            let law = biased_law(&params, &weights);
            assert!((law.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            let mut draws = Draws::new(&format!("{name}, {sampler:?}"));
            let counts = biased_counts(&params, &weights, 1_000_000, &mut draws);
            accept(&format!("{name}, {sampler:?}"), p_of_law(&counts, &law));
            let other = match bias {
                BiasCode::Exponential => WrsParams { exponential_survival: 0.81, ..params },
                BiasCode::None => WrsParams { bias: BiasCode::Exponential, exponential_survival: 0.99, ..params },
                BiasCode::Bernoulli => WrsParams { bias: BiasCode::Exponential, ..params },
            };
            reject("another bias", p_of_law(&counts, &biased_law(&other, &weights)));
        }
    }
}

#[test]
fn h13_order_is_forgotten_without_bias_and_recency_wins_with_it() {
    let (sorted, shuffled) = ([1.0_f32, 2.0, 3.0, 4.0], [4.0_f32, 1.0, 3.0, 2.0]);
    let unbiased = WrsParams { bias: BiasCode::None, ..PAPER };
    let mut draws = Draws::new("order");
    let mut p = [0.0; 2];
    for (p, weights) in p.iter_mut().zip([sorted, shuffled]) {
        let law = weights.map(|w| f64::from(w) / 10.0);
        *p = p_of_law(&biased_counts(&unbiased, &weights, 1_000_000, &mut draws), &law);
        accept(&format!("weights {weights:?}, no bias"), *p);
        // With bias, the same weights are not kept in proportion.
        reject("biased", p_of_law(&biased_counts(&PAPER, &weights, 100_000, &mut draws), &law));
    }
    // Bernoulli survival, weights 1: acceptance of frame k is more than 1 / k, so later ones are likelier.
    let ones = [1.0; 10];
    let law = biased_law(&PAPER, &ones);
    assert!(law.windows(2).all(|w| w[0] <= w[1] + 1e-12), "recency order: {law:?}");
    let counts = biased_counts(&PAPER, &ones, 1_000_000, &mut draws);
    let recency = p_of_law(&counts, &law);
    accept("biased stream against its law", recency);
    reject("biased stream against equal shares", p_of_law(&counts, &[0.1; 10]));
    let last = law[9] / law[4];
    holds!(
        "H13",
        Cpu,
        "p = {:.2}, {:.2} in two orders; biased: the 10th {last:.1}x the 5th, p = {recency:.2}",
        p[0],
        p[1]
    );
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
    let p = counts.map(|c| p_of_counts(&c, &expected));
    accept("A (B C)", p[0]);
    accept("(A B) C", p[1]);
    // The planted error: an inner combine that keeps the larger sum instead of adding both.
    let mut forgetful = [0_u64; 3];
    for _ in 0..1_000_000 {
        let (_, c) = reservoir::combine(leaf(wb), leaf(wc), draws.uniform());
        let (_, second) = reservoir::combine(leaf(wa), leaf(wb.max(wc)), draws.uniform());
        forgetful[if second { 1 + usize::from(c) } else { 0 }] += 1;
    }
    reject("sums that are not added", p_of_counts(&forgetful, &expected));
    holds!("H14", Cpu, "p = {:.2} and {:.2} against w_i / (sum of w), 1e6 trials", p[0], p[1]);
}
