//! Inputs that are taken for others: other kinds of files, patterns, names, animations, lights without shadows.

use super::rig::{Folder, ran, refuses, run, succeeds, tool, words};
use afterimage::Image;
use afterimage_lab::source::exr_file::{FrameToWrite, write};
use base64::Engine;
use serde_json::{Value, json};
use std::fs;

const QUICK: &str = "--foveation off --method none --backend cpu --no-jod --no-flip --gaze 8,4 --frames 1";

#[test]
fn files_of_other_kinds_are_told_what_to_become() {
    let folder = Folder::new();
    let out = folder.text("out");
    let refused = |name: &str, bytes: &[u8], words: &[&str]| {
        let input = folder.write(name, bytes);
        refuses(&["info", &input], words);
        refuses(&run(&input, &out, &["--gaze", "8,4"]), words);
    };
    let scene = ["scenes are read as .gltf or .glb", "export it as glTF"];
    refused("a.obj", b"v 0 0 0\nf 1 1 1\n", &scene);
    refused("a.USDA", b"#usda 1.0\n(\n)\n", &scene);
    refused("a.ply", b"ply\nformat ascii 1.0\n", &scene);
    refused("a.fbx", b"Kaydara FBX Binary  \0", &scene);
    refused("a.mp4", b"\0\0\0\x20ftypisom", &["a video", "motion vectors", ".exr frames"]);
    refused("a.tiff", b"II*\0", &["is a picture of a kind", "convert it to .exr or .png"]);
    refused("a.edf", b"SR_RESEARCH_COMBINED_FILE\0\x01", &["is a recording (.edf)", "edf2asc"]);
    // What no one knows is told what is.
    refused("a.xyz", b"\0\x01\x02\x03", &["not supported", "(.gltf, .glb)"]);
}

#[test]
fn patterns_and_folders_of_pictures_are_told_what_to_give() {
    let folder = Folder::new();
    fs::create_dir(folder.path("frames")).unwrap();
    for name in ["f_0001.png", "f_0002.png"] {
        let picture = image::RgbImage::from_pixel(16, 8, image::Rgb([90, 120, 60]));
        picture.save(folder.path("frames").join(name)).unwrap();
    }
    let frames = folder.text("frames");
    refuses(&["info", &frames], &["2 pictures and no .exr", "motion vectors", "one picture as a still"]);
    for pattern in ["f_%04d.png", "f_%d.exr", "f_####.exr", "f_@@@@.exr", "f.$F4.exr", "f_*.exr"] {
        let input = format!("{frames}/{pattern}");
        refuses(&["info", &input], &["is a pattern", &format!("give the folder, {frames};")]);
    }
    // A file of such a name is that file, and a pattern without its folder does not exist.
    let hash = format!("{frames}/take#2.png");
    fs::copy(folder.path("frames/f_0001.png"), &hash).unwrap();
    assert!(succeeds(&["info", &hash]).contains("16x8 px"));
    refuses(&["info", &format!("{frames}/no/f_%04d.exr")], &["does not exist"]);
}

