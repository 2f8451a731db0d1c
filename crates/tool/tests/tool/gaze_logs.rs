//! Gaze logs of eye trackers on the command line.

use super::rig::{Folder, refuses, succeeds, tool, words};
use std::fs;
#[cfg(unix)]
use std::{path::Path, process::Command};

const SDK: &[u8] = b"device_time_stamp,left_gaze_point_on_display_area_x,left_gaze_point_on_display_area_y,\
    left_gaze_point_validity\n1000000,0.5,0.25,1\n1010000,0.25,0.75,1\n1020000,nan,nan,0\n";

/// Output and errors of a command that succeeds.
#[track_caller]
fn both(args: &[&str]) -> (String, String) {
    let output = tool(args);
    assert!(output.status.success(), "{output:?}");
    (String::from_utf8(output.stdout).unwrap(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn an_export_is_read_as_it_is_and_converted() {
    let folder = Folder::new();
    let log = folder.write("recording.CSV", SDK);
    let out = folder.text("out.csv");
    let command = ["scanpath", "--from", "tobii", &log, "--out", &out];
    let (text, errors) = both(&command);
    assert!(text.contains("0.020 s, 3 samples (1 lost), from tobii"), "{text}");
    assert!(errors.contains("give --screen-mm WxH and --distance-mm D"), "{errors}");
    let screen = ["--screen-px", "2000x1000", "--screen-mm", "500x250", "--distance-mm", "700"];
    let (_, errors) = both(&[&command[..], &screen].concat());
    assert_eq!(errors, "");
    let written = fs::read_to_string(&out).unwrap();
    assert!(written.contains("# screen_px: 2000x1000\n# screen_cm: 50x25\n# distance_cm: 70\n"), "{written}");
    assert!(written.ends_with("t_s,x_px,y_px,valid\n0,1000,250,1\n0.01,500,750,1\n0.02,nan,nan,0\n"), "{written}");
    // The log itself and what it was converted to give the same gaze: 0.5, 0.25 of 64x36 from the middle of a pixel.
    let [direct, converted] = [&log, &out].map(|gaze| {
        let small = "run analytic:scroll --size 64x36 --frames 2 --method none --no-jod --no-flip --gaze-map fit";
        both(&words(&format!("{small} --gaze {gaze} --out {}", folder.text("run"))));
        fs::read_to_string(folder.path("run/gaze.csv")).unwrap()
    });
    assert_eq!(direct, converted);
    assert!(direct.contains("0,31.500,8.500"), "{direct}");
    let text = succeeds(&["info", &log]);
    assert!(["--from tobii", "samples: 3 (1 lost)", "warning: "].iter().all(|words| text.contains(words)), "{text}");
}

#[test]
fn what_a_log_lacks_is_asked_for_in_one_line() {
    let folder = Folder::new();
    let page = folder.write("page.csv", b"x,y,t\n960,540,0\n970,540,33.3\n");
    let out = folder.text("out.csv");
    for command in [&["scanpath", &page, "--out", &out][..], &["info", &page]] {
        refuses(command, &["page.csv", "size of the screen", "--screen-px WxH", "--screen-mm WxH"]);
    }
    refuses(&["run", "analytic:scroll", "--gaze", &page, "--out", &folder.text("run")], &["--screen-px WxH"]);
    succeeds(&["info", &page, "--screen-px", "1920x1080"]);
    let sweep = "sweep analytic:scroll --backend cpu --size 32x18 --frames 38 --axis method=none";
    let points = folder.text("sweep");
    let sweep = [&words(sweep)[..], &["--gaze", &page, "--out", &points]].concat();
    // It says its plan before it reads the log.
    let refused = tool(&sweep);
    let errors = String::from_utf8_lossy(&refused.stderr);
    assert!(refused.status.code() == Some(2) && errors.contains("--screen-px WxH"), "{errors}");
    both(&[&sweep[..], &["--screen-px", "1920x1080"]].concat());
    let angle = ["run", "analytic:scroll", "--gaze", &page, "--screen-px", "1920x1080", "--gaze-map", "angle"];
    refuses(&[&angle[..], &["--out", &folder.text("run")]].concat(), &["--gaze-map fit", "--screen-mm WxH"]);
    refuses(&["scanpath", &page, "--seconds", "3", "--out", &out], &["--seconds"]);
    refuses(&["scanpath", "--screen-mm", "5x5", "--out", &out], &["--screen-mm", "not a gaze log"]);
    refuses(&["run", "analytic:scroll", "--gaze", "3,4", "--eye", "left", "--out", &out], &["--eye", "--gaze 3,4"]);
    refuses(&["info", "analytic:scroll", "--screen-px", "8x8"], &["--screen-px", "analytic:scroll"]);
}

/// Times in milliseconds would be a clip of an hour: `run` says so before it makes the folder.
#[test]
fn a_run_does_not_start_with_times_that_are_hardly_seconds() {
    let folder = Folder::new();
    let head = "# screen_px: 1920x1080\n# screen_cm: 53x30\n# distance_cm: 65\nt_s,x_px,y_px,valid\n";
    let log = |name: &str, step: f64| {
        let rows: String = (0..90).map(|i| format!("{},{},500,1\n", f64::from(i) * step, 900 + i)).collect();
        folder.write(name, format!("{head}{rows}").as_bytes())
    };
    let (milliseconds, seconds, slow) = (log("ms.csv", 16.0), log("s.csv", 0.016), log("slow.csv", 0.5));
    let out = folder.text("out");
    let command = format!("run analytic:still --size 32x18 --method none --backend cpu --no-jod --no-flip --out {out}");
    let command = words(&command);
    let said =
        ["ms.csv: 90 samples in 1424.000 s are 0.06 a second", "milliseconds?", "--frames (85441 for all of it)"];
    refuses(&[&command[..], &["--gaze", &milliseconds]].concat(), &said);
    // One wrong time: more frames than there are numbers.
    let wrong = folder.write("wrong.csv", format!("{head}0,1,1,1\n0.004,2,2,1\n0.008,3,3,1\n7e20,4,4,1\n").as_bytes());
    let said =
        ["wrong.csv: no sample for 7.000e20 s after 0.008 s; is a time wrong?", "--frames (18446744073709551615"];
    refuses(&[&command[..], &["--gaze", &wrong]].concat(), &said);
    assert!(!folder.path("out").exists());
    // A number of frames, times in seconds, and few samples in a short clip.
    for (gaze, more, warned) in
        [(&milliseconds, &["--frames", "2"][..], true), (&seconds, &[], false), (&slow, &["--start", "44"], true)]
    {
        let (_, errors) = both(&[&command[..], &["--gaze", gaze], more].concat());
        assert_eq!(errors.contains("milliseconds?"), warned, "{errors}");
    }
}

#[test]
fn units_that_nobody_states_are_found_or_doubted() {
    let folder = Folder::new();
    let rows: String = (0..120).map(|i| format!("{:.4},{},500\n", f64::from(i) / 60.0, 900 + i)).collect();
    let log = folder.write("unity.csv", format!("Time,GazeX,GazeY\n{rows}").as_bytes());
    let text = succeeds(&["info", &log, "--screen-px", "1920x1080"]);
    assert!(text.contains("scanpath of 1.983 s") && !text.contains("a second"), "{text}");
    // A name that says milliseconds is believed, and doubted.
    let log = folder.write("ms.csv", format!("t_ms,x,y\n{rows}").as_bytes());
    let text = succeeds(&["info", &log, "--screen-px", "1920x1080"]);
    assert!(text.contains("120 samples in 0.002 s are 59") && text.contains("another unit"), "{text}");
    let run = "run analytic:still --size 64x36 --frames 1 --method none --backend cpu --no-jod --no-flip";
    for (gaze, is_share) in [("0.5,0.25", true), ("0,0", false), ("1,1", false), ("32.5,0.5", false)] {
        let (_, errors) = both(&[&words(run)[..], &["--gaze", gaze, "--out", &folder.text("out")]].concat());
        assert_eq!(errors.contains("for this share of the frame give 32,9"), is_share, "{gaze}: {errors}");
    }
}

#[test]
fn columns_are_named_on_the_command_line() {
    let folder = Folder::new();
    let rows: String = (0..60).map(|i| format!("{},-6.0,1.8,0\n", 8 * i)).collect();
    let log = folder.write("gazebase.csv", format!("n,x,y,val\n{rows}").as_bytes());
    refuses(&["info", &log], &["gazebase.csv", "name the columns with --gaze-columns t=NAME,x=NAME,y=NAME"]);
    let columns = "--gaze-columns t=n,x=x,y=y,valid=!val --gaze-unit deg --time-unit ms";
    let text = succeeds(&[&["info", &log][..], &words(columns)].concat());
    assert!(text.contains("scanpath of 0.472 s") && text.contains("samples: 60 (0 lost)"), "{text}");
    let out = folder.text("out.csv");
    both(&[&["scanpath", &log, "--out", &out][..], &words(columns)].concat());
    // The screen of angles has 2000 pixels for 100 degrees; y is up.
    let px = fs::read_to_string(&out).unwrap().lines().last().unwrap().split(',').map(String::from).collect::<Vec<_>>();
    let at = |degrees: f64, i: usize| {
        1000.0 + 1000.0 * degrees.to_radians().tan() / 50f64.to_radians().tan() - px[i].parse::<f64>().unwrap()
    };
    assert!(at(-6.0, 1).abs() < 0.1 && at(-1.8, 2).abs() < 0.5, "{px:?}");
    for bad in ["t=n,x=x", "t=n,x=x,y=y,w=z", "t=n,x=x,x=y", "t=n,x=,y=y"] {
        refuses(&["info", &log, "--gaze-columns", bad], &["--gaze-columns", "expected t=NAME,x=NAME,y=NAME"]);
    }
    refuses(&["info", &log, "--gaze-columns", "t=n,x=u,y=y"], &["has no column \"u\"", "it has n, x, y, val"]);
    refuses(&["info", &log, "--gaze-unit", "deg"], &["--gaze-columns"]);
    let fixed = ["run", "analytic:still", "--gaze", "3,4", "--gaze-columns", "t=n,x=x,y=y", "--out", &out];
    refuses(&fixed, &["--gaze-columns", "not a gaze log"]);
}

/// The recipe of docs/gaze-logs.md, run as it is written.
#[cfg(unix)]
#[test]
fn a_layout_reads_a_whole_data_set() {
    let docs = fs::read_to_string(afterimage_testing::workspace().join("docs/gaze-logs.md")).unwrap();
    let block = |name: &str| {
        let (_, after) = docs.split_once(&format!("<!-- {name} -->\n\n")).unwrap();
        after
            .lines()
            .take_while(|line| line.starts_with("    "))
            .map(|line| format!("{}\n", &line[4..]))
            .collect::<String>()
    };
    let folder = Folder::new();
    fs::create_dir(folder.path("recordings")).unwrap();
    for subject in 1..=3 {
        let rows: String = (0..60).map(|i| format!("{},-6.0,1.8,{}\n", 8 * i, i32::from(i == 7))).collect();
        folder.write(&format!("recordings/S_{subject} a.csv"), format!("n,x,y,val\n{rows}").as_bytes());
    }
    let layout = folder.write("gazebase.json", block("layout").as_bytes());
    let bin = Path::new(super::rig::TOOL.0).parent().unwrap();
    let path = format!("{}:{}", bin.display(), std::env::var("PATH").unwrap());
    let mut shell = Command::new("sh");
    shell.args(["-ec", &block("recipe")]).current_dir(folder.path("")).env("PATH", path).env("NODEVICE_SELECT", "1");
    let ran = shell.output().unwrap();
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    assert_eq!(super::rig::files(&folder.path("scanpaths")), ["S_1 a.csv", "S_2 a.csv", "S_3 a.csv"]);
    // The same as with the options.
    let log = folder.text("recordings/S_1 a.csv");
    let columns = "--gaze-columns t=n,x=x,y=y,valid=!val --gaze-unit deg --time-unit ms --screen-px 1680x1050 \
                   --screen-mm 474x297 --distance-mm 550";
    let out = folder.text("out.csv");
    both(&[&["scanpath", &log, "--out", &out][..], &words(columns)].concat());
    let layout_says = fs::read_to_string(folder.path("scanpaths/S_1 a.csv")).unwrap();
    assert_eq!(layout_says, fs::read_to_string(&out).unwrap());
    assert!(layout_says.contains("1680x1050"), "{layout_says}");
    // An option replaces what the file says.
    let scanpath = ["scanpath", &log, "--gaze-layout", &layout, "--out", &out];
    both(&[&scanpath[..], &["--screen-px", "840x525"]].concat());
    assert!(fs::read_to_string(&out).unwrap().contains("840x525"));
    refuses(&[&scanpath[..], &["--gaze-columns", "t=n,x=x,y=y"]].concat(), &["--gaze-layout", "cannot be used with"]);
    let fixed = ["run", "analytic:still", "--gaze", "3,4", "--gaze-layout", &layout, "--out", &out];
    refuses(&fixed, &["--gaze-layout", "not a gaze log"]);
}

#[test]
fn layouts_name_the_field_that_is_wrong() {
    let folder = Folder::new();
    let log = folder.write("log.csv", b"n,x,y\n0,1,2\n8,1,2\n");
    let columns = r#""columns": {"t": "n", "x": "x", "y": "y"}"#;
    for (json, words) in [
        (r#"{"columns": {"t": "n", "x": "x"}}"#.to_owned(), "`columns.y` is missing"),
        (r#"{"columns": {"t": "n", "x": 4, "y": "y"}}"#.to_owned(), "`columns.x` is 4; expected the name of a column"),
        (
            r#"{"columns": {"t": "n", "x": "x", "y": "y", "w": "y"}}"#.to_owned(),
            "`columns.w` is no field; expected t, x, y",
        ),
        (r#"{"columns": "t=n"}"#.to_owned(), "`columns` is \"t=n\"; expected an object"),
        (format!(r#"{{{columns}, "unit": "pixels"}}"#), "`unit` is \"pixels\"; expected \"px\", \"norm\", \"deg\""),
        (format!(r#"{{{columns}, "time_unit": 1000}}"#), "`time_unit` is 1000; expected \"auto\", \"s\", \"ms\""),
        (
            format!(r#"{{{columns}, "screen_px": "1920x1080"}}"#),
            "`screen_px` is \"1920x1080\"; expected [WIDTH, HEIGHT]",
        ),
        (format!(r#"{{{columns}, "screen_px": [0, 5]}}"#), "`screen_px` is [0,5]"),
        (format!(r#"{{{columns}, "screen_mm": [5.5]}}"#), "`screen_mm` is [5.5]"),
        (
            format!(r#"{{{columns}, "distance_mm": -1}}"#),
            "`distance_mm` is -1; expected a number of millimeters above 0",
        ),
        (format!(r#"{{{columns}, "eye": "middle"}}"#), "`eye` is \"middle\"; expected \"both\", \"left\", \"right\""),
        (format!(r#"{{{columns}, "columns2": 1}}"#), "`columns2` is no field; expected columns, unit"),
        (r#"{"unit": "deg"}"#.to_owned(), "`unit` is that of `columns`, which is missing"),
        ("[1]".to_owned(), "holds no JSON object"),
        ("{".to_owned(), "is no JSON"),
    ] {
        let layout = folder.write("layout.json", json.as_bytes());
        refuses(&["info", &log, "--gaze-layout", &layout], &["--gaze-layout", "layout.json", words]);
    }
    refuses(&["info", &log, "--gaze-layout", "no/such.json"], &["--gaze-layout", "no/such.json", "cannot be read"]);
    let layout = folder
        .write("layout.json", format!("{{{columns}, \"time_unit\": \"ms\", \"screen_px\": [640, 480]}}").as_bytes());
    assert!(succeeds(&["info", &log, "--gaze-layout", &layout]).contains("640x480"));
}
