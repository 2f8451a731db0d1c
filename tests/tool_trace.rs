//! `afterimage trace` as other programs use it: what it writes, and how it refuses.
#![cfg(feature = "cli")]

use afterimage::source::{FrameSource, ReadLimits, SequenceSource, StillSource};
use afterimage::trace::effects::Effect;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn trace(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_afterimage"))
        .arg("trace")
        .args(args)
        // Silences a line of Mesa's about windows.
        .env("NODEVICE_SELECT", "1")
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("the tool starts")
}

const SMALL: [&str; 6] = ["--size", "24x16", "--spp", "2", "--backend", "cpu"];

/// Traces into a folder of its own.
struct Traced {
    folder: tempfile::TempDir,
    stdout: String,
}

impl Traced {
    #[track_caller]
    fn new(scene: &str, more: &[&str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        let output = trace(&[&[scene, "--out", out.to_str().unwrap()][..], &SMALL, more].concat());
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{scene} {more:?}: {stderr}");
        assert!(stderr.is_empty(), "nothing on stderr when it is no terminal: {stderr}");
        Self { folder, stdout: String::from_utf8(output.stdout).unwrap() }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join("out").join(name)
    }

    fn report(&self) -> Value {
        serde_json::from_str(&fs::read_to_string(self.path("trace.json")).unwrap()).unwrap()
    }

    fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    fn files(&self, name: &str) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(self.path(name)).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

/// One clear line that holds `words`, exit code 2, no panic.
#[track_caller]
fn refuses(scene: &str, more: &[&str], words: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let output = trace(&[&[scene, "--out", out.to_str().unwrap()][..], more].concat());
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    println!("{}", stderr.trim_end());
    assert_eq!(output.status.code(), Some(2), "{scene} {more:?}: {stderr}");
    assert_eq!(stderr.lines().count(), 1, "one line: {stderr}");
    assert!(output.stdout.is_empty());
    for word in words {
        assert!(stderr.contains(word), "'{word}' is missing: {stderr}");
    }
    assert!(!out.join("trace.json").exists());
}

fn picture(path: &Path) -> afterimage::image::Image<[f32; 3]> {
    StillSource::open(path, &ReadLimits::default()).unwrap().frame(0).unwrap().color
}

#[test]
fn it_writes_what_the_contract_says() {
    let t = Traced::new("builtin:cornell", &["--frames", "2", "--aov", "depth,motion,variance"]);
    assert_eq!(t.files(""), ["cameras.json", "color", "depth", "motion", "trace.json", "variance"]);
    assert_eq!(t.files("color"), ["000000.exr", "000000.png", "000001.exr", "000001.png", "cameras.json"]);
    for part in ["depth", "motion", "variance"] {
        assert_eq!(t.files(part), ["000000.exr", "000001.exr"], "{part}");
    }
    assert_eq!(image::open(t.path("color/000001.png")).unwrap().to_rgb8().dimensions(), (24, 16));
    let color = picture(&t.path("color/000000.exr"));
    assert_eq!(color.size(), [24, 16]);
    assert!(color.pixels().iter().flatten().all(|v| v.is_finite() && *v >= 0.0));
    assert!(color.pixels().iter().any(|c| c[0] > 0.01));
    assert!(t.stdout.contains("36 triangles, 2 frames of 24x16 at 2 spp"), "{}", t.stdout);

    let report = t.report();
    for (key, value) in [
        ("tool", "afterimage"),
        ("scene", "builtin:cornell"),
        ("integrator", "mis"),
        ("bsdf", "auto"),
        ("sampling", "uniform"),
    ] {
        assert_eq!(report[key], value, "{key}");
    }
    for (key, value) in
        [("frames", 2), ("spp", 2), ("max_depth", 3), ("seed", 0), ("triangles", 36), ("nonfinite_samples", 0)]
    {
        assert_eq!(report[key], value, "{key}");
    }
    for key in ["fps", "hfov_deg", "load_ms", "build_ms", "compile_ms", "rays", "seconds", "million_rays_per_second"] {
        assert!(report[key].is_number(), "{key}: {}", report[key]);
    }
    assert_eq!(report["backend"]["kind"], "cpu");
    assert_eq!((&report["samples"]["traced"], &report["samples"]["uniform"]), (&1536.into(), &1536.into()));
    assert_eq!(report["effects"], serde_json::json!(["emissive-triangles"]));
    assert_eq!(report["warnings"], serde_json::json!([]));
    assert!(report["rays"].as_u64().unwrap() > 1536);
    let cameras: Value = serde_json::from_slice(&t.bytes("cameras.json")).unwrap();
    assert_eq!(cameras["frames"].as_array().unwrap().len(), 2);
}

#[test]
fn the_same_seed_gives_the_same_bytes() {
    let a = Traced::new("builtin:cornell", &["--seed", "5"]);
    let b = Traced::new("builtin:cornell", &["--seed", "5"]);
    let c = Traced::new("builtin:cornell", &["--seed", "6"]);
    for file in ["color/000000.exr", "color/000000.png"] {
        assert_eq!(a.bytes(file), b.bytes(file));
        assert_ne!(a.bytes(file), c.bytes(file));
    }
}

#[test]
fn all_effects_give_the_bytes_of_those_that_are_needed() {
    for scene in ["builtin:cornell", "builtin:bunny-low"] {
        let auto = Traced::new(scene, &[]);
        let all = Traced::new(scene, &["--effects", "all", "-v"]);
        assert_eq!(auto.bytes("color/000000.exr"), all.bytes("color/000000.exr"), "{scene}");
        assert_eq!(all.report()["effects"].as_array().unwrap().len(), Effect::ALL.len());
        assert!(all.stdout.contains("nothing in the scene needs it"), "{}", all.stdout);
        let none = Traced::new(scene, &["--effects", "none", "-v"]);
        assert_ne!(auto.bytes("color/000000.exr"), none.bytes("color/000000.exr"), "{scene}");
        assert!(none.stdout.contains("left out though the scene has it"), "{}", none.stdout);
    }
}

#[test]
fn every_option_does_something() {
    let plain = Traced::new("builtin:bunny-low", &[]);
    let exr = plain.bytes("color/000000.exr");
    for more in [
        &["--hfov", "30"][..],
        &["--spp", "3"],
        &["--max-depth", "1"],
        &["--integrator", "nee"],
        &["--integrator", "naive"],
        &["--bsdf", "phong"],
        &["--sky", "none"],
        &["--sky", "0.1,2,3"],
        &["--effects", "environment"],
        &["--tonemap", "reinhard"],
        &["--exposure", "-1.5"],
    ] {
        // The last of an option given twice counts, if it may be.
        let args: Vec<&str> = more.to_vec();
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        let mut all = vec!["builtin:bunny-low", "--out", out.to_str().unwrap(), "--size", "24x16", "--backend", "cpu"];
        if args[0] != "--spp" {
            all.extend(["--spp", "2"]);
        }
        all.extend(&args);
        let output = trace(&all);
        assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
        assert_ne!(fs::read(out.join("color/000000.exr")).unwrap(), exr, "{args:?}");
    }
    let png = Traced::new("builtin:bunny-low", &["--format", "png"]);
    assert_eq!(png.files("color"), ["000000.png", "cameras.json"]);
    let only = Traced::new("builtin:bunny-low", &["--format", "exr"]);
    assert_eq!(only.files("color"), ["000000.exr", "cameras.json"]);
    assert_eq!(only.bytes("color/000000.exr"), exr);
    assert_eq!(Traced::new("builtin:bunny-low", &["--fps", "24"]).report()["fps"], 24.0);
    assert_eq!(Traced::new("builtin:bunny-low", &["--sampling", "uniform"]).bytes("color/000000.exr"), exr);
}

#[test]
fn a_written_camera_file_is_a_camera() {
    let first = Traced::new("builtin:cubes", &["--frames", "1"]);
    let file = first.path("cameras.json");
    let again = Traced::new("builtin:cubes", &["--camera", file.to_str().unwrap()]);
    let (a, b) = (picture(&first.path("color/000000.exr")), picture(&again.path("color/000000.exr")));
    // The field of view goes through the file as decimal degrees: some samples fall on other cubes.
    let alike = a.pixels().iter().zip(b.pixels()).filter(|(a, b)| (0..3).all(|k| (a[k] - b[k]).abs() < 0.02)).count();
    assert!(alike > 24 * 16 * 95 / 100, "{alike}");
}

#[test]
fn a_path_of_keyframes_moves_the_camera_and_a_sky_may_be_a_picture() {
    let sky = Traced::new("builtin:control", &[]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("path.json");
    let keyframes = r#"{"keyframes": [{"time_s": 0, "position": [0, 1, 5], "target": [0, 0, 0]},
        {"time_s": 1, "position": [3, 1, 4], "target": [0, 0, 0]}]}"#;
    fs::write(&path, keyframes).unwrap();
    let exr = sky.path("color/000000.exr");
    let args = [
        "--camera",
        path.to_str().unwrap(),
        "--frames",
        "2",
        "--fps",
        "2",
        "--sky",
        exr.to_str().unwrap(),
        "--aov",
        "motion",
    ];
    let moved = Traced::new("builtin:bunny-low", &args);
    assert_ne!(moved.bytes("color/000000.exr"), moved.bytes("color/000001.exr"));
    assert_ne!(moved.bytes("motion/000000.exr"), moved.bytes("motion/000001.exr"));
    assert!(moved.report()["effects"].as_array().unwrap().contains(&"environment-map".into()));
}

#[test]
fn values_that_cannot_be_are_refused_in_one_line() {
    let scene = "builtin:cornell";
    for (more, words) in [
        (&["--size", "0x10"][..], &["--size"][..]),
        (&["--size", "abc"], &["--size"]),
        (&["--size", "70000x10"], &["--size", "too large"]),
        (&["--size", "60000x60000"], &["--size", "too large"]),
        (&["--spp", "0"], &["--spp"]),
        (&["--spp=-1"], &["--spp"]),
        (&["--spp", "99999999"], &["--spp"]),
        (&["--frames", "0"], &["--frames"]),
        (&["--max-depth", "65"], &["--max-depth", "64"]),
        (&["--fps", "0"], &["--fps"]),
        (&["--fps", "NaN"], &["--fps"]),
        (&["--hfov", "180"], &["hfov_deg"]),
        (&["--hfov=-3"], &["hfov"]),
        (&["--exposure", "inf"], &["--exposure"]),
        (&["--integrator", "best"], &["--integrator"]),
        (&["--bsdf", "lambert"], &["--bsdf"]),
        (&["--sampling", "some"], &["--sampling"]),
        (&["--format", "gif"], &["--format"]),
        (&["--tonemap", "filmic"], &["--tonemap"]),
        (&["--aov", "normals"], &["--aov"]),
        (&["--backend", "tpu"], &["--backend"]),
        (&["--effects", "glow"], &["--effects", "glow"]),
        (&["--effects", ""], &["--effects"]),
        (&["--sky", "1,2"], &["--sky"]),
        (&["--sky", "1,2,-3"], &["--sky"]),
        (&["--sky", "1,2,nan"], &["--sky"]),
        (&["--sky", "missing.exr"], &["missing.exr"]),
        (&["--camera", "nobody"], &["--camera", "nobody"]),
        (&["--camera", "missing.json"], &["missing.json"]),
        (&["--clip", "dance"], &["dance"]),
        (&["--seed=-1"], &["--seed"]),
        (&["--nonsense"], &["--nonsense"]),
    ] {
        refuses(scene, more, words);
    }
}

#[test]
fn hostile_scene_files_are_refused_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let header = |length: u32| [b"glTF".to_vec(), 2u32.to_le_bytes().to_vec(), length.to_le_bytes().to_vec()].concat();
    let huge = br#"{"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4000000000000}],
        "bufferViews": [{"buffer": 0, "byteLength": 4000000000000}],
        "accessors": [{"bufferView": 0, "count": 100000000000, "type": "VEC3", "componentType": 5126}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]}"#;
    let outside = br#"{"asset": {"version": "2.0"}, "buffers": [{"byteLength": 12, "uri": "../../../etc/passwd"}],
        "bufferViews": [{"buffer": 0, "byteLength": 12}],
        "accessors": [{"bufferView": 0, "count": 1, "type": "VEC3", "componentType": 5126}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]}"#;
    let circle = br#"{"asset": {"version": "2.0"}, "nodes": [{"children": [1]}, {"children": [0]}], "scenes": [{"nodes": [0]}]}"#;
    for (name, bytes) in [
        ("empty.gltf", &b""[..]),
        ("empty.glb", b""),
        ("text.gltf", b"this is no scene"),
        ("cut.glb", &header(1000)),
        ("lies.glb", &header(u32::MAX)),
        ("huge.gltf", huge),
        ("outside.gltf", outside),
        ("circle.gltf", circle),
        ("scene.fbx", b"whatever"),
    ] {
        refuses(&write(name, bytes), &[], &[name]);
    }
    refuses("missing.glb", &[], &["missing.glb"]);
    refuses("builtin:teapot", &[], &["teapot", "cornell"]);
    refuses(folder.path().to_str().unwrap(), &[], &[]);
}

