//! Points that nothing beats.

/// What a point costs and how wrong it is; less of each is better.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standing {
    /// Milliseconds.
    pub cost_ms: f64,
    /// Share of the samples that the renderer shades: a second cost, where it is not known what it comes to in milliseconds; else 0.
    pub samples_share: f64,
    /// Error.
    pub error: f64,
}

impl Standing {
    /// Whether nothing about it is worse than about `other`, and something is better.
    fn beats(&self, other: &Self) -> bool {
        let (a, b) = (self.parts(), other.parts());
        a.iter().zip(&b).all(|(a, b)| a <= b) && a != b
    }

    fn parts(&self) -> [f64; 3] {
        [self.cost_ms, self.samples_share, self.error]
    }
}

/// Which of the points no other point beats. NaN is never one of them.
pub fn frontier(points: &[Standing]) -> Vec<bool> {
    let sound = |p: &Standing| p.parts().iter().all(|v| !v.is_nan());
    // In order of cost a point can only be beaten by those before it, and of those only by ones that are on the frontier.
    let mut order: Vec<usize> = (0..points.len()).filter(|&i| sound(&points[i])).collect();
    order.sort_by(|&a, &b| {
        let (a, b) = (points[a].parts(), points[b].parts());
        a.iter().zip(&b).map(|(a, b)| a.total_cmp(b)).find(|o| o.is_ne()).unwrap_or(std::cmp::Ordering::Equal)
    });
    let mut best: Vec<usize> = vec![];
    for i in order {
        if !best.iter().any(|&b| points[b].beats(&points[i])) {
            best.push(i);
        }
    }
    let mut is_best = vec![false; points.len()];
    best.into_iter().for_each(|i| is_best[i] = true);
    is_best
}
