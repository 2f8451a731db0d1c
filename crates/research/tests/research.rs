//! Experiments on tiny frames: their tables have what they promise.

use afterimage_testing::program::{Folder, Program, read_json};
use serde_json::Value;
use std::fs;
use std::path::Path;

const RESEARCH: Program = Program(env!("CARGO_BIN_EXE_afterimage-research"));

fn succeeds(args: &[&str]) -> String {
    RESEARCH.succeeds(args)
}

fn refuses(args: &[&str], words: &[&str]) {
    RESEARCH.refuses(args, words);
}

#[test]
fn every_experiment_says_its_options() {
    let listed = succeeds(&["--help"]);
    let names = listed.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    let names = names.filter(|line| !line.starts_with("   ")).filter_map(|line| line.split_whitespace().next());
    let names: Vec<_> = names.filter(|name| *name != "help").collect();
    assert_eq!(names.len(), 29, "{names:?}");
    for name in names {
        let usage = format!("Usage: cargo research {name}");
        assert!(succeeds(&[name, "--help"]).contains(&usage), "{name}");
    }
    refuses(&["quads"], &["<INPUT>", "--help"]);
    refuses(&["quads", "analytic:lateral", "--frames", "0"], &["1..=100000"]);
}

#[test]
fn tells_how_much_of_the_saved_samples_is_saved_time() {
    let folder = Folder::new();
    let json = folder.text("foveated.json");
    let text = succeeds(&["foveated", "--backend", "cpu", "--size", "96x54", "--frames", "1", "--json", &json]);
    assert!(text.contains("| share of saved | share of reduction |"), "{text}");
    let report = read_json(Path::new(&json));
    let tracer = &report["scenes"][0]["tracers"][0];
    assert_eq!((&report["max_depth"], &tracer["backend"]["kind"]), (&3.into(), &"cpu".into()));
    let patterns = tracer["patterns"].as_array().unwrap();
    let samples: Vec<_> = patterns.iter().map(|p| p["samples_per_pixel"].as_u64().unwrap()).collect();
    assert_eq!(samples, [1, 8, 32], "one path a point, regions 8,4,2 and 32,16,8");
    for p in patterns {
        let of = |key: &str| p[key].as_f64().unwrap_or_else(|| panic!("{key} of {p}"));
        let is = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-9 * expected.abs(), "{p}");
        let median = |key: &str| p[key]["median"].as_f64().unwrap();
        is(of("sample_reduction") * of("samples"), 96.0 * 54.0 * of("samples_per_pixel"));
        is(of("time_reduction"), median("uniform_cpu_ms") / median("cpu_ms"));
        let saved = |reduction: f64| 1.0 - 1.0 / reduction;
        is(of("share_of_saved"), saved(of("time_reduction")) / saved(of("sample_reduction")));
        is(of("share_of_reduction"), of("time_reduction") / of("sample_reduction"));
        assert!(of("sample_reduction") > 4.0, "{p}");
    }
    refuses(&["foveated", "--frames", "0"], &["1 to"]);
}

#[test]
#[ignore = "experiments are long: cargo test -p afterimage-research -- --ignored"]
fn puts_the_papers_figures_beside_ours() {
    let folder = Folder::new();
    let json = folder.text("papers.json");
    let small = ["papers", "--backend", "cpu", "--size", "64x36", "--frames", "1", "--json", &json];
    let text = succeeds(&small);
    assert!(text.contains("| 32,16,8 | 8.60 | 30.9x | 8.6 |"), "{text}");
    let report = read_json(Path::new(&json));
    let regions = report["regions"]["patterns"].as_array().unwrap();
    assert_eq!(regions.len(), 4);
    assert!((report["regions"]["hfov_deg"].as_f64().unwrap() - 61.1).abs() < 0.1);
    assert_eq!(regions[0]["paper_time_reduction"], 23.93);
    // A few pixels only: measured values are arbitrary.
    assert!(regions.iter().all(|p| p["time_reduction"].as_f64().unwrap() > 0.0 && p["clock"] == "CPU"));
    let layers = report["layers"].as_array().unwrap();
    assert_eq!(layers.len(), 5);
    assert!(layers.iter().all(|scene| scene["size"] == serde_json::json!([36, 40]) && scene["max_depth"] == 8));
    assert!(layers.iter().all(|scene| scene["patterns"].as_array().unwrap().len() == 2));
    // Sparse frames with smr beside all of them, with about as many samples.
    let of_layers = layers.iter().flat_map(|scene| scene["patterns"].as_array().unwrap());
    for p in regions.iter().chain(of_layers) {
        for kind in ["filled", "planned_smr"] {
            let of = |key: &str| p[kind][key].as_f64().unwrap_or_else(|| panic!("{kind}.{key} of {p}"));
            // No error at all has no PSNR.
            let psnr_db = p[kind]["psnr_db"].as_f64().unwrap_or(f64::INFINITY);
            assert!(psnr_db > 5.0 && (0.0..1.0).contains(&of("flip")) && of("samples") > 0.0, "{p}");
            assert!((of("render_ms") + of("post_ms") - of("total_ms")).abs() < 1e-9 && of("render_ms") > 0.0, "{p}");
            assert_eq!(of("post_ms") > 0.0, kind == "planned_smr");
        }
    }
    refuses(&["papers", "--frames", "0"], &["1 to"]);
    refuses(&["papers", "--camera", "no/such.json"], &["no/such.json"]);
}