#[test]
fn a_scene_of_nothing_gives_a_frame() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("nothing.gltf");
    fs::write(&path, br#"{"asset": {"version": "2.0"}}"#).unwrap();
    let t = Traced::new(path.to_str().unwrap(), &["--aov", "depth,motion,variance"]);
    // A scene without light gets a white sky.
    assert!(picture(&t.path("color/000000.exr")).pixels().iter().all(|c| *c == [1.0; 3]));
    assert_eq!(t.report()["triangles"], 0);
}

/// Rows of a gaze.csv.
fn gaze(path: &Path) -> Vec<[f64; 2]> {
    let text = fs::read_to_string(path).unwrap();
    let row = |line: &str| {
        let values: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
        [values[1], values[2]]
    };
    text.lines().skip(1).map(row).collect()
}

#[test]
fn two_eyes_have_frames_cameras_and_gazes_of_their_own() {
    const FOVEATED: [&str; 6] = ["--sampling", "regions", "--region-spp", "4,2,1", "--gaze", "12,12"];
    let more = [&FOVEATED[..], &["--stereo", "0.064", "--frames", "2", "--aov", "depth,motion"]].concat();
    let t = Traced::new("builtin:cornell", &more);
    assert_eq!(t.files(""), ["cameras.json", "gaze.csv", "left", "right", "trace.json"]);
    for eye in ["left", "right"] {
        let there = ["cameras.json", "color", "depth", "gaze.csv", "motion", "scanpath.csv"];
        assert_eq!(t.files(eye), there, "{eye}");
        let frames = ["000000.exr", "000000.png", "000001.exr", "000001.png", "cameras.json"];
        assert_eq!(t.files(&format!("{eye}/color")), frames, "{eye}");
    }
    assert!(t.stdout.contains("2 frames for each of two eyes of 24x16"), "{}", t.stdout);

    // Eyes are where they should be. In the file's axes x is the scene's, and this camera's right is -x.
    let eye_x = |name: &str| {
        let cameras: Value = serde_json::from_slice(&t.bytes(name)).unwrap();
        cameras["frames"][1]["camera_to_world"][0][3].as_f64().unwrap()
    };
    let [head, left, right] = ["cameras.json", "left/cameras.json", "right/color/cameras.json"].map(eye_x);
    assert!((left - right - 0.064).abs() < 1e-9 && (left + right - 2.0 * head).abs() < 1e-9, "{left} {head} {right}");

    // Gazes: apart by ipd f / z, f being half the width over the tangent of half the field of view.
    let report = t.report();
    let focal_px = 12.0 / (report["hfov_deg"].as_f64().unwrap().to_radians() / 2.0).tan();
    let [l, r] = ["left/gaze.csv", "right/gaze.csv"].map(|name| gaze(&t.path(name)));
    assert_eq!(gaze(&t.path("gaze.csv")), [[12.0, 12.0]; 2]);
    let apart = l[0][0] - r[0][0];
    assert!((0.5 * (l[0][0] + r[0][0]) - 12.0).abs() < 2e-3 && (l[0][1] - 12.0).abs() < 2e-3, "{l:?} {r:?}");
    let z = 0.064 * focal_px / apart;
    let mono = Traced::new("builtin:cornell", &[&FOVEATED[..], &["--aov", "depth"]].concat());
    let mut source = SequenceSource::open(&mono.path("color"), &ReadLimits::default()).unwrap();
    let depth = source.frame(0).unwrap().depth.unwrap().at(12, 12);
    // Three decimals of a pixel.
    assert!((z / f64::from(depth) - 1.0).abs() < 0.002 / apart, "{z} m of {depth} m");

    let stereo = &report["stereo"];
    assert_eq!((&stereo["ipd_m"], stereo["eyes"].as_array().unwrap().len()), (&0.064.into(), 2));
    let of = |eye: usize, key: &str| stereo["eyes"][eye]["samples"][key].as_u64().unwrap();
    for key in ["traced", "uniform"] {
        assert_eq!(report["samples"][key].as_u64().unwrap(), of(0, key) + of(1, key), "{key}");
    }
    assert_eq!((&stereo["eyes"][1]["name"], &stereo["eyes"][1]["gaze"]), (&"right".into(), &"right/gaze.csv".into()));
    assert_eq!(stereo["eyes"][0]["sampling"], "regions");
    assert!(mono.report()["stereo"].is_null());
    assert_eq!(of(0, "uniform"), 2 * mono.report()["samples"]["uniform"].as_u64().unwrap());

    // An eye's folder and its scanpath are what `run` reads.
    let out = t.path("run");
    let [input, path] = ["right/color", "right/scanpath.csv"].map(|name| t.path(name).to_str().unwrap().to_owned());
    let args = ["run", &input, "--gaze", &path, "--frames", "2", "--method", "none", "--backend", "cpu", "--out"];
    let run = Command::new(env!("CARGO_BIN_EXE_afterimage")).args(args).arg(&out).output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    for (a, b) in gaze(&out.join("gaze.csv")).iter().zip(&r) {
        assert!((a[0] - b[0]).abs() < 2e-3 && (a[1] - b[1]).abs() < 2e-3, "{a:?} {b:?}");
    }
}

