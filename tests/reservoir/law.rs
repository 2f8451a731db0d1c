//! The law by which samples are kept: frequencies against probabilities.

use super::*;

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

/// The same through `combine` with one-candidate reservoirs.
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

/// The same through A-ES keys.
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
fn h11_h12_samples_are_kept_in_proportion_to_their_weights() {
    let cases: [(&str, &[f32], u64); 3] = [
        ("constant weights", &[1.0; 10], 1_000_000),
        ("weights 1 2 3 4", &[1.0, 2.0, 3.0, 4.0], 2_500_000),
        ("paper's weights", &[1.0, 0.535, 0.229, 0.092, 0.03], 2_000_000),
    ];
    for (name, weights, trials) in cases {
        let mut draws = Draws::new(name);
        accept(&format!("{name}, update"), p_of_stream(weights, trials, || stream(weights, &mut draws)));
        accept(&format!("{name}, combine"), p_of_stream(weights, trials, || stream_by_combine(weights, &mut draws)));
        accept(&format!("{name}, A-ES"), p_of_stream(weights, trials, || stream_by_keys(weights, &mut draws)));
    }
    // Negative control: a weight off by 1 %.
    let off = [1.0, 2.0, 3.0, 4.04];
    let mut draws = Draws::new("off by 1 %");
    reject("weight off by 1 %", p_of_stream(&[1.0, 2.0, 3.0, 4.0], 4_000_000, || stream(&off, &mut draws)));
}

#[test]
fn h12_exact_enumeration_of_the_law() {
    // Probability of each sample from the acceptance probabilities alone, in f64: prod (1 - p_later) p_i = w_i / sum.
    let weights = [1.0_f64, 2.0, 3.0, 4.0];
    for i in 0..4 {
        let mut sum = 0.0;
        let mut p = 0.0;
        for (j, w) in weights.iter().enumerate() {
            sum += w;
            let accept = w / sum;
            p = if j == i { accept } else { p * (1.0 - accept) };
        }
        assert!((p - weights[i] / 10.0).abs() < 1e-15);
    }
}

#[test]
fn h13_order_is_forgotten_without_bias_and_recency_wins_with_it() {
    let shuffled = [4.0, 1.0, 3.0, 2.0];
    let mut draws = Draws::new("order");
    accept("shuffled weights", p_of_stream(&shuffled, 1_000_000, || stream(&shuffled, &mut draws)));
    // Bernoulli survival, weights 1: acceptance of frame k is 1 / (a_k' + 1), more than 1 / k, so later ones are likelier.
    let n = 10;
    let mut accept_p = vec![];
    let mut a = 0.0_f64;
    for _ in 0..n {
        let kept = if a == 0.0 { 0.0 } else { a * a / (a + 1.0) };
        accept_p.push(1.0 / (kept + 1.0));
        a = kept + 1.0;
    }
    let law: Vec<f64> =
        (0..n).map(|i| accept_p[i] * accept_p[i + 1..].iter().map(|p| 1.0 - p).product::<f64>()).collect();
    assert!(law.windows(2).all(|w| w[0] <= w[1] + 1e-12), "recency order: {law:?}");
    let mut draws = Draws::new("recency");
    let trials = 1_000_000;
    let mut counts = vec![0_u64; n];
    for _ in 0..trials {
        let (mut w_sum, mut sample) = (0.0, 0);
        for i in 0..n {
            let d = step(&PAPER, w_sum, 1.0, draws.uniform());
            w_sum = d.w_sum;
            sample = if d.take { i } else { sample };
        }
        counts[sample] += 1;
    }
    // The first sample is never kept (a' = 0 after the first frame would need a0 > 0): drop empty cells.
    let (mut c, mut e) = (vec![], vec![]);
    for (i, &p) in law.iter().enumerate() {
        if p * trials as f64 >= 5.0 {
            c.push(counts[i]);
            e.push(p * trials as f64);
        } else {
            assert_eq!(counts[i], 0);
        }
    }
    accept("biased stream against its law", p_of_counts(&c, &e));
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
    accept("A (B C)", p_of_counts(&counts[0], &expected));
    accept("(A B) C", p_of_counts(&counts[1], &expected));
}

#[test]
fn p5_the_expected_sample_is_the_weighted_mean() {
    let (a, b) = (3.0_f32, 0.4);
    let kept = f64::from(a) * f64::from(a) / f64::from(a + b);
    let p = f64::from(b) / (kept + f64::from(b));
    for sampler in [SamplerCode::AChao, SamplerCode::AEs] {
        let params = WrsParams { sampler, ..PAPER };
        let mut draws = Draws::new("expected sample");
        let trials = 1_000_000;
        let mut taken = 0;
        for _ in 0..trials {
            // A history of sum a has the key law of one sample of weight a.
            let log_key = reservoir::a_es_log_key(draws.uniform(), a);
            let d = wrs::step(Vec3::ONE, b, Past { log_key, ..past(a) }, &params, draws.uniform());
            taken += u64::from(d.take);
        }
        accept(&format!("replacement rate, {sampler:?}"), p_of_rate(taken, trials, p));
        reject("rate off by 2 %", p_of_rate(taken, trials, 1.02 * p));
    }
}

#[test]
fn p8_survival_follows_the_half_life_formula() {
    for (name, b) in [("4 deg", 0.535_f64), ("10 deg", 0.157), ("20 deg", 0.061), ("30 deg", 0.030)] {
        let mut a = 1.0_f64;
        for _ in 0..18 {
            a = recur64(a, 1.0, 1.0);
        }
        assert!((a - 5.42).abs() < 0.02, "18 foveal frames give {a}");
        let formula = std::f64::consts::LN_2 * (a + b) / b + 0.5 * std::f64::consts::LN_2.powi(2);
        let pixels = 20_000_u64;
        let mut draws = Draws::new(name);
        let mut states = vec![(a as f32, true); pixels as usize];
        let mut alive_exact = 1.0;
        let mut a_exact = a;
        for _ in 0..formula.round() as usize {
            for (w_sum, alive) in &mut states {
                let d = step(&PAPER, *w_sum, b as f32, draws.uniform());
                *w_sum = d.w_sum;
                *alive &= !d.take;
            }
            let kept = a_exact * a_exact / (a_exact + b);
            alive_exact *= kept / (kept + b);
            a_exact = kept + b;
        }
        let alive = states.iter().filter(|s| s.1).count() as u64;
        println!("{name}: formula {formula:.1} frames, {:.3} alive", alive as f64 / pixels as f64);
        accept(&format!("survivors at {name}"), p_of_rate(alive, pixels, alive_exact));
        // The formula itself is good to a frame.
        let per_frame = b / (a + b);
        assert!((alive_exact - 0.5).abs() < 1.2 * per_frame, "{name}: {alive_exact}");
    }
}
