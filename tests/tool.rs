//! The command-line tool as other programs use it: what it writes, and how it refuses.
#![cfg(feature = "cli")]

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn tool(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_afterimage"))
        .args(args)
        // Silences a line of Mesa's about windows.
        .env("NODEVICE_SELECT", "1")
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("the tool starts")
}

#[track_caller]
fn succeeds(args: &[&str]) -> String {
    let output = tool(args);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{args:?}: {stderr}");
    assert!(stderr.is_empty(), "nothing on stderr when it is no terminal: {stderr}");
    String::from_utf8(output.stdout).unwrap()
}

/// One clear line that holds `words`, exit code 2, no panic.
#[track_caller]
fn refuses(args: &[&str], words: &[&str]) -> String {
    let output = tool(args);
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    println!("{}", stderr.trim_end());
    assert_eq!(output.status.code(), Some(2), "{args:?}: {stderr}");
    assert_eq!(stderr.lines().count(), 1, "one line: {stderr}");
    assert!(output.stdout.is_empty());
    for word in words {
        assert!(stderr.contains(word), "'{word}' is missing: {stderr}");
    }
    stderr
}

fn read_json(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn text(&self, name: &str) -> String {
        self.path(name).to_str().unwrap().to_owned()
    }

    fn write(&self, name: &str, bytes: &[u8]) -> String {
        fs::write(self.path(name), bytes).unwrap();
        self.text(name)
    }
}

const DEBUG: &str = "weight,age,survival,flush,gate,motion";

const SMALL: &[&str] = &["--size", "160x90", "--frames", "4"];

fn run<'a>(input: &'a str, out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&["run", input, "--out", out][..], more].concat()
}

#[test]
fn run_writes_what_the_contract_says() {
    let folder = Folder::new();
    let out = folder.text("out");
    let more = [SMALL, &["--reference", "--method", "none,wrs", "--debug", DEBUG]].concat();
    succeeds(&run("analytic:lateral", &out, &more));
    let out = folder.path("out");
    assert_eq!(
        files(&out),
        ["debug", "frames.csv", "gaze.csv", "none", "reference", "report.json", "sheet.png", "wrs"]
    );
    let frames = ["000000.png", "000001.png", "000002.png", "000003.png"];
    for part in ["none", "wrs", "reference", "debug/wrs/flush", "debug/none/motion"] {
        assert_eq!(files(&out.join(part)), frames, "{part}");
    }
    assert_eq!(image::open(out.join("wrs/000003.png")).unwrap().to_rgb8().dimensions(), (160, 90));

    let report = read_json(&out.join("report.json"));
    assert_eq!(report["tool"], "afterimage");
    assert_eq!((&report["frames"], &report["size"][0], &report["fps"]), (&4.into(), &160.into(), &60.0.into()));
    assert_eq!(report["backend"]["kind"], "cpu");
    for method in ["none", "wrs"] {
        let m = &report["methods"][method];
        for key in ["psnr_db", "ssim", "flicker", "cpu_ms", "bytes_per_pixel", "nonfinite_in", "flushed"] {
            assert!(m[key].is_number(), "{method}.{key}: {}", m[key]);
        }
        for key in ["median", "p25", "p75"] {
            assert!(m["ms"][key].is_number());
        }
        for band in ["fovea", "mid", "periphery"] {
            assert!(m["bands"][band].get("psnr_db").is_some() && m["bands"][band].get("flip").is_some());
        }
        assert_eq!(m["nonfinite_out"], 0);
        for key in ["flip", "weighted_psnr_db", "delta_e94_mean", "delta_e94_p99"] {
            assert!(m[key].is_number(), "{method}.{key}: {}", m[key]);
        }
        for key in ["retained_psnr_db", "replaced", "ghost_energy", "ghost_half_frames"] {
            assert!(m.get(key).is_some(), "{method}.{key}");
        }
    }
    assert_eq!(report["methods"]["wrs"]["bytes_per_pixel"], 48);
    // 160 pixels over 70 degrees.
    assert!((report["flip_pixels_per_degree"].as_f64().unwrap() - 1.994).abs() < 1e-3);
    let gaze = fs::read_to_string(out.join("gaze.csv")).unwrap();
    assert_eq!((gaze.lines().next(), gaze.lines().count()), (Some("frame,x_px,y_px"), 5));
}

