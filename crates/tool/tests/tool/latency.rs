//! `run --gaze-latency` and `--fixed-fovea`.

use super::rig::{Folder, read_json, refuses, run, succeeds, words};
use std::fs;

/// A gaze that steps by 12 pixels in every frame of 60 a second, after it rested for a second.
fn stepping() -> String {
    let head = "# screen_px: 160x90\n# screen_cm: 40x22.5\n# distance_cm: 60\nt_s,x_px,y_px,valid\n";
    // Half a frame before each frame, so that rounding does not matter.
    let row = |i: i32| {
        let t_s = 1.0 + (f64::from(i) - 0.5) / 60.0;
        format!("{t_s:.6},{},{},1\n", 20 + 12 * i.max(0), 60 - 2 * i.max(0))
    };
    head.to_owned() + &(-60..12).map(row).collect::<String>()
}

#[test]
fn a_late_gaze_foveates_elsewhere_and_scores_know_the_true_one() {
    let folder = Folder::new();
    let gaze = folder.write("gaze.csv", stepping().as_bytes());
    let clip = |name: &str, start: &str, latency: &str, foveation: &str| {
        let line = format!(
            "--size 160x90 --frames 8 --method none,smr --no-flip --no-jod --foveation {foveation} --gaze {gaze} --gaze-map fit \
             --start {start} --gaze-latency {latency} --backend cpu"
        );
        succeeds(&run("analytic:lateral", &folder.text(name), &words(&line)));
    };
    for foveation in ["sparse", "mip"] {
        // Times count from the first sample. Three frames are 50 ms.
        clip("true", "1.008333333", "0", foveation);
        clip("late", "1.008333333", "50", foveation);
        let bytes = |run: &str, file: &str| fs::read(folder.path(run).join(file)).unwrap();
        clip("expected", "0.958333333", "0", foveation);
        for frame in 0..8 {
            for method in ["none", "smr"] {
                let file = format!("{method}/{frame:06}.png");
                assert_eq!(bytes("late", &file), bytes("expected", &file), "{foveation}: {file}");
            }
        }
        // The planted error: without latency the frames are others.
        assert_ne!(bytes("late", "none/000007.png"), bytes("true", "none/000007.png"));
        assert_eq!(bytes("late", "gaze.csv"), bytes("true", "gaze.csv"));
        assert_ne!(bytes("late", "gaze.csv"), bytes("expected", "gaze.csv"));
        let fovea = |run: &str| {
            let report = read_json(&folder.path(run).join("report.json"));
            assert_eq!(report["gaze_latency_ms"], if run == "late" { 50.0 } else { 0.0 });
            report["methods"]["none"]["bands"]["fovea"]["psnr_db"].as_f64()
        };
        // Where the eye looks is no longer sharp; where the renderer thought it looked, it is (null: no error at all).
        let db = |run: &str| fovea(run).unwrap_or(f64::INFINITY);
        println!("{foveation}: fovea {} dB in time, {} dB late", db("true"), db("late"));
        assert!(db("late") < db("true") - 3.0 && db("late") < db("expected") - 3.0, "{} dB", db("late"));
    }
    let out = folder.text("refused");
    for wrong in ["-1", "NaN", "1001", "late"] {
        let latency = format!("--gaze-latency={wrong}");
        refuses(&run("analytic:still", &out, &[&latency]), &["--gaze-latency", "0 to 1000 milliseconds"]);
    }
}

/// The frames are those of a gaze in the middle, and the scores those of the eye.
#[test]
fn a_fixed_fovea_stays_in_the_middle_and_scores_follow_the_eye() {
    let folder = Folder::new();
    let clip = |name: &str, gaze: &str, more: &[&str]| {
        let line = "--size 160x90 --frames 4 --method smr --no-flip --no-jod --backend cpu --foveation mip --fovea 10";
        succeeds(&run("analytic:lateral", &folder.text(name), &[&words(line)[..], &["--gaze", gaze], more].concat()));
        let report = read_json(&folder.path(name).join("report.json"));
        let db = report["methods"]["smr"]["bands"]["fovea"]["psnr_db"].as_f64().unwrap_or(f64::INFINITY);
        (fs::read(folder.path(name).join("smr/000003.png")).unwrap(), report["fixed_fovea"].clone(), db)
    };
    let (fixed, is_fixed, beside) = clip("fixed", "20,20", &["--fixed-fovea"]);
    let (middle, is_tracked, within) = clip("middle", "79.5,44.5", &[]);
    assert!(fixed == middle && is_fixed == true && is_tracked == false);
    println!("fovea {within} dB where the frame is sharp, {beside} dB where the eye looks");
    assert!(beside < within - 3.0);
    // A planted error: the fovea follows the eye.
    assert_ne!(clip("tracked", "20,20", &[]).0, fixed);
    let both = ["--fixed-fovea", "--gaze-latency", "20"];
    refuses(&run("analytic:still", &folder.text("both"), &both), &["--fixed-fovea", "--gaze-latency"]);
}