#[test]
fn prices_effects_between_the_markers() {
    let folder = Folder::new();
    let (page, json) = (folder.text("effects.md"), folder.text("effects.json"));
    let small = ["--size", "16x9", "--backend", "cpu", "--scene", "builtin:cornell", "--json", &json, "--out", &page];
    let command = [&["effects"], &small[..]].concat();
    succeeds(&command);
    let table = std::fs::read_to_string(&page).unwrap();
    std::fs::write(&page, format!("before\n{table}after\n")).unwrap();
    succeeds(&command);
    let text = std::fs::read_to_string(&page).unwrap();
    assert!(text.starts_with("before\n<!--") && text.ends_with("-->\nafter\n"), "{text}");
    let rows = ["| effect added | builtin:cornell |", "| clearcoat |", "| emissive-triangles | needed |"];
    for word in rows.into_iter().chain(["| builtin:cornell | 36 | emissive-triangles |"]) {
        assert!(text.contains(word), "{word} in {text}");
    }
    let prices = &read_json(Path::new(&json))["scenes"][0]["prices"][0];
    assert_eq!(prices[0]["ratio"]["median"].as_f64(), Some(1.0));
    std::fs::write(&page, "no markers").unwrap();
    refuses(&command, &["markers"]);
}

#[test]
#[ignore = "experiments are long: cargo test -p afterimage-research -- --ignored"]
fn compares_patterns_at_equal_numbers_of_samples() {
    let folder = Folder::new();
    let (out, json) = (folder.text("out"), folder.text("patterns.json"));
    let base = ["patterns", "builtin:courtyard", "--out", &out, "--backend", "cpu", "--json", &json];
    succeeds(&[&base[..], &["--size", "320x180", "--frames", "2", "--reference-samples", "3"]].concat());
    let report = read_json(Path::new(&json));
    let patterns = report["patterns"].as_array().unwrap();
    let names: Vec<_> = patterns.iter().map(|p| p["pattern"].as_str().unwrap()).collect();
    assert_eq!(names, ["regions", "uniform", "layers", "acuity"]);
    for p in patterns {
        let share = p["samples_of_regions"].as_f64().unwrap();
        assert!((share - 1.0).abs() <= 0.02, "{}: {share}", p["pattern"]);
        assert!(p["rays"].as_f64() > p["samples"].as_f64());
        for key in ["psnr_db", "weighted_psnr_db", "ssim", "flip"] {
            assert!(p[key].is_number(), "{key}");
        }
    }
    let table = fs::read_to_string(Path::new(&out).join("patterns.md")).unwrap();
    assert_eq!(table.lines().count(), 2 + patterns.len());
    for file in ["reference.exr", "reference.png", "acuity.png", "acuity_flip.png", "layers_flip.png"] {
        assert!(Path::new(&out).join(file).exists(), "{file}");
    }
    // The written reference is accepted, but not at another size.
    let exr = folder.text("out/reference.exr");
    let again = [&base[..], &["--frames", "2", "--reference", &exr, "--size"]].concat();
    succeeds(&[&again[..], &["320x180"]].concat());
    let second = read_json(Path::new(&json));
    let db = |report: &Value, i: usize| report["patterns"][i]["psnr_db"].as_f64().unwrap();
    for i in 0..patterns.len() {
        assert!((db(&report, i) - db(&second, i)).abs() < 0.01, "half floats are exact enough");
    }
    refuses(&[&again[..], &["160x90"]].concat(), &["320x180", "160x90"]);
    for more in [
        ["--region-spp", "8,4"],
        ["--gaze", "12"],
        ["--frames", "0"],
        ["--reference-samples", "0"],
        ["--size", "4x4"],
        ["--camera", "nowhere"],
    ] {
        refuses(&[&base[..], &more].concat(), &[more[0].trim_start_matches("--camera")]);
    }
}

