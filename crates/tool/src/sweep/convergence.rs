//! Convergence of traced points: squared error against samples and against time.

use super::row::Row;
use serde::Serialize;
use std::collections::BTreeMap;

/// Options that set the number of samples, not their pattern.
const SAMPLES: [&str; 2] = ["spp", "region-spp"];
/// Smallest number of points for a slope.
const MIN_POINTS: usize = 3;

/// One pattern and method at several sample counts.
#[derive(Clone, Debug, Serialize)]
pub struct Convergence {
    /// The traced scene.
    pub input: String,
    /// Name of the method.
    pub method: String,
    /// Method and options that the points share.
    pub label: String,
    /// In ascending order of samples.
    pub points: Vec<ConvergencePoint>,
    /// Least-squares slope of lg(squared error) against lg(samples): whole image, then fovea, middle, periphery.
    /// Independent samples without bias have -1.
    pub slope_by_samples: [Option<f64>; 4],
    /// Least-squares slope of lg(squared error) against lg(milliseconds), in the same order.
    pub slope_by_time: [Option<f64>; 4],
}

/// Errors at one sample count.
#[derive(Clone, Debug, Serialize)]
pub struct ConvergencePoint {
    /// [`Row::id`].
    pub id: String,
    /// Mean samples per pixel of the frame.
    pub samples_per_pixel: f64,
    /// Milliseconds per frame of tracing and the method.
    pub cost_ms: f64,
    /// Mean squared error: whole image, then fovea, middle, periphery.
    pub mse: [Option<f64>; 4],
    /// 1 / (squared error x seconds), in the same order. Squared error instead of variance includes the bias of pixels
    /// that are interpolated between samples.
    pub efficiency: [Option<f64>; 4],
}

/// Convergence of every pattern and method with at least three sample counts.
pub(super) fn convergences(rows: &[Row]) -> Vec<Convergence> {
    let mut groups: BTreeMap<_, Vec<&Row>> = BTreeMap::new();
    for row in rows.iter().filter(|r| r.samples_per_pixel.is_some()) {
        let mut options = row.point.options.clone();
        options.retain(|name, _| !SAMPLES.contains(&name.as_str()));
        groups.entry((row.point.input.clone(), row.point.method.clone(), options)).or_default().push(row);
    }
    let of = |((input, method, options), mut rows): ((String, String, super::Options), Vec<&Row>)| {
        rows.sort_by(|a, b| a.samples_per_pixel.unwrap_or(0.0).total_cmp(&b.samples_per_pixel.unwrap_or(0.0)));
        let points: Vec<ConvergencePoint> = rows.iter().filter_map(|row| point(row)).collect();
        let words = options.iter().map(|(name, value)| format!("{name} {value}").trim_end().to_owned());
        let label = [method.clone()].into_iter().chain(words).collect::<Vec<_>>().join(", ");
        let slopes = |x: &dyn Fn(&ConvergencePoint) -> f64| {
            [0, 1, 2, 3].map(|i| slope(points.iter().filter_map(|p| Some((x(p), p.mse[i]?)))))
        };
        let (slope_by_samples, slope_by_time) = (slopes(&|p| p.samples_per_pixel), slopes(&|p| p.cost_ms));
        Convergence { input, method, label, slope_by_samples, slope_by_time, points }
    };
    groups.into_iter().filter(|(_, rows)| rows.len() >= MIN_POINTS).map(of).collect()
}

fn point(row: &Row) -> Option<ConvergencePoint> {
    let mse = row.mse;
    let seconds = row.cost_ms / 1000.0;
    Some(ConvergencePoint {
        id: row.id.clone(),
        samples_per_pixel: row.samples_per_pixel?,
        cost_ms: row.cost_ms,
        mse,
        efficiency: mse.map(|mse| mse.map(|mse| 1.0 / (mse * seconds)).filter(|e| e.is_finite())),
    })
}

/// Slope of lg(y) against lg(x) by least squares.
fn slope(points: impl Iterator<Item = (f64, f64)>) -> Option<f64> {
    let points: Vec<[f64; 2]> =
        points.filter(|&(x, y)| x > 0.0 && y > 0.0).map(|(x, y)| [x.log10(), y.log10()]).collect();
    let count = points.len() as f64;
    let mean = |i: usize| points.iter().map(|p| p[i]).sum::<f64>() / count;
    let [mx, my] = [mean(0), mean(1)];
    let along: f64 = points.iter().map(|p| (p[0] - mx).powi(2)).sum();
    let slope = points.iter().map(|p| (p[0] - mx) * (p[1] - my)).sum::<f64>() / along;
    (points.len() >= MIN_POINTS && along > 1e-9).then_some(slope)
}

#[cfg(test)]
mod tests {
    use super::slope;

    #[test]
    fn a_power_has_its_exponent_as_slope() {
        for exponent in [-1.0, -0.5, 0.0] {
            let found = slope([1.0, 2.0, 4.0, 16.0].map(|x: f64| (x, 3.0 * x.powf(exponent))).into_iter()).unwrap();
            assert!((found - exponent).abs() < 1e-12, "{found}");
        }
        assert_eq!(slope([(1.0, 1.0), (1.0, 2.0), (1.0, 3.0)].into_iter()), None, "one sample count only");
        assert_eq!(slope([(1.0, 1.0), (2.0, 0.0), (3.0, 3.0)].into_iter()), None, "two points are no line");
    }
}
