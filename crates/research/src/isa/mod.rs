//! `cargo research isa`: a cycle model of the compute passes on three AMD GPUs.
//!
//! Makes the tables of `docs/cycles.tsv`. Mesa's RADV makes a device without hardware
//! (`RADV_FORCE_FAMILY`), compiles for it, and says how many cycles it expects of each instruction. This adds them up
//! along the paths of a wave. A model: no memory system, no divergence within a wave. Ten
//! seconds.

mod failure;
mod gpu;
mod passes;
mod perf;
mod radv;
mod spirv;
mod table;

use afterimage_program::failure::Failure;
use clap::{Args, ValueEnum};
use failure::Result;
use gpu::GPUS;
use passes::{Pass, methods};
use std::io::Write;
use table::Figures;

/// File with the tables.
const FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/cycles.tsv");

/// Cycles of the passes on AMD GPUs, modelled from the code of Mesa's driver
#[derive(Args, Clone, Debug)]
pub struct IsaArgs {
    /// What to do; default: print the tables
    #[arg(value_enum)]
    action: Option<Action>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Action {
    /// Compare the tables with docs/cycles.tsv
    Check,
    /// Rewrite docs/cycles.tsv
    Bless,
    /// Compile the passes for the GPU that RADV_FORCE_FAMILY names, in a process of its own
    #[value(hide = true)]
    Compile,
}

/// Makes, compares or rewrites the tables.
pub fn bench(args: &IsaArgs) -> std::result::Result<(), Failure> {
    run(args.action).map_err(|e| Failure::Work(e.to_string()))
}

fn run(action: Option<Action>) -> Result<()> {
    if action == Some(Action::Compile) {
        // In a process of its own: see Gpu::compile.
        return gpu::compile_all();
    }
    let Some(icd) = radv::icd() else { return skip("no RADV (Debian: mesa-vulkan-drivers)") };
    let methods = methods()?;
    let passes: Vec<&Pass> = methods.iter().flat_map(|m| &m.passes).collect();
    let mut figures = Figures::default();
    for gpu in &GPUS {
        figures.add(gpu, &passes, gpu.compile(&icd, passes.len())?)?;
    }
    match action {
        None | Some(Action::Compile) => print!("{}", table::file(&methods, &figures)),
        Some(Action::Check) => {
            let file = std::fs::read_to_string(FILE)?;
            let known = table::driver_of(&file).ok_or("docs/cycles.tsv names no driver in its first line")?;
            if known != figures.driver {
                return skip(&format!("docs/cycles.tsv has figures of {known}, this is {}", figures.driver));
            }
            let changes = table::file_changes(&file, &figures);
            if !changes.is_empty() {
                let how = "cargo research isa bless accepts them";
                return Err(format!("cycles differ from docs/cycles.tsv; {how}:\n{}", changes.join("\n")).into());
            }
        }
        Some(Action::Bless) => std::fs::write(FILE, table::file(&methods, &figures))?,
    }
    Ok(())
}

fn skip(why: &str) -> Result<()> {
    writeln!(std::io::stderr(), "\nSKIPPED: cycles of the passes were not compared: {why}\n")?;
    Ok(())
}
