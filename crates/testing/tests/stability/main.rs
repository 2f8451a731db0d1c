//! The contract of hard cases: a test proves every row, and docs/stability.md lists the test and what it measured.
//!
//! Tests call `holds!("H08", Cpu, "s = {s}")`, which writes a record to the folder named by `AFTERIMAGE_STABILITY`.
//! `tests/stability.sh` writes the table from the records; `tests/run.sh` compares them.

mod rows;
mod table;

use afterimage_testing::hard_case::{Side, record};
use afterimage_testing::workspace;
use rows::ROWS;
use std::collections::BTreeSet;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use table::{Held, missing, parse, print};

/// Path of the table.
fn table_path() -> PathBuf {
    workspace().join("docs/stability.md")
}

/// Rows that are no more: of repair of sparse frames, which frames shaded by quads replace (H107, H108).
const WITHDRAWN: std::ops::RangeInclusive<usize> = 99..=102;

#[test]
fn the_rows_are_h01_to_h108_in_order() {
    let numbers = (1..=108).filter(|number| !WITHDRAWN.contains(number));
    assert!(ROWS.iter().map(|row| row.id.to_owned()).eq(numbers.map(|number| format!("H{number:02}"))));
    for row in &ROWS {
        let cells = [row.input, row.must, row.limit.unwrap_or("-")];
        assert!(cells.iter().all(|c| !c.is_empty() && c.is_ascii() && !c.contains(['|', '\n'])), "{}", row.id);
    }
}

/// The table has every row, no other rows, and a test for every side.
#[test]
fn the_table_has_every_row() {
    let held = parse(&fs::read_to_string(table_path()).unwrap());
    assert_eq!(missing(&held), Vec::<String>::new());
}

/// The tests in the table exist and record their row, themselves or as a row `test: "H86", law` of the laws that
/// executors share.
#[test]
fn the_tests_of_the_table_exist() {
    let shared =
        ["depth", "feedback", "gaze", "kernel", "lifecycle", "light", "motion", "scale", "simulator", "surfaces"]
            .map(|of| format!("{of}_hard.rs"));
    let shared = shared.into_iter().chain(["sparse_hard/mod.rs".into()]);
    let shared = shared.map(|file| fs::read_to_string(workspace().join("tests/common").join(file)).unwrap());
    let shared = shared.collect::<String>();
    for held in parse(&fs::read_to_string(table_path()).unwrap()) {
        let (name, files) = (held.test.rsplit("::").next().unwrap(), held.files());
        let side = match held.side.as_str() {
            "CPU" => "Cpu",
            "GPU" => "Gpu",
            _ => "Tool",
        };
        let both = [format!("fn {name}("), format!("holds!(\"{}\", $side,", held.row)];
        if shared.contains(&format!("{name}: \"{}\", ", held.row)) || both.iter().all(|said| shared.contains(said)) {
            continue;
        }
        let said = [format!("fn {name}("), format!("holds!(\"{}\", {side},", held.row)];
        let text = files.iter().filter_map(|f| fs::read_to_string(f).ok()).collect::<Vec<_>>().join("\n");
        let text = text.replace("holds!(\n", "holds!(").replace("!(        ", "!(");
        let words = |t: &str| t.split_whitespace().collect::<String>();
        for said in said {
            assert!(words(&text).contains(&words(&said)), "{} {}: no {said} in {files:?}", held.row, held.test);
        }
    }
}

/// After a complete test run: the records agree with the table, except for measured values, which may differ between
/// machines.
#[test]
#[ignore = "after all other tests: tests/run.sh"]
fn the_table_is_what_the_tests_said() {
    let folder = PathBuf::from(std::env::var_os("AFTERIMAGE_STABILITY").expect("AFTERIMAGE_STABILITY names no folder"));
    let said = read(&folder);
    if std::env::var_os("AFTERIMAGE_BLESS").is_some() {
        assert_eq!(missing(&said), Vec::<String>::new(), "records in {}", folder.display());
        fs::write(table_path(), print(&said)).unwrap();
    }
    let names = |held: &[Held]| -> BTreeSet<_> {
        held.iter().map(|h| (h.row.clone(), h.side.clone(), h.test.clone())).collect()
    };
    let (said, printed) = (names(&said), names(&parse(&fs::read_to_string(table_path()).unwrap())));
    let of = |a: &BTreeSet<_>, b: &BTreeSet<_>| a.difference(b).cloned().collect::<Vec<(String, String, String)>>();
    if workspace().join("../shared/data").is_dir() {
        assert_eq!(of(&printed, &said), [], "in the table, but recorded by no test");
    } else {
        // Not eprintln!, which the test harness captures.
        let without = of(&printed, &said).len();
        let _ =
            writeln!(std::io::stderr(), "SKIPPED: no ../shared/data; {without} lines of the table were not compared");
    }
    assert_eq!(of(&said, &printed), [], "recorded by tests, but not in the table");
}

/// The records of tests in the folder, sorted.
fn read(folder: &Path) -> Vec<Held> {
    let mut held: Vec<Held> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap().to_owned();
            let mut words = name.splitn(3, ' ').map(str::to_owned);
            let mut word = || words.next().expect("ROW SIDE TEST");
            let (row, side) = (word(), word());
            Held { row, side, test: word().replace('.', "::"), figure: fs::read_to_string(&path).unwrap() }
        })
        .collect();
    held.sort();
    held
}

/// The checks find a row without a test, a side without a test, and an unknown row.
#[test]
fn what_is_missing_is_noticed() {
    let whole: Vec<Held> = ROWS
        .iter()
        .flat_map(|r| r.sides.iter().map(|side| Held::new(r.id, side, "reservoir::drift", "1412.7")))
        .collect();
    assert_eq!(missing(&whole), Vec::<String>::new());
    assert_eq!(parse(&print(&whole)), whole, "the printed table parses to the same records");
    let without = |row: &str, side: &str| {
        missing(&whole.iter().filter(|h| h.row != row || h.side != side).cloned().collect::<Vec<_>>())
    };
    assert_eq!(without("H08", "GPU"), ["H08 has no test on the GPU"]);
    assert_eq!(without("H84", "GPU"), ["H84 has no test on the GPU"]);
    let more = [whole, vec![Held::new("H109", "CPU", "a::b", "0")]].concat();
    assert_eq!(missing(&more), ["H109 is no row"]);
}

/// Sides are written as the table expects, and `record` works without a folder.
#[test]
fn a_record_has_a_name_that_is_read_again() {
    assert_eq!([Side::Cpu, Side::Gpu, Side::Tool].map(|s| s.to_string()), ["CPU", "GPU", "tool"]);
    // Without a folder, it only prints.
    if std::env::var_os("AFTERIMAGE_STABILITY").is_none() {
        record("H01", Side::Cpu, "a::b::{{closure}}", "1");
    }
}
