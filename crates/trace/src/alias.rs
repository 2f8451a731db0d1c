//! Walker's alias method: draws an index with given probabilities in constant time.

/// The alias table, and each weight's probability. A row is (probability to keep the row's own index, index to take
/// otherwise). Weights that are negative or not finite count as 0. If no weight is above 0, all indices are equally
/// probable.
pub fn alias_table(weights: &[f64]) -> (Vec<(f32, u32)>, Vec<f32>) {
    let n = weights.len();
    let mut weights: Vec<f64> = weights.iter().map(|w| if w.is_finite() && *w > 0.0 { *w } else { 0.0 }).collect();
    let mut sum: f64 = weights.iter().sum();
    if !(sum > 0.0 && sum.is_finite()) {
        weights.fill(1.0);
        sum = n as f64;
    }
    let probabilities = weights.iter().map(|w| (w / sum) as f32).collect();
    let mut share: Vec<f64> = weights.iter().map(|w| w / sum * n as f64).collect();
    let mut rows: Vec<(f32, u32)> = (0..n as u32).map(|i| (1.0, i)).collect();
    let (mut small, mut large): (Vec<usize>, Vec<usize>) = (0..n).partition(|&i| share[i] < 1.0);
    while let (Some(&s), Some(&l)) = (small.last(), large.last()) {
        small.pop();
        rows[s] = (share[s] as f32, l as u32);
        share[l] -= 1.0 - share[s];
        if share[l] < 1.0 {
            large.pop();
            small.push(l);
        }
    }
    (rows, probabilities)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_add_up_to_the_weights() {
        let weights = [0.0, 3.0, 1.0, f64::NAN, 0.5, -1.0, 1e-9, 7.0];
        let (rows, probabilities) = alias_table(&weights);
        let mut got = [0.0; 8];
        for (i, &(keep, alias)) in rows.iter().enumerate() {
            got[i] += f64::from(keep) / 8.0;
            got[alias as usize] += (1.0 - f64::from(keep)) / 8.0;
        }
        for i in 0..8 {
            let expected = if weights[i] > 0.0 { weights[i] / 11.500000001 } else { 0.0 };
            assert!(
                (got[i] - expected).abs() < 1e-7 && (f64::from(probabilities[i]) - expected).abs() < 1e-7,
                "{i}: {}",
                got[i]
            );
        }
    }

    #[test]
    fn no_weight_at_all_is_all_alike_and_none_is_none() {
        assert_eq!(alias_table(&[0.0, 0.0]), (vec![(1.0, 0), (1.0, 1)], vec![0.5, 0.5]));
        assert_eq!(alias_table(&[]), (vec![], vec![]));
    }
}
