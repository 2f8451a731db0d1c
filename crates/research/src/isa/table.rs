//! The tables of docs/performance.md, and what differs from them.

use super::failure::Result;
use super::gpu::{Compiled, GPUS, Gpu};
use super::passes::{MethodPasses, Pass, SIZE_PX};
use super::perf::{PATHS, Path, Program};
use serde_json::Value;

const MARKER: &str = "<!-- generated: cargo research isa, ";
/// Change of a pass's cycles that the page need not follow.
const TOLERANCE: f64 = 0.03;

/// All figures.
#[derive(Default)]
pub struct Figures {
    /// Name and version of the driver.
    pub driver: String,
    rows: Vec<Row>,
}

/// Figures of a pass on a GPU.
struct Row {
    family: &'static str,
    pass: String,
    statistics: Value,
    waves: f64,
    /// In the order of [`PATHS`].
    paths: [Path; 3],
    /// Pixels that an invocation takes.
    pixels: f64,
}

impl Figures {
    /// Adds the figures of a GPU.
    pub fn add(&mut self, gpu: &Gpu, passes: &[&Pass], compiled: Compiled) -> Result<()> {
        self.driver = compiled.driver;
        let mut wrong = vec![];
        for (pass, (statistics, code)) in passes.iter().zip(compiled.passes) {
            let program = Program::parse(&code, gpu);
            if program.loops != pass.loops.len() {
                let known = pass.loops;
                wrong.push(format!("{} on {}: {} loops, not {known:?}", pass.name, gpu.family, program.loops));
                continue;
            }
            let paths = PATHS.map(|path| program.on_path(pass.loops, path));
            let (family, pixels, name, waves) = (gpu.family, pass.pixels, pass.name.clone(), program.waves);
            self.rows.push(Row { family, pass: name, statistics, waves, paths, pixels });
        }
        if wrong.is_empty() { Ok(()) } else { Err(wrong.join("\n").into()) }
    }

    fn row(&self, family: &str, pass: &str) -> &Row {
        self.rows.iter().find(|r| r.family == family && r.pass == pass).expect("every pass is on every GPU")
    }
}

impl Row {
    /// Cycles of a SIMD for 64 pixels, texels or samples.
    fn cycles(&self, path: usize) -> f64 {
        self.paths[path].cycles / self.pixels
    }

    /// Name and cycles, as the page has them.
    fn line(&self) -> String {
        let s = |name: &str| self.statistics[name].as_u64().unwrap_or(0);
        let cycles: Vec<String> = (0..PATHS.len()).map(|path| format!("{:.0}", self.cycles(path))).collect();
        let loads = [0, 1].map(|path| format!("{:.3}", self.paths[path].loads / self.pixels));
        let loads = loads.each_ref().map(|l| l.trim_end_matches('0').trim_end_matches('.'));
        format!(
            "| {} | {} | {} | {} | {} | {} | {} | {}, {} |\n",
            self.family,
            self.pass,
            s("Instructions"),
            s("VGPRs"),
            s("Spilled VGPRs") + s("Spilled SGPRs"),
            self.waves,
            cycles.join(" | "),
            loads[0],
            loads[1],
        )
    }
}

/// Both tables.
pub fn all(methods: &[MethodPasses], figures: &Figures) -> String {
    format!("{}\n{}", passes(figures), roofline(methods, figures))
}

/// Figures of the passes. The head of its first column names the driver.
fn passes(figures: &Figures) -> String {
    let head = format!(
        "| {} | pass | instructions | VGPRs | spills | waves | {} | loads, still and moving |\n",
        figures.driver,
        PATHS.join(" | ")
    );
    let rows: String = figures.rows.iter().map(Row::line).collect();
    format!("{head}{}|\n{rows}", "|---".repeat(10))
}

/// Times of a frame of all passes: of arithmetic, of memory, and the longer one.
fn roofline(methods: &[MethodPasses], figures: &Figures) -> String {
    let [width, height] = SIZE_PX.map(f64::from);
    let head =
        "| card | method | memory ms | arithmetic ms, still | moving | relit | frame ms, still | moving | relit |\n";
    let mut table = format!("{head}{}|\n", "|---".repeat(9));
    for gpu in &GPUS {
        for method in methods {
            let arithmetic_ms = [0, 1, 2].map(|path| {
                let cycles: f64 = method
                    .passes
                    .iter()
                    .map(|pass| figures.row(gpu.family, &pass.name).paths[path].cycles / pass.pixels * pass.share)
                    .sum();
                cycles * width * height / 64.0 / (gpu.simds * gpu.ghz * 1e6)
            });
            let memory_ms = f64::from(method.bytes) * width * height / (gpu.gigabytes * 1e6);
            let cells = [memory_ms].into_iter().chain(arithmetic_ms).chain(arithmetic_ms.map(|ms| ms.max(memory_ms)));
            let cells: Vec<String> = cells.map(|ms| format!("{ms:.2}")).collect();
            table += &format!("| {} | {} | {} |\n", gpu.card, method.name, cells.join(" | "));
        }
    }
    table
}

