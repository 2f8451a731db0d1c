//! Sampling patterns with equal numbers of samples.

use afterimage::ViewGeometry;
use afterimage_program::failure::Failure;
use afterimage_trace::sampling::{Acuity, Layers, Regions, Sampling};

/// Largest relative difference between the numbers of samples.
const TOLERANCE: f64 = 0.02;

/// A pattern with its settings.
pub struct Candidate {
    pub name: &'static str,
    pub sampling: Sampling,
    /// Samples per pixel where the pattern is densest.
    pub samples: u32,
    /// Description of the settings.
    pub settings: String,
}

/// Regions with `region_spp` samples, and the other patterns with the same total.
pub fn candidates(geometry: &ViewGeometry, gaze_px: [f32; 2], region_spp: [u32; 3]) -> Result<Vec<Candidate>, Failure> {
    let count = |sampling: &Sampling, samples: u32| -> f64 {
        sampling.plan(geometry, gaze_px, samples, 0).samples().iter().sum::<u64>() as f64
    };
    let regions = Sampling::Regions(Regions { samples: region_spp, ..Regions::default() });
    let target = count(&regions, region_spp[0]);
    let [a, b, c] = region_spp;
    let mut all =
        vec![Candidate { name: "regions", sampling: regions, samples: a, settings: format!("{a}, {b}, {c} samples") }];
    // Uniform: a random share of the pixels, with the same number of samples each.
    let pixels = geometry.size_px().iter().map(|&s| f64::from(s)).product::<f64>();
    let samples = (target / pixels).ceil().max(1.0) as u32;
    let share = (target / pixels / f64::from(samples)) as f32;
    let uniform = Sampling::Acuity(Acuity { fovea_deg: 1e-3, least: share, falloff: 1e3 });
    let settings = format!("{} in {:.1} % of the pixels", counted(samples), 100.0 * share);
    all.push(Candidate { name: "uniform", sampling: uniform, samples, settings });
    // Layers: the number of samples per target that is closest with the thesis' radii; then scale the radii.
    let layers = |scale: f64| {
        let radii_deg = Layers::default().radii_deg.map(|r| (f64::from(r) * scale).min(84.0) as f32);
        Sampling::Layers(Layers { radii_deg, ..Layers::default() })
    };
    let samples = (target / count(&layers(1.0), 1)).round().max(1.0) as u32;
    let scale = fit(0.05, 8.0, target, |scale| count(&layers(scale), samples));
    let settings = format!("{} per target, radii times {scale:.2}", counted(samples));
    all.push(Candidate { name: "layers", sampling: layers(scale), samples, settings });
    // Acuity: as many samples per pixel in the fovea as regions; then fit the diameter of the fovea.
    let acuity = |fovea_deg: f64| Sampling::Acuity(Acuity { fovea_deg: fovea_deg as f32, ..Acuity::default() });
    let fovea_deg = fit(0.01, 40.0, target, |fovea_deg| count(&acuity(fovea_deg), a));
    let settings = format!("{} per pixel within {fovea_deg:.2} degrees", counted(a));
    all.push(Candidate { name: "acuity", sampling: acuity(fovea_deg), samples: a, settings });
    for candidate in &all {
        let taken = count(&candidate.sampling, candidate.samples);
        if (taken / target - 1.0).abs() > TOLERANCE {
            return Err(Failure::Input(format!(
                "--region-spp {a},{b},{c}: regions takes {target} samples, {} gets no closer than {taken}; choose other numbers",
                candidate.name
            )));
        }
    }
    Ok(all)
}

/// A number of samples with its noun.
fn counted(samples: u32) -> String {
    format!("{samples} sample{}", if samples == 1 { "" } else { "s" })
}

/// Bisection: the value between `low` and `high`, both above 0, for which the monotonic `count` is closest to `target`.
fn fit(low: f64, high: f64, target: f64, count: impl Fn(f64) -> f64) -> f64 {
    let rises = count(high) > count(low);
    let (mut low, mut high) = (low, high);
    for _ in 0..24 {
        let middle = (low * high).sqrt();
        if (count(middle) < target) == rises {
            low = middle;
        } else {
            high = middle;
        }
    }
    (low * high).sqrt()
}
