//! `afterimage trace` with one eye: files, options, cameras, refusals.

use super::rig::{picture, refuses, traced};
use crate::rig::{Folder, Out, words};

#[test]
fn it_writes_what_the_contract_says() {
    let t = traced("builtin:cornell", "--frames 2 --aov depth,motion,variance");
    assert_eq!(t.files(""), words("cameras.json color depth motion trace.json variance"));
    assert_eq!(t.files("color"), words("000000.exr 000000.png 000001.exr 000001.png cameras.json"));
    for part in ["depth", "motion", "variance"] {
        assert_eq!(t.files(part), ["000000.exr", "000001.exr"], "{part}");
    }
    assert_eq!(image::open(t.path("color/000001.png")).unwrap().to_rgb8().dimensions(), (24, 16));
    let color = picture(&t.path("color/000000.exr"));
    assert_eq!(color.size(), [24, 16]);
    assert!(color.pixels().iter().flatten().all(|v| v.is_finite() && *v >= 0.0));
    assert!(color.pixels().iter().any(|c| c[0] > 0.01));
    assert!(t.said.contains("36 triangles, 2 frames of 24x16 at 2 spp"), "{}", t.said);

    let report = t.json("trace.json");
    let expected = serde_json::json!({"tool": "afterimage", "scene": "builtin:cornell", "integrator": "mis", "bsdf": "auto",
        "sampling": "uniform", "frames": 2, "spp": 2, "max_depth": 3, "seed": 0, "triangles": 36, "nonfinite_samples": 0,
        "effects": ["emissive-triangles"], "warnings": []});
    for (key, value) in expected.as_object().unwrap() {
        assert_eq!(report[key], *value, "{key}");
    }
    for key in ["fps", "hfov_deg", "load_ms", "build_ms", "compile_ms", "rays", "seconds", "million_rays_per_second"] {
        assert!(report[key].is_number(), "{key}: {}", report[key]);
    }
    assert_eq!(report["backend"]["kind"], "cpu");
    assert_eq!((&report["samples"]["traced"], &report["samples"]["uniform"]), (&1536.into(), &1536.into()));
    assert!(report["rays"].as_u64().unwrap() > 1536);
    assert_eq!(t.json("cameras.json")["frames"].as_array().unwrap().len(), 2);
}

#[test]
fn the_same_seed_gives_the_same_bytes() {
    let [a, b, c] = [5, 5, 6].map(|seed| traced("builtin:cornell", &format!("--seed {seed}")));
    for file in ["color/000000.exr", "color/000000.png"] {
        assert_eq!(a.bytes(file), b.bytes(file));
        assert_ne!(a.bytes(file), c.bytes(file));
    }
}

#[test]
fn every_option_does_something() {
    let bunny = |options: &str| traced("builtin:bunny-low", options);
    let exr = bunny("").bytes("color/000000.exr");
    let more = Out::of(&words("trace builtin:bunny-low --size 24x16 --spp 3 --backend cpu"));
    assert_ne!(more.bytes("color/000000.exr"), exr);
    for option in [
        "--hfov 30",
        "--max-depth 1",
        "--integrator nee",
        "--integrator naive",
        "--bsdf phong",
        "--sky none",
        "--sky 0.1,2,3",
        "--effects environment",
        "--tonemap reinhard",
        "--exposure -1.5",
    ] {
        assert_ne!(bunny(option).bytes("color/000000.exr"), exr, "{option}");
    }
    assert_eq!(bunny("--format png").files("color"), ["000000.png", "cameras.json"]);
    let only = bunny("--format exr --fps 24 --sampling uniform");
    assert_eq!(only.files("color"), ["000000.exr", "cameras.json"]);
    assert_eq!(only.bytes("color/000000.exr"), exr);
    assert_eq!(only.json("trace.json")["fps"], 24.0);
}

#[test]
fn a_written_camera_file_is_a_camera() {
    let first = traced("builtin:cubes", "--frames 1");
    let again = traced("builtin:cubes", &format!("--camera {}", first.path("cameras.json").display()));
    let (a, b) = (picture(&first.path("color/000000.exr")), picture(&again.path("color/000000.exr")));
    // The file stores the field of view in decimal degrees, so some samples hit other cubes.
    let alike = a.pixels().iter().zip(b.pixels()).filter(|(a, b)| (0..3).all(|k| (a[k] - b[k]).abs() < 0.02)).count();
    assert!(alike > 24 * 16 * 95 / 100, "{alike}");
}

#[test]
fn a_path_of_keyframes_moves_the_camera_and_a_sky_may_be_a_picture() {
    let sky = traced("builtin:control", "");
    let folder = Folder::new();
    let path = folder.write(
        "path.json",
        br#"{"keyframes": [{"time_s": 0, "position": [0, 1, 5], "target": [0, 0, 0]},
        {"time_s": 1, "position": [3, 1, 4], "target": [0, 0, 0]}]}"#,
    );
    let sky = sky.path("color/000000.exr");
    let options = format!("--camera {path} --frames 2 --fps 2 --sky {} --aov motion", sky.display());
    let moved = traced("builtin:bunny-low", &options);
    assert_ne!(moved.bytes("color/000000.exr"), moved.bytes("color/000001.exr"));
    assert_ne!(moved.bytes("motion/000000.exr"), moved.bytes("motion/000001.exr"));
    assert!(moved.json("trace.json")["effects"].as_array().unwrap().contains(&"environment-map".into()));
}

#[test]
fn a_scene_of_nothing_gives_a_frame() {
    let folder = Folder::new();
    let path = folder.write("nothing.gltf", br#"{"asset": {"version": "2.0"}}"#);
    let t = traced(&path, "--aov depth,motion,variance");
    // A scene without light gets a white sky.
    assert!(picture(&t.path("color/000000.exr")).pixels().iter().all(|c| *c == [1.0; 3]));
    assert_eq!(t.json("trace.json")["triangles"], 0);
}

#[test]
fn values_that_cannot_be_are_refused_in_one_line() {
    for (options, words) in [
        ("--size 0x10", &["--size"][..]),
        ("--size 70000x10", &["--size", "too large"]),
        ("--spp 0", &["--spp"]),
        ("--frames 0", &["--frames"]),
        ("--max-depth 65", &["--max-depth", "64"]),
        ("--fps 0", &["--fps"]),
        ("--hfov 180", &["--hfov", "below 180"]),
        ("--exposure inf", &["--exposure"]),
        ("--integrator best", &["--integrator"]),
        ("--aov normals", &["--aov"]),
        ("--effects glow", &["--effects", "glow"]),
        ("--sky 1,2", &["--sky"]),
        ("--sky 1,2,nan", &["--sky"]),
        ("--sky missing.exr", &["missing.exr"]),
        ("--camera nobody", &["--camera", "nobody"]),
        ("--camera missing.json", &["missing.json"]),
        ("--clip dance", &["dance"]),
        ("--nonsense", &["--nonsense"]),
    ] {
        refuses(options, words);
    }
}
