//! `afterimage run --pixel`.

use super::rig::{Folder, SMALL, ran, refuses, run, words};

/// Rows of `pixel.csv` of a frame and method, as (stage, name, values).
fn rows(csv: &str, frame: &str, method: &str) -> Vec<(String, String, String)> {
    let begin = format!("{frame},{method},");
    let of = csv.lines().filter_map(|line| line.strip_prefix(&begin)).map(|line| {
        let unquoted =
            line.split('"').enumerate().map(|(i, part)| if i % 2 == 1 { part.replace(',', ";") } else { part.into() });
        let cells: Vec<String> = unquoted.collect::<String>().split(',').map(str::to_owned).collect();
        assert_eq!(cells.len(), 4, "{line}");
        (cells[0].clone(), cells[1].clone(), cells[3].clone())
    });
    of.collect()
}

fn value<'a>(rows: &'a [(String, String, String)], stage: &str, name: &str) -> Option<&'a str> {
    rows.iter().find(|row| row.0 == stage && row.1 == name).map(|row| row.2.as_str())
}

/// Whether the notes of a frame say the color that the frame has at the pixel, as bytes of its PNG.
fn says_what_is_shown(rows: &[(String, String, String)], png: &std::path::Path, [x, y]: [u32; 2]) -> bool {
    let shown = image::open(png).unwrap().to_rgb8().get_pixel(x, y).0;
    let color: Vec<f64> = value(rows, "shown", "color").unwrap().split(' ').map(|v| v.parse().unwrap()).collect();
    let encoded = |v: f64| if v <= 0.0031308 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 };
    color.iter().zip(shown).all(|(v, byte)| (255.0 * encoded(*v).clamp(0.0, 1.0) - f64::from(byte)).abs() < 0.75)
}

#[test]
fn a_pixel_is_explained_frame_by_frame_for_every_method() {
    for (foveation, methods) in [("mip", "none,wrs,smr,taa,taau"), ("planned", "wrs,taau,smr")] {
        let asked = format!("--method {methods} --foveation {foveation} --gaze 100,60 --no-flip");
        let out = ran("analytic:lateral", &format!("{SMALL} {asked} --pixel 40,30 --pixel-frames 2..3"));
        let csv = out.text("pixel.csv");
        assert!(csv.starts_with("frame,method,stage,name,unit,values\n"), "{csv}");
        for method in methods.split(',') {
            for frame in ["2", "3"] {
                assert!(out.said.contains(&format!("frame {frame}, pixel 40,30, {method}\n")), "{}", out.said);
                let rows = rows(&csv, frame, method);
                let at = |name: &str| value(&rows, "input", name);
                assert_eq!(at("gaze"), Some("100 60"), "{foveation}, {method}");
                // 60 and 30 pixels from the gaze; 160 pixels over 70 degrees.
                let e_deg: f64 = at("distance from the gaze").unwrap().parse().unwrap();
                assert!((25.0..33.0).contains(&e_deg), "{e_deg}");
                let png = out.path(&format!("{method}/00000{frame}.png"));
                assert!(says_what_is_shown(&rows, &png, [40, 30]), "{foveation}, {method}: {rows:?}");
                let notes = [("verdict", "history"), ("decision", "history's share"), ("stored", "words")];
                for (stage, name) in notes.into_iter().filter(|_| method != "none") {
                    assert!(value(&rows, stage, name).is_some(), "{foveation}, {method}: {stage} {name}");
                }
            }
            assert!(rows(&csv, "1", method).is_empty(), "only the frames that were asked for");
        }
        // A planted error: notes of another pixel's picture.
        let rows = rows(&csv, "3", "smr");
        let png = out.path("smr/000003.png");
        let caught = (0..20).filter(|x| !says_what_is_shown(&rows, &png, [8 * x, 70])).count();
        println!("{foveation}: the color of {caught} of 20 other pixels is told apart");
        assert!(caught >= 15, "{foveation}: {caught}");
    }
}

#[test]
fn without_frames_the_last_one_is_explained_and_nothing_else_changes() {
    let asked = "--size 160x90 --frames 3 --method smr --backend cpu --no-jod --no-flip";
    let [plain, explained] = ["", "--pixel 0,89"].map(|pixel| ran("analytic:occluder", &format!("{asked} {pixel}")));
    assert!(!plain.said.contains("pixel 0,89") && !plain.path("pixel.csv").exists());
    let said = &explained.said;
    assert!(said.matches("pixel 0,89").count() == 1 && said.contains("frame 2, pixel 0,89, smr\n"), "{said}");
    for frame in ["smr/000000.png", "smr/000002.png"] {
        assert!(plain.bytes(frame) == explained.bytes(frame), "{frame}");
    }
}

#[test]
fn a_pixel_that_cannot_be_explained_is_refused_in_one_line() {
    let folder = Folder::new();
    let out = folder.text("out");
    for (more, said) in [
        ("--pixel 160,0", &["--pixel 160,0", "160x90", "0 to 159", "0 to 89"][..]),
        ("--pixel 0,90", &["--pixel 0,90", "0 to 89"]),
        ("--pixel 3", &["--pixel", "X,Y"]),
        ("--pixel -1,3", &["--pixel"]),
        ("--pixel 3,3 --pixel-frames 2..4", &["--pixel-frames 2..4", "4 frames", "0 to 3"]),
        ("--pixel 3,3 --pixel-frames 2..1", &["--pixel-frames", "A..B"]),
        ("--pixel-frames 2..3", &["--pixel"]),
        ("--pixel 3,3 --backend gpu", &["--pixel", "bit for bit", "leave --backend gpu out"]),
    ] {
        refuses(&run("analytic:still", &out, &words(&format!("{SMALL} {more}"))), said);
    }
    assert!(!folder.path("out").exists(), "nothing was written");
}