/// The page with its tables generated anew.
pub fn rewritten(page: &str, methods: &[MethodPasses], figures: &Figures) -> String {
    let mut output = String::new();
    let mut is_replaced = false;
    for line in page.lines() {
        is_replaced = is_replaced && line.starts_with('|');
        if is_replaced {
            continue;
        }
        output += line;
        output.push('\n');
        if let Some(kind) = line.strip_prefix(MARKER) {
            output += &if kind.starts_with("roofline") { roofline(methods, figures) } else { passes(figures) };
            is_replaced = true;
        }
    }
    output
}

/// Lines of the table of passes.
fn lines_of(page: &str) -> impl Iterator<Item = Vec<&str>> {
    let lines = page.lines().skip_while(|l| !l.starts_with(&format!("{MARKER}passes"))).skip(1);
    lines.take_while(|l| l.starts_with('|')).map(|l| l.trim_matches('|').split('|').map(str::trim).collect())
}

/// Driver of the page's figures.
pub fn driver_of(page: &str) -> Option<String> {
    Some(lines_of(page).next()?.first()?.to_string())
}

/// Passes whose cycles are not those of the page.
pub fn page_changes(page: &str, figures: &Figures) -> Vec<String> {
    let now = passes(figures);
    let now = format!("{MARKER}passes -->\n{now}");
    changes(lines_of(page).collect(), lines_of(&now).collect())
}

/// Changes between rows; the first two are head and rule.
fn changes(page: Vec<Vec<&str>>, now: Vec<Vec<&str>>) -> Vec<String> {
    let [page, now] = [page, now].map(|rows| rows.into_iter().skip(2).collect::<Vec<_>>());
    // Behind the GPU and the pass: instructions, registers, spills, waves.
    let cycles = |cells: &[&str], path: usize| cells.get(6 + path).and_then(|c| c.parse::<f64>().ok());
    let mut changes = vec![];
    for row in &now {
        let name = row[..2].join(" ");
        let Some(before) = page.iter().find(|r| r[..2] == row[..2]) else {
            changes.push(format!("{name} is new"));
            continue;
        };
        for (path, path_name) in PATHS.iter().enumerate() {
            let pair = cycles(before, path).zip(cycles(row, path));
            let Some((was, is)) = pair else {
                changes.push(format!("{name}, {path_name}: no number"));
                continue;
            };
            if (is - was).abs() > TOLERANCE * was {
                changes.push(format!("{name}, {path_name}: {was} to {is} cycles ({:+.1} %)", 100.0 * (is / was - 1.0)));
            }
        }
    }
    let gone = page.iter().filter(|r| !now.iter().any(|n| n[..2] == r[..2]));
    changes.extend(gone.map(|r| format!("{} is gone", r[..2].join(" "))));
    changes
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str = "<!-- generated: cargo research isa, passes -->\n| radv 1 | pass | instructions | VGPRs | spills \
        | waves | still | moving | relit | loads |\n|---|\n| g | a | 9 | 9 | 0 | 16 | 100 | 200 | 300 | 5, 5 |\n\
        | g | b | 9 | 9 | 0 | 16 | 100 | 200 | 300 | 5, 5 |\n\ntext\n";

    #[test]
    fn a_change_is_found() {
        assert_eq!(driver_of(PAGE).as_deref(), Some("radv 1"));
        let compare = |now: &str| changes(lines_of(PAGE).collect(), lines_of(now).collect());
        assert_eq!(compare(PAGE), Vec::<String>::new());
        let within = PAGE.replace("| a | 9 | 9 | 0 | 16 | 100 | 200 |", "| a | 9 | 9 | 0 | 16 | 103 | 194 |");
        assert_eq!(compare(&within), Vec::<String>::new());
        let grown = PAGE.replace("| a | 9 | 9 | 0 | 16 | 100 | 200 |", "| a | 9 | 9 | 0 | 16 | 104 | 193 |");
        let expected = ["g a, still: 100 to 104 cycles (+4.0 %)", "g a, moving: 200 to 193 cycles (-3.5 %)"];
        assert_eq!(compare(&grown), expected);
        assert_eq!(compare(&PAGE.replace("| b |", "| c |")), ["g c is new", "g b is gone"]);
        assert_eq!(compare(&PAGE.replace("| a | 9 | 9 | 0 | 16 | 100", "| a | 9 | 9 | 0 | 16 | x")).len(), 1);
    }
}