#[test]
fn run_leaves_flip_out_when_told() {
    let folder = Folder::new();
    let out = folder.text("out");
    succeeds(&run("analytic:lateral", &out, &[SMALL, &["--method", "none", "--no-flip"]].concat()));
    let report = read_json(&folder.path("out").join("report.json"));
    let none = &report["methods"]["none"];
    assert!(none["flip"].is_null() && none["bands"]["mid"]["flip"].is_null() && none["psnr_db"].is_number());
    assert!(report["flip_pixels_per_degree"].is_null());
}

#[test]
fn the_same_seed_gives_the_same_bytes_on_any_number_of_threads() {
    let folder = Folder::new();
    let frames = |name: &str, threads: &str, seed: &str| {
        let out = folder.text(name);
        let status = Command::new(env!("CARGO_BIN_EXE_afterimage"))
            .args(run("analytic:occluder", &out, &[SMALL, &["--seed", seed, "--format", "exr"]].concat()))
            .env("RAYON_NUM_THREADS", threads)
            .output()
            .unwrap();
        assert!(status.status.success());
        (0..4).map(|i| fs::read(folder.path(name).join(format!("wrs/{i:06}.exr"))).unwrap()).collect::<Vec<_>>()
    };
    let one = frames("one", "1", "5");
    assert_eq!(one, frames("two", "2", "5"));
    assert_ne!(one, frames("other", "2", "6"));
}

#[test]
fn both_backends_write_the_same_bytes() {
    let folder = Folder::new();
    let on = |backend| {
        let out = folder.text(backend);
        let more = ["--format", "exr", "--wrs-sampler", "a-es", "--backend", backend, "--debug", DEBUG];
        tool(&run("analytic:occluder", &out, &[SMALL, &more].concat()))
    };
    let gpu = on("gpu");
    if gpu.status.code() == Some(2) && std::env::var("AFTERIMAGE_GPU").as_deref() != Ok("require") {
        let text = String::from_utf8_lossy(&gpu.stderr).into_owned();
        assert!(text.contains("mesa-vulkan-drivers"), "{text}");
        eprintln!("SKIPPED: no adapter");
        return;
    }
    assert!(gpu.status.success(), "{}", String::from_utf8_lossy(&gpu.stderr));
    assert!(on("cpu").status.success());
    let report = read_json(&folder.path("gpu/report.json"));
    assert_eq!(report["backend"]["kind"], "gpu");
    if report["backend"]["name"].as_str().unwrap().contains("llvmpipe") {
        let cpu = read_json(&folder.path("cpu/report.json"));
        for method in ["none", "wrs"] {
            let of = |report: &Value, key: &str| report["methods"][method][key].clone();
            for key in ["flushed", "replaced", "nonfinite_in", "bytes_per_pixel", "persistent_bytes_per_pixel"] {
                assert_eq!(of(&report, key), of(&cpu, key), "{method}.{key}");
            }
            assert!(of(&report, "flushed").is_number());
            for view in DEBUG.split(',') {
                for i in 0..4 {
                    let path = |b: &str| folder.path(b).join(format!("debug/{method}/{view}/{i:06}.png"));
                    assert_eq!(fs::read(path("cpu")).unwrap(), fs::read(path("gpu")).unwrap(), "{method}, {view}, {i}");
                }
            }
        }
        for i in 0..4 {
            let frame = |b: &str| fs::read(folder.path(b).join(format!("wrs/{i:06}.exr"))).unwrap();
            assert_eq!(frame("cpu"), frame("gpu"), "frame {i}");
        }
    }
}

#[test]
fn a_rerun_replaces_the_frames_of_the_run_before_and_nothing_else() {
    let folder = Folder::new();
    let out = folder.text("out");
    succeeds(&run("analytic:still", &out, SMALL));
    fs::write(folder.path("out/wrs/notes.txt"), "mine").unwrap();
    succeeds(&run("analytic:still", &out, &["--size", "160x90", "--frames", "2"]));
    assert_eq!(files(&folder.path("out/wrs")), ["000000.png", "000001.png", "notes.txt"]);
    // Frames of something else are not touched.
    fs::create_dir_all(folder.path("foreign/wrs")).unwrap();
    fs::write(folder.path("foreign/wrs/000007.png"), "photo").unwrap();
    refuses(&run("analytic:still", &folder.text("foreign"), SMALL), &["frames of something else", "--out"]);
    assert_eq!(fs::read_to_string(folder.path("foreign/wrs/000007.png")).unwrap(), "photo");
}

