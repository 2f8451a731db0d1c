//! The tables of docs/cycles.tsv, and what differs from them.

use super::failure::Result;
use super::gpu::{Compiled, GPUS, Gpu};
use super::passes::{MethodPasses, Pass, SIZE_PX};
use super::perf::{PATHS, Path, Program};
use serde_json::Value;

/// Begins the file's first line, before the driver.
const HEAD: &str = "# cargo research isa, ";
/// Begins the line above the figures of the passes.
const PASSES_HEAD: &str = "gpu\tpass\t";
/// Change of a pass's cycles that the file need not follow.
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

    /// Cycles of a pass on a path, for 64 pixels of the frame.
    fn cycles_of(&self, gpu: &Gpu, pass: &Pass, path: usize) -> f64 {
        self.row(gpu.family, &pass.name).cycles(path) * pass.share
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

    /// Name and cycles, as the file has them.
    fn line(&self) -> String {
        let s = |name: &str| self.statistics[name].as_u64().unwrap_or(0);
        let cycles: Vec<String> = (0..PATHS.len()).map(|path| format!("{:.0}", self.cycles(path))).collect();
        let loads = [0, 1].map(|path| format!("{:.3}", self.paths[path].loads / self.pixels));
        let loads = loads.each_ref().map(|l| l.trim_end_matches('0').trim_end_matches('.'));
        format!(
            "{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\n",
            self.family,
            self.pass,
            s("Instructions"),
            s("VGPRs"),
            s("Spilled VGPRs") + s("Spilled SGPRs"),
            self.waves,
            cycles.join("\t"),
            loads[0],
            loads[1],
        )
    }
}

/// The whole file: the driver, figures of the passes, times of a frame, and shares of plans.
pub fn file(methods: &[MethodPasses], figures: &Figures) -> String {
    let [passes, times, plans] = [passes(figures), roofline(methods, figures), plans(methods, figures)];
    format!("{HEAD}{}\n\n{passes}\n{times}\n{plans}", figures.driver)
}

/// Figures of the passes.
fn passes(figures: &Figures) -> String {
    let paths = PATHS.join("\t");
    let head = format!("{PASSES_HEAD}instructions\tVGPRs\tspills\twaves\t{paths}\tloads, still\tloads, moving\n");
    let rows: String = figures.rows.iter().map(Row::line).collect();
    head + &rows
}

/// Times of a frame of all passes: of arithmetic, of memory, and the longer one.
fn roofline(methods: &[MethodPasses], figures: &Figures) -> String {
    let [width, height] = SIZE_PX.map(f64::from);
    let head = [
        "card",
        "method",
        "memory ms",
        "arithmetic ms, still",
        "arithmetic ms, moving",
        "arithmetic ms, relit",
        "frame ms, still",
        "frame ms, moving",
        "frame ms, relit",
    ];
    let mut table = head.join("\t") + "\n";
    for gpu in &GPUS {
        for method in methods {
            let arithmetic_ms = [0, 1, 2].map(|path| {
                let cycles: f64 = method.passes.iter().map(|pass| figures.cycles_of(gpu, pass, path)).sum();
                cycles * width * height / 64.0 / (gpu.simds * gpu.ghz * 1e6)
            });
            let memory_ms = f64::from(method.bytes) * width * height / (gpu.gigabytes * 1e6);
            let cells = [memory_ms].into_iter().chain(arithmetic_ms).chain(arithmetic_ms.map(|ms| ms.max(memory_ms)));
            let cells: Vec<String> = cells.map(|ms| format!("{ms:.2}")).collect();
            table += &format!("{}\t{}\t{}\n", gpu.card, method.name, cells.join("\t"));
        }
    }
    table
}

/// Cycles of plans over those of the method's other passes.
fn plans(methods: &[MethodPasses], figures: &Figures) -> String {
    let mut table = format!("gpu\tmethod\tplan over the other passes, {}\n", PATHS.join("\t"));
    for gpu in &GPUS {
        for method in methods.iter().filter(|m| m.passes.iter().any(|pass| pass.plans)) {
            let cells = [0, 1, 2].map(|path| {
                let sum = |plans: bool| {
                    let passes = method.passes.iter().filter(|pass| pass.plans == plans);
                    passes.map(|pass| figures.cycles_of(gpu, pass, path)).sum::<f64>()
                };
                format!("{:.2}", sum(true) / sum(false))
            });
            table += &format!("{}\t{}\t{}\n", gpu.family, method.name, cells.join("\t"));
        }
    }
    table
}

/// Rows of the figures of the passes.
fn rows_of(file: &str) -> Vec<Vec<&str>> {
    let rows = file.lines().skip_while(|l| !l.starts_with(PASSES_HEAD)).skip(1);
    rows.take_while(|l| !l.is_empty()).map(|l| l.split('\t').collect()).collect()
}

/// Driver of the file's figures.
pub fn driver_of(file: &str) -> Option<&str> {
    file.lines().next()?.strip_prefix(HEAD)
}

/// Passes whose cycles are not those of the file.
pub fn file_changes(file: &str, figures: &Figures) -> Vec<String> {
    changes(&rows_of(file), &rows_of(&passes(figures)))
}

/// Changes between rows.
fn changes(file: &[Vec<&str>], now: &[Vec<&str>]) -> Vec<String> {
    // Behind the GPU and the pass: instructions, registers, spills, waves.
    let cycles = |cells: &[&str], path: usize| cells.get(6 + path).and_then(|c| c.parse::<f64>().ok());
    let mut changes = vec![];
    for row in now {
        let name = row[..2].join(" ");
        let Some(before) = file.iter().find(|r| r[..2] == row[..2]) else {
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
    let gone = file.iter().filter(|r| !now.iter().any(|n| n[..2] == r[..2]));
    changes.extend(gone.map(|r| format!("{} is gone", r[..2].join(" "))));
    changes
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "# cargo research isa, radv 1\n\ngpu\tpass\tinstructions\tVGPRs\tspills\twaves\tstill\tmoving\trelit\n\
        g\ta\t9\t9\t0\t16\t100\t200\t300\ng\tb\t9\t9\t0\t16\t100\t200\t300\n\ncard\tmethod\n";

    #[test]
    fn a_change_is_found() {
        assert_eq!(driver_of(FILE), Some("radv 1"));
        assert_eq!(rows_of(FILE).len(), 2);
        let compare = |now: &str| changes(&rows_of(FILE), &rows_of(now));
        assert_eq!(compare(FILE), Vec::<String>::new());
        let within = FILE.replace("a\t9\t9\t0\t16\t100\t200", "a\t9\t9\t0\t16\t103\t194");
        assert_eq!(compare(&within), Vec::<String>::new());
        let grown = FILE.replace("a\t9\t9\t0\t16\t100\t200", "a\t9\t9\t0\t16\t104\t193");
        let expected = ["g a, still: 100 to 104 cycles (+4.0 %)", "g a, moving: 200 to 193 cycles (-3.5 %)"];
        assert_eq!(compare(&grown), expected);
        assert_eq!(compare(&FILE.replace("g\tb", "g\tc")), ["g c is new", "g b is gone"]);
        assert_eq!(compare(&FILE.replace("a\t9\t9\t0\t16\t100", "a\t9\t9\t0\t16\tx")).len(), 1);
    }
}
