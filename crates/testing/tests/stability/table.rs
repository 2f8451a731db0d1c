//! Prints docs/stability.csv, which has every measured value, and docs/stability.md, which has a line for each hard
//! case.

use super::rows::ROWS;
use std::path::PathBuf;

const HEAD: &str = "# Hard cases\n\n\
    Inputs that break temporal methods, and what must hold for them. All hold, some within [limits](#limits).\n\n\
    Each case is tested on the CPU (Rust against f64 or a closed form) and the GPU (WGSL on software Vulkan), or where brackets say. \
    The last column is what its first test measured; [stability.csv](stability.csv) has all tests. Run one with \
    `cargo test --workspace --features cpu,view NAME -- --nocapture`.\n\n\
    `tests/stability.sh` generates both files. `tests/run.sh` fails if a case or a test is missing.\n\n\
    `tests/soak.sh` runs 100,000 frames with random resets, resizes, lost gazes, invalid pixels and exposure steps. In one run, executors \
    were equal in every bit, no output was NaN or infinite, and memory stayed at 224 MiB. Of 1,000,000 planned frames, half of them \
    antialiased, with cuts, other shares and 50,117 dropped encoders besides, none showed a wrong value, and memory stayed at 173 and \
    186 MiB.\n\n\
    Column \"planned\": where a test of planned frames proves the case; the others are of full-size frames, or of arithmetic that both \
    use.\n\n\
    case | input | must hold | planned | measured\n---|---|---|---|---\n";
const LIMITS: &str = "\n## Limits\n\n";
const COLUMNS: [&str; 6] = ["row", "input", "must hold", "executor", "test", "measured"];

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

    /// Row, side and test.
    pub fn name(&self) -> String {
        format!("{} {} {}", self.row, self.side, self.test)
    }

    /// Whether it is proved on planned frames.
    fn is_planned(&self) -> bool {
        ["planned", "mask", "quads"].iter().any(|word| self.test.contains(word)) || self.figure.contains("planned")
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
        ["tests", "crates/lab/tests", "crates/trace/tests", "crates/tool/tests"]
            .into_iter()
            .flat_map(in_crate)
            .collect()
    }
}

/// Sides of tests in their order.
fn sides<'a>(held: impl Iterator<Item = &'a Held>) -> String {
    let mut sides: Vec<&str> = held.map(|h| h.side.as_str()).collect();
    sides.dedup();
    sides.join("+")
}

/// Prints the page: for each row, the sides that test it, if not CPU and GPU, those that do on planned frames, and what
/// its first test measured.
pub fn page(held: &[Held]) -> String {
    let lines = ROWS.iter().map(|row| {
        let held: Vec<&Held> = held.iter().filter(|h| h.row == row.id).collect();
        let planned = sides(held.iter().copied().filter(|h| h.is_planned()));
        let of_whole_frames = held.iter().find(|h| !h.test.contains("planned"));
        let first = of_whole_frames.or(held.first()).map_or("", |h| h.figure.as_str());
        let on = match sides(held.iter().copied()).as_str() {
            "CPU+GPU" => String::new(),
            sides => format!(" ({sides})"),
        };
        format!("{}{on} | {} | {} | {planned} | {first}\n", row.id, row.input, row.must)
    });
    let limits = ROWS.iter().filter_map(|r| Some(format!("- {}: {}\n", r.id, r.limit?)));
    HEAD.to_owned() + &lines.collect::<String>() + LIMITS + &limits.collect::<String>()
}

/// Prints the table of all tests.
pub fn csv(held: &[Held]) -> String {
    let lines = ROWS.iter().flat_map(|row| {
        let held = held.iter().filter(move |h| h.row == row.id);
        held.map(move |h| [row.id, row.input, row.must, &h.side, &h.test, &h.figure])
    });
    [COLUMNS].into_iter().chain(lines).map(|cells| cells.map(quoted).join(",") + "\n").collect()
}

/// A cell of CSV, in quotes where it needs them.
fn quoted(cell: &str) -> String {
    if cell.contains([',', '"']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.to_owned() }
}

/// The cells of a line of CSV.
fn cells(line: &str) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut is_quoted = false;
    // A comma separates cells where the quotes before it are even in number.
    for part in line.split(',') {
        let cell = cells.last_mut().expect("begins with a cell");
        cell.push_str(part);
        is_quoted ^= part.matches('"').count() % 2 == 1;
        if is_quoted { cell.push(',') } else { cells.push(String::new()) }
    }
    cells.pop();
    let bare =
        |cell: &String| cell.strip_prefix('"').and_then(|c| c.strip_suffix('"')).map(|c| c.replace("\"\"", "\""));
    cells.iter().map(|cell| bare(cell).unwrap_or_else(|| cell.clone())).collect()
}

/// Parses the table of all tests.
pub fn parse(csv: &str) -> Vec<Held> {
    let held = csv.lines().skip(1).map(|line| {
        let cells = cells(line);
        let [row, _, _, side, test, figure] = &cells[..] else { panic!("six cells: {line}") };
        Held::new(row, side, test, figure)
    });
    held.collect()
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
