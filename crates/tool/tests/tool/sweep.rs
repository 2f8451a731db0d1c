//! `afterimage sweep` as a process: files, resuming, errors.

use super::rig::{Folder, files, kill_once, read_json, refuses, succeeds, tool, words};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Three rounds (sizes of the fovea) of two methods on small frames; the first size has a third point.
const SMALL: &str = "sweep analytic:lateral --backend cpu --size 96x54 --frames 38 --axis method=none,smr \
                     --axis fovea=5,10,15 --switch no-flush";

fn sweep<'a>(out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    [&words(SMALL), more, &["--out", out]].concat()
}

#[track_caller]
fn run(out: &str, more: &[&str]) -> String {
    succeeds(&sweep(out, more))
}

fn table(out: &str) -> Value {
    read_json(&Path::new(out).join("sweep.json"))
}

/// Every point and its scores, without times, which differ between runs.
fn figures(out: &str) -> BTreeMap<String, String> {
    let table = table(out);
    let rows = table["rows"].as_array().unwrap().iter();
    rows.map(|row| {
        let figures =
            ["values", "samples_share", "bytes_per_pixel", "seeds", "label", "command", "rust"].map(|key| &row[key]);
        (row["id"].as_str().unwrap().to_owned(), serde_json::to_string(&figures).unwrap())
    })
    .collect()
}

/// The finished points in the folder of a sweep.
fn points(out: &Path) -> Vec<String> {
    let place = out.join("points");
    let names = if place.is_dir() { files(&place) } else { vec![] };
    names.into_iter().filter(|name| name.ends_with(".json") && !name.starts_with('.')).collect()
}

/// Kills a sweep once a round of it is finished. False if it ended first.
fn is_killed(out: &Path) -> bool {
    // Rounds have at most three points, so at least one is complete then, on any machine.
    kill_once(&sweep(out.to_str().unwrap(), &[]), || points(out).len() >= 3);
    let kept = points(out).len();
    println!("killed with {kept} of 7 points");
    assert!(kept >= 3, "a round was finished");
    kept < 7
}

#[test]
fn a_whole_sweep_is_that_of_parts_and_recommends_what_fits() {
    let folder = Folder::new();
    let whole = folder.text("whole");
    let said = run(&whole, &[]);
    assert!(said.contains("7 points, 7 to measure in 3 rounds"), "{said}");
    assert_eq!(figures(&whole).len(), 7);
    for name in ["sweep.csv", "sweep.json"] {
        assert!(folder.path("whole").join(name).exists(), "{name}");
    }
    one_that_is_killed_goes_on_and_ends_with_the_same_tables(&folder, &whole);
    shards_that_are_merged_are_the_whole_sweep(&folder, &whole);
    it_recommends_what_fits(&folder, &whole);
}

fn one_that_is_killed_goes_on_and_ends_with_the_same_tables(folder: &Folder, whole: &str) {
    // On a busy machine, a sweep may end before it is killed: then another one is.
    let names = ["killed", "killed again", "killed once more"];
    let name =
        names.into_iter().find(|name| is_killed(&folder.path(name))).expect("a sweep that is killed in the middle");
    let killed = folder.text(name);
    let points = || points(&folder.path(name));
    assert!(!folder.path(name).join("sweep.json").exists());
    let said = run(&killed, &[]);
    assert!(!said.contains("7 to measure"), "what was finished is not measured again: {said}");
    assert_eq!(figures(&killed), figures(whole));
    // Another run has nothing to do.
    assert!(run(&killed, &[]).contains("0 to measure"));
    // A round that was killed between writing its points is measured again completely, so that its times are from one
    // run.
    fs::remove_file(folder.path(name).join("points").join(&points()[0])).unwrap();
    let said = run(&killed, &[]);
    assert!(said.contains("in 1 rounds") && !said.contains(", 1 to measure"), "{said}");
    assert_eq!(figures(&killed), figures(whole));
}

