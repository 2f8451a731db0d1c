//! Metrics of quality that a sweep compares.

use afterimage_lab::metric::Scores;

/// A metric of quality.
#[derive(Clone, Copy, Debug)]
pub struct Metric {
    /// Name in tables and on the command line.
    pub key: &'static str,
    /// Name in reports.
    pub title: &'static str,
    /// Unit, empty for none.
    pub unit: &'static str,
    /// Whether more is better.
    pub more_is_better: bool,
    /// Significant digits after the decimal point.
    pub digits: usize,
    /// Reads the metric from scores.
    pub of: fn(&Scores) -> Option<f64>,
}

impl Metric {
    /// Finds a metric by its key.
    pub fn find(key: &str) -> Option<&'static Self> {
        METRICS.iter().find(|m| m.key == key)
    }

    /// The value as an error, less is better. `None`, the PSNR of equal pictures, is the smallest error.
    pub fn error(&self, value: Option<f64>) -> f64 {
        match value {
            None => f64::NEG_INFINITY,
            Some(v) if self.more_is_better => -v,
            Some(v) => v,
        }
    }
}

macro_rules! metric {
    ($key:literal, $title:literal, $unit:literal, $more:literal, $digits:literal, $of:expr) => {
        Metric { key: $key, title: $title, unit: $unit, more_is_better: $more, digits: $digits, of: $of }
    };
}

/// All metrics, in the order of the tables. `docs/metrics.md` has their formulas.
pub const METRICS: &[Metric] = &[
    metric!("jod", "JOD", "", true, 3, |s| s.whole.jod),
    metric!("flip", "FLIP", "", false, 4, |s| s.whole.flip),
    metric!("psnr_db", "PSNR", "dB", true, 2, |s| s.whole.psnr_db),
    metric!("ssim", "SSIM", "", true, 4, |s| s.whole.ssim),
    metric!("weighted_psnr_db", "Weighted PSNR", "dB", true, 2, |s| s.weighted_psnr_db),
    metric!("retained_psnr_db", "Retained PSNR", "dB", true, 2, |s| s.retained_psnr_db),
    metric!("fovea_psnr_db", "PSNR of the fovea", "dB", true, 2, |s| s.bands[0].psnr_db),
    metric!("mid_psnr_db", "PSNR from 2.5 to 7.5 degrees", "dB", true, 2, |s| s.bands[1].psnr_db),
    metric!("periphery_psnr_db", "PSNR beyond 7.5 degrees", "dB", true, 2, |s| s.bands[2].psnr_db),
    metric!("fovea_jod", "JOD of the fovea", "", true, 3, |s| s.bands[0].jod),
    metric!("mid_jod", "JOD from 2.5 to 7.5 degrees", "", true, 3, |s| s.bands[1].jod),
    metric!("periphery_jod", "JOD beyond 7.5 degrees", "", true, 3, |s| s.bands[2].jod),
    metric!("fovea_flip", "FLIP of the fovea", "", false, 4, |s| s.bands[0].flip),
    metric!("mid_flip", "FLIP from 2.5 to 7.5 degrees", "", false, 4, |s| s.bands[1].flip),
    metric!("periphery_flip", "FLIP beyond 7.5 degrees", "", false, 4, |s| s.bands[2].flip),
    metric!("delta_e94_p99", "99th percentile of Delta E 94", "", false, 1, |s| s.delta_e94_p99),
    metric!("flicker", "Flicker", "", false, 2, |s| s.flicker),
    metric!("ghost_energy", "Ghosts", "frames", false, 2, |s| s.ghost_energy),
];
