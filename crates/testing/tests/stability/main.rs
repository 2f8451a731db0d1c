//! The contract of hard cases: a test proves every row. docs/stability.csv lists the tests and what each measured;
//! docs/stability.md is a page of it with a line for each row.
//!
//! Tests call `holds!("H08", Cpu, "s = {s}")`, which writes a record to the folder named by `AFTERIMAGE_STABILITY`.
//! `tests/stability.sh` writes both files from the records; `tests/run.sh` compares them.

mod rows;
mod table;

use afterimage_testing::hard_case::{Side, record};
use afterimage_testing::workspace;
use rows::ROWS;
use std::collections::BTreeSet;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use table::{Held, csv, missing, page, parse};

fn table_path() -> PathBuf {
    workspace().join("docs/stability.csv")
}

fn page_path() -> PathBuf {
    workspace().join("docs/stability.md")
}

/// The records in the table.
fn table() -> Vec<Held> {
    parse(&fs::read_to_string(table_path()).unwrap())
}

/// Rows that are no more: of depth and motion at samples alone, and of repair of sparse frames, which frames shaded by
/// quads replace (H107, H108).
const WITHDRAWN: [usize; 5] = [94, 99, 100, 101, 102];

#[test]
fn the_rows_are_h01_to_h114_in_order() {
    let numbers = (1..=114).filter(|number| !WITHDRAWN.contains(number));
    assert!(ROWS.iter().map(|row| row.id.to_owned()).eq(numbers.map(|number| format!("H{number:02}"))));
    for row in &ROWS {
        let cells = [row.input, row.must, row.limit.unwrap_or("-")];
        assert!(cells.iter().all(|c| !c.is_empty() && c.is_ascii() && !c.contains(['|', '\n'])), "{}", row.id);
    }
}

/// The table has every row, no other rows, and a test for every side.
#[test]
fn the_table_has_every_row() {
    assert_eq!(missing(&table()), Vec::<String>::new());
}

/// Table and page are what is printed for the records in the table, so that a line changed in only one is noticed.
#[test]
fn table_and_page_agree() {
    let held = table();
    for (path, printed) in [(table_path(), csv(&held)), (page_path(), page(&held))] {
        let written = fs::read_to_string(&path).unwrap();
        let differs = written.lines().zip(printed.lines()).find(|(a, b)| a != b);
        assert_eq!(differs, None, "{}: written, and printed by tests/stability.sh", path.display());
        assert_eq!(written, printed, "{}", path.display());
    }
}

/// The tests in the table exist and record their row, themselves or as rows `test: "H86", law` of the laws that
/// executors share.
#[test]
fn the_tests_of_the_table_exist() {
    let shared =
        ["depth", "feedback", "gaze", "kernel", "lifecycle", "light", "motion", "scale", "simulator", "surfaces"]
            .map(|of| format!("{of}_hard.rs"));
    let shared = shared.into_iter().chain(["planned_hard/mod.rs".into(), "mask_hard/mod.rs".into()]);
    let shared = shared.map(|file| fs::read_to_string(workspace().join("tests/common").join(file)).unwrap());
    let shared = shared.collect::<String>();
    for held in table() {
        let (name, files) = (held.test.rsplit("::").next().unwrap(), held.files());
        let side = match held.side.as_str() {
            "CPU" => "Cpu",
            "GPU" => "Gpu",
            _ => "Tool",
        };
        let rows = shared.lines().find_map(|line| line.trim_start().strip_prefix(&format!("{name}: ")));
        if rows.is_some_and(|rows| rows.contains(&format!("\"{}\", ", held.row))) {
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

/// After a complete test run: the records agree with the table.
#[test]
#[ignore = "after all other tests: tests/run.sh"]
fn the_table_is_what_the_tests_said() {
    let folder = PathBuf::from(std::env::var_os("AFTERIMAGE_STABILITY").expect("AFTERIMAGE_STABILITY names no folder"));
    let said = read(&folder);
    if std::env::var_os("AFTERIMAGE_BLESS").is_some() {
        assert_eq!(missing(&said), Vec::<String>::new(), "records in {}", folder.display());
        fs::write(table_path(), csv(&said)).unwrap();
        fs::write(page_path(), page(&said)).unwrap();
    }
    let printed = table();
    // Not eprintln!, which the test harness captures.
    let skipped = |what: &str| writeln!(std::io::stderr(), "SKIPPED: {what}").unwrap();
    let unsaid = without(&printed, &said);
    if workspace().join("../shared/data").is_dir() {
        assert_eq!(unsaid, Vec::<String>::new(), "in the table, but recorded by no test");
    } else {
        skipped(&format!("no ../shared/data; {} lines of the table were not compared", unsaid.len()));
    }
    assert_eq!(without(&said, &printed), Vec::<String>::new(), "recorded by tests, but not in the table");
    // No failure: another processor's mathematics may differ in a last digit.
    for changed in changed(&said, &printed) {
        writeln!(std::io::stderr(), "DIFFERS, run tests/stability.sh if it should: {changed}").unwrap();
    }
}

/// Records of `a` whose test has none in `b`.
fn without(a: &[Held], b: &[Held]) -> Vec<String> {
    let names: BTreeSet<_> = b.iter().map(Held::name).collect();
    a.iter().map(Held::name).filter(|name| !names.contains(name)).collect()
}

/// Tests whose value is not the one in the table.
fn changed(said: &[Held], printed: &[Held]) -> Vec<String> {
    let differs = |h: &&Held| printed.iter().any(|p| p.name() == h.name() && p.figure != h.figure);
    said.iter().filter(differs).map(|h| format!("{}: measured {}", h.name(), h.figure)).collect()
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
    assert_eq!(parse(&csv(&whole)), whole, "the printed table parses to the same records");
    let without = |row: &str, side: &str| {
        missing(&whole.iter().filter(|h| h.row != row || h.side != side).cloned().collect::<Vec<_>>())
    };
    assert_eq!(without("H08", "GPU"), ["H08 has no test on the GPU"]);
    assert_eq!(without("H84", "GPU"), ["H84 has no test on the GPU"]);
    let more = [whole, vec![Held::new("H115", "CPU", "a::b", "0")]].concat();
    assert_eq!(missing(&more), ["H115 is no row"]);
}

/// The comparison finds a test without a line, a line without a test and a changed value.
#[test]
fn what_has_changed_is_noticed() {
    let table = [Held::new("H08", "CPU", "a::b", "1412.7, \"s\""), Held::new("H84", "GPU", "a::d", "llvmpipe")];
    let with = |index: usize, figure: &str| {
        let mut said = table.to_vec();
        said[index].figure = figure.into();
        said
    };
    assert_eq!(parse(&csv(&table)), table);
    assert_eq!((without(&table, &table), changed(&table, &table)), (vec![], vec![]));
    assert_eq!(without(&table, &table[1..]), ["H08 CPU a::b"]);
    assert_eq!(changed(&with(0, "1412.8"), &table), ["H08 CPU a::b: measured 1412.8"]);
    // Either file alone.
    assert_ne!(page(&with(0, "1412.8")), page(&table));
    assert_ne!(csv(&with(0, "1412.8")), csv(&table));
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
