//! Grid, frontier, table and store of a sweep.

use crate::report::table;
use crate::report::table::options;
use afterimage_cli::sweep::frontier::{Standing, frontier};
use afterimage_cli::sweep::grid::parse_switch;
use afterimage_cli::sweep::store::id;
use afterimage_cli::sweep::{Axis, Grid, METRICS, Measurement, Point, Store, Table};
use afterimage_lab::clock::Quartiles;
use proptest::prelude::*;
use std::collections::BTreeSet;

fn point(method: &str, pairs: &[(&str, &str)], seed: u64) -> Point {
    Point { input: "clip".into(), method: method.into(), options: options(pairs), seed }
}

/// A measurement whose pass takes `ms` while the control takes `control_ms`, and that has no score but `flip`.
fn measurement(point: Point, ms: f64, control_ms: f64, flip: f64) -> Measurement {
    let around = |v: f64| Quartiles { median: v, p25: 0.9 * v, p75: 1.2 * v };
    let mut m = table::measurement(point, ms, 48, 0.1, flip);
    (m.figures.ms, m.figures.psnr_last_frame_db, m.figures.scores) = (Some(around(ms)), None, Default::default());
    m.figures.scores.whole.flip = Some(flip);
    (m.pass_ms, m.control_ms) = (around(ms), around(control_ms));
    m.frame_ms = vec![0.5 * ms, ms, 2.0 * ms];
    m.round = "a".into();
    m
}

#[test]
fn an_axis_is_read_as_it_is_typed() {
    let axis = |text| Axis::parse(text).unwrap();
    let some = |v: &str| Some(v.to_owned());
    assert_eq!(axis("fovea=5,10").values, [[some("5")], [some("10")]]);
    assert_eq!(axis("--fovea = 5 , 10").options, ["fovea"]);
    let rates = axis("rate-mid+rate-far=2+4,8+16");
    assert_eq!((&rates.options[1][..], &rates.values[1][1]), ("rate-far", &some("16")));
    assert_eq!(axis("no-gate=-,on").values, [[None], [some("")]]);
    assert_eq!(axis("region-spp=32,16,8;2,2,2").values[1], [some("2,2,2")]);
    assert_eq!(parse_switch("wrs-bias=none"), ("wrs-bias".into(), some("none")));
    assert_eq!(parse_switch("no-gate"), ("no-gate".into(), some("")));
    for bad in ["fovea", "=5", "fovea=", "Fov ea=5", "a+b=1", "a=1+2", ";=;"] {
        let error = Axis::parse(bad).unwrap_err().to_string();
        println!("{error}");
        assert!(error.contains("--axis") && error.contains("expected NAME=VALUE"));
    }
}

#[test]
fn a_grid_has_every_combination_once_and_switches_one_at_a_time() {
    let grid = Grid {
        axes: ["method=none,wrs,smr", "fovea=5,10"].map(|a| Axis::parse(a).unwrap()).into(),
        switches: ["no-gate", "no-relight", "no-flush"].map(parse_switch).into(),
    };
    let concerns = |option: &str, method: &str| match option {
        "no-gate" => method == "wrs",
        "no-relight" => method == "smr",
        "no-flush" => method != "none",
        _ => true,
    };
    let points = grid.points(&["clip".into()], 3, concerns, |method, _| method == "wrs");
    // 2 of none, 2 + 2 of smr, and (2 + 2) x 3 seeds of wrs.
    assert_eq!(points.len(), 2 + 4 + 12);
    assert_eq!(points.iter().collect::<BTreeSet<_>>().len(), points.len());
    assert!(points.contains(&point("wrs", &[("fovea", "5"), ("no-gate", "")], 2)));
    assert!(!points.iter().any(|p| p.method == "smr" && p.options.contains_key("no-gate")));
    assert!(!points.iter().any(|p| p.options.contains_key("no-flush") && p.options["fovea"] == "10"));
    let ids: BTreeSet<String> = points.iter().map(id).collect();
    assert_eq!(ids.len(), points.len(), "every point has a file of its own");
}