#[cfg(unix)]
#[test]
fn names_that_are_not_utf_8_are_named() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let folder = Folder::new();
    let out = folder.path("out").join(OsStr::from_bytes(b"caf\xe9"));
    let command = |input: &[u8]| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_afterimage"));
        command.arg("run").arg(OsStr::from_bytes(input)).arg("--out").arg(&out);
        command.args(words(&format!("--size 32x18 {QUICK}"))).output().unwrap()
    };
    // The output folder may have such a name.
    assert!(command(b"analytic:still").status.success() && out.join("report.json").exists());
    let refused = command(b"b\xe9.png");
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(refused.status.code() == Some(2) && said.lines().count() == 1, "{said}");
    assert!(said.contains(r#"the argument "b\xE9.png" is not UTF-8"#) && said.contains("rename the file"), "{said}");
}

/// A scene of a floor and a triangle above it, with these further members.
fn scene(folder: &Folder, name: &str, change: impl FnOnce(&mut Value)) -> String {
    let corners = [[-2.0f32, -1.0, -4.0], [2.0, -1.0, -4.0], [0.0, 1.0, -4.0]];
    let times = [0.5f32, 1.5];
    let keys = [[[0.0f32; 3], [1.0, 0.0, 0.0]], [[0.0; 3], [0.0, 1.0, 0.0]]];
    let values = corners.iter().flatten().chain(&times).chain(keys.iter().flatten().flatten());
    let bytes: Vec<u8> = values.flat_map(|v| v.to_le_bytes()).collect();
    let uri =
        format!("data:application/octet-stream;base64,{}", base64::engine::general_purpose::STANDARD.encode(&bytes));
    let view = |offset: usize, length: usize| json!({"buffer": 0, "byteOffset": offset, "byteLength": length});
    let accessor = |view: usize, count: usize, kind: &str| json!({"bufferView": view, "componentType": 5126, "count": count, "type": kind});
    let animation = |name: &str, output: usize| {
        json!({"name": name, "samplers": [{"input": 1, "output": output}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]})
    };
    let mut file = json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0}, {"camera": 0}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "buffers": [{"uri": uri, "byteLength": bytes.len()}],
        "bufferViews": [view(0, 36), view(36, 8), view(44, 24), view(68, 24)],
        "accessors": [accessor(0, 3, "VEC3"), accessor(1, 2, "SCALAR"), accessor(2, 2, "VEC3"), accessor(3, 2, "VEC3")],
        "animations": [animation("slide", 2), animation("rise", 3)]
    });
    change(&mut file);
    folder.write(name, serde_json::to_string(&file).unwrap().as_bytes())
}

#[test]
fn an_animation_is_chosen_by_name_or_number() {
    let folder = Folder::new();
    let input = scene(&folder, "two.gltf", |_| {});
    let text = succeeds(&["info", &input]);
    let lines = ["animations: 2 ('slide', 'rise')", "--animation NAME", "the first animation, s: 1.000"];
    assert!(lines.iter().all(|words| text.contains(words)), "{text}");
    assert!(succeeds(&["info", &input, "--animation", "rise"]).contains("duration of animation rise, s: 1.000"));
    let shown = |options: &str| {
        let quick = QUICK.replace("--frames 1", "--frames 20");
        ran(&input, &format!("{quick} --size 64x36 {options}")).bytes("none/000019.png")
    };
    let slide = shown("");
    let rise = shown("--animation rise");
    assert!(slide != rise && shown("--animation 1") == rise && shown("--animation slide") == slide);
    let out = folder.text("out");
    refuses(&run(&input, &out, &["--animation", "walk"]), &["no animation \"walk\"", "slide", "rise"]);
    refuses(&run("analytic:still", &out, &["--animation", "rise"]), &["--animation", "scene"]);
    refuses(&["info", "analytic:still", "--animation", "rise"], &["--animation", "not a scene"]);
    let trace = |options: &str| {
        let out = folder.text("traced");
        succeeds(
            &[&["trace", &input, "--out", &out][..], &words("--size 32x18 --spp 1 --frames 20"), &words(options)]
                .concat(),
        );
        fs::read(folder.path("traced/color/000019.exr")).unwrap()
    };
    assert!(trace("--clip rise") == trace("--animation 1") && trace("--animation slide") != trace("--animation rise"));
}

