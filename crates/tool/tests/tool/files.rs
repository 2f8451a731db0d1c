//! Files that people bring: the exposure of their frames, and folders of runs that were aborted.

use super::rig::{Folder, files, kill_once, read_json, refuses, run, succeeds, tool, words};
use afterimage::Image;
use afterimage_lab::source::exr_file::{FrameToWrite, write};
use std::fs;

const QUICK: &str = "--foveation off --method none --backend cpu --no-jod --no-flip --gaze 8,4";

#[test]
fn the_remains_of_an_aborted_run_are_replaced() {
    let folder = Folder::new();
    let out = folder.text("out");
    let long = format!("{QUICK} --frames 100000 --size 64x36");
    kill_once(&run("analytic:lateral", &out, &words(&long)), || folder.path("out/none/000002.png").exists());
    assert!(folder.path("out/none/000002.png").exists() && !folder.path("out/report.json").exists());
    // What a write that was cut off leaves behind.
    fs::write(folder.path("out/none/.000009.png.1.2.part"), b"x").unwrap();
    fs::write(folder.path("out/none/notes.txt"), "mine").unwrap();
    let again = format!("{QUICK} --frames 2 --size 32x18");
    let again = run("analytic:lateral", &out, &words(&again));
    succeeds(&again);
    assert_eq!(files(&folder.path("out/none")), ["000000.png", "000001.png", "notes.txt"]);
    assert!(!files(&folder.path("out")).iter().any(|name| name.starts_with('.')), "{:?}", files(&folder.path("out")));
    assert_eq!(read_json(&folder.path("out/report.json"))["frames"], 2);
    // Frames of something else stay, also in the folder of a finished run without its report.
    fs::remove_file(folder.path("out/report.json")).unwrap();
    refuses(&again, &["frames of something else", "--out"]);
    assert_eq!(files(&folder.path("out/none")).len(), 3);
}

#[test]
fn an_exposure_that_fits_is_proposed_and_found() {
    let folder = Folder::new();
    let path = folder.path("bright.exr");
    write(&path, &FrameToWrite::color(&Image::filled([16, 9], [1000.0; 3]))).unwrap();
    let input = path.to_str().unwrap();
    let out = folder.text("out");
    let with = |exposure: &str| {
        let options = format!("{QUICK} --frames 1 {exposure}");
        let output = tool(&run(input, &out, &words(&options)));
        assert!(output.status.success());
        let report = read_json(&folder.path("out/report.json"));
        let shown = image::open(folder.path("out/none/000000.png")).unwrap().into_rgb8();
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let warned = String::from_utf8_lossy(&output.stderr).into_owned();
        (text, warned, report["exposure_ev"].as_f64().unwrap(), shown.get_pixel(8, 4).0[0])
    };
    // log2(0.18 / 1000) = -12.44
    let (_, warned, ev, shown) = with("");
    assert!(warned.contains("100 % of what is lit") && warned.contains("--exposure -12.4 fits"), "{warned}");
    assert_eq!((ev, shown), (0.0, 255));
    for exposure in ["auto", "-12.4"] {
        let (text, warned, ev, shown) = with(&format!("--exposure {exposure}"));
        assert_eq!(text.contains("exposure: -12.4 stops, from the first frame"), exposure == "auto", "{text}");
        assert!(!warned.contains("warning"), "{warned}");
        // 0.18 of white, encoded.
        assert!((ev + 12.4).abs() < 1e-5 && (115..=121).contains(&shown), "{ev} {shown}");
    }
    refuses(&run(input, &out, &["--exposure", "automatic"]), &["--exposure", "auto"]);
}
