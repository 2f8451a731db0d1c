//! A synthetic sweep with the sizes and gaps of a real one.

use afterimage_cli::method_report::MethodReport;
use afterimage_cli::sweep::measurement::{ClipFacts, Machine};
use afterimage_cli::sweep::{Measurement, Options, Point, Table};
use afterimage_lab::clock::Quartiles;
use afterimage_lab::metric::{BandScores, Scores};

pub const INPUTS: [&str; 2] = ["sponza/", "still.png"];

/// Method, milliseconds of its pass, bytes per pixel that it moves, and the fraction of the foveation error that
/// remains.
const METHODS: [(&str, f64, u32, f64); 5] = [
    ("none", 0.21, 14, 1.0),
    ("taa", 0.55, 38, 0.8),
    ("wrs", 0.83, 46, 0.62),
    ("smr", 1.27, 44, 0.45),
    ("oracle", 9.0, 0, 0.2),
];

pub fn options(pairs: &[(&str, &str)]) -> Options {
    pairs.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect()
}

/// Switches: name, value, methods that have it, and and their factor on milliseconds, change in bytes, and factor on
/// the error.
type Switch = (&'static str, &'static str, &'static [&'static str], f64, i32, f64);
const SWITCHES: [Switch; 4] = [
    ("no-flush", "", &["wrs", "smr", "taa"], 0.93, -8, 1.3),
    ("no-gate", "", &["wrs"], 0.98, 0, 1.18),
    ("wrs-bias", "none", &["wrs"], 0.99, 0, 0.97),
    ("no-chain", "", &["smr"], 0.71, -12, 1.12),
];

/// Measurements on both inputs: sizes of the fovea, rates, switches, and three seeds of randomized methods.
pub fn measurements() -> Vec<Measurement> {
    let mut all = vec![];
    for (i, input) in INPUTS.iter().enumerate() {
        for (method, ms, bytes, left) in METHODS {
            // The oracle needs a still.
            if method == "oracle" && *input != "still.png" {
                continue;
            }
            let mut add = |named: Options, ms: f64, bytes: u32, share: f64, error: f64| {
                for seed in 0..if method == "wrs" { 3 } else { 1 } {
                    let point =
                        Point { input: (*input).to_owned(), method: method.to_owned(), options: named.clone(), seed };
                    let error = error * (1.0 + 0.01 * seed as f64) * (1.0 + 0.4 * i as f64);
                    all.push(measurement(point, ms, bytes, share, error));
                }
            };
            for (fovea, share) in [("5", 0.043), ("10", 0.091), ("20", 0.274)] {
                for (far, more) in [("16", 1.0), ("8", 1.13)] {
                    let named = options(&[("fovea", fovea), ("rate-far", far)]);
                    let wide = fovea.parse::<f64>().unwrap();
                    add(named, ms * (1.0 + 0.001 * wide), bytes, share * more, left * 0.2 / wide.sqrt() / more);
                }
            }
            for (name, value, of, ms_by, bytes_by, error_by) in SWITCHES {
                if of.contains(&method) {
                    let named = options(&[("fovea", "5"), ("rate-far", "16"), (name, value)]);
                    let bytes = bytes.saturating_add_signed(bytes_by);
                    add(named, ms * 1.005 * ms_by, bytes, 0.043, left * 0.0894 * error_by);
                }
            }
        }
    }
    all
}

pub fn measurement(point: Point, ms: f64, bytes: u32, share: f64, error: f64) -> Measurement {
    let around = |ms: f64| Quartiles { median: ms, p25: 0.95 * ms, p75: 1.08 * ms };
    let db = |error: f64| Some(-20.0 * error.log10());
    let band = |of: f64| {
        let [mse, ssim, flip, jod] = [of * of, 1.0 - of, of * 0.9, 10.0 - of].map(Some);
        BandScores { psnr_db: db(of), mse, ssim, flip, jod }
    };
    let moves = point.input.ends_with('/');
    let scores = Scores {
        whole: band(error),
        bands: [0.2, 0.7, 1.3].map(|by| band(error * by)),
        weighted_psnr_db: db(error * 0.5),
        delta_e94_mean: Some(20.0 * error),
        delta_e94_p99: Some(120.0 * error),
        retained_psnr_db: db(error * 0.8),
        retained_share: Some(0.4),
        flicker: Some(30.0 * error),
        ghost_energy: moves.then_some(5.0 * error),
        ghost_half_frames: None,
    };
    let figures = MethodReport {
        share_of_oracle: None,
        ms: Some(around(ms)),
        cpu_ms: Some(ms),
        frame: Default::default(),
        scores,
        psnr_last_frame_db: db(error),
        worst_crop: None,
        nonfinite_in: 0,
        nonfinite_out: 0,
        rejected: Some(0.02),
        replaced: Some(0.1),
        shaded_share: None,
        bytes_per_pixel: (point.method != "oracle").then_some(bytes),
        persistent_bytes_per_pixel: 8.0,
    };
    Measurement {
        version: "0.1.0".into(),
        rust: format!("Settings {{ method: MethodKind::{} }}", point.method),
        point,
        common: options(&[("backend", "gpu"), ("frames", "120")]),
        clip: ClipFacts { size: [1280, 720], frames: 120, timed_frames: 112, fps: 60.0, hfov_deg: 70.0 },
        machine: Machine {
            kind: "gpu".into(),
            name: "A Made-Up Adapter".into(),
            driver: "made up 1.0".into(),
            clock: "timestamp queries of the device".into(),
        },
        pass_ms: around(ms),
        pass_cpu_ms: Some(ms),
        frame_ms: vec![ms],
        round: String::new(),
        control_ms: around(0.55),
        render_ms: None,
        render_cpu_ms: None,
        samples_share: share,
        samples_per_pixel: None,
        copy_ms: 0.011 * f64::from(bytes),
        figures,
    }
}

/// The table for a renderer that takes `renderer_ms` for a full-rate frame, if known.
pub fn table(renderer_ms: Option<f64>) -> Table {
    of(&measurements(), renderer_ms)
}

pub fn of(measurements: &[Measurement], renderer_ms: Option<f64>) -> Table {
    let command = "afterimage sweep sponza/ still.png --out sweep".into();
    Table::new(measurements, renderer_ms, command)
}