#[test]
fn a_command_can_be_pasted_into_a_shell() {
    let point = Point { input: "it's a file.exr".into(), ..point("wrs", &[("no-gate", ""), ("fovea", "5")], 2) };
    let expected = r"afterimage run 'it'\''s a file.exr' --method wrs --gaze 'a b.csv' --fovea 5 --no-gate --seed 2";
    assert_eq!(point.command(&options(&[("gaze", "a b.csv")])), expected);
}

/// The frontier by definition: no other point is at least as good in every part and better in one.
fn by_brute_force(points: &[Standing], is_beaten: impl Fn([f64; 3], [f64; 3]) -> bool) -> Vec<bool> {
    let parts = |s: &Standing| [s.cost_ms, s.samples_share, s.error];
    let sound = |s: &Standing| parts(s).iter().all(|v| !v.is_nan());
    points.iter().map(|p| sound(p) && !points.iter().any(|q| sound(q) && is_beaten(parts(p), parts(q)))).collect()
}

fn dominated(p: [f64; 3], q: [f64; 3]) -> bool {
    q.iter().zip(&p).all(|(q, p)| q <= p) && q != p
}

proptest! {
    #![proptest_config(afterimage_testing::property("frontier", 500))]
    #[test]
    fn the_frontier_is_that_of_brute_force(parts in prop::collection::vec((0..6_u8, 0..3_u8, 0..6_u8), 0..40)) {
        // Small numbers make ties frequent; the last value of the error represents NaN.
        let error = |e: u8| if e == 5 { f64::NAN } else { f64::from(e) };
        let at = |&(c, s, e): &(u8, u8, u8)| Standing { cost_ms: c.into(), samples_share: s.into(), error: error(e) };
        let points: Vec<Standing> = parts.iter().map(at).collect();
        prop_assert_eq!(frontier(&points), by_brute_force(&points, dominated));
    }
}

#[test]
fn a_frontier_that_forgets_ties_or_shares_is_caught() {
    let at = |cost_ms, samples_share, error| Standing { cost_ms, samples_share, error };
    let points = [at(1.0, 0.1, 3.0), at(1.0, 0.1, 3.0), at(2.0, 0.1, 3.0), at(1.0, 0.2, 2.0), at(0.5, 0.3, 3.0)];
    assert_eq!(frontier(&points), [true, true, false, true, true]);
    let strict = |p: [f64; 3], q: [f64; 3]| q.iter().zip(&p).all(|(q, p)| q < p);
    let without_shares = |p: [f64; 3], q: [f64; 3]| q[0] <= p[0] && q[2] <= p[2] && (q[0], q[2]) != (p[0], p[2]);
    assert_ne!(frontier(&points), by_brute_force(&points, strict));
    assert_ne!(frontier(&points), by_brute_force(&points, without_shares));
}

#[test]
fn times_of_a_machine_that_slowed_down_are_made_comparable() {
    let fovea = |deg| [("fovea", deg)];
    // The machine was twice as slow in the second round, as its control shows.
    let measurements = [
        measurement(point("smr", &fovea("5"), 0), 10.0, 4.0, 0.2),
        measurement(point("wrs", &fovea("5"), 0), 5.0, 4.0, 0.3),
        measurement(point("smr", &fovea("10"), 0), 22.0, 8.0, 0.1),
    ];
    let table = Table::new(&measurements, None, "afterimage sweep".into());
    let ms: Vec<(f64, f64)> = table.rows.iter().map(|r| (r.pass_ms.median, r.drift)).collect();
    assert_eq!(ms, [(5.0, 1.0), (10.0, 1.0), (11.0, 0.5)]);
    assert_eq!(table.rows[1].pass_ms.p75, 12.0);
    let labels: Vec<&str> = table.rows.iter().map(|r| r.label.as_str()).collect();
    assert_eq!(labels, ["wrs, fovea 5", "smr, fovea 5", "smr, fovea 10"]);
}

#[test]
fn seeds_are_one_row_with_their_spread() {
    let of = |seed: u8, flip| measurement(point("wrs", &[], seed.into()), 10.0 + f64::from(seed), 4.0, flip);
    let measurements = [of(0, 0.2), of(1, 0.4), of(2, 0.3)];
    let table = Table::new(&measurements, None, String::new());
    let [row] = &table.rows[..] else { panic!("one row") };
    assert_eq!((row.seeds, row.pass_ms.median), (3, 11.0));
    assert!((row.values["flip"].unwrap() - 0.3).abs() < 1e-12);
    assert_eq!(row.spread["flip"], [0.2, 0.4]);
}

