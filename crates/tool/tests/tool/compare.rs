//! `afterimage compare`: scores of folders that others wrote.

use super::rig::{Folder, Out, read_json, refuses, succeeds, tool, words};
use afterimage::{Image, ViewGeometry};
use afterimage_lab::metric::{encode, psnr_db, ssim_map};
use afterimage_lab::picture::{to_rgb8, write_png};
use afterimage_lab::source::ReadLimits;
use afterimage_lab::source::exr_file::{ExrHeader, FrameToWrite, Vectors, write, write_channels};
use afterimage_metric::{Display, Flip, ReferenceVideo, TestVideo, VideoScore, Viewing};
use serde_json::Value;
use std::fs;

type Frame = Image<[f32; 3]>;

const SIZE: [u32; 2] = [160, 96];
const FRAMES: usize = 4;
const FPS: f32 = 50.0;
const HFOV_DEG: f32 = 30.0;
const GAZE: [f32; 2] = [30.0, 48.0];

/// Linear texture that moves by a pixel a frame.
fn scene(frame: usize) -> Frame {
    Image::from_fn(SIZE, |[x, y]| {
        let (x, y) = (x as f32 - frame as f32, y as f32);
        let v = 0.3 + 0.15 * (0.9 * x + 0.2 * y).sin() + 0.1 * (1.3 * y).cos() * (0.4 * x).sin();
        [v, 0.8 * v, 0.6 * v]
    })
}

/// The frame with a box blur of 5x5 pixels in columns from `from` to `to`, of which `share` is mixed in.
fn partly_blurred(frame: &Frame, [from, to]: [i32; 2], share: f32) -> Frame {
    let [width, height] = SIZE.map(|s| s as i32);
    Image::from_fn(SIZE, |[x, y]| {
        let (x, y) = (x as i32, y as i32);
        let own = frame.at(x as usize, y as usize);
        if !(from..to).contains(&x) {
            return own;
        }
        let mut mixed = own.map(|v| (1.0 - share) * v);
        for (dx, dy) in (-2..=2).flat_map(|dx| (-2..=2).map(move |dy| (dx, dy))) {
            let [x, y] = [(x + dx).clamp(0, width - 1), (y + dy).clamp(0, height - 1)];
            let c = frame.at(x as usize, y as usize);
            (0..3).for_each(|i| mixed[i] += share * c[i] / 25.0);
        }
        mixed
    })
}

fn blurred(frame: &Frame, columns: [i32; 2]) -> Frame {
    partly_blurred(frame, columns, 1.0)
}

/// Linear frames of a folder, as EXR with halves.
fn exr(folder: &Folder, name: &str, frame: impl Fn(usize) -> Frame) -> String {
    fs::create_dir_all(folder.path(name)).unwrap();
    for i in 0..FRAMES {
        write(&folder.path(name).join(format!("{i:06}.exr")), &FrameToWrite::color(&frame(i))).unwrap();
    }
    folder.text(name)
}

/// sRGB frames of a folder, as PNG.
fn png(folder: &Folder, name: &str, frames: usize, frame: impl Fn(usize) -> Frame) -> String {
    fs::create_dir_all(folder.path(name)).unwrap();
    for i in 0..frames {
        write_png(&folder.path(name).join(format!("f.{i:04}.png")), &to_rgb8(&encode(&frame(i), 0.0))).unwrap();
    }
    folder.text(name)
}

/// Reference, and a test that is blurred at the left.
fn folders(folder: &Folder) -> [String; 2] {
    [exr(folder, "full", scene), exr(folder, "left", |i| blurred(&scene(i), [0, 60]))]
}

const SEEN: &str = "--hfov 30 --fps 50 --gaze 30,48";

/// What a comparison wrote.
#[track_caller]
fn compared(inputs: &[&str], options: &str) -> Out {
    Out::of(&[&["compare"], inputs, &words(options)].concat())
}