fn shards_that_are_merged_are_the_whole_sweep(folder: &Folder, whole: &str) {
    let parts = ["1/2", "2/2"].map(|shard| {
        let part = folder.text(&shard.replace('/', "of"));
        run(&part, &["--shard", shard]);
        part
    });
    let counts = parts.each_ref().map(|part| figures(part).len());
    assert!(counts.iter().all(|&n| n > 0) && counts.iter().sum::<usize>() == 7, "{counts:?}");
    let [merged, other] = ["merged", "other"].map(|name| folder.text(name));
    succeeds(&["sweep", "--merge", &parts[0], &parts[1], "--out", &merged]);
    assert_eq!(figures(&merged), figures(whole));
    let pictures = |name: &str| files(&folder.path(name).join("pictures")).len();
    assert_eq!(pictures("merged"), pictures("whole"));

    run(&other, &["--set", "hfov=50", "--axis", "fovea=5"]);
    let line = format!("sweep --merge {merged} {other} --out {}", folder.text("no"));
    refuses(&words(&line), &["other", "is part of another sweep"]);
}

fn it_recommends_what_fits(folder: &Folder, whole: &str) {
    for (line, expected) in [
        ("--budget-ms 1e9 --renderer-ms 0", "afterimage run analytic:lateral --method smr"),
        ("--budget-ms 1e9 --renderer-ms 0", "let settings = Settings { foveation: Foveation {"),
        ("--budget-ms 0", "nothing costs 0 ms or less; the cheapest, none"),
        // Anything reaches 1 dB.
        ("--by psnr_db --target 1 --renderer-ms 0", "--method none"),
        ("--target-flip 0 --renderer-ms 0", "nothing is as good; the best is"),
    ] {
        let said = succeeds(&[&["sweep", "--out", whole], &words(line)[..]].concat());
        assert!(said.contains(expected), "{line}: {said}");
    }

    // The printed command gives the printed scores.
    let table = table(whole);
    let row = table["rows"].as_array().unwrap().iter().find(|r| r["method"] == "smr").unwrap();
    let command = format!("{} --out {}", row["command"].as_str().unwrap(), folder.text("again"));
    succeeds(&words(&command)[1..]);
    let report = read_json(&folder.path("again/report.json"));
    assert_eq!(report["methods"]["smr"]["flip"], row["values"]["flip"]);
    assert_eq!(report["methods"]["smr"]["psnr_db"], row["values"]["psnr_db"]);
}

