//! `afterimage trace --stereo`.

use super::rig::{picture, refuses, traced};
use crate::rig::{Out, ran, words};
use afterimage_lab::source::{FrameSource, ReadLimits, SequenceSource};

/// Rows of a gaze.csv.
fn gaze(out: &Out, name: &str) -> Vec<[f64; 2]> {
    let row = |line: &str| {
        let values: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
        [values[1], values[2]]
    };
    out.text(name).lines().skip(1).map(row).collect()
}

#[test]
fn two_eyes_have_frames_cameras_and_gazes_of_their_own() {
    const FOVEATED: &str = "--sampling regions --region-spp 4,2,1 --gaze 12,12";
    let t = traced("builtin:cornell", &format!("{FOVEATED} --stereo 0.064 --frames 2 --aov depth,motion"));
    assert_eq!(t.files(""), words("cameras.json gaze.csv left right trace.json"));
    for eye in ["left", "right"] {
        assert_eq!(t.files(eye), words("cameras.json color depth gaze.csv motion scanpath.csv"), "{eye}");
        let frames = words("000000.exr 000000.png 000001.exr 000001.png cameras.json");
        assert_eq!(t.files(&format!("{eye}/color")), frames, "{eye}");
    }
    assert!(t.said.contains("2 frames for each of two eyes of 24x16"), "{}", t.said);

    // Positions of the eyes. The file's x axis is the scene's, and this camera's right is -x.
    let eye_x = |name: &str| t.json(name)["frames"][1]["camera_to_world"][0][3].as_f64().unwrap();
    let [head, left, right] = ["cameras.json", "left/cameras.json", "right/color/cameras.json"].map(eye_x);
    assert!((left - right - 0.064).abs() < 1e-9 && (left + right - 2.0 * head).abs() < 1e-9, "{left} {head} {right}");

    // The gazes differ by ipd f / z, where f is half the width divided by the tangent of half the field of view.
    let report = t.json("trace.json");
    let focal_px = 12.0 / (report["hfov_deg"].as_f64().unwrap().to_radians() / 2.0).tan();
    let [head, l, r] = ["gaze.csv", "left/gaze.csv", "right/gaze.csv"].map(|name| gaze(&t, name));
    assert_eq!(head, [[12.0, 12.0]; 2]);
    let apart = l[0][0] - r[0][0];
    assert!((0.5 * (l[0][0] + r[0][0]) - 12.0).abs() < 2e-3 && (l[0][1] - 12.0).abs() < 2e-3, "{l:?} {r:?}");
    let z = 0.064 * focal_px / apart;
    let mono = traced("builtin:cornell", &format!("{FOVEATED} --aov depth"));
    let mut source = SequenceSource::open(&mono.path("color"), &ReadLimits::default()).unwrap();
    let depth = source.frame(0).unwrap().depth.unwrap().at(12, 12);
    // The file has three decimals.
    assert!((z / f64::from(depth) - 1.0).abs() < 0.002 / apart, "{z} m of {depth} m");

    let stereo = &report["stereo"];
    assert_eq!((&stereo["ipd_m"], stereo["eyes"].as_array().unwrap().len()), (&0.064.into(), 2));
    let of = |eye: usize, key: &str| stereo["eyes"][eye]["samples"][key].as_u64().unwrap();
    for key in ["traced", "uniform"] {
        assert_eq!(report["samples"][key].as_u64().unwrap(), of(0, key) + of(1, key), "{key}");
    }
    assert_eq!((&stereo["eyes"][1]["name"], &stereo["eyes"][1]["gaze"]), (&"right".into(), &"right/gaze.csv".into()));
    assert_eq!(stereo["eyes"][0]["sampling"], "regions");
    let alone = mono.json("trace.json");
    assert!(alone["stereo"].is_null());
    assert_eq!(of(0, "uniform"), 2 * alone["samples"]["uniform"].as_u64().unwrap());

    // `run` reads an eye's folder and its scanpath.
    let [input, path] = ["right/color", "right/scanpath.csv"].map(|name| t.path(name));
    let options = format!("--gaze {} --frames 2 --method none --backend cpu --no-jod --no-flip", path.display());
    let out = ran(input.to_str().unwrap(), &options);
    for (a, b) in gaze(&out, "gaze.csv").iter().zip(&r) {
        assert!((a[0] - b[0]).abs() < 2e-3 && (a[1] - b[1]).abs() < 2e-3, "{a:?} {b:?}");
    }
}

#[test]
fn two_eyes_need_no_gaze_but_a_distance() {
    let t = traced("builtin:cornell", "--stereo 0.2");
    assert_eq!(t.files(""), words("cameras.json left right trace.json"));
    assert_eq!(t.files("left"), ["cameras.json", "color"]);
    let [l, r] = ["left", "right"].map(|eye| picture(&t.path(&format!("{eye}/color/000000.exr"))));
    assert!(l != r && [&l, &r].iter().all(|i| i.pixels().iter().any(|c| c[0] > 0.01)));
    assert!(t.json("trace.json")["stereo"]["eyes"][0]["gaze"].is_null());
    for ipd in ["0", "-0.06", "63", "nan", "wide"] {
        refuses(&format!("--stereo {ipd}"), &["--stereo"]);
    }
}