#[test]
fn bad_usage_is_one_line_and_exit_code_2() {
    let folder = Folder::new();
    let out = folder.text("out");
    let still = "analytic:still";
    refuses(&["run", still], &["--out"]);
    refuses(&["dance"], &["dance"]);
    refuses(&run(still, &out, &["--method", "none,dlss"]), &["dlss", "wrs"]);
    refuses(&run(still, &out, &["--method", "wrs,wrs"]), &["twice"]);
    refuses(&run("analytic:lateral", &out, &["--method", "oracle"]), &["stills"]);
    refuses(&run("analytic:sponza", &out, &[]), &["sponza", "lateral"]);
    refuses(&run(still, &out, &["--size", "0x5"]), &["WxH"]);
    refuses(&run(still, &out, &["--size", "100000x100000"]), &["limit", "--max-megapixels"]);
    refuses(&run(still, &out, &["--frames", "0"]), &["at least 1"]);
    refuses(&run(still, &out, &["--frames", "1000000000000"]), &["at most"]);
    refuses(&run(still, &out, &["--fovea", "20"]), &["fovea", "15"]);
    refuses(&run(still, &out, &["--fovea", "NaN"]), &["fovea"]);
    refuses(&run(still, &out, &["--rate-mid", "5"]), &["power of two"]);
    refuses(&run(still, &out, &["--hfov", "180"]), &["180"]);
    refuses(&run(still, &out, &["--fps", "0"]), &["--fps"]);
    refuses(&run(still, &out, &["--start=-1"]), &["start"]);
    refuses(&run(still, &out, &["--wrs-bias", "exponential:x"]), &["LAMBDA"]);
    refuses(&run(still, &out, &["--gate-divisor", "0"]), &["gate divisor"]);
    refuses(&run(still, &out, &["--gaze", "1,x"]), &["X,Y"]);
    refuses(&run(still, &out, &["--gaze", "synthetic:x"]), &["SEED"]);
    refuses(&run(still, &out, &["--camera", "lateral"]), &["--camera", "scene"]);
    refuses(&run("analytic:still", &out, &["--source", "raster"]), &["--source", "scene"]);
    assert!(!folder.path("out").exists(), "nothing was written");
}

#[test]
fn scenes_are_rasterised_and_go_through_every_method() {
    let folder = Folder::new();
    let mut args =
        vec!["run", "builtin:cubes", "--source", "raster", "--size", "96x54", "--frames", "3", "--fps", "30"];
    let out = folder.text("out");
    args.extend(["--method", "none,taa,wrs,smr", "--backend", "cpu", "--out", &out]);
    let output = tool(&args);
    if output.status.code() == Some(2) && std::env::var("AFTERIMAGE_GPU").as_deref() != Ok("require") {
        assert!(String::from_utf8_lossy(&output.stderr).contains("adapter"));
        eprintln!("SKIPPED: no adapter");
        return;
    }
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let report = read_json(&folder.path("out/report.json"));
    assert_eq!((&report["fps"], &report["frames"]), (&serde_json::json!(30.0), &serde_json::json!(3)));
    for method in ["none", "taa", "wrs", "smr"] {
        assert!(folder.path(&format!("out/{method}/000002.png")).is_file());
        assert_eq!(report["methods"][method]["nonfinite_out"], 0);
    }
    refuses(&["run", "builtin:cubes", "--camera", "left", "--out", &folder.text("none")], &["left", "lateral"]);
    refuses(&["run", "builtin:none", "--out", &folder.text("none")], &["builtin:none", "courtyard"]);
    refuses(&["run", "no/such.glb", "--out", &folder.text("none")], &["such.glb"]);
}