#[test]
#[ignore = "experiments are long: cargo test -p afterimage-research -- --ignored"]
fn measures_how_time_grows() {
    if afterimage_testing::gpu::adapter().is_none() {
        return;
    }
    let folder = Folder::new();
    let json = folder.text("growth.json");
    let small = ["--size", "160x90", "--frames", "1", "--max-megapixels", "0.6", "--triangles", "2000"];
    let text = succeeds(&[&["growth", "--of", "pixels,eyes", "--json", &json], &small[..]].concat());
    assert!(text.contains("| megapixels | triangles | lattices | eyes | samples | render ms | smr ms | total ms |"));
    let report = read_json(Path::new(&json));
    let series = report["series"].as_array().unwrap();
    assert_eq!(series.len(), 4, "two axes, two renderers");
    for s in series {
        let points = s["points"].as_array().unwrap();
        assert_eq!(points.len(), 2, "{}", s["of"]);
        for p in points {
            let of = |key: &str| p[key].as_f64().unwrap();
            assert!(of("render_ms") > 0.0 && of("post_ms") > 0.0);
            assert!((of("render_ms") + of("post_ms") - of("total_ms")).abs() < 1e-9 * of("total_ms"));
        }
        // Twice the eyes: twice the samples.
        if s["of"] == "eyes" {
            assert_eq!(points[1]["samples"].as_u64(), points[0]["samples"].as_u64().map(|n| 2 * n));
        }
        assert!(
            s["total"]["slope"].is_number() && s["total"]["standard_error"].is_null(),
            "two points: {}",
            s["total"]
        );
        assert!(s["last_over_first"].as_f64().unwrap() > 0.0);
    }
    refuses(&["growth", "--of", "time"], &["pixels"]);
    refuses(&["growth", "--frames", "0"], &["1..=1000"]);
}

/// The rows contain the sweep's results and the paper's.
#[test]
#[ignore = "experiments are long: cargo test -p afterimage-research -- --ignored"]
fn the_papers_table_is_written_beside_ours() {
    let folder = Folder::new();
    let (still, out, markdown) = (folder.path("still.png"), folder.path("out"), folder.path("table.md"));
    let stripes = |x: u32, y: u32| {
        image::Rgb([if (x / 3 + y / 2).is_multiple_of(2) { 220 } else { 30 }, (x * 5 % 256) as u8, 90])
    };
    image::RgbImage::from_fn(96, 54, stripes).save(&still).unwrap();
    let path = |path: &Path| path.to_str().unwrap().to_owned();
    let (still, moving) = (path(&still), "fixtures/sequences/lateral_160x90");
    let gaze = "fixtures/scanpath_viewing.csv";
    let files = ["--gaze", gaze, "--out", &path(&out), "--markdown", &path(&markdown)];
    let numbers = ["--frames", "38", "--seeds", "1", "--backend", "cpu"];
    succeeds(&[&["wrs", &still, moving][..], &files, &numbers].concat());
    let (text, table) = (fs::read_to_string(&markdown).unwrap(), read_json(&out.join("sweep.json")));
    let [of_still, of_moving] = [&still, moving].map(|input| {
        let from = text.find(&format!("`{input}`, ")).unwrap();
        text[from..].split("\nPSNR gain over ").next().unwrap()
    });
    let mut rows = 0;
    for row in table["rows"].as_array().unwrap() {
        let (method, fovea) = (row["method"].as_str().unwrap(), row["options"]["fovea"].as_str().unwrap());
        // The page has two of the sweep's three foveae.
        if fovea == "7.5" {
            continue;
        }
        let psnr_db = row["values"]["psnr_db"].as_f64().unwrap();
        let preset = if row["options"]["wrs-preset"] == "weighted" { " weighted" } else { "" };
        let line = format!("| {method}{preset} | {fovea} | {psnr_db:.2} | ");
        let ours = if row["input"] == still.as_str() { of_still } else { of_moving };
        assert!(ours.contains(&line), "'{line}' is missing: {ours}");
        rows += 1;
    }
    assert_eq!(rows, 2 * 2 * 5, "two clips, two foveae, four methods, two presets of wrs");
    assert!(text.contains("\n| `Settings::weighted()` | "), "{text}");
    // Table 1 of Cantory et al.: stills are compared with none, moving cameras with taa.
    assert!(of_still.contains("| paper, Sponza: none, wrs | 5 | 24.13, 26.52 | 0.540, 0.720 | | |"), "{of_still}");
    assert!(of_moving.contains("| paper, Corridor: taa, wrs | 5 | 22.27, 23.12 | 0.736, 0.775 | | |"), "{of_moving}");
    assert!(
        text.contains("\nPSNR gain over none, 5 degrees: wrs ")
            && text.contains("\nPSNR gain over taa, 5 degrees: wrs "),
        "{text}"
    );
    assert!(text.contains("\nRun time in ms a frame"), "{text}");
}