/// Scores of quads are those of settled frames, as of `run --score-from`. The settings that the library names are
/// points of the preset, and called so.
#[test]
fn the_preset_of_quads_recommends_settings_by_their_names() {
    let folder = Folder::new();
    let out = folder.text("out");
    let line = format!(
        "sweep analytic:lateral --preset quads --backend cpu --size 64x36 --set hfov=40 --set reference-samples=1 \
         --set no-flip --out {out}"
    );
    succeeds(&words(&line));
    let table = table(&out);
    let rows = table["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 24);
    let of = |name: &str| {
        let named = |row: &&Value| row["rust"] == format!("{name}()");
        assert_eq!(rows.iter().filter(named).count(), 1, "{name}");
        rows.iter().find(named).unwrap()
    };
    let (screen, headset) = (of("Settings::screen"), of("Settings::headset"));
    assert!(screen["label"].as_str().unwrap().ends_with(", Settings::screen"), "{screen}");
    let share = |row: &Value| row["samples_share"].as_f64().unwrap();
    assert!(share(screen) < share(headset), "a wider fovea has more pixels");

    let again = folder.text("again");
    succeeds(&words(&format!("{} --out {again}", screen["command"].as_str().unwrap()))[1..]);
    let report = read_json(&folder.path("again/report.json"));
    assert_eq!(report["methods"]["smr"]["jod"], screen["values"]["jod"]);
    assert_eq!(report["methods"]["smr"]["shaded_share"], screen["samples_share"]);

    // Beside a renderer that slow the pass takes no time, so that what fits has at most as many pixels.
    let budget = format!("--by jod --renderer-ms 1e6 --budget-ms {}", 1e6 * share(screen) + 5e3);
    let said = succeeds(&[&["sweep", "--out", &out], &words(&budget)[..]].concat());
    assert!(said.contains("let settings = Settings::screen();"), "{said}");
    assert!(fs::read_to_string(folder.path("out/pareto.svg")).unwrap().contains(">\nSettings::screen\n<"));
}

#[test]
fn a_plan_in_a_file_is_read_and_a_wrong_one_refused() {
    let folder = Folder::new();
    let (plan, out, no) = (folder.text("plan.toml"), folder.text("out"), folder.text("no"));
    let text = "seeds = 2\n[common]\nframes = 38\nsize = \"64x36\"\nbackend = \"cpu\"\n[axes]\nmethod = [\"wrs\"]\n\
                \"rate-mid+rate-far\" = [\"2+4\"]\n[switches]\nof = [\"no-gate\"]\n";
    fs::write(&plan, text).unwrap();
    succeeds(&["sweep", "analytic:lateral", "--file", &plan, "--out", &out]);
    let table = table(&out);
    let rows = table["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 2);
    assert!(rows.iter().all(|r| r["seeds"] == 2 && r["command"].as_str().unwrap().contains("--rate-far 4")));
    assert_eq!(table["prices"][0]["switch"], "no-gate");

    let ten = "[1,2,3,4,5,6,7,8,9,10]";
    let axes = ["fovea", "mid", "blend", "smr-tolerance", "exposure", "hfov"].map(|axis| format!("{axis} = {ten}\n"));
    let many = format!("[axes]\n{}", axes.concat());
    let wrong = [
        ("seeds = 0", "expected 1 to 1000"),
        ("axis = 3", "is no plan of a sweep"),
        ("[axes]\nmethod = []", "has no values"),
        ("[axes]\nout = [\"x\"]", "is set by the sweep itself"),
        ("[axes]\nmethod = [\"tsr\"]", "possible values: none, taa"),
        ("[axes]\nfove = [5]", "unexpected argument '--fove'"),
        ("[axes]\nmethod = [\"none\"]\n[common]\nframes = 37", "too few; expected at least 38"),
        (&many, "more than 100000 combinations"),
    ];
    for (text, words) in wrong {
        fs::write(&plan, text).unwrap();
        refuses(&["sweep", "analytic:lateral", "--file", &plan, "--out", &no], &[words]);
    }
    assert!(!folder.path("no").exists(), "all points are checked before the first is measured");
    let missing = ["sweep", "analytic:lateral", "--file", &folder.text("missing.toml"), "--out", &no];
    refuses(&missing, &["missing.toml", "cannot be read"]);
}

/// Traced samples are independent and, where every pixel has samples, unbiased. So the squared error of single frames
/// falls with their number in the fovea of every pattern, and in the whole frame with uniform samples. Interpolation
/// between samples is biased, most of all beside the lamp, which is brighter than the output range: there, more samples
/// help least.
#[test]
fn traced_patterns_converge_with_samples() {
    let folder = Folder::new();
    let out = folder.text("out");
    let line = format!(
        "sweep builtin:cornell --preset convergence --size 32x24 --gaze 16,12 --frames 38 --backend cpu \
         --set reference-samples=1024 --set no-flip --set no-jod --out {out}"
    );
    succeeds(&words(&line));
    let table = table(&out);
    let all = table["convergences"].as_array().unwrap();
    assert_eq!(all.len(), 8, "four patterns, with and without history");
    let slopes = |method: &str, pattern: &str| {
        let of = |c: &&Value| {
            c["method"] == method && c["label"].as_str().unwrap().ends_with(&format!("sampling {pattern}"))
        };
        let slopes = all.iter().find(of).unwrap()["slope_by_samples"].as_array().unwrap();
        [slopes[0].as_f64().unwrap(), slopes[1].as_f64().unwrap()]
    };
    let uniform = slopes("none", "uniform");
    for pattern in ["uniform", "regions", "layers", "acuity"] {
        let [frame, fovea] = slopes("none", pattern);
        println!("{pattern}: frame {frame:.2}, fovea {fovea:.2}");
        assert!(fovea < -0.5, "{pattern}");
        assert!(pattern == "uniform" || frame > uniform[0] + 0.3, "{pattern}: bias stays");
    }
    assert!(uniform[0] < -0.5 && slopes("smr", "uniform")[0] < -0.5);
    let text = fs::read_to_string(folder.path("out/sweep.md")).unwrap();
    assert!(text.contains("sampling uniform: slopes"), "{text}");
}

#[test]
fn another_sweep_is_not_mixed_in_and_what_is_no_sweep_is_refused() {
    let folder = Folder::new();
    let (out, empty) = (&folder.text("out"), &folder.text(""));
    run(out, &["--axis", "fovea=5", "--axis", "method=none"]);
    let before = figures(out);
    refuses(&sweep(out, &["--start", "0.5"]), &["holds a sweep that was made with"]);
    assert_eq!(figures(out), before);
    // Points with the same frames may be added.
    run(out, &["--axis", "fovea=5,10", "--axis", "method=none"]);
    assert_eq!(figures(out).len(), 2);
    refuses(&["sweep", "--out", empty], &["holds no sweep"]);
    refuses(&["sweep", "nowhere.exr", "--out", empty], &["nowhere.exr", "does not exist"]);
    for (shard, words) in [("0/2", "1 <= I <= N"), ("3/2", "1 <= I <= N"), ("x", "2/8")] {
        refuses(&["sweep", "x.exr", "--out", empty, "--shard", shard], &[words]);
    }
    refuses(&["sweep", "--out", empty, "--by", "beauty"], &["expected one of jod, flip, psnr_db"]);
}

#[cfg(unix)]
#[test]
fn a_full_disk_and_an_unwritable_folder_are_clear_errors() {
    let folder = Folder::new();
    refuses(&sweep(&folder.write("file", b"x"), &[]), &["cannot be written", "give --out a folder"]);

    // Limit files to 1 KiB to simulate a full disk. The signal is ignored, so that writing fails.
    let out = folder.text("out");
    let one = ["--axis", "method=none", "--axis", "fovea=5"];
    let command = sweep(&out, &one).join(" ");
    let script = format!("trap '' XFSZ; ulimit -f 2; exec {} {command}", env!("CARGO_BIN_EXE_afterimage"));
    let output =
        Command::new("sh").args(["-c", &script]).current_dir(afterimage_testing::workspace()).output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(1) && stderr.lines().count() == 1, "{stderr}");
    assert!(stderr.contains("cannot be written") && stderr.contains("free space or choose another --out"), "{stderr}");
    // No partial file remains, and the sweep resumes when there is space.
    assert_eq!(["out/points", "out/pictures"].map(|part| files(&folder.path(part))), [[""; 0]; 2]);
    run(&out, &one);
    assert_eq!(figures(&out).len(), 1);
}

#[test]
fn points_are_compared_by_what_was_measured() {
    let folder = Folder::new();
    let out = folder.text("sweep");
    let small = "sweep analytic:scroll --backend cpu --size 48x27 --frames 38 --axis method=none,smr --set no-flip=on";
    let command = [&words(small)[..], &["--out", &out]].concat();
    let said = succeeds(&command);
    assert!(said.contains("FLIP was not measured; points are compared by JOD (--by jod)"), "{said}");
    assert!(said.contains("best JOD for its cost") && said.contains("smr"), "{said}");
    let plot = fs::read_to_string(folder.path("sweep/pareto.svg")).unwrap();
    assert!(plot.contains("JOD; higher is better") && plot.matches("class=\"point\"").count() == 2, "{plot}");
    let tables = fs::read_to_string(folder.path("sweep/sweep.md")).unwrap();
    assert!(tables.contains("| JOD |") && !tables.contains("JOD JOD"), "{tables}");
    let neither = folder.text("neither");
    let neither = [&words(small)[..], &["--set", "no-jod=on", "--out", &neither]].concat();
    assert!(succeeds(&neither).contains("compared by PSNR (--by psnr_db)"));
    let target = tool(&[&command[..], &["--target", "0.1"]].concat());
    let refused = String::from_utf8(target.stderr).unwrap();
    assert!(target.status.code() == Some(2) && refused.contains("FLIP was not measured"), "{refused}");
    assert!(refused.contains("--by jod"), "{refused}");
}
