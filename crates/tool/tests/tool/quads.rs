//! `afterimage run --foveation planned`.

use super::rig::{Folder, Out, SMALL, ran, refuses, run, words};
use serde_json::Value;

const METHODS: [&str; 3] = ["none", "wrs", "smr"];

/// A run of quads on a backend.
fn quads(input: &str, backend: &str, more: &str) -> Out {
    ran(input, &format!("--foveation planned --backend {backend} --no-flip {more}"))
}

/// A figure of each frame.
fn by_frame(out: &Out, method: &str, name: &str) -> Vec<f64> {
    out.column(method, name).into_iter().map(|figure| figure.expect("every frame has it")).collect()
}

/// Runs with a budget in percent; the report, and the shaded shares of each method by frame.
fn report(budget: &str) -> (Value, [Vec<f64>; 3]) {
    let small = "--size 240x135 --frames 6 --no-jod --gaze 90,75 --jitter halton --reference-samples 2";
    let out = quads("analytic:occluder", "cpu", &format!("{small} --budget {budget}"));
    (out.json("report.json"), METHODS.map(|method| by_frame(&out, method, "shaded_share")))
}

/// Whether each method's share is the mean of its frames, smr spends most of the budget, and no frame exceeds it but
/// the first, which is a quarter.
fn is_consistent(report: &Value, shares: &[Vec<f64>; 3], even: &[Vec<f64>; 3], budget: f64) -> bool {
    let is_mean = METHODS.iter().zip(shares).all(|(method, shares)| {
        let mean = shares.iter().sum::<f64>() / shares.len() as f64;
        (report["methods"][method]["shaded_share"].as_f64().unwrap() - mean).abs() < 1e-5
    });
    let spent = |method: usize| shares[method].iter().zip(&even[0]).skip(1).map(|(all, even)| all - even);
    // A part of the quads at the lower edge lies beyond it.
    let is_within = (0..3).flat_map(spent).all(|spent| (0.0..=1.02 * budget).contains(&spent));
    is_mean && is_within && spent(2).all(|spent| spent >= 0.6 * budget)
}

#[test]
fn reports_say_how_much_was_shaded() {
    let (even_report, even) = report("0");
    assert!(is_consistent(&even_report, &even, &even, 0.0));
    let mut before = even_report["methods"]["smr"]["psnr_db"].as_f64().unwrap();
    for percent in ["3", "12"] {
        let (report, shares) = report(percent);
        let budget = percent.parse::<f64>().unwrap() / 100.0;
        assert!(is_consistent(&report, &shares, &even, budget), "{shares:?}, {even:?}");
        assert!(!is_consistent(&report, &shares, &even, 2.1 * budget), "a planted error: half the budget");
        let foveation = &report["foveation"];
        assert_eq!(foveation["simulator"], "planned");
        assert_eq!(["rate_mid", "rate_far"].map(|rate| foveation[rate].as_u64().unwrap()), [4, 8]);
        assert_eq!(foveation["budget_percent"].as_f64(), percent.parse().ok());
        let smr = &report["methods"]["smr"];
        assert!(report["samples"].is_null());
        let psnr_db = smr["psnr_db"].as_f64().unwrap();
        println!("budget {percent} %: {psnr_db:.2} dB, {} shaded", smr["shaded_share"]);
        assert!(psnr_db > before + 0.1, "{percent} %: {psnr_db} after {before}");
        before = psnr_db;
    }
}

/// Without a gaze: as much everywhere, in every frame.
#[test]
fn a_share_is_shaded_everywhere_alike() {
    let more = "--size 240x135 --frames 6 --no-jod --share 25 --jitter halton --reference-samples 1";
    let out = quads("analytic:occluder", "cpu", more);
    let report = out.json("report.json");
    let foveation = ["fovea_deg", "mid_deg", "rate_mid", "rate_far", "budget_percent"];
    assert_eq!(foveation.map(|key| report["foveation"][key].as_f64().unwrap()), [0.0, 0.0, 4.0, 4.0, 12.5]);
    let shares = by_frame(&out, "smr", "shaded_share");
    println!("shares {shares:?}");
    assert!(shares.iter().all(|share| (0.2..0.255).contains(share)), "{shares:?}");
}

/// The renderer's time is that of depth and motion and of the quads that each method asked for.
#[test]
fn scenes_are_shaded_by_quads() {
    if afterimage_testing::gpu::adapter().is_none() {
        return;
    }
    // On a device the methods choose the same quads, which are shaded and stay there.
    let [cpu, gpu] = ["cpu", "gpu"].map(|backend| {
        quads("builtin:cubes", backend, &format!("{SMALL} --jitter halton --reference-samples 1 --budget 5"))
    });
    let [report, other] = [&cpu, &gpu].map(|out| out.json("report.json"));
    let number = |report: &Value, method: &str, key: &str| report["methods"][method][key].as_f64().unwrap();
    assert!((0.03..0.2).contains(&number(&report, "smr", "shaded_share")), "{report}");
    for method in METHODS {
        let [shaded, times] = ["shaded_share", "render_ms"].map(|key| by_frame(&cpu, method, key));
        assert!(shaded.len() == 4 && shaded.iter().chain(&times).all(|&v| v > 0.0), "{shaded:?}, {times:?}");
        let differs = |key: &str| (number(&report, method, key) - number(&other, method, key)).abs();
        assert!(differs("shaded_share") < 1e-3 && differs("psnr_db") < 0.05, "{method}");
    }
}