#[test]
fn what_the_renderer_costs_moves_the_frontier() {
    let mut coarse = measurement(point("none", &[("fovea", "5")], 0), 1.0, 4.0, 0.3);
    let mut fine = measurement(point("none", &[("fovea", "10")], 0), 1.0, 4.0, 0.2);
    (coarse.samples_share, fine.samples_share) = (0.1, 0.4);
    let frontier = |renderer_ms| -> Vec<(String, f64, bool)> {
        let table = Table::new(&[coarse.clone(), fine.clone()], renderer_ms, String::new());
        table.rows.iter().map(|r| (r.label.clone(), r.cost_ms, r.frontier.contains(&"flip"))).collect()
    };
    assert!(frontier(None).iter().all(|r| r.2), "nobody knows what the samples cost: {:?}", frontier(None));
    assert!(frontier(Some(10.0)).iter().all(|r| r.2));
    let costs: Vec<f64> = frontier(Some(10.0)).iter().map(|r| r.1).collect();
    assert_eq!(costs, [2.0, 5.0]);
    // If samples are free, fewer samples are no advantage.
    let free: Vec<bool> = frontier(Some(0.0)).iter().map(|r| r.2).collect();
    assert_eq!(free.iter().filter(|b| **b).count(), 1);
}

#[test]
fn traced_points_with_several_numbers_of_samples_have_a_slope() {
    let traced = |spp: f64, mse: f64| {
        let spp_text = spp.to_string();
        let mut m = measurement(point("none", &[("sampling", "layers"), ("spp", &spp_text)], 0), 1.0, 4.0, 0.2);
        m.samples_per_pixel = Some(0.25 * spp);
        m.render_ms = Some(Quartiles { median: 100.0 * spp - 1.0, p25: 1.0, p75: 1.0 });
        m.figures.scores.whole.mse = Some(mse);
        m
    };
    let measurements = [traced(16.0, 0.01), traced(1.0, 0.16), traced(4.0, 0.04)];
    let table = Table::new(&measurements, None, String::new());
    let [found] = &table.convergences[..] else { panic!("one pattern") };
    assert_eq!(found.label, "none, sampling layers");
    assert_eq!(found.points.iter().map(|p| p.samples_per_pixel).collect::<Vec<_>>(), [0.25, 1.0, 4.0]);
    assert!((found.slope_by_samples[0].unwrap() + 1.0).abs() < 1e-12);
    assert!((found.slope_by_time[0].unwrap() + 1.0).abs() < 1e-12);
    assert_eq!(found.slope_by_samples[1], None, "the fovea has no figure");
    // 1 / (0.16 x 0.1 s)
    assert!((found.points[0].efficiency[0].unwrap() - 62.5).abs() < 1e-9);
}

