//! `afterimage bench`.

use super::rig::{Folder, read_json, refuses, succeeds, words};
use std::path::Path;

#[test]
fn bench_times_every_pass_against_the_copy() {
    let folder = Folder::new();
    let json = folder.text("bench.json");
    let args = ["bench", "post", "--size", "160x90", "--frames", "30", "--json", &json];
    if afterimage_testing::gpu::adapter().is_none() {
        refuses(&args, &["adapter"]);
        return;
    }
    succeeds(&args);
    let report = read_json(Path::new(&json));
    let passes = report["passes"].as_array().unwrap();
    let expected = "copy none taa wrs smr taau wrs-weighted smr-screen smr-everywhere mip gauss block";
    assert_eq!(passes.iter().map(|p| p["name"].as_str().unwrap()).collect::<Vec<_>>(), words(expected));
    for pass in passes {
        assert!(pass["ms"]["median"].as_f64().unwrap() > 0.0);
        let most = match pass["name"].as_str().unwrap() {
            // Samples, and two loops over them before the pixels.
            "smr-screen" | "smr-everywhere" => 64,
            // A reference beside each sample.
            "wrs-weighted" => 56,
            _ => 48,
        };
        assert!((1..=most).contains(&pass["bytes_per_pixel"].as_u64().unwrap()));
        assert!(["ms_per_megapixel", "share_of_copy_bandwidth"].iter().all(|key| pass[key].as_f64().unwrap() > 0.0));
    }
    assert!(!report["adapter"].as_str().unwrap().is_empty() && report["cold_start_ms"].as_f64().unwrap() > 0.0);
    refuses(&["bench", "post", "--frames", "3"], &["30"]);
}

#[test]
fn bench_counts_the_rays_of_the_tracer() {
    let folder = Folder::new();
    let json = folder.text("rays.json");
    let line = format!("bench trace --size 32x18 --backend cpu --scene builtin:cornell --json {json}");
    succeeds(&words(&line));
    let report = read_json(Path::new(&json));
    let tracer = &report["scenes"][0]["tracers"][0];
    // At least one camera ray per pixel, and at most two rays per bounce plus the last.
    assert!((576..=576 * 7).contains(&tracer["rays_per_frame"].as_u64().unwrap()));
    assert!(tracer["mrays_per_core_second"].as_f64().unwrap() > 0.0);
    refuses(&["bench", "trace", "--scene", "builtin:none"], &["builtin:none"]);
    refuses(&["bench", "trace", "--frames", "3"], &["30"]);
}
