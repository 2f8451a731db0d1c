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

/// A rename would replace what is no regular file, and a link.
#[cfg(unix)]
#[test]
fn devices_pipes_and_links_are_written_and_stay() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    use std::process::{Command, Stdio};
    let folder = Folder::new();
    let command = "scanpath --seconds 1 --out";
    let plain = folder.text("plain.csv");
    succeeds(&[&words(command)[..], &[&plain]].concat());
    let expected = fs::read_to_string(&plain).unwrap();
    assert!(expected.starts_with("# task") && expected.lines().count() > 500);
    // Links to a file, to one that does not exist yet, and to a link.
    let [old, new] = ["old.csv", "new.csv"].map(|name| folder.path(name));
    fs::write(&old, "old").unwrap();
    for (link, target) in [("to_old", "old.csv"), ("to_new", "new.csv"), ("to_link", "to_old")] {
        symlink(target, folder.path(link)).unwrap();
        succeeds(&[&words(command)[..], &[&folder.text(link)]].concat());
        assert!(folder.path(link).is_symlink());
    }
    assert!([old, new].iter().all(|file| fs::read_to_string(file).unwrap() == expected));
    symlink("circle", folder.path("circle")).unwrap();
    refuses(&[&words(command)[..], &[&folder.text("circle")]].concat(), &["too many links", "--out"]);
    // A pipe with a reader.
    let pipe = folder.text("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let reader = Command::new("cat").arg(&pipe).stdout(Stdio::piped()).spawn().unwrap();
    succeeds(&[&words(command)[..], &[&pipe]].concat());
    assert_eq!(String::from_utf8(reader.wait_with_output().unwrap().stdout).unwrap(), expected);
    assert!(fs::symlink_metadata(&pipe).unwrap().file_type().is_fifo());
    // The program's own output, by a link: rows alone, also in a file behind what is there.
    symlink("/dev/stdout", folder.path("stdout")).unwrap();
    let stdout = folder.text("stdout");
    let to_stdout = [&words(command)[..], &[&stdout]].concat();
    let output = tool(&to_stdout);
    assert_eq!(String::from_utf8(output.stdout).unwrap(), expected);
    assert!(String::from_utf8_lossy(&output.stderr).contains("fixations"));
    let appended = folder.path("appended.csv");
    fs::write(&appended, "before\n").unwrap();
    let file = fs::OpenOptions::new().append(true).open(&appended).unwrap();
    let mut again = Command::new(env!("CARGO_BIN_EXE_afterimage"));
    let status = again.args(&to_stdout).stdout(file).stderr(Stdio::null()).status().unwrap();
    assert!(status.success() && folder.path("stdout").is_symlink());
    assert_eq!(fs::read_to_string(&appended).unwrap(), format!("before\n{expected}"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_device_is_an_error_of_the_work() {
    let folder = Folder::new();
    std::os::unix::fs::symlink("/dev/full", folder.path("full")).unwrap();
    let full = folder.text("full");
    let output = tool(&["scanpath", "--seconds", "60", "--out", &full]);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{errors}");
    assert!(errors.contains("No space left on device") && errors.lines().count() == 1, "{errors}");
    assert!(folder.path("full").is_symlink());
}