#[test]
fn what_does_not_move_or_cast_shadows_is_said() {
    let folder = Folder::new();
    let still = scene(&folder, "still.gltf", |file| drop(file.as_object_mut().unwrap().remove("animations")));
    let out = folder.text("out");
    let said = |command: &[&str]| {
        let output = tool(command);
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stderr).unwrap()
    };
    let trace = |more: &str| {
        succeeds(&[&["trace", &still, "--out", &out][..], &words("--size 16x9 --spp 1"), &words(more)].concat())
    };
    assert!(trace("--frames 2").contains("warning: nothing moves in these 2 frames; --camera lateral"));
    for moving in ["--frames 1", "--frames 2 --camera lateral", "--frames 2 --camera still"] {
        assert!(!trace(moving).contains("warning"), "{moving}");
    }
    let lit = |kind: &str| {
        scene(&folder, &format!("{kind}.gltf"), |file| {
            file.as_object_mut().unwrap().remove("animations");
            file["nodes"][1]["extensions"] = json!({"KHR_lights_punctual": {"light": 0}});
            let spot = if kind == "spot" { json!({}) } else { json!(null) };
            let mut light = json!({"type": kind, "spot": spot});
            light.as_object_mut().unwrap().retain(|_, value| !value.is_null());
            file["extensions"] = json!({"KHR_lights_punctual": {"lights": [light]}});
        })
    };
    for (kind, is_said) in [("point", true), ("spot", true), ("directional", false)] {
        let input = lit(kind);
        let warned =
            |source: &str| said(&run(&input, &out, &words(&format!("--size 32x18 {QUICK} --source {source}"))));
        assert_eq!(warned("raster").contains("1 point or spot lights cast no shadows"), is_said, "{kind}");
        assert!(!warned("trace").contains("shadows"), "{kind}");
    }
}

#[test]
fn deferred_shading_is_for_scenes_and_says_when_it_falls_back() {
    let folder = Folder::new();
    let out = folder.text("out");
    let frames = afterimage_testing::workspace().join("fixtures/sequences/lateral_160x90");
    let shading = ["--shading", "deferred"];
    refuses(&run(frames.to_str().unwrap(), &out, &shading), &["--shading: ", "has frames already", "give a scene"]);
    refuses(&run("analytic:still", &out, &shading), &["--shading: ", "has frames already"]);
    let traced = [&shading[..], &["--source", "trace"]].concat();
    refuses(&run("builtin:cubes", &out, &traced), &["--shading: ", "rasterised scenes", "--source trace"]);
    assert!(!folder.path("out").exists(), "nothing was written");
    let said = |name: &str, extensions: Value, shading: &str| {
        let input = scene(&folder, name, |file| {
            file.as_object_mut().unwrap().remove("animations");
            file["materials"] = json!([{"extensions": extensions}]);
            file["meshes"][0]["primitives"][0]["material"] = json!(0);
        });
        let output = tool(&run(&input, &out, &words(&format!("--size 32x18 {QUICK} --shading {shading}"))));
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stderr).unwrap()
    };
    let stretched = || json!({"KHR_materials_anisotropy": {"anisotropyStrength": 0.5}});
    let falls_back = "--shading deferred: the scene has materials that are drawn forward, and so is all of it";
    assert_eq!(said("stretched.gltf", stretched(), "deferred").matches(falls_back).count(), 1);
    assert!(!said("stretched.gltf", stretched(), "forward").contains("--shading"));
    assert!(!said("plain.gltf", json!({}), "deferred").contains("--shading"));
}

#[test]
fn a_sun_leaves_its_scene_its_exposure() {
    let folder = Folder::new();
    let exposure = |sun: f32| {
        let path = folder.path(&format!("sun{sun}.exr"));
        let color = Image::from_fn([32, 18], |[x, y]| if x + y == 0 { [sun; 3] } else { [0.1 + 0.02 * x as f32; 3] });
        write(&path, &FrameToWrite::color(&color)).unwrap();
        let input = path.to_str().unwrap();
        assert!(!succeeds(&["info", input]).contains("warning"));
        ran(input, &format!("{QUICK} --exposure auto")).json("report.json")["exposure_ev"].as_f64().unwrap()
    };
    let (without, with) = (exposure(0.4), exposure(60_000.0));
    assert!((with - without).abs() < 0.2, "{with} beside a sun, {without} without");
}
