//! `afterimage info`, `scanpath` and `--help`.

use super::rig::{Folder, SMALL, ran, refuses, succeeds};
use std::fs;

#[test]
fn scanpath_writes_what_run_reads_and_info_explains_both() {
    let folder = Folder::new();
    let [csv, again] = ["view.csv", "again.csv"].map(|name| folder.text(name));
    for file in [&csv, &again] {
        succeeds(&["scanpath", "--seconds", "2", "--seed", "4", "--out", file]);
    }
    assert_eq!(fs::read(&csv).unwrap(), fs::read(&again).unwrap());
    let text = succeeds(&["info", &csv]);
    assert!(text.contains("1920x1080 px") && text.contains("--gaze-map: angle"), "{text}");
    ran("analytic:scroll", &format!("{SMALL} --gaze {csv} --start 1"));
    let text = succeeds(&["info", "analytic:lateral"]);
    assert!(text.contains("640x360") && text.contains("motion convention: as read"), "{text}");
    assert!(text.contains("inputs look:\n  motion: ") && !text.contains("WRONG"), "{text}");
    refuses(&["scanpath", "--seconds=-1", "--out", &csv], &["-1"]);
    refuses(&["scanpath", "--out", &format!("{csv}/x.csv")], &["cannot be written"]);
    assert!(succeeds(&["info", "adapters"]).contains("CPU"));
    refuses(&["info", "analytic:lateral", "--self-test"], &["--self-test", "expected the word adapters"]);
    let text = succeeds(&["info", "adapters", "--self-test"]);
    let required = std::env::var("AFTERIMAGE_GPU").is_ok_and(|v| v == "require");
    for line in ["bits of NaN through a variable", "two-sum", "smr against the CPU"] {
        assert!(text.contains(line) || !required, "{text}");
    }
}

/// `INSTA_UPDATE=always` writes the reviewed texts anew (`snapshots/`).
#[test]
fn info_says_what_a_scene_holds() {
    insta::assert_snapshot!("info_cornell", succeeds(&["info", "builtin:cornell"]));

    // A triangle with a light, a camera and two animations.
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
    insta::assert_snapshot!("info_scene", succeeds(&["info", &scene]).replace(&scene, "scene.gltf"));

    refuses(&["info", "builtin:teapot"], &["teapot", "cornell"]);
    refuses(&["info", "missing.glb"], &["missing.glb"]);
    refuses(&["info", &folder.write("broken.gltf", b"no scene")], &["broken.gltf"]);
}

/// `INSTA_UPDATE=always` writes the reviewed texts anew (`snapshots/`).
#[test]
fn help_is_what_was_reviewed() {
    let commands = ["demo", "run", "trace", "bench", "sweep", "compare", "scanpath", "info"];
    for command in commands {
        let text = succeeds(&[command, "--help"]);
        assert!(text.contains("Example") && text.contains(&format!("afterimage {command}")), "{command}");
        insta::assert_snapshot!(format!("help_{command}"), text);
    }
    #[cfg(feature = "view")]
    insta::assert_snapshot!("help_view", succeeds(&["view", "--help"]));
    for command in ["run", "trace"] {
        insta::assert_snapshot!(format!("short_help_{command}"), succeeds(&[command, "-h"]));
    }
    assert!(succeeds(&["--version"]).starts_with("afterimage 0."));
}

/// `-h` fits on two screens and says where the rest is.
#[test]
fn short_help_is_short() {
    let view = cfg!(feature = "view").then_some("view");
    let commands = ["demo", "run", "trace", "bench", "sweep", "compare", "scanpath", "info"].into_iter().chain(view);
    for command in commands {
        let [short, long] = ["-h", "--help"].map(|help| succeeds(&[command, help]));
        // Without a terminal, lines have 100 columns.
        let lines = short.lines().count();
        println!("{command}: {lines} lines of -h, {} of --help", long.lines().count());
        assert!(lines <= 120, "{command}: {lines} lines");
        assert!(command == "demo" || short.lines().last().unwrap().contains("--help"), "{command}");
        let options = |text: &str| text.lines().filter(|line| line.trim_start().starts_with("--")).count();
        assert!(options(&short) <= options(&long), "{command}");
        if ["run", "trace", "view"].contains(&command) {
            assert!((8..=11).contains(&options(&short)) && options(&long) > 20, "{command}: {}", options(&short));
            assert!(short.contains("Example") && lines <= 60, "{command}: {lines}");
        }
    }
}
