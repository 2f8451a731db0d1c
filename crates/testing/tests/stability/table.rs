//! docs/stability.md: printed from what tests said, and read again.

use super::rows::ROWS;
use std::path::PathBuf;

const HEAD: &str = "# Hard cases\n\n\
    Every row of the contract: an input that breaks temporal methods, and what must hold all the same. \"CPU\" is the Rust kernel or \
    pass, against f64 or a closed form; \"GPU\" is the same in WGSL on an adapter (here a software one); \"tool\" is the program. The \
    figure is what the test measured when this page was written; run one with `cargo test --all-features NAME -- --nocapture`.\n\n\
    This page is generated: `tests/stability.sh`. `tests/run.sh` fails if a row or a test of it is missing.\n\n\
    Single cases are not all: `tests/soak.sh` runs 100,000 frames of 320x180 of wrs and as many of smr on both executors, equal in \
    every bit, through 46,406 and 46,303 resets, resizes, lost gazes, broken pixels and steps of exposure, in any order. Not one \
    component was shown that is no number, none of wrs above what was presented, no pixel of smr's fovea but the candidate; in 250 \
    quiet stretches weight sums of wrs stayed within 0.94 of what storage may round; memory, of both at once, \
    stood at 224 MiB from frame 35,000 to the end, give or take 0.4. (Of one run, with 0.1.0; it takes hours and is not repeated when \
    this page is written.)\n\n\
    | row | input | must hold | held by | figure |\n|---|---|---|---|---|\n";
const LIMITS: &str = "\n## Rows that cannot hold as they stand\n\n";

/// A row that a test holds.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Held {
    pub row: String,
    pub side: String,
    /// `program::module::function`.
    pub test: String,
    pub figure: String,
}

impl Held {
    pub fn new(row: &str, side: &str, test: &str, figure: &str) -> Self {
        Self { row: row.into(), side: side.into(), test: test.into(), figure: figure.into() }
    }

    /// Files that may have the test: those of its program.
    pub fn files(&self) -> Vec<PathBuf> {
        let tests = afterimage_testing::workspace().join("tests");
        let path: Vec<&str> = self.test.split("::").collect();
        let folder = tests.join(path[0]);
        let module = path.get(1).map_or_else(String::new, |m| format!("{m}.rs"));
        vec![tests.join(format!("{}.rs", path[0])), folder.join("main.rs"), folder.join(module)]
    }
}

/// The page.
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

/// What a page says.
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

/// Rows and sides without a test, and rows of no list.
pub fn missing(held: &[Held]) -> Vec<String> {
    let none = |row: &str, side: &str| !held.iter().any(|h| h.row == row && h.side == side);
    let absent = ROWS.iter().flat_map(|r| {
        r.sides.iter().filter(|side| none(r.id, side)).map(|side| format!("{} has no test on the {side}", r.id))
    });
    let unknown = held.iter().filter(|h| ROWS.iter().all(|r| r.id != h.row)).map(|h| format!("{} is no row", h.row));
    absent.chain(unknown).collect()
}