#[test]
fn bad_files_are_one_line_and_exit_code_2() {
    let folder = Folder::new();
    let out = folder.text("out");
    let gaze = |csv: &str, words: &[&str]| {
        let file = folder.write("gaze.csv", csv.as_bytes());
        refuses(&run("analytic:still", &out, &["--gaze", &file]), words);
    };
    gaze("# screen_px: 100x100\nt_s,x_px,y_px,valid\n0,1,1,1\n0.1,abc,1,1\n", &["gaze.csv", "line 4"]);
    gaze("# screen_px: 100x100\nt_s,x_px,y_px,valid\n0,nan,nan,0\n0.1,nan,nan,0\n", &["gaze.csv", "lost"]);
    gaze("", &["gaze.csv"]);
    refuses(&run("analytic:still", &out, &["--gaze", "no/such.csv"]), &["no/such.csv"]);
    refuses(&run("no/such/folder", &out, &[]), &["no/such/folder", "does not exist"]);
    fs::create_dir(folder.path("empty")).unwrap();
    refuses(&run(&folder.text("empty"), &out, &[]), &["empty", ".exr"]);
    let file = folder.write("broken.png", b"\x89PNG\r\n\x1a\nnot a picture");
    refuses(&run(&file, &out, &[]), &["broken.png"]);
    let file = folder.write("broken.exr", b"v/1\x01 and nothing more");
    refuses(&run(&file, &out, &[]), &["broken.exr"]);
    // A PNG whose header claims 1,000,000 x 1,000,000 pixels.
    let mut png = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\x0fB@\0\x0fB@\x08\x02\0\0\0".to_vec();
    png.extend([0; 64]);
    let file = folder.write("huge.png", &png);
    refuses(&run(&file, &out, &[]), &["huge.png"]);
    assert!(!folder.path("out").exists(), "nothing was written");
    // A file where the folder should be.
    let file = folder.write("file", b"");
    refuses(&run("analytic:still", &format!("{file}/out"), SMALL), &["cannot be written", "--out"]);
}

#[test]
fn a_still_from_a_picture_file_works_without_depth_and_motion() {
    let folder = Folder::new();
    let picture = folder.text("still.png");
    image::RgbImage::from_fn(33, 21, |x, y| image::Rgb([x as u8 * 7, y as u8 * 11, 90])).save(&picture).unwrap();
    let out = folder.text("out");
    succeeds(&run(&picture, &out, &["--frames", "3", "--method", "none,wrs,oracle", "--gaze", "5,5"]));
    let report = read_json(&folder.path("out/report.json"));
    assert!(report["methods"]["oracle"]["bytes_per_pixel"].is_null());
    assert!(report["methods"]["oracle"]["share_of_oracle"]["psnr"].is_null(), "the eye did not move: nothing to gain");
    let more = ["--size", "160x90", "--frames", "60", "--method", "none,wrs,oracle"];
    succeeds(&run("analytic:still", &folder.text("moving eye"), &more));
    let methods = &read_json(&folder.path("moving eye/report.json"))["methods"];
    let share = |method: &str| methods[method]["share_of_oracle"]["psnr"].as_f64().unwrap();
    assert_eq!((share("none"), share("oracle")), (0.0, 1.0));
    assert!(share("wrs") > 0.0 && share("wrs") < 1.0);
    assert_eq!(report["methods"]["wrs"]["bytes_per_pixel"], 40);
    assert_eq!(report["methods"]["none"]["flicker"], 0.0, "nothing moves, and the eye neither");
}

#[test]
fn scanpath_writes_what_run_reads_and_info_explains_both() {
    let folder = Folder::new();
    let csv = folder.text("view.csv");
    succeeds(&["scanpath", "--seconds", "2", "--seed", "4", "--out", &csv]);
    let again = folder.text("again.csv");
    succeeds(&["scanpath", "--seconds", "2", "--seed", "4", "--out", &again]);
    assert_eq!(fs::read(&csv).unwrap(), fs::read(&again).unwrap());
    let text = succeeds(&["info", &csv]);
    assert!(text.contains("1920x1080 px") && text.contains("--gaze-map: angle"), "{text}");
    succeeds(&run("analytic:scroll", &folder.text("out"), &[SMALL, &["--gaze", &csv, "--start", "1"]].concat()));
    let text = succeeds(&["info", "analytic:lateral"]);
    assert!(text.contains("640x360") && text.contains("motion convention: as read"), "{text}");
    refuses(&["scanpath", "--seconds=-1", "--out", &csv], &["-1"]);
    refuses(&["scanpath", "--out", &format!("{csv}/x.csv")], &["cannot be written"]);
    assert!(succeeds(&["info", "adapters"]).contains("CPU"));
}

