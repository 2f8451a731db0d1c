//! Contrast sensitivity against published thresholds.

use afterimage_metric::csf::sensitivity;
use std::collections::BTreeMap;
use std::path::Path;

/// A threshold that was measured.
struct Threshold {
    source: String,
    nits: f32,
    cpd: f32,
    hz: f32,
    ecc_deg: f32,
    area_deg2: f32,
    log10_sensitivity: f32,
}

fn thresholds() -> Vec<Threshold> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/contrast_thresholds.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let rows = text.lines().filter(|line| !line.starts_with('#')).skip(1).map(|line| {
        let (source, numbers) = line.split_once(',').unwrap();
        let v: Vec<f32> = numbers.split(',').map(|v| v.parse().unwrap()).collect();
        let [nits, cpd, hz, ecc_deg, area_deg2, log10_sensitivity] = v[..].try_into().unwrap();
        Threshold { source: source.to_owned(), nits, cpd, hz, ecc_deg, area_deg2, log10_sensitivity }
    });
    rows.collect()
}

/// Root mean square error in dB by study, after the study's own gain: observers and criteria differ.
fn errors_db(of: impl Fn(&Threshold) -> f32) -> BTreeMap<String, f64> {
    let mut errors: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for threshold in &thresholds() {
        let off = 20.0 * (of(threshold).log10() - threshold.log10_sensitivity);
        errors.entry(threshold.source.clone()).or_default().push(off.into());
    }
    let rms = |v: Vec<f64>| {
        let mean = v.iter().sum::<f64>() / v.len() as f64;
        (v.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / v.len() as f64).sqrt()
    };
    errors.into_iter().map(|(source, v)| (source, rms(v))).collect()
}

fn model(t: &Threshold) -> f32 {
    sensitivity(t.cpd, t.hz, t.ecc_deg, t.nits, t.area_deg2)
}

/// stelaCSF is off by 4.15 dB on more rows of these and another study, by the report of its authors.
#[test]
fn thresholds_of_ten_studies_are_met_within_observers_differences() {
    let errors = errors_db(model);
    println!("{errors:.2?}");
    let mean = errors.values().sum::<f64>() / errors.len() as f64;
    println!("mean {mean:.2} dB over {} studies", errors.len());
    assert!(errors.len() == 10 && mean < 3.3, "{mean}");
    assert!(errors.values().all(|&e| e < 5.5), "{errors:.2?}");
}

#[test]
fn planted_errors_of_units_are_caught() {
    for (what, wrong) in [
        ("radians for degrees", errors_db(|t| sensitivity(t.cpd, t.hz, t.ecc_deg.to_radians(), t.nits, t.area_deg2))),
        (
            "radians per second for Hz",
            errors_db(|t| sensitivity(t.cpd, std::f32::consts::TAU * t.hz, t.ecc_deg, t.nits, t.area_deg2)),
        ),
        ("a side for an area", errors_db(|t| sensitivity(t.cpd, t.hz, t.ecc_deg, t.nits, t.area_deg2.sqrt()))),
        ("no luminance", errors_db(|t| sensitivity(t.cpd, t.hz, t.ecc_deg, 100.0, t.area_deg2))),
    ] {
        let mean = wrong.values().sum::<f64>() / wrong.len() as f64;
        println!("{what}: {mean:.2} dB");
        assert!(mean > 3.3 || wrong.values().any(|&e| e > 5.5), "{what}: {mean}");
    }
}

#[test]
fn sensitivity_falls_with_eccentricity_and_is_finite_everywhere() {
    for cpd in [0.05, 0.5, 2.0, 8.0, 30.0] {
        for hz in [0.0, 5.0, 60.0] {
            for nits in [0.001, 1.0, 1e4] {
                let at = |e| sensitivity(cpd, hz, e, nits, 1.0);
                let values = [0.0, 1.0, 5.0, 20.0, 60.0].map(at);
                assert!(values.iter().all(|v| v.is_finite() && *v >= 0.0), "{cpd} {hz} {nits}: {values:?}");
                assert!(values.windows(2).all(|v| v[1] <= v[0]), "{cpd} {hz} {nits}: {values:?}");
            }
        }
    }
}
