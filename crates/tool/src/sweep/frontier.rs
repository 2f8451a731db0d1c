//! Pareto frontier of cost and error.

/// Cost and error of a point; less is better.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// Milliseconds.
    pub cost_ms: f64,
    /// Share of the samples that the renderer traces: a second cost if the renderer's time is not known, else 0.
    pub samples_share: f64,
    /// Error.
    pub error: f64,
}

impl Standing {
    /// Whether no part is greater than the same part of `other`, and at least one is smaller.
    fn dominates(&self, other: &Self) -> bool {
        let (a, b) = (self.parts(), other.parts());
        a.iter().zip(&b).all(|(a, b)| a <= b) && a != b
    }

    fn parts(&self) -> [f64; 3] {
        [self.cost_ms, self.samples_share, self.error]
    }
}

/// For each point, whether it is on the frontier: no other point dominates it. Points with NaN are not on it.
pub fn frontier(points: &[Standing]) -> Vec<bool> {
    let is_valid = |p: &Standing| p.parts().iter().all(|v| !v.is_nan());
    // In ascending order, only an earlier point on the frontier can dominate a point.
    let mut order: Vec<usize> = (0..points.len()).filter(|&i| is_valid(&points[i])).collect();
    order.sort_by(|&a, &b| {
        let (a, b) = (points[a].parts(), points[b].parts());
        a.iter().zip(&b).map(|(a, b)| a.total_cmp(b)).find(|o| o.is_ne()).unwrap_or(std::cmp::Ordering::Equal)
    });
    let mut best: Vec<usize> = vec![];
    for i in order {
        if !best.iter().any(|&b| points[b].dominates(&points[i])) {
            best.push(i);
        }
    }
    let mut is_best = vec![false; points.len()];
    best.into_iter().for_each(|i| is_best[i] = true);
    is_best
}