#[test]
fn each_eye_is_sampled_around_its_own_gaze() {
    let at = |gaze: &str, more: &[&str]| {
        let pattern = ["--sampling", "regions", "--region-spp", "9,4,1", "--region-deg", "8,17", "--gaze", gaze];
        Traced::new("builtin:cornell", &[&pattern[..], more].concat())
    };
    let t = at("6,8", &["--stereo", "0.2"]);
    let report = t.report();
    let of = |eye: usize| report["stereo"]["eyes"][eye]["samples"]["regions"].clone();
    // Near the edge, where fewer samples lie around the gaze.
    assert_ne!(of(0), of(1));
    for (eye, name) in ["left", "right"].iter().enumerate() {
        let [x, y] = gaze(&t.path(&format!("{name}/gaze.csv")))[0];
        assert_eq!(at(&format!("{x},{y}"), &[]).report()["samples"]["regions"], of(eye), "{name}: {x}, {y}");
    }
}

#[test]
fn two_eyes_need_no_gaze_but_a_distance() {
    let t = Traced::new("builtin:cornell", &["--stereo", "0.2"]);
    assert_eq!(t.files(""), ["cameras.json", "left", "right", "trace.json"]);
    assert_eq!(t.files("left"), ["cameras.json", "color"]);
    let [l, r] = ["left", "right"].map(|eye| picture(&t.path(&format!("{eye}/color/000000.exr"))));
    assert!(l != r && [&l, &r].iter().all(|i| i.pixels().iter().any(|c| c[0] > 0.01)));
    assert!(t.report()["stereo"]["eyes"][0]["gaze"].is_null());
    for ipd in ["0", "-0.06", "63", "nan", "wide"] {
        refuses("builtin:cornell", &["--stereo", ipd], &["--stereo"]);
    }
}
