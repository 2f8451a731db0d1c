//! `afterimage run`: files, and their reproducibility.

use super::rig::{DEBUG, Folder, SMALL, files, ran, refuses, run, same_on_both_backends, succeeds, tool, words};
use serde_json::Value;
use std::fs;
use std::process::Command;

#[test]
fn run_writes_what_the_contract_says() {
    let out = ran("analytic:lateral", &format!("{SMALL} --reference --method none,wrs --debug {DEBUG}"));
    let expected = "debug frames.csv gaze.csv none psnr.png psnr.svg reference report.json sheet.png wrs";
    assert_eq!(out.files(""), words(expected));
    for part in ["none", "wrs", "reference", "debug/wrs/flush", "debug/none/motion"] {
        assert_eq!(out.files(part), words("000000.png 000001.png 000002.png 000003.png"), "{part}");
    }
    assert_eq!(image::open(out.path("wrs/000003.png")).unwrap().to_rgb8().dimensions(), (160, 90));
    let plot = out.text("psnr.svg");
    assert!(plot.contains("lateral: PSNR by frame, mip 8 and 16"), "{plot}");
    assert_eq!(plot.matches("class=\"curve\"").count(), 2, "a line for each method");
    assert_eq!(image::open(out.path("psnr.png")).unwrap().width(), 1920);

    let report = out.json("report.json");
    assert_eq!(report["tool"], "afterimage");
    assert_eq!((&report["frames"], &report["size"][0], &report["fps"]), (&4.into(), &160.into(), &60.0.into()));
    assert_eq!(report["backend"]["kind"], "cpu");
    for method in ["none", "wrs"] {
        let m = &report["methods"][method];
        let numbers = "psnr_db ssim flicker cpu_ms bytes_per_pixel nonfinite_in flushed flip weighted_psnr_db \
                       delta_e94_mean delta_e94_p99";
        for key in words(numbers) {
            assert!(m[key].is_number(), "{method}.{key}: {}", m[key]);
        }
        assert!(["median", "p25", "p75"].iter().all(|key| m["ms"][key].is_number()));
        for band in ["fovea", "mid", "periphery"] {
            assert!(m["bands"][band].get("psnr_db").is_some() && m["bands"][band].get("flip").is_some());
        }
        assert_eq!(m["nonfinite_out"], 0);
        for key in ["retained_psnr_db", "replaced", "ghost_energy", "ghost_half_frames"] {
            assert!(m.get(key).is_some(), "{method}.{key}");
        }
    }
    assert_eq!(report["methods"]["none"]["worst_crop"]["delta_db"], 0.0, "none is compared with itself");
    let worst = &report["methods"]["wrs"]["worst_crop"];
    assert!(worst["delta_db"].as_f64().unwrap() <= 0.0 && worst["frame"].as_u64().unwrap() >= 2, "{worst}");
    assert_eq!(report["methods"]["wrs"]["bytes_per_pixel"], 48);
    // 160 pixels over 70 degrees.
    assert!((report["flip_pixels_per_degree"].as_f64().unwrap() - 1.994).abs() < 1e-3);
    let gaze = out.text("gaze.csv");
    assert_eq!((gaze.lines().next(), gaze.lines().count()), (Some("frame,x_px,y_px"), 5));
}