#[track_caller]
fn report(inputs: &[&str], options: &str) -> Value {
    compared(inputs, options).json("report.json")
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[track_caller]
fn assert_near(value: &Value, expected: f64, within: f64) {
    assert!((number(value) - expected).abs() <= within, "{value} is not {expected}");
}

#[test]
fn equal_frames_are_10_jod_without_error() {
    let folder = Folder::new();
    let full = exr(&folder, "full", scene);
    let same = exr(&folder, "same", scene);
    let out = compared(&[&full, &same], SEEN);
    let written = words("frames.csv gaze.csv jod.png jod.svg psnr.png psnr.svg report.json sheet.png");
    assert_eq!(out.files(""), written);
    let report = out.json("report.json");
    assert_eq!((&report["tool"], &report["command"]), (&"afterimage".into(), &"compare".into()));
    assert_eq!((&report["frames"], &report["fps"], &report["hfov_deg"]), (&4.into(), &50.0.into(), &30.0.into()));
    let same = &report["methods"]["same"];
    for part in [same, &same["bands"]["fovea"], &same["bands"]["mid"], &same["bands"]["periphery"]] {
        assert_eq!((&part["jod"], &part["mse"], &part["flip"]), (&10.0.into(), &0.0.into(), &0.0.into()));
        assert_eq!((&part["psnr_db"], &part["ssim"]), (&Value::Null, &1.0.into()), "an infinite PSNR");
    }
    for unknown in ["worst_crop", "retained_psnr_db", "retained_share", "flicker", "ghost_energy"] {
        assert!(same[unknown].is_null(), "{unknown}: {}", same[unknown]);
    }
    assert!(out.said.contains("exact") && !out.said.contains("worst 64x64  "), "{}", out.said);
    assert_eq!(out.text("gaze.csv").lines().count(), 1 + FRAMES);
    assert!(out.text("psnr.svg").contains("exact") && out.text("jod.svg").contains("JOD by frame"));
}

/// The same figures as by calling the metrics' own functions.
#[test]
fn a_blur_has_the_figures_of_the_library() {
    let folder = Folder::new();
    let [full, left] = folders(&folder);
    let out = compared(&[&full, &left], &format!("{SEEN} --exposure 0.5"));
    let geometry = ViewGeometry::flat(SIZE, HFOV_DEG).unwrap();
    let viewing = Viewing { geometry, display: Display::default(), fps: FPS };
    let (mut references, mut video) = (ReferenceVideo::new(viewing), TestVideo::default());
    let flip = Flip::for_view(&geometry);
    let (mut squared, mut ssim, mut error, mut frames, mut crop_mse) = (0.0, 0.0, 0.0, vec![], vec![]);
    let mean = |values: &[f32]| values.iter().map(|&v| f64::from(v)).sum::<f64>() / values.len() as f64;
    for i in 0..FRAMES {
        // The files hold halves.
        let read = |name: &str| {
            let header = ExrHeader::open(&folder.path(name).join(format!("{i:06}.exr")), &ReadLimits::default());
            header.unwrap().read(Vectors::Skip).unwrap().color
        };
        let [r, s] = ["full", "left"].map(|name| encode(&read(name), 0.5));
        frames.push(video.push(&references.push(&r, Some(GAZE)), &s).jod);
        let errors: Vec<f32> = r
            .pixels()
            .iter()
            .zip(s.pixels())
            .map(|(r, s)| (0..3).map(|c| (r[c] - s[c]).powi(2)).sum::<f32>() / 3.0)
            .collect();
        squared += mean(&errors) / FRAMES as f64;
        ssim += mean(ssim_map(&r, &s).unwrap().pixels()) / FRAMES as f64;
        error += mean(flip.map(&r, &s).pixels()) / FRAMES as f64;
        // Crops begin at 0, 64 and 96 pixels, and at 0 and 32.
        for (x0, y0) in [0, 64, 96].into_iter().flat_map(|x| [(x, 0), (x, 32)]) {
            let inside = |i: &usize| (x0..x0 + 64).contains(&(i % 160)) && (y0..y0 + 64).contains(&(i / 160));
            let crop: Vec<f32> = (0..errors.len()).filter(inside).map(|i| errors[i]).collect();
            crop_mse.push((mean(&crop), i, x0, y0));
        }
    }
    let VideoScore { jod, bands } = video.score().unwrap();
    assert!(jod < 9.5, "a visible blur: {jod}");
    let found = &out.json("report.json")["methods"]["left"];
    assert_near(&found["jod"], jod, 1e-12);
    for (name, jod) in ["fovea", "mid", "periphery"].into_iter().zip(bands) {
        assert_near(&found["bands"][name]["jod"], jod.unwrap(), 1e-12);
    }
    assert_near(&found["psnr_db"], psnr_db(squared).unwrap(), 1e-5);
    assert_near(&found["ssim"], ssim, 1e-6);
    assert_near(&found["flip"], error, 1e-6);
    let by_frame: Vec<f64> = out.column("left", "jod").into_iter().map(Option::unwrap).collect();
    assert!(by_frame.iter().zip(&frames).all(|(a, b)| (a - b).abs() < 1e-4), "{by_frame:?} {frames:?}");
    let (mse, frame, x, y) = crop_mse.into_iter().reduce(|a, b| if b.0 > a.0 { b } else { a }).unwrap();
    let crop = &found["worst_crop"];
    assert_eq!((&crop["frame"], &crop["x_px"], &crop["y_px"]), (&frame.into(), &x.into(), &y.into()));
    assert_near(&crop["psnr_db"], psnr_db(mse).unwrap(), 1e-4);
    assert!(number(&crop["flip"]) > error && number(&crop["ssim"]) < ssim && number(&crop["lost_jod"]) > 0.0);
}

#[test]
fn a_blur_far_from_the_gaze_scores_higher() {
    let folder = Folder::new();
    let slight = |columns: [i32; 2]| move |i: usize| partly_blurred(&scene(i), columns, 0.3);
    let full = exr(&folder, "full", scene);
    let [left, right] = [exr(&folder, "left", slight([0, 60])), exr(&folder, "right", slight([100, 160]))];
    let lost = |gaze: &str| {
        let report = report(&[&full, &left, &right], &format!("--hfov 90 --fps 50 --no-flip --gaze {gaze}"));
        let [left, right] = ["left", "right"].map(|test| report["methods"][test].clone());
        assert_near(&left["psnr_db"], number(&right["psnr_db"]), 0.1);
        [left, right].map(|test| 10.0 - number(&test["jod"]))
    };
    let [at_left, at_right] = ["30,48", "130,48"].map(lost);
    println!("JOD lost with the gaze at the left {at_left:?}, at the right {at_right:?}");
    assert!(at_left[1] < 0.6 * at_left[0] && at_right[0] < 0.6 * at_right[1], "the blur at the gaze is the worse one");
    // A gaze that moves: by frame, in the form that runs write, and as a log.
    let moving = folder.write("gaze.csv", b"frame,x_px,y_px\n0,30,48\n1,30,48\n2,130,48\n3,130,48\n");
    let log = "# screen_px: 160x96\nt_s,x_px,y_px,valid\n0,30,48,1\n0.02,30,48,1\n0.04,130,48,1\n0.06,130,48,1\n";
    let log = folder.write("log.csv", log.as_bytes());
    // Positions of a log count from the corner of the top left pixel, those of a run from its middle.
    for (gaze, last) in [(moving, "3,130.000,48.000"), (log, "3,129.500,47.500")] {
        let out = compared(&[&full, &left, &right], &format!("--hfov 90 --fps 50 --no-flip --gaze {gaze}"));
        assert_eq!(out.text("gaze.csv").lines().nth(4), Some(last));
        let [left, right] = ["left", "right"].map(|test| out.column(test, "jod"));
        assert!(left[1] < right[1] && left[3] > right[3], "{left:?} {right:?}");
    }
}

#[test]
fn the_display_changes_the_score() {
    let folder = Folder::new();
    let [full, left] = folders(&folder);
    let scored = |options: &str| {
        let report = report(&[&full, &left], &format!("{SEEN} --no-flip {options}"));
        (number(&report["methods"]["left"]["jod"]), report["jod_display"].clone())
    };
    let (usual, display) = scored("");
    assert_eq!(
        (&display["peak_nits"], &display["contrast"], &display["ambient_lux"]),
        (&250.0.into(), &1000.0.into(), &0.0.into())
    );
    let (dim, display) = scored("--display-peak 5");
    assert_eq!(display["peak_nits"], 5.0);
    assert!(dim > usual + 0.02, "a dim display hides: {dim}, {usual}");
    assert!(scored("--display-peak 1000").0 < usual, "a bright one shows");
    let (washed, display) = scored("--display-ambient 20000");
    assert_eq!(display["ambient_lux"], 20000.0);
    assert!(washed > usual + 0.02, "light of the room hides: {washed}, {usual}");
    assert!(scored("--display-contrast 4").0 > usual + 0.02, "so does a grey black");
    // `run` and `sweep` have the same display.
    let ran = |options: &str| {
        let options = format!("--size 96x54 --frames 3 --gaze 10,10 --method none --no-flip {options}");
        let report = super::rig::ran("analytic:lateral", &options).json("report.json");
        (number(&report["methods"]["none"]["jod"]), report["jod_display"].clone())
    };
    let ((usual, _), (dim, display)) = (ran(""), ran("--display-peak 5 --display-contrast 100 --display-ambient 10"));
    assert!(dim > usual, "{dim} {usual}");
    assert_eq!(
        (&display["peak_nits"], &display["contrast"], &display["ambient_lux"]),
        (&5.0.into(), &100.0.into(), &10.0.into())
    );
}

/// Folders of a run are inputs, with what its report says of their view, and have the scores that the run gave.
#[test]
fn folders_of_a_run_have_its_scores() {
    let folder = Folder::new();
    let out = folder.text("out");
    let options =
        "--size 160x90 --frames 6 --hfov 50 --fps 40 --method none,smr --reference --format exr --backend cpu";
    succeeds(&[&["run", "analytic:lateral", "--out", &out][..], &words(options)].concat());
    let run = read_json(&folder.path("out/report.json"));
    let [reference, none, smr] = ["reference", "none", "smr"].map(|name| folder.text(&format!("out/{name}")));
    let found = report(&[&reference, &none, &smr], &format!("--gaze {out}/gaze.csv"));
    assert_eq!((&found["fps"], &found["hfov_deg"], &found["gaze_map"]), (&40.0.into(), &50.0.into(), &"none".into()));
    for method in ["none", "smr"] {
        let [found, run] = [&found, &run].map(|report| &report["methods"][method]);
        // Frames are written as halves.
        for (key, within) in [("jod", 0.01), ("psnr_db", 0.02), ("ssim", 1e-3), ("flip", 1e-3)] {
            assert_near(&found[key], number(&run[key]), within);
        }
        assert_near(&found["bands"]["mid"]["psnr_db"], number(&run["bands"]["mid"]["psnr_db"]), 0.05);
    }
    refuses(&["compare", &reference, &none, "--out", &out], &["holds report.json of a run", "another folder"]);
}

#[test]
fn stills_and_encoded_frames_are_compared() {
    let folder = Folder::new();
    let [full, left] = [png(&folder, "full", 3, scene), png(&folder, "left", 3, |i| blurred(&scene(i), [0, 60]))];
    let found = report(&[&full, &left], SEEN);
    assert_eq!(found["frames"], 3);
    assert!(number(&found["methods"]["left"]["jod"]) < 9.5);
    // Linear frames are encoded; those of 8 bits differ by rounding.
    let linear = exr(&folder, "linear", scene);
    let found = report(&[&linear, &full], &format!("{SEEN} --frames 3"));
    assert!(number(&found["methods"]["full"]["psnr_db"]) > 55.0 && number(&found["methods"]["full"]["jod"]) > 9.9);
    // Exposure is that of linear frames alone.
    let dark = exr(&folder, "dark", |i| scene(i).map(|c| c.map(|v| 0.25 * v)));
    let found = report(&[&full, &dark], &format!("{SEEN} --frames 3 --exposure 2"));
    assert!(number(&found["methods"]["dark"]["psnr_db"]) > 55.0);
    let stills = [format!("{full}/f.0000.png"), format!("{left}/f.0000.png")];
    let found = report(&[&stills[0], &stills[1]], SEEN);
    assert_eq!(found["frames"], 1);
    let jod = number(&found["methods"]["f.0000.png"]["jod"]);
    assert!((5.0..9.5).contains(&jod), "{jod}");
    // Tests of one name have their paths; the middle of the frame is the gaze.
    fs::create_dir(folder.path("more")).unwrap();
    let more = png(&folder, "more/left", 3, scene);
    let found = report(&[&full, &left, &more], "--no-jod --no-flip");
    assert_eq!(found["methods"][&more]["mse"], 0.0);
    assert_eq!((&found["gaze"], &found["jod_display"]), (&"79.5,47.5".into(), &Value::Null));
}

#[test]
fn what_does_not_fit_together_is_one_line() {
    let folder = Folder::new();
    let full = png(&folder, "full", 3, scene);
    let out = folder.text("out");
    let refused = |reference: &str, test: &str, more: &str, words_of: &[&str]| {
        refuses(&[&["compare", reference, test, "--out", &out][..], &words(more)].concat(), words_of);
    };
    let short = png(&folder, "short", 2, scene);
    refused(&full, &short, "", &["short: has 2 frames", "has 3", "--frames 2 to compare the first 2"]);
    refused(&full, &short, "--frames 3", &["--frames 3", "short has 2", "at most 2"]);
    let small = png(&folder, "small", 3, |_| Image::filled([80, 48], [0.5; 3]));
    refused(&full, &small, "", &["small: has 80x48 pixels", "full has 160x96"]);
    write_png(&folder.path("short").join("f.0002.png"), &to_rgb8(&Image::filled([8, 8], [0.5; 3]))).unwrap();
    refused(&full, &short, "", &["f.0002.png", "8x8", "160x96"]);
    fs::create_dir(folder.path("empty")).unwrap();
    refused(&full, &folder.text("empty"), "", &["empty", "no .exr, .png or .jpg"]);
    refused(&folder.text("empty"), &full, "", &["empty", "no .exr, .png or .jpg"]);
    refused(&full, "no/such", "", &["no/such", "does not exist"]);
    refused(&full, "builtin:cubes", "", &["builtin:cubes", "is a scene", "full-rate frames, which a run writes"]);
    refused(&full, &folder.write("notes.txt", b"notes"), "", &["notes.txt", "not supported"]);
    refused(&full, &format!("{full}/f.%04d.png"), "", &["is a pattern", "give the folder"]);
    refused(&full, &full, "--exposure 1", &["--exposure", ".exr", "encoded already"]);
    refused(&full, &full, "--gaze 1,x", &["--gaze", "X,Y"]);
    let gaze =
        |rows: &str| format!("--gaze {}", folder.write("gaze.csv", format!("frame,x_px,y_px\n{rows}").as_bytes()));
    refused(&full, &full, &gaze("0,1,2\n1,x,2\n"), &["gaze.csv: line 3 is 1,x,2", "a row a frame"]);
    refused(&full, &full, &gaze("0,1,2\n2,1,2\n"), &["gaze.csv: line 3 is 2,1,2"]);
    refused(&full, &full, &gaze(""), &["gaze.csv: has no frame"]);
    refused(&full, &full, &format!("--start 9 {}", gaze("0,1,2\n")), &["--start 9", "ends before, after 1 frames"]);
    refused(&full, &full, "--display-peak 0", &["--display-peak", "1 to 10000 cd/m2"]);
    refused(&full, &full, "--display-ambient=-1", &["--display-ambient", "lux"]);
    refuses(&["compare", &full, "--out", &out], &["<TEST>"]);
    refuses(&["compare", &full, &full, &full, "--out", &out], &["named twice"]);
    fs::rename(folder.path("full/f.0001.png"), folder.path("full/f.0007.png")).unwrap();
    refused(&full, &full, "", &["jump from 2 to 7"]);
    assert!(!folder.path("out").exists(), "nothing was written");
}

#[test]
fn pixels_that_are_no_number_are_refused_or_counted() {
    let folder = Folder::new();
    let full = exr(&folder, "full", scene);
    let broken = exr(&folder, "broken", scene);
    let mut frame = scene(2);
    frame.pixels_mut()[5] = [f32::NAN; 3];
    frame.pixels_mut()[6] = [f32::INFINITY; 3];
    let planes = [0, 1, 2].map(|c| frame.map(|pixel| pixel[c]));
    let channels = [("R", &planes[0]), ("G", &planes[1]), ("B", &planes[2])];
    write_channels(&folder.path("broken/000002.exr"), &channels).unwrap();
    let out = folder.text("out");
    refuses(
        &["compare", &full, &broken, "--out", &out],
        &["broken/000002.exr", "2 pixels", "NaN or infinite", "--nonfinite-as-black"],
    );
    assert!(!folder.path("out/report.json").exists());
    let found = report(&[&full, &broken], &format!("{SEEN} --nonfinite-as-black"));
    assert_eq!(found["methods"]["broken"]["nonfinite_in"], 2);
    assert!(number(&found["methods"]["broken"]["psnr_db"]) > 30.0);
    let found = report(&[&broken, &full], &format!("{SEEN} --nonfinite-as-black"));
    assert_eq!((&found["nonfinite_reference"], &found["methods"]["full"]["nonfinite_in"]), (&2.into(), &0.into()));
}

#[test]
fn frames_of_other_numbers_are_compared_in_order() {
    let folder = Folder::new();
    let full = png(&folder, "full", 2, scene);
    fs::create_dir(folder.path("from1")).unwrap();
    for i in 0..2 {
        fs::copy(folder.path(&format!("full/f.{i:04}.png")), folder.path(&format!("from1/{}.png", i + 1))).unwrap();
    }
    let out = folder.text("out");
    let said = tool(&["compare", &full, &folder.text("from1"), "--out", &out, "--no-flip"]);
    let warned = String::from_utf8(said.stderr).unwrap();
    assert!(said.status.success() && warned.lines().count() == 1, "{warned}");
    assert!(
        warned.contains("starts with frame 1") && warned.contains("with 0; they are compared in this order"),
        "{warned}"
    );
    assert_eq!(read_json(&folder.path("out/report.json"))["methods"]["from1"]["mse"], 0.0);
    // A log of gaze that ends before the frames.
    let log = folder.write("log.csv", b"frame,x_px,y_px\n0,30,48\n");
    let said = tool(&["compare", &full, &folder.text("from1"), "--out", &out, "--no-flip", "--gaze", &log]);
    let warned = String::from_utf8(said.stderr).unwrap();
    assert!(warned.contains("covers 1 of 2 frames") && warned.contains("is held"), "{warned}");
}

#[test]
fn the_color_of_exr_frames_is_named() {
    let folder = Folder::new();
    let layers = |name: &str, second: &Frame| {
        let of = |frame: &Frame, i: usize| frame.map(|c| c[i]);
        let (first, parts) = (scene(0), ["R", "G", "B"]);
        let planes: Vec<(String, Image<f32>)> = [("beauty", &first), ("denoised", second)]
            .into_iter()
            .flat_map(|(layer, frame)| (0..3).map(move |i| (format!("{layer}.{}", parts[i]), of(frame, i))))
            .collect();
        let channels: Vec<(&str, &Image<f32>)> = planes.iter().map(|(name, plane)| (name.as_str(), plane)).collect();
        write_channels(&folder.path(name), &channels).unwrap();
        folder.text(name)
    };
    let inputs = [layers("a.exr", &scene(0)), layers("b.exr", &blurred(&scene(0), [0, 160]))];
    let inputs = inputs.each_ref().map(String::as_str);
    let psnr_db = |options: &str| report(&inputs, options)["methods"]["b.exr"]["psnr_db"].clone();
    assert!(psnr_db("--no-flip --no-jod --color beauty").is_null(), "equal frames have no error");
    assert!(number(&psnr_db("--no-flip --no-jod --color denoised")) < 60.0);
    let out = folder.text("out");
    refuses(&["compare", inputs[0], inputs[1], "--color", "diffuse", "--out", &out], &["diffuse", "beauty.R"]);
    let png = png(&folder, "encoded", 1, scene);
    refuses(&["compare", &png, &png, "--color", "beauty", "--out", &out], &["--color", "there are none"]);
}