#[test]
fn a_switch_is_priced_against_the_point_without_it() {
    let measurements = [
        measurement(point("wrs", &[("fovea", "5")], 0), 10.0, 4.0, 0.2),
        measurement(point("wrs", &[("fovea", "5"), ("no-gate", "")], 0), 6.0, 4.0, 0.25),
        measurement(point("wrs", &[("fovea", "10")], 0), 10.0, 4.0, 0.1),
        measurement(point("smr", &[("fovea", "5"), ("no-gate", "")], 0), 6.0, 4.0, 0.25),
    ];
    let table = Table::new(&measurements, None, String::new());
    let [price] = &table.prices[..] else { panic!("one price: {:?}", table.prices) };
    assert_eq!((price.switch.as_str(), price.method.as_str(), price.pass_ms), ("no-gate", "wrs", [10.0, 6.0]));
    assert_eq!(price.values["flip"], [Some(0.2), Some(0.25)]);
    // Frames that are slow for both points do not count as cost of the switch: the ratio is the same in all frames.
    assert_eq!(price.time_ratio, Quartiles { median: 0.6, p25: 0.6, p75: 0.6 });
    let mut apart = measurements;
    apart[1].round = "b".into();
    let ratio = Table::new(&apart, None, String::new()).prices[0].time_ratio;
    for (found, expected) in [(ratio.median, 0.6), (ratio.p25, 5.4 / 12.0), (ratio.p75, 7.2 / 9.0)] {
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
}

#[test]
fn the_csv_has_a_cell_for_every_column_of_every_row() {
    let hostile = Point { input: "a,\"b\"\nc".into(), ..point("wrs", &[("no-gate", "")], 0) };
    let measurements = [measurement(hostile, 10.0, 4.0, 0.2), measurement(point("smr", &[], 0), 10.0, 4.0, 0.2)];
    let csv = Table::new(&measurements, None, String::new()).csv();
    // Splits a line into cells, with quotes; a quoted line break joins two lines.
    let cells =
        |text: &str| text.split('"').step_by(2).map(|unquoted| unquoted.matches(',').count()).sum::<usize>() + 1;
    let header = csv.lines().next().unwrap();
    let rest = csv[header.len() + 1..].trim_end();
    assert_eq!(cells(rest), 2 * cells(header) - 1, "{csv}");
    assert!(METRICS.iter().all(|m| header.split(',').any(|c| c == m.key)));
}

#[test]
fn the_store_gives_back_what_it_was_given_and_refuses_what_is_not_its_own() {
    let folder = tempfile::tempdir().unwrap();
    assert!(Store::open(folder.path()).unwrap_err().to_string().contains("holds no sweep"));
    let store = Store::create(folder.path()).unwrap();
    let given =
        [measurement(point("smr", &[], 0), 3.25, 4.0, 0.3125), measurement(point("wrs", &[], 1), 0.5, 4.0, 0.0)];
    given.iter().for_each(|m| store.save(m).unwrap());
    assert_eq!(store.load().unwrap(), given);
    assert!(folder.path().join("points").read_dir().unwrap().all(|e| e.unwrap().path().extension().unwrap() == "json"));
    for (name, text) in [("x.json", "{"), ("y.json", "[]"), ("z.json", &"1".repeat(2 << 20)[..])] {
        let path = folder.path().join("points").join(name);
        std::fs::write(&path, text).unwrap();
        let error = store.load().unwrap_err().to_string();
        println!("{}", &error[error.len().saturating_sub(150)..]);
        assert!(error.contains(name) && error.contains("measured again"));
        std::fs::remove_file(&path).unwrap();
    }
}

/// Untrusted folders cannot cause reads or writes outside the folder.
#[test]
fn a_measurement_that_leads_out_of_its_folder_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (theirs, ours) = (folder.path().join("a/b/theirs"), folder.path().join("a/b/ours"));
    let (store, own) = (Store::create(&theirs).unwrap(), Store::create(&ours).unwrap());
    let good = measurement(point("smr", &[], 0), 3.25, 4.0, 0.3125);
    store.save(&good).unwrap();
    let file = theirs.join("points").join(format!("{}.json", id(&good.point)));
    let text = std::fs::read_to_string(&file).unwrap();
    for method in ["../../../evil", "/tmp/evil", "..", "wrs"] {
        let evil = text.replace("\"smr\"", &format!("\"{method}\""));
        assert_ne!(evil, text);
        std::fs::write(&file, evil).unwrap();
        let error = store.load().unwrap_err().to_string();
        assert!(error.contains("does not have its point's name"), "{error}");
    }
    std::fs::write(&file, &text).unwrap();
    assert_eq!(store.load().unwrap().len(), 1);
    #[cfg(unix)]
    {
        let secret = folder.path().join("secret");
        std::fs::write(&secret, "secret").unwrap();
        std::os::unix::fs::symlink(&secret, store.picture(&good.point, "shown")).unwrap();
        let error = own.adopt(&store, &good.point).unwrap_err().to_string();
        assert!(error.contains("is a link"), "{error}");
        std::fs::rename(&file, folder.path().join("away.json")).unwrap();
        std::os::unix::fs::symlink(folder.path().join("away.json"), &file).unwrap();
        assert!(store.load().unwrap_err().to_string().contains("is a link"));
    }
    assert!(own.load().unwrap().is_empty() && std::fs::read_dir(folder.path()).unwrap().count() <= 3);
}
