//! `afterimage trace` with one eye: files, options, cameras.

use super::rig::{Traced, picture};
use crate::rig::{Folder, words};
use serde_json::Value;

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
fn every_option_does_something() {
    let plain = Traced::new("builtin:bunny-low", &[]);
    let exr = plain.bytes("color/000000.exr");
    assert_ne!(Traced::with_spp("builtin:bunny-low", "3", &[]).bytes("color/000000.exr"), exr);
    for (option, value) in [
        ("--hfov", "30"),
        ("--max-depth", "1"),
        ("--integrator", "nee"),
        ("--integrator", "naive"),
        ("--bsdf", "phong"),
        ("--sky", "none"),
        ("--sky", "0.1,2,3"),
        ("--effects", "environment"),
        ("--tonemap", "reinhard"),
        ("--exposure", "-1.5"),
    ] {
        let other = Traced::new("builtin:bunny-low", &[option, value]);
        assert_ne!(other.bytes("color/000000.exr"), exr, "{option} {value}");
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
    // The file stores the field of view in decimal degrees, so some samples hit other cubes.
    let alike = a.pixels().iter().zip(b.pixels()).filter(|(a, b)| (0..3).all(|k| (a[k] - b[k]).abs() < 0.02)).count();
    assert!(alike > 24 * 16 * 95 / 100, "{alike}");
}

#[test]
fn a_path_of_keyframes_moves_the_camera_and_a_sky_may_be_a_picture() {
    let sky = Traced::new("builtin:control", &[]);
    let folder = Folder::new();
    let path = folder.write(
        "path.json",
        br#"{"keyframes": [{"time_s": 0, "position": [0, 1, 5], "target": [0, 0, 0]},
        {"time_s": 1, "position": [3, 1, 4], "target": [0, 0, 0]}]}"#,
    );
    let exr = sky.path("color/000000.exr");
    let line = format!("--camera {path} --frames 2 --fps 2 --sky {} --aov motion", exr.display());
    let moved = Traced::new("builtin:bunny-low", &words(&line));
    assert_ne!(moved.bytes("color/000000.exr"), moved.bytes("color/000001.exr"));
    assert_ne!(moved.bytes("motion/000000.exr"), moved.bytes("motion/000001.exr"));
    assert!(moved.report()["effects"].as_array().unwrap().contains(&"environment-map".into()));
}

#[test]
fn a_scene_of_nothing_gives_a_frame() {
    let folder = Folder::new();
    let path = folder.write("nothing.gltf", br#"{"asset": {"version": "2.0"}}"#);
    let t = Traced::new(&path, &["--aov", "depth,motion,variance"]);
    // A scene without light gets a white sky.
    assert!(picture(&t.path("color/000000.exr")).pixels().iter().all(|c| *c == [1.0; 3]));
    assert_eq!(t.report()["triangles"], 0);
}