#[test]
fn the_same_seed_gives_the_same_bytes_on_any_number_of_threads() {
    let folder = Folder::new();
    let frames = |name: &str, threads: &str, seed: &str| {
        let out = folder.text(name);
        let options = format!("{SMALL} --seed {seed} --format exr");
        let status = Command::new(env!("CARGO_BIN_EXE_afterimage"))
            .args(run("analytic:occluder", &out, &words(&options)))
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
    if afterimage_testing::gpu::adapter().is_none() {
        let folder = Folder::new();
        refuses(&run("analytic:still", &folder.text("out"), &["--backend", "gpu"]), &["mesa-vulkan-drivers"]);
        return;
    }
    let debug = format!("--size 160x90 --frames 4 --wrs-sampler a-es --no-jod --debug {DEBUG}");
    let traced = "--source trace --spp 2 --reference-samples 2 --no-jod --method none,taa,taau,smr --frames 3 --size 64x36 \
                  --gaze 20,12";
    for (input, line, simulator) in [("analytic:occluder", &debug[..], "mip"), ("builtin:cubes", traced, "planned")] {
        let [cpu, gpu] = same_on_both_backends(input, line);
        assert_eq!((&cpu["backend"]["kind"], &gpu["backend"]["kind"]), (&"cpu".into(), &"gpu".into()));
        let foveation = &cpu["foveation"];
        assert_eq!(foveation["simulator"], simulator, "{line}");
        if simulator == "planned" {
            // Stored samples and their noise, of two frames.
            assert_eq!(cpu["methods"]["smr"]["persistent_bytes_per_pixel"], 24.0);
            continue;
        }
        assert!(cpu["methods"]["wrs"]["flushed"].is_number());
        for method in ["none", "wrs"] {
            let [cpu, gpu] = [&cpu, &gpu].map(|report| &report["methods"][method]["persistent_bytes_per_pixel"]);
            assert_eq!(cpu, gpu, "{method}");
        }
    }
}

#[test]
fn frames_before_the_first_that_counts_are_shown_and_not_scored() {
    let scored = |from: u32| {
        let out = ran("analytic:lateral", &format!("{SMALL} --method none --score-from {from}"));
        let psnr: Vec<f64> = out.column("none", "psnr_db").into_iter().flatten().collect();
        (psnr, out.json("report.json")["methods"]["none"].clone())
    };
    let ((frames, whole), (_, last)) = (scored(0), scored(3));
    let pooled =
        |psnr: &[f64]| -10.0 * (psnr.iter().map(|db| 10_f64.powf(-db / 10.0)).sum::<f64>() / psnr.len() as f64).log10();
    assert!((whole["psnr_db"].as_f64().unwrap() - pooled(&frames)).abs() < 1e-3, "{whole}, {frames:?}");
    assert!((last["psnr_db"].as_f64().unwrap() - frames[3]).abs() < 1e-3, "{last}, {frames:?}");
    assert!((frames[3] - pooled(&frames)).abs() > 1e-2, "otherwise this test cannot fail");
    let late = format!("{SMALL} --score-from 4");
    refuses(&run("analytic:lateral", &Folder::new().text("out"), &words(&late)), &["--score-from 4", "4 frames"]);
}

/// Of scenes methods choose the pixels, and given frames simulate blur, unless the command line says otherwise.
#[test]
fn scenes_have_few_samples_by_default_and_given_frames_are_blurred() {
    if afterimage_testing::gpu::adapter().is_none() {
        return;
    }
    for (input, more, expected) in [
        ("builtin:cubes", "", ["planned", ""]),
        ("builtin:cubes", "--source trace --spp 1 --reference-samples 1", ["planned", ""]),
        ("builtin:cubes", "--foveation layers", ["layers", "samples"]),
        ("builtin:cubes", "--foveation mip", ["mip", ""]),
        ("analytic:still", "", ["mip", ""]),
    ] {
        let out = ran(input, &format!("--size 64x36 --frames 2 --method none --no-flip --no-jod {more}"));
        let foveation = &out.json("report.json")["foveation"];
        let found = ["simulator", "geometry"].map(|key| foveation[key].as_str().unwrap_or_default());
        assert_eq!(found, expected, "{input}, {more}");
    }
}

#[test]
fn a_run_that_fails_leaves_no_plot_of_the_run_before() {
    let folder = Folder::new();
    let sequence = afterimage_testing::workspace().join("fixtures/sequences/lateral_160x90");
    fs::create_dir(folder.path("frames")).unwrap();
    for name in files(&sequence) {
        fs::copy(sequence.join(&name), folder.path("frames").join(&name)).unwrap();
    }
    let (frames, out) = (folder.text("frames"), folder.text("out"));
    let more = ["--frames", "6", "--no-flip", "--no-jod"];
    succeeds(&run(&frames, &out, &more));
    assert!(folder.path("out/psnr.svg").is_file() && folder.path("out/psnr.png").is_file());
    let last = folder.path("frames/frame_0005.exr");
    let mut bytes = fs::read(&last).unwrap();
    // Inside the last chunk: found only when the frame is read.
    let from = bytes.len() - 200;
    bytes[from..].fill(0xff);
    fs::write(&last, bytes).unwrap();
    assert!(!tool(&run(&frames, &out, &more)).status.success());
    let left = files(&folder.path("out"));
    assert!(
        left.contains(&"none".to_owned()) && left.iter().all(|f| !f.starts_with("psnr") && f != "report.json"),
        "{left:?}"
    );
}

#[test]
fn a_still_from_a_picture_file_works_without_depth_and_motion() {
    let folder = Folder::new();
    let picture = folder.text("still.png");
    image::RgbImage::from_fn(33, 21, |x, y| image::Rgb([x as u8 * 7, y as u8 * 11, 90])).save(&picture).unwrap();
    let report = ran(&picture, "--frames 3 --method none,wrs,oracle --gaze 5,5 --no-jod").json("report.json");
    assert!(report["methods"]["oracle"]["bytes_per_pixel"].is_null());
    assert!(report["methods"]["oracle"]["share_of_oracle"]["psnr"].is_null(), "the eye did not move: nothing to gain");
    let more = "--size 160x90 --frames 40 --method none,wrs,oracle --no-jod --no-flip";
    let methods = &ran("analytic:still", more).json("report.json")["methods"];
    let share = |method: &str| methods[method]["share_of_oracle"]["psnr"].as_f64().unwrap();
    assert_eq!((share("none"), share("oracle")), (0.0, 1.0));
    assert!(share("wrs") > 0.0 && share("wrs") < 1.0);
    assert_eq!(report["methods"]["wrs"]["bytes_per_pixel"], 40);
    assert_eq!(report["methods"]["none"]["flicker"], 0.0, "nothing moves, and the eye neither");
}

/// Renderer and post-process, in every file that has times, add up to the whole frame.
#[test]
fn the_time_of_a_frame_is_that_of_the_renderer_and_the_post_process() {
    let kinds = [
        ("samples", "--source raster --foveation layers --rate-mid 4 --rate-far 8 --geometry samples"),
        ("full", "--source raster --foveation layers --rate-mid 4 --rate-far 8 --geometry full"),
        ("mip", "--source raster --foveation mip"),
        ("traced", "--source trace --sampling regions --region-spp 1,1,1"),
    ];
    if afterimage_testing::gpu::adapter().is_none() {
        return;
    }
    let mut render_ms = vec![];
    for (name, more) in kinds {
        let small = "--reference-samples 2 --size 160x90 --frames 5 --method none,smr --backend cpu --no-flip --no-jod";
        let out = ran("builtin:cubes", &format!("{more} {small}"));
        assert!(out.said.contains("render +   post =  total ms"), "{}", out.said);
        let report = out.json("report.json");
        for method in ["none", "smr"] {
            let of = |key: &str| report["methods"][method][key].as_f64();
            let adds = |a: Option<f64>, b: Option<f64>, total: Option<f64>, what: &str| {
                let (a, b, total) = (a.expect(what), b.expect(what), total.expect(what));
                assert!(a > 0.0 && b > 0.0 && (a + b - total).abs() < 1e-9 * total, "{name}, {method}, {what}");
            };
            let post_ms = report["methods"][method]["ms"]["median"].as_f64();
            adds(of("render_ms"), post_ms, of("total_ms"), "total_ms");
            if cfg!(unix) {
                adds(of("render_cpu_ms"), of("cpu_ms"), of("total_cpu_ms"), "total_cpu_ms");
            }
            for key in ["device_ms", "render_device_ms", "total_device_ms"] {
                assert!(report["methods"][method].get(key).is_some(), "{key}");
            }
        }
        assert_eq!(report["methods"]["none"]["render_ms"], report["methods"]["smr"]["render_ms"], "one renderer");
        let full_rate = &report["full_rate"];
        match name {
            // The reference has other samples a pixel.
            "traced" => assert!(full_rate.is_null(), "{full_rate}"),
            "mip" => assert_eq!(full_rate["render_ms"], report["methods"]["smr"]["render_ms"]),
            _ => assert!(full_rate["render_ms"].as_f64().unwrap() > 0.0),
        }
        let clock = if cfg!(unix) { "render_cpu_ms" } else { "render_ms" };
        render_ms.push((report["methods"]["smr"][clock].as_f64().unwrap(), full_rate[clock].as_f64()));
        frames_add_up(&out.text("frames.csv"));
    }
    // Reading back, references and metrics are not part of the renderer's time, or foveated frames would take longer
    // than full-rate frames. A device's frame may be too short for that to show.
    let [samples, full, ..] = render_ms[..] else { panic!() };
    println!("foveated and full rate, ms: {samples:?}, with depth and motion everywhere {full:?}");
    assert!(samples.0 < samples.1.unwrap(), "{render_ms:?}");

    // Frames that are read have no renderer.
    let out = ran("analytic:lateral", &format!("{SMALL} --method smr --no-flip"));
    let report = out.json("report.json");
    for key in ["render_ms", "render_cpu_ms", "total_ms", "total_cpu_ms"] {
        assert!(report["methods"]["smr"].get(key).is_some_and(Value::is_null), "{key}");
    }
    assert!(report["full_rate"].is_null());
    let none = &report["methods"]["smr"];
    assert!(none["flip"].is_null() && none["bands"]["mid"]["flip"].is_null() && none["psnr_db"].is_number());
    let csv = out.text("frames.csv");
    assert!(csv.lines().nth(1).unwrap().ends_with(",,,,,,"), "{csv}");
}

/// Checks the times in the rows of a `frames.csv`.
#[track_caller]
fn frames_add_up(csv: &str) {
    let mut lines = csv.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(&header[..5], ["frame", "method", "psnr_db", "retained_psnr_db", "ms"], "old columns stay");
    assert_eq!(&header[8..13], ["cpu_ms", "render_ms", "render_cpu_ms", "total_ms", "total_cpu_ms"]);
    let mut rows = 0;
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!(cells.len(), header.len(), "{line}");
        let of = |name: &str| cells[header.iter().position(|h| *h == name).unwrap()].parse::<f64>().ok();
        let adds = |a: f64, b: f64, total: f64| assert!((a + b - total).abs() < 0.002, "{line}");
        adds(of("ms").unwrap(), of("render_ms").unwrap(), of("total_ms").unwrap());
        if cfg!(unix) {
            adds(of("cpu_ms").unwrap(), of("render_cpu_ms").unwrap(), of("total_cpu_ms").unwrap());
        }
        rows += 1;
    }
    assert_eq!(rows, 10, "five frames of two methods");
}