/// smr's first frame has the fovea and one pixel in 4, drawn at half the size on either backend; other methods' has
/// not.
#[test]
fn the_first_frame_is_a_quarter() {
    if afterimage_testing::gpu::adapter().is_none() {
        return;
    }
    let runs = ["cpu", "gpu"].map(|backend| {
        let more = format!("{SMALL} --jitter halton --reference-samples 1 --budget 5 --method none,smr");
        quads("builtin:cubes", backend, &more)
    });
    let shares = by_frame(&runs[0], "smr", "shaded_share");
    let of_none = by_frame(&runs[0], "none", "shaded_share");
    let [psnr, on_device] = runs.map(|out| by_frame(&out, "smr", "psnr_db"));
    println!("{shares:?} shaded, {psnr:?} dB, {on_device:?} on the device");
    assert!(psnr.iter().zip(&on_device).all(|(a, b)| (a - b).abs() < 0.05));
    assert!((0.24..0.3).contains(&shares[0]) && shares[1] < 0.2 && of_none[0] < 0.2, "{shares:?}, {of_none:?}");
}

/// One pixel of a chosen quad has as many places for a quarter of the pixels.
#[test]
fn single_pixels_of_quads_are_shaded() {
    let [whole, single] = ["", "--single-pixels"].map(|more| {
        let more = format!("--size 240x135 --frames 6 --no-jod --fovea 0 --budget 0 --method taau {more}");
        quads("analytic:lateral", "cpu", &more)
    });
    let [whole, single] = [whole, single].map(|out| by_frame(&out, "taau", "shaded_share"));
    println!("{whole:?}, {single:?}");
    assert!(whole.iter().zip(&single).all(|(whole, single)| (0.2..0.3).contains(&(single / whole))));
}

#[test]
fn what_quads_cannot_do_is_refused() {
    let folder = Folder::new();
    let out = folder.text("out");
    let still = "analytic:still";
    let refused = |input: &str, more: &str, expected: &[&str]| {
        refuses(&run(input, &out, &words(&format!("--foveation planned --backend cpu {more}"))), expected)
    };
    refused(still, "--method oracle", &["oracle", "moving samples"]);
    refused(still, "--geometry samples", &["--geometry", "--foveation layers"]);
    refused(still, "--rate-far 16", &["rate_far", "power of two from 2 to 8"]);
    refused(still, "--rate-mid 8 --rate-far 4", &["rate_far is 4", "at least rate_mid, 8"]);
    refused("builtin:cubes", "--source trace --sampling regions", &["--foveation planned", "--sampling regions"]);
    for budget in ["-1", "101", "NaN", "much"] {
        refused(still, &format!("--budget={budget}"), &["--budget", "0 to 100 percent"]);
    }
    refuses(&run(still, &out, &["--budget", "3"]), &["--budget", "--foveation planned"]);
    refuses(&run(still, &out, &["--single-pixels"]), &["--single-pixels", "--foveation planned"]);
    refused(still, "--share 25 --budget 3", &["--share", "--budget"]);
    refuses(&run(still, &out, &["--share", "25"]), &["--share", "--foveation planned"]);
    refuses(&["bench", "--foveation", "planned"], &["--foveation"]);
    assert!(!folder.path("out").exists(), "nothing was written");
}

#[test]
fn albedo_is_worth_decibels_on_texture_and_reaches_smr_alone() {
    let more = "--size 160x90 --frames 10 --no-jod --camera walk --share 8 --jitter halton --reference-samples 1";
    let psnr_db = |backend: &str, more: &str, method: &str| {
        let report = quads("builtin:courtyard", backend, more).json("report.json");
        assert_eq!(report["albedo"], more.contains("--albedo"));
        report["methods"][method]["psnr_db"].as_f64().unwrap()
    };
    let without = ["smr", "taau"].map(|method| psnr_db("cpu", &format!("{more} --method {method}"), method));
    let with = format!("{more} --albedo scene --method smr,taau");
    let [smr, taau] = ["smr", "taau"].map(|method| psnr_db("cpu", &with, method));
    println!("smr, taau: {without:?} without, {smr}, {taau} with albedo");
    assert!(smr > without[0] + 0.1, "smr: {smr} after {without:?}");
    assert_eq!(taau, without[1]);
    let with = format!("{more} --albedo scene --method smr");
    assert!((psnr_db("gpu", &with, "smr") - smr).abs() < 0.01, "on a device");
}
