//! Sums of ACO's estimate for each instruction (`ACO_DEBUG=perfinfo`), with the known number of rounds of each loop.
//! ACO itself assumes 8 rounds for every loop and 32 for an inner one, and that every branch is taken half or three
//! quarters of the time.

use super::gpu::Gpu;
use std::collections::BTreeMap;

/// Paths of a wave: nothing moves; all moves; smr also relights history.
pub const PATHS: [&str; 3] = ["still", "moving", "relit"];

/// Rounds of a loop of the shaders on a path of a wave.
fn rounds(name: &str, path: &str) -> f64 {
    match (name, path) {
        // Of smr: 2x2 pixels.
        ("block", _) => 4.0,
        // Pixels or samples of 3x3.
        ("around", _) => 9.0,
        // Of four taps of Catmull-Rom's twelve.
        ("resample", "moving" | "relit") => 3.0,
        ("relight", "relit") => 1.0,
        ("four", _) | ("four relit", "relit") => 4.0,
        // Shaded pixels of an invocation.
        ("pixel", _) => 1.0,
        // Samples around a noisy one, its own included.
        ("twelve", _) => 12.0,
        // Further paths of a noisy pixel, as a mean.
        ("paths", _) => 2.0,
        ("around relit", "relit") => 9.0,
        // Of plans: keys of an invocation, and sums of all invocations.
        ("keys", _) => 256.0,
        ("runs", _) | ("runs relit", "relit") => 64.0,
        // Quads of a run and beside it.
        ("run", _) => 32.0,
        ("list", _) => 2.0,
        // Rows until none has nearer quads, above and below, as a mean over the periphery of default quads.
        ("rows", _) => 5.0,
        ("quads", _) => 36.0,
        // That of the samples around, and that of the block.
        ("gains", _) => 2.0,
        ("quads relit", "relit") => 36.0,
        ("guard", "moving" | "relit") => 1.0,
        // Few pixels need the slope of the depth test, and few are at full rate.
        (
            "slope" | "near" | "resample" | "relight" | "around relit" | "quads relit" | "four relit" | "runs relit"
            | "guard",
            _,
        ) => 0.0,
        ("no paths" | "no pixels", _) => 0.0,
        _ => panic!("no loop {name}"),
    }
}

#[derive(Default)]
struct Block {
    /// Loops that it is in, outermost first.
    inside: Vec<usize>,
    is_header: bool,
    use_of: BTreeMap<&'static str, f64>,
}

/// Code of a pass.
#[derive(Default)]
pub struct Program {
    blocks: Vec<Block>,
    pub loops: usize,
    /// Waves that fit a SIMD.
    pub waves: f64,
}

/// What a wave does on a path.
#[derive(Clone, Copy)]
pub struct Path {
    /// Cycles of the busiest unit of a SIMD.
    pub cycles: f64,
    /// Instructions that read images and buffers, of all invocations together.
    pub loads: f64,
}

impl Program {
    pub fn parse(text: &str, gpu: &Gpu) -> Self {
        let mut program = Self::default();
        let mut open = vec![];
        for line in text.lines() {
            if line.starts_with("BB") {
                program.blocks.push(Block::default());
            } else if let Some((_, kind)) = line.split_once("kind:") {
                let block = program.blocks.last_mut().expect("its first line");
                // A block may leave a loop and lead to the next one, which its own header begins.
                if kind.contains("loop-exit") {
                    open.pop();
                }
                if kind.contains("loop-header") {
                    open.push(program.loops);
                    program.loops += 1;
                    block.is_header = true;
                }
                block.inside.clone_from(&open);
            } else if let Some((clocks, instruction)) =
                line.trim_start().strip_prefix('(').and_then(|l| l.split_once(" clk)"))
            {
                let uses = &mut program.blocks.last_mut().expect("a block").use_of;
                add_instruction(uses, clocks, instruction, gpu);
            } else if let Some(waves) = line.strip_prefix("num_waves: ") {
                program.waves = waves.parse().expect("a number");
            }
        }
        program
    }

    /// Sums over a path; all branches are taken.
    pub fn on_path(&self, loops: &[&str], path: &str) -> Path {
        let mut sums = BTreeMap::new();
        for block in &self.blocks {
            let mut times = 1.0;
            for (depth, &i) in block.inside.iter().enumerate() {
                // The header is looked at once more than the body.
                let is_own = block.is_header && depth + 1 == block.inside.len();
                times *= rounds(loops[i], path) + f64::from(u8::from(is_own));
            }
            for (&unit, cycles) in &block.use_of {
                *sums.entry(unit).or_insert(0.0) += cycles * times;
            }
        }
        let sum = |unit| sums.get(unit).copied().unwrap_or(0.0);
        let busiest = ["valu", "complex", "scalar"].map(sum).into_iter().fold(0.0, f64::max);
        Path { cycles: busiest.max(sum("latency") / self.waves), loads: sum("loads") }
    }
}

/// Adds an instruction to the use of the units.
fn add_instruction(uses: &mut BTreeMap<&'static str, f64>, clocks: &str, instruction: &str, gpu: &Gpu) {
    let op = instruction.split_once(" = ").map_or(instruction, |(_, rest)| rest).split_whitespace().next();
    let op = op.expect("an instruction");
    let mut add = |unit, cycles| *uses.entry(unit).or_insert(0.0) += cycles;
    add("latency", clocks.trim().parse::<f64>().expect("a number"));
    if op.starts_with("v_") {
        let (valu, complex) = cycles(op, gpu.is_gcn);
        // A wave of 64 takes two passes on a SIMD that is 32 wide.
        let passes = if gpu.is_gcn { 1.0 } else { 2.0 };
        add("valu", valu * passes);
        add("complex", complex * passes);
    } else if op.starts_with("image_") || op.starts_with("buffer_") {
        add(if op.contains("store") { "stores" } else { "loads" }, 1.0);
    } else if op.starts_with("s_") && !op.starts_with("s_waitcnt") && op != "s_clause" {
        add("scalar", if gpu.is_gcn { 4.0 } else { 1.0 });
    }
}

/// Cycles of the vector unit, and of its slow part (`get_perf_info` of Mesa's `aco_statistics.cpp`).
fn cycles(op: &str, is_gcn: bool) -> (f64, f64) {
    let any = |of: &[&str]| of.iter().any(|o| op.starts_with(o));
    if any(&["v_rcp_", "v_rsq_", "v_sqrt_", "v_exp_", "v_log_", "v_sin_", "v_cos_"]) {
        return if is_gcn { (16.0, 0.0) } else { (1.0, 4.0) };
    }
    if any(&["v_mul_lo_u32", "v_mul_hi_", "v_mul_lo_i32"]) {
        return if is_gcn { (16.0, 0.0) } else { (4.0, 4.0) };
    }
    if any(&["v_lshlrev_b64", "v_lshrrev_b64", "v_ashrrev_i64", "v_mad_u64_u32"]) {
        return if is_gcn { (8.0, 0.0) } else { (2.0, 2.0) };
    }
    match (is_gcn, op.starts_with("v_cvt_")) {
        (true, true) => (16.0, 0.0),
        (true, false) => (4.0, 0.0),
        (false, _) => (1.0, 0.0),
    }
}
