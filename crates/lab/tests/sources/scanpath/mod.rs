//! Scanpaths: files, resampling to frames, and the statistics of synthetic ones.
//!
//! `cargo test -p afterimage-lab --test sources -- --ignored write_fixture` rewrites `fixtures/scanpath_viewing.csv`
//! and `fixtures/scanpath_headset.csv`.

use crate::shared_data::shared_data;
use afterimage::ViewGeometry;
use afterimage_lab::error::InputError;
use afterimage_lab::scanpath::*;
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

mod dialects;
mod frames;
mod gaze_logs;
mod head;
mod statistics;

const HEADER: &str = "# screen_px: 1024x768\n# screen_cm: 38.0x30.0\n# distance_cm: 67\nt_s,x_px,y_px,valid\n";
const VIEW_PX: [u32; 2] = [640, 360];

fn fixture() -> PathBuf {
    afterimage_testing::workspace().join("fixtures/scanpath_viewing.csv")
}

fn view() -> ViewGeometry {
    ViewGeometry::flat(VIEW_PX, 70.0).unwrap()
}

fn parse(rows: &str) -> Result<Scanpath, InputError> {
    parse_csv("gaze.csv", format!("{HEADER}{rows}").as_bytes())
}

fn screen(known: bool) -> Screen {
    Screen { size_px: [1024, 768], size_cm: known.then_some([38.0, 30.0]), distance_cm: known.then_some(67.0) }
}

fn path_of(samples: Vec<Sample>) -> Result<Scanpath, InputError> {
    Scanpath::new("test", screen(true), About::default(), samples)
}

fn at(t_s: f64, px: [f32; 2]) -> Sample {
    Sample { t_s, px: Some(px) }
}

/// Name, samples, lost samples: the table in the data's README.
const RECORDED: [(&str, usize, usize); 6] = [
    ("reading_1250hz_clean.csv", 20_000, 0),
    ("reading_1250hz_blinks.csv", 22_500, 521),
    ("reading_250hz_noisy.csv", 5_000, 188),
    ("image_500hz.csv", 4_987, 123),
    ("image_500hz_lost.csv", 4_988, 450),
    ("video_500hz_pursuit.csv", 10_000, 88),
];

#[test]
fn recorded_files_and_the_fixture_read_as_their_table_says() {
    let path = read_csv(fixture()).unwrap();
    assert_eq!((path.samples().len(), path.lost()), (1500, 0));
    let Some(folder) = shared_data("scanpaths") else { return };
    for (name, samples, lost) in RECORDED {
        let path = read_csv(folder.join(name)).unwrap();
        assert_eq!((path.samples().len(), path.lost()), (samples, lost), "{name}");
        let screen = path.screen();
        let is_known = name != "reading_250hz_noisy.csv";
        assert_eq!((screen.size_px, screen.tangent_per_px().is_some()), ([1024, 768], is_known));
        let rate: f64 = name.split('_').find_map(|w| w.split("hz").next()?.parse().ok()).unwrap();
        assert_eq!(path.about().rate_hz, Some(rate));
        // H63: lost samples and outliers of real trackers give finite pixels in every frame after the first valid
        // sample.
        let gaze = FrameGaze::new(&path, &view(), GazeMap::default_for(path.screen()), 0.0, 60.0).unwrap();
        let first_valid = path.samples().iter().find(|s| s.px.is_some()).unwrap().t_s;
        for i in 0..gaze.frames() {
            let px = gaze.px(i);
            assert_eq!(px.is_none(), (i as f64 / 60.0) < first_valid, "{name}, frame {i}");
            assert!(px.unwrap_or_default().iter().all(|v| v.is_finite()));
        }
        assert_eq!(parse_csv(path.name(), &csv(&path)).unwrap(), path, "{name} round trip");
    }
}

#[test]
#[ignore = "writes fixtures/scanpath_viewing.csv and fixtures/scanpath_headset.csv"]
fn write_fixture() {
    std::fs::write(fixture(), csv(&fixture_path())).unwrap();
    std::fs::write(head::fixture(), csv(&head::fixture_path())).unwrap();
}

#[test]
fn the_fixtures_are_what_the_generators_make() {
    let all = [(fixture(), fixture_path(), 100_000), (head::fixture(), head::fixture_path(), 200_000)];
    for (file, made, most_bytes) in all {
        let read = read_csv(&file).unwrap();
        assert_eq!((read.about(), read.samples().len()), (made.about(), made.samples().len()));
        for (a, b) in read.samples().iter().zip(made.samples()) {
            let (p, q) = (a.px.unwrap(), b.px.unwrap());
            // Not bit for bit: sines may differ in the last digit on another platform.
            assert!(a.t_s == b.t_s && (p[0] - q[0]).abs() < 1e-2 && (p[1] - q[1]).abs() < 1e-2, "{p:?} {q:?}");
        }
        let poses = |path: &Scanpath| path.poses().unwrap_or_default().to_vec();
        for (a, b) in poses(&read).iter().zip(&poses(&made)) {
            let apart = a.space_from_head() - b.space_from_head();
            assert!(apart.to_cols_array().iter().all(|v| v.abs() < 1e-5));
        }
        assert_eq!(poses(&read).len(), poses(&made).len());
        assert!(std::fs::metadata(file).unwrap().len() < most_bytes);
    }
}

fn fixture_path() -> Scanpath {
    let options = SyntheticOptions { seed: 1, duration_s: 6.0, rate_hz: 250.0, ..Default::default() };
    generate(&options).unwrap().path
}

