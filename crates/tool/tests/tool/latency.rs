//! `run --gaze-latency` and `--fixed-fovea`.

use super::rig::{Folder, Out, ran, refuses, run};

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
    // `quads` is another name of `planned`.
    for foveation in ["quads", "mip"] {
        // Times count from the first sample. Three frames are 50 ms.
        let runs = [("1.008333333", 0.0), ("1.008333333", 50.0), ("0.958333333", 0.0)].map(|(start, latency_ms)| {
            let options = format!(
                "--size 160x90 --frames 8 --method none,smr --no-flip --no-jod --foveation {foveation} --gaze {gaze} \
                 --gaze-map fit --start {start} --gaze-latency {latency_ms} --backend cpu"
            );
            let out = ran("analytic:lateral", &options);
            assert_eq!(out.json("report.json")["gaze_latency_ms"], latency_ms);
            out
        });
        let [in_time, late, expected] = &runs;
        for frame in 0..8 {
            for method in ["none", "smr"] {
                let file = format!("{method}/{frame:06}.png");
                assert_eq!(late.bytes(&file), expected.bytes(&file), "{foveation}: {file}");
            }
        }
        // The planted error: without latency the frames are others.
        assert_ne!(late.bytes("none/000007.png"), in_time.bytes("none/000007.png"));
        assert_eq!(late.bytes("gaze.csv"), in_time.bytes("gaze.csv"));
        assert_ne!(late.bytes("gaze.csv"), expected.bytes("gaze.csv"));
        // Where the eye looks is no longer sharp; where the renderer thought it looked, it is.
        let [in_time, late, expected] = runs.map(|out| fovea_db(&out, "none"));
        println!("{foveation}: fovea {in_time} dB in time, {late} dB late");
        assert!(late < in_time - 3.0 && late < expected - 3.0, "{late} dB");
    }
    let out = folder.text("refused");
    for wrong in ["-1", "NaN", "1001", "late"] {
        let latency = format!("--gaze-latency={wrong}");
        refuses(&run("analytic:still", &out, &[&latency]), &["--gaze-latency", "0 to 1000 milliseconds"]);
    }
}

/// PSNR in the true fovea (null in the report: no error at all).
fn fovea_db(out: &Out, method: &str) -> f64 {
    out.json("report.json")["methods"][method]["bands"]["fovea"]["psnr_db"].as_f64().unwrap_or(f64::INFINITY)
}

/// The frames are those of a gaze in the middle, and the scores those of the eye.
#[test]
fn a_fixed_fovea_stays_in_the_middle_and_scores_follow_the_eye() {
    let clip = |more: &str| {
        let small = "--size 160x90 --frames 4 --method smr --no-flip --no-jod --backend cpu --foveation mip --fovea 10";
        let out = ran("analytic:lateral", &format!("{small} {more}"));
        (out.bytes("smr/000003.png"), out.json("report.json")["fixed_fovea"].clone(), fovea_db(&out, "smr"))
    };
    let (fixed, is_fixed, beside) = clip("--gaze 20,20 --fixed-fovea");
    let (middle, is_tracked, within) = clip("--gaze 79.5,44.5");
    assert!(fixed == middle && is_fixed == true && is_tracked == false);
    println!("fovea {within} dB where the frame is sharp, {beside} dB where the eye looks");
    assert!(beside < within - 3.0);
    // A planted error: the fovea follows the eye.
    assert_ne!(clip("--gaze 20,20").0, fixed);
    let both = ["--fixed-fovea", "--gaze-latency", "20"];
    refuses(&run("analytic:still", &Folder::new().text("out"), &both), &["--fixed-fovea", "--gaze-latency"]);
}