#[test]
fn info_says_what_a_scene_holds() {
    let text = succeeds(&["info", "builtin:cornell"]);
    for line in [
        "builtin:cornell",
        "triangles: 36 (0 of them move)",
        "textures: 0, 0 bytes",
        "lights: none",
        "environment: none",
        "cameras: 1 ('main')",
        "animations: 0",
        "effects that it calls for: emissive-triangles",
    ] {
        assert!(text.lines().any(|l| l == line), "'{line}' in\n{text}");
    }
    assert!(text.contains("bounds, m: x ") && text.contains("materials that emit light: 1 ("), "{text}");

    // A triangle that a light, a camera and two animations go with.
    let folder = Folder::new();
    let floats = |values: &[f32]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let corners = floats(&[0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0, -1.0]);
    let keys = floats(&[0.0, 1.5, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    folder.write("data.bin", &[corners, keys].concat());
    let scene = folder.write(
        "scene.gltf",
        br#"{"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual", "KHR_xyz"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}]}},
        "buffers": [{"uri": "data.bin", "byteLength": 68}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8},
            {"buffer": 0, "byteOffset": 44, "byteLength": 24}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, -1], "max": [2, 3, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1.5]},
            {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}],
        "materials": [{"name": "red\npaint"}, {"name": "unused"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
        "cameras": [{"type": "perspective", "name": "door", "perspective": {"yfov": 0.8, "znear": 0.1}}],
        "nodes": [{"mesh": 0}, {"camera": 0}, {"extensions": {"KHR_lights_punctual": {"light": 0}}}],
        "animations": [
            {"name": "walk", "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                "samplers": [{"input": 1, "output": 2}]},
            {"channels": [], "samplers": []}],
        "scenes": [{"nodes": [0, 1, 2]}]}"#,
    );
    let text = succeeds(&["info", &scene]);
    for line in [
        scene.as_str(),
        "triangles: 1 (1 of them move)",
        "bounds, m: x 0 to 2, y 0 to 3, z -1 to 0",
        "materials: 1 ('red\\npaint')",
        "lights: 1 point",
        "materials that emit light: 0",
        "cameras: 1 ('door')",
        "animations: 2 ('walk')",
        "length of the first animation, s: 1.500",
        "effects that it calls for: metal, punctual-lights, moving-objects",
    ] {
        assert!(text.lines().any(|l| l == line), "'{line}' in\n{text}");
    }
    assert!(text.contains("warning: ") && text.contains("KHR_xyz"), "{text}");

    refuses(&["info", "builtin:teapot"], &["teapot", "cornell"]);
    refuses(&["info", "missing.glb"], &["missing.glb"]);
    refuses(&["info", &folder.write("broken.gltf", b"no scene")], &["broken.gltf"]);
}

#[test]
fn bench_times_every_pass_against_the_copy() {
    let folder = Folder::new();
    let json = folder.text("bench.json");
    let output = tool(&["bench", "post", "--size", "160x90", "--frames", "30", "--json", &json]);
    if output.status.code() == Some(2) && std::env::var("AFTERIMAGE_GPU").as_deref() != Ok("require") {
        eprintln!("SKIPPED: no adapter");
        return;
    }
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let report = read_json(Path::new(&json));
    let passes = report["passes"].as_array().unwrap();
    assert_eq!(
        passes.iter().map(|p| p["name"].as_str().unwrap()).collect::<Vec<_>>(),
        ["copy", "none", "wrs", "taa", "smr", "mip", "gauss", "block"]
    );
    for pass in passes {
        assert!(pass["ms"]["median"].as_f64().unwrap() > 0.0);
        assert!((1..=48).contains(&pass["bytes_per_pixel"].as_u64().unwrap()));
        assert!(
            pass["ms_per_megapixel"].as_f64().unwrap() > 0.0 && pass["share_of_copy_bandwidth"].as_f64().unwrap() > 0.0
        );
    }
    assert!(!report["adapter"].as_str().unwrap().is_empty() && report["cold_start_ms"].as_f64().unwrap() > 0.0);
    refuses(&["bench", "post", "--frames", "3"], &["30"]);
}

#[test]
fn bench_counts_the_rays_of_the_tracer() {
    let folder = Folder::new();
    let json = folder.text("rays.json");
    let small = ["--size", "32x18", "--backend", "cpu", "--scene", "builtin:cornell", "--json", &json];
    succeeds(&[&["bench", "trace"], &small[..]].concat());
    let report = read_json(Path::new(&json));
    let tracer = &report["scenes"][0]["tracers"][0];
    // A camera ray a pixel at least, and no more than two a bounce and the last.
    assert!((576..=576 * 7).contains(&tracer["rays_per_frame"].as_u64().unwrap()));
    assert!(tracer["mrays_per_core_second"].as_f64().unwrap() > 0.0);
    refuses(&["bench", "trace", "--scene", "builtin:none"], &["builtin:none"]);
    refuses(&["bench", "effects", "--frames", "3"], &["30"]);
}

#[test]
fn bench_puts_the_papers_figures_beside_ours() {
    let folder = Folder::new();
    let json = folder.text("papers.json");
    let small = ["bench", "papers", "--backend", "cpu", "--size", "64x36", "--frames", "1", "--json", &json];
    let text = succeeds(&small);
    assert!(text.contains("| 32,16,8 | 8.60 | 30.9x | 8.6 |"), "{text}");
    let report = read_json(Path::new(&json));
    let regions = report["regions"]["patterns"].as_array().unwrap();
    assert_eq!(regions.len(), 4);
    assert!((report["regions"]["hfov_deg"].as_f64().unwrap() - 61.1).abs() < 0.1);
    assert_eq!(regions[0]["paper_time_reduction"], 23.93);
    // Of a few pixels: what is measured is anything.
    assert!(regions.iter().all(|p| p["time_reduction"].as_f64().unwrap() > 0.0 && p["clock"] == "CPU"));
    let layers = report["layers"].as_array().unwrap();
    assert_eq!(layers.len(), 5);
    assert!(layers.iter().all(|scene| scene["size"] == serde_json::json!([36, 40]) && scene["max_depth"] == 8));
    assert!(layers.iter().all(|scene| scene["patterns"].as_array().unwrap().len() == 2));
    refuses(&["bench", "papers", "--frames", "0"], &["1 to"]);
    refuses(&["bench", "papers", "--camera", "no/such.json"], &["no/such.json"]);
}

#[test]
fn bench_prices_effects_between_the_markers() {
    let folder = Folder::new();
    let (page, json) = (folder.text("effects.md"), folder.text("effects.json"));
    let small = ["--size", "16x9", "--backend", "cpu", "--scene", "builtin:cornell", "--json", &json, "--out", &page];
    let command = [&["bench", "effects"], &small[..]].concat();
    succeeds(&command);
    let table = std::fs::read_to_string(&page).unwrap();
    std::fs::write(&page, format!("before\n{table}after\n")).unwrap();
    succeeds(&command);
    let text = std::fs::read_to_string(&page).unwrap();
    assert!(text.starts_with("before\n<!--") && text.ends_with("-->\nafter\n"), "{text}");
    for word in [
        "### builtin:cornell",
        "| auto again |",
        "| clearcoat |",
        "| auto and clearcoat |",
        "| emissive-triangles | needed |",
    ] {
        assert!(text.contains(word), "{word} in {text}");
    }
    let prices = &read_json(Path::new(&json))["scenes"][0]["prices"][0];
    assert_eq!(prices[0]["ratio"]["median"].as_f64(), Some(1.0));
    std::fs::write(&page, "no markers").unwrap();
    refuses(&command, &["markers"]);
}

#[test]
fn bench_compares_patterns_at_equal_numbers_of_samples() {
    let folder = Folder::new();
    let (out, json) = (folder.text("out"), folder.text("patterns.json"));
    let base = ["bench", "patterns", "builtin:courtyard", "--out", &out, "--backend", "cpu", "--json", &json];
    succeeds(&[&base[..], &["--size", "320x180", "--frames", "2", "--reference-spp", "3"]].concat());
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
    // The reference that was written is one; of another size it is none.
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
        ["--reference-spp", "0"],
        ["--size", "4x4"],
        ["--camera", "nowhere"],
    ] {
        refuses(&[&base[..], &more].concat(), &[more[0].trim_start_matches("--camera")]);
    }
}

#[test]
fn help_states_units_and_an_example() {
    for command in ["demo", "run", "bench", "scanpath", "info"] {
        let text = succeeds(&[command, "--help"]);
        assert!(text.contains("Example"), "{command}");
        assert!(text.contains(&format!("afterimage {command}")), "{command}");
    }
    let text = succeeds(&["run", "--help"]);
    for word in ["degrees", "pixels", "seconds", "[default: 5]", "stops"] {
        assert!(text.contains(word), "{word}");
    }
    assert!(succeeds(&["--version"]).starts_with("afterimage 0."));
}