fn csv(path: &Scanpath) -> Vec<u8> {
    let mut out = Vec::new();
    write_csv(path, &mut out).unwrap();
    out
}

#[test]
fn bad_files_are_refused_in_one_line_that_says_where() {
    let cases: [(&str, &str); 13] = [
        ("", "there is no sample"),
        ("0,1,2,0\n", "lost in all 1 samples"),
        ("0,nan,nan,1\n", "lost in all 1 samples"),
        ("0,1,2,1\n0.1,1,2\n", "line 6: 3 columns"),
        ("0,1,2,1\n0.1,1,2,1,1\n", "line 6: 5 columns"),
        ("0,1,2,1\n\n0.1,x,2,1\n", "line 7: x_px is \"x\""),
        ("0,1,2,yes\n", "line 5: valid is \"yes\""),
        ("nan,1,2,1\n", "line 5: t_s is \"nan\""),
        (",1,2,1\n", "line 5: t_s is \"\""),
        ("0.1,1,2,1\n0.0,1,2,1\n", "line 6: t_s is 0 after 0.1"),
        ("# screen_px: 5x5\n0,1,2,1\n", "line 5: \"screen_px\" is given a second time"),
        ("# rate_hz: fast\n", "line 5: rate_hz is \"fast\""),
        ("# origin: middle\n", "line 5: the origin is \"middle\""),
    ];
    let cases = cases.map(|(rows, expected)| (format!("{HEADER}{rows}").into_bytes(), expected));
    let whole: [(&[u8], &str); 8] = [
        (b"", "no column names"),
        (b"# screen_px: 4x4\n0,1,2,1\n", "line 2: \"0,1,2,1\" instead of the column names"),
        (b"t_s,x_px,y_px,valid\n0,1,2,1\n", "size is missing"),
        (b"# screen_px: unknown\nt_s,x_px,y_px,valid\n0,1,2,1\n", "size is missing"),
        (b"# screen_px: 0x768\n", "line 1: screen_px is \"0x768\""),
        (b"# screen_cm: 38x-1\n", "line 1: screen_cm is"),
        (b"# distance_cm: inf\n", "line 1: distance_cm is"),
        (b"# a\n# b \xff\n", "line 2: not UTF-8"),
    ];
    for (bytes, expected) in cases.iter().map(|(bytes, expected)| (&bytes[..], *expected)).chain(whole) {
        let error = parse_csv("gaze.csv", bytes).unwrap_err().to_string();
        assert!(error.contains(expected) && error.starts_with("gaze.csv"), "{error}");
        assert!(!error.contains('\n') && error.contains("; "), "{error}");
    }
}

#[test]
fn missing_folder_and_oversized_files_are_refused_before_reading() {
    let dir = tempfile::tempdir().unwrap();
    let error = |p: &Path| read_csv(p).unwrap_err().to_string();
    assert!(error(&dir.path().join("none.csv")).contains("none.csv: cannot be read"));
    assert!(error(dir.path()).contains("is a folder"));
    let big = dir.path().join("big.csv");
    // A sparse file: takes no disk space, and reading it would take noticeable time.
    std::fs::File::create(&big).unwrap().set_len(MAX_FILE_BYTES + 1).unwrap();
    assert!(error(&big).contains("larger than 256 MiB"));
}

fn any_samples() -> impl Strategy<Value = Vec<Sample>> {
    let px = prop::option::weighted(0.7, [-2e3f32..4e3, -2e3f32..4e3]);
    prop::collection::vec((1e-4f64..0.1, px), 1..60).prop_map(|steps| {
        let mut t_s = -0.3;
        let step = |(dt, px)| {
            t_s += dt;
            Sample { t_s, px }
        };
        steps.into_iter().map(step).collect()
    })
}

proptest! {
    #![proptest_config(afterimage_testing::property("scanpath", 256))]

    #[test]
    fn writing_and_reading_gives_the_same_scanpath(
        samples in any_samples(),
        known in any::<bool>(),
        task in prop::option::of("[ -~é]{0,20}"),
        rate_hz in prop::option::of(0.1f64..5e3),
        notes in prop::collection::btree_map("[a-z]{3}_[a-z ]{0,5}", "[ -~\t]{0,20}", 0..4),
    ) {
        let about = About { task, rate_hz, notes: notes.into_iter().collect() };
        let Ok(path) = Scanpath::new("n", screen(known), about, samples) else {
            return Ok(()); // All samples lost, or two equal keys after trimming.
        };
        prop_assert_eq!(parse_csv("n", &csv(&path)).unwrap(), path);
    }
}

#[test]
fn a_seed_is_a_scanpath() {
    let make = |seed| generate(&SyntheticOptions { seed, duration_s: 3.0, ..Default::default() }).unwrap();
    assert_eq!(make(3), make(3));
    let starts: BTreeSet<_> = (0..20).map(|seed| make(seed).path.samples()[0].px.unwrap().map(f32::to_bits)).collect();
    assert_eq!(starts.len(), 20);
    let lengths = [(1.1, 10.0, 11), (6.0, 250.0, 1500), (0.001, 1.0, 1), (2.0, 0.5 + 0.5, 2)];
    for (duration_s, rate_hz, samples) in lengths {
        let made = generate(&SyntheticOptions { duration_s, rate_hz, ..Default::default() }).unwrap();
        assert_eq!(made.path.samples().len(), samples);
        assert_eq!((made.path.lost(), made.path.samples()[0].t_s), (0, 0.0));
    }
}
