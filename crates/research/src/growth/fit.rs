//! Exponents of growth.

use serde::Serialize;

/// Straight line through points on log axes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Fit {
    /// Exponent: the time grows as x to this power.
    pub slope: f64,
    /// Standard error of the slope, from the points' distances to the line; `None` for two points.
    pub standard_error: Option<f64>,
}

impl Fit {
    /// Least squares of ln y against ln x; `None` unless there are two different x. All values must be above 0.
    pub fn of(points: &[[f64; 2]]) -> Option<Self> {
        let logs: Vec<[f64; 2]> = points.iter().map(|p| p.map(f64::ln)).collect();
        let count = logs.len() as f64;
        let [mx, my] = [0, 1].map(|i| logs.iter().map(|p| p[i]).sum::<f64>() / count);
        let along: f64 = logs.iter().map(|p| (p[0] - mx).powi(2)).sum();
        if logs.len() < 2 || along < 1e-12 {
            return None;
        }
        let slope = logs.iter().map(|p| (p[0] - mx) * (p[1] - my)).sum::<f64>() / along;
        let left: f64 = logs.iter().map(|p| (p[1] - my - slope * (p[0] - mx)).powi(2)).sum();
        let standard_error = (logs.len() > 2).then(|| (left / (count - 2.0) / along).sqrt());
        Some(Self { slope, standard_error })
    }
}

#[cfg(test)]
mod tests {
    use super::Fit;

    #[test]
    fn a_power_has_its_exponent_as_slope_and_no_error() {
        let fit = Fit::of(&[1.0_f64, 2.0, 5.0, 9.0].map(|x| [x, 3.0 * x.powf(0.7)])).unwrap();
        assert!((fit.slope - 0.7).abs() < 1e-12 && fit.standard_error.unwrap() < 1e-9, "{fit:?}");
        assert_eq!(Fit::of(&[[1.0, 1.0], [1.0, 2.0]]), None);
        assert_eq!(Fit::of(&[[1.0, 2.0], [2.0, 4.0]]), Some(Fit { slope: 1.0, standard_error: None }));
    }

    #[test]
    fn the_standard_error_is_that_of_least_squares() {
        // ln x = 0, 1, 2; ln y = 0, 1.5, 2: slope 1, residuals -1/6, 1/3, -1/6.
        let points = [[0.0, 0.0], [1.0, 1.5], [2.0, 2.0]].map(|p: [f64; 2]| p.map(f64::exp));
        let fit = Fit::of(&points).unwrap();
        assert!((fit.slope - 1.0).abs() < 1e-12);
        assert!((fit.standard_error.unwrap() - (1.0_f64 / 6.0 / 2.0).sqrt()).abs() < 1e-12, "{fit:?}");
    }
}
