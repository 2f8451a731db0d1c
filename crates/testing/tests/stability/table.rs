//! Prints and parses docs/stability.md.

use super::rows::ROWS;
use std::path::PathBuf;

const HEAD: &str = "# Hard cases\n\n\
    Every row of the contract: an input that breaks temporal methods, and what must hold for it. \"CPU\" is the Rust kernel or \
    pass, compared with f64 or a closed form; \"GPU\" is the WGSL on an adapter (here a software one); \"tool\" is the command-line tool. \
    The last column is what the test measured when this page was generated; run a test with `cargo test --workspace --features cpu,view NAME -- --nocapture`.\n\n\
    This page is generated: `tests/stability.sh`. `tests/run.sh` fails if a row or a test of it is missing.\n\n\
    Long runs supplement the single cases: `tests/soak.sh` runs 100,000 frames of 320x180 each of wrs and smr on both executors, through \
    46,406 and 46,303 resets, resizes, lost gazes, invalid pixels and exposure steps in random order. Both executors were equal in every \
    bit. No output component was NaN or infinite, none of wrs exceeded its inputs, and smr's fovea always showed the candidate. In 250 \
    stretches without events, weight sums of wrs stayed within 0.94 of the permitted rounding of storage. Memory of both together \
    stayed at 224 MiB from frame 35,000 to the end, within 0.4. (One run, with 0.1.0; it takes hours and is not repeated when \
    this page is generated.)\n\n\
    | row | input | must hold | test | measured |\n|---|---|---|---|---|\n";
const LIMITS: &str = "\n## Rows that hold with limits\n\n";

/// A row proved by a test.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Held {
    pub row: String,
    pub side: String,
    /// `test_program::module::function`.
    pub test: String,
    pub figure: String,
}

impl Held {
    pub fn new(row: &str, side: &str, test: &str, figure: &str) -> Self {
        Self { row: row.into(), side: side.into(), test: test.into(), figure: figure.into() }
    }

    /// Files that may contain the test.
    pub fn files(&self) -> Vec<PathBuf> {
        let path: Vec<&str> = self.test.split("::").collect();
        let (program, modules) = (path[0], &path[1..path.len().max(2) - 1]);
        let in_crate = |tests: &str| {
            let tests = afterimage_testing::workspace().join(tests);
            let mut files = vec![tests.join(format!("{program}.rs")), tests.join(program).join("main.rs")];
            let mut folder = tests.join(program);
            for module in modules {
                files.push(folder.join(format!("{module}.rs")));
                folder.push(module);
                files.push(folder.join("mod.rs"));
            }
            files
        };
        ["tests", "crates/lab/tests", "crates/tool/tests"].into_iter().flat_map(in_crate).collect()
    }
}

/// Prints the page.
pub fn print(held: &[Held]) -> String {
    let mut page = HEAD.to_owned();
    for row in &ROWS {
        for (index, held) in held.iter().filter(|h| h.row == row.id).enumerate() {
            let [id, input, must] = if index == 0 { [row.id, row.input, row.must] } else { [""; 3] };
            page += &format!("| {id} | {input} | {must} | {} `{}` | {} |\n", held.side, held.test, held.figure);
        }
    }
    let limits: Vec<_> = ROWS.iter().filter_map(|r| Some(format!("- **{}**: {}\n", r.id, r.limit?))).collect();
    page + LIMITS + &if limits.is_empty() { "None.\n".to_owned() } else { limits.concat() }
}

/// Parses a page.
pub fn parse(page: &str) -> Vec<Held> {
    let mut row = "";
    let lines = page.lines().filter(|l| l.starts_with('|')).skip(2);
    lines
        .map(|line| {
            let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
            let [id, _, _, by, figure] = cells[..] else { panic!("five cells: {line}") };
            row = if id.is_empty() { row } else { id };
            let (side, test) = by.split_once(' ').expect("SIDE `TEST`");
            Held::new(row, side, test.trim_matches('`'), figure)
        })
        .collect()
}

/// Rows and sides without a test, and unknown rows.
pub fn missing(held: &[Held]) -> Vec<String> {
    let none = |row: &str, side: &str| !held.iter().any(|h| h.row == row && h.side == side);
    let absent = ROWS.iter().flat_map(|r| {
        r.sides.iter().filter(|side| none(r.id, side)).map(|side| format!("{} has no test on the {side}", r.id))
    });
    let unknown = held.iter().filter(|h| ROWS.iter().all(|r| r.id != h.row)).map(|h| format!("{} is no row", h.row));
    absent.chain(unknown).collect()
}
