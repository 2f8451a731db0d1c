//! `scanpath --head` and `--camera head`.

use super::rig::{Folder, Out, ran, refuses, run, succeeds, words};
use std::fs;

const SMALL: &str = "--size 96x96 --hfov 90 --method none --no-flip --no-jod --reference-samples 1";

/// Rows of a table without its names, as numbers.
fn rows(table: &str) -> Vec<Vec<f64>> {
    table.lines().skip(1).map(|line| line.split(',').map(|v| v.parse().unwrap()).collect()).collect()
}

#[test]
fn a_generated_head_moves_the_camera_and_its_scanpath_repeats_the_run() {
    let small = format!("{SMALL} --frames 8 --fps 20 --start 1 --format exr");
    let first = ran("builtin:cornell", &format!("{small} --camera head-walk --gaze synthetic:4"));
    let (poses, gaze) = (rows(&first.text("pose.csv")), rows(&first.text("gaze.csv")));
    assert_eq!((poses.len(), gaze.len(), poses[0].len()), (8, 8, 8));
    // It walks at 0.9 m/s, and looks around.
    let step = |a: &[f64], b: &[f64]| (1..4).map(|k| (b[k] - a[k]).powi(2)).sum::<f64>().sqrt();
    let way = step(&poses[0], &poses[7]);
    assert!((0.25..0.5).contains(&way), "{way} m in 0.35 s");
    assert!(poses.iter().all(|p| (p[4..].iter().map(|q| q * q).sum::<f64>() - 1.0).abs() < 1e-6));
    let moves = gaze.windows(2).map(|w| step(&[0.0, w[0][1], w[0][2], 0.0], &[0.0, w[1][1], w[1][2], 0.0]));
    assert!(moves.fold(0.0, f64::max) > 2.0);
    assert_eq!(first.json("report.json")["gaze_map"], "angle");

    let path = first.path("scanpath.csv");
    let again = ran("builtin:cornell", &format!("{small} --camera head --gaze {}", path.display()));
    for file in ["pose.csv", "scanpath.csv", "gaze.csv", "cameras.json", "none/000007.exr"] {
        assert_eq!(first.bytes(file), again.bytes(file), "{file}");
    }
    // The cameras lie beside the frames, too; a run without a head leaves none behind.
    let frames = first.json("none/cameras.json");
    assert_eq!((frames["frames"].as_array().unwrap().len(), &frames["width"]), (8, &96.into()));
    assert_eq!(first.bytes("none/cameras.json"), first.bytes("cameras.json"));
    let walk = format!("{SMALL} --frames 1 --camera walk");
    succeeds(&run("builtin:cornell", again.path("").to_str().unwrap(), &words(&walk)));
    let left = ["pose.csv", "scanpath.csv", "cameras.json", "none/cameras.json"];
    assert!(!left.iter().any(|file| again.path(file).exists()));
}

#[test]
fn scanpath_writes_heads_that_trace_follows_with_both_eyes() {
    let folder = Folder::new();
    let csv = folder.text("head.csv");
    let text = succeeds(&["scanpath", "--head", "--pursuits", "0.5", "--seconds", "2", "--rate", "90", "--out", &csv]);
    assert!(text.contains("fixations"), "{text}");
    let written = fs::read_to_string(&csv).unwrap();
    assert!(written.contains("\nt_s,x_px,y_px,valid,head_x_m,") && written.lines().count() == 190, "{written}");
    assert!(succeeds(&["info", &csv]).contains("head: a pose at every sample"));
    let line = format!(
        "trace builtin:cornell --stereo 0.063 --sampling regions --region-spp 2,1,1 --size 32x32 --hfov 90 \
         --camera head --gaze {csv} --start 0.5 --frames 3 --fps 4 --backend cpu"
    );
    let traced = Out::of(&words(&line));
    let cameras = traced.json("cameras.json");
    assert_eq!(cameras["frames"].as_array().unwrap().len(), 3);
    assert_ne!(cameras["frames"][0]["camera_to_world"], cameras["frames"][2]["camera_to_world"]);
    let [head, left, right] = ["gaze.csv", "left/gaze.csv", "right/gaze.csv"].map(|file| rows(&traced.text(file)));
    // The left eye sees what is near farther to the right; where the ray leaves the box, nothing is near.
    assert!(left[0][1] > head[0][1] && head[0][1] > right[0][1], "{head:?} {left:?} {right:?}");
    for i in 0..3 {
        assert!(left[i][1] >= head[i][1] && head[i][1] >= right[i][1], "{head:?} {left:?} {right:?}");
        assert!((left[i][1] + right[i][1] - 2.0 * head[i][1]).abs() < 0.05);
    }
}

#[test]
fn heads_that_cannot_be_are_refused_in_one_line() {
    let folder = Folder::new();
    let out = folder.text("out");
    let view = folder.text("view.csv");
    succeeds(&["scanpath", "--seconds", "1", "--out", &view]);
    let bad = folder.write(
        "bad.csv",
        b"# screen_px: 9x9\nt_s,x_px,y_px,valid,head_x_m,head_y_m,head_z_m,head_qx,head_qy,head_qz,head_qw\n\
          0,1,1,1,0,0,0,0,0,0,2\n",
    );
    for (camera, gaze, said) in [
        ("head", &view[..], &["view.csv", "no poses of the head"][..]),
        ("head", "40,40", &["--camera head", "40,40", "synthetic:SEED"]),
        ("head", "none.csv", &["none.csv", "cannot be read"]),
        ("head-walk", &view, &["--camera head-walk", "synthetic:SEED"]),
        ("head", "synthetic:x", &["synthetic:x"]),
        ("head", &bad, &["bad.csv, line 3", "length 2.0000"]),
        ("head", "synthetic:1 --start nan", &["start"]),
    ] {
        let options = format!("{SMALL} --camera {camera} --gaze {gaze}");
        refuses(&run("builtin:cornell", &out, &words(&options)), said);
    }
    refuses(&run("analytic:still", &out, &["--camera", "head"]), &["--camera", "has frames already"]);
    refuses(&["scanpath", "--walk", "--out", &out], &["--head"]);
    refuses(&["scanpath", "--head", "--pursuits", "2", "--out", &out], &["pursuits: 2"]);
    refuses(&["scanpath", "--head", "--screen", "9x9", "--out", &out], &["--screen"]);
    assert!(!folder.path("out").exists());
}
