//! A cycle model of the compute passes on three AMD GPUs.
//!
//! Mesa's RADV makes a device without hardware (`RADV_FORCE_FAMILY`), compiles for it, and says how many cycles it
//! expects of each instruction. `afterimage-isa` adds them up along the paths of a wave and prints the tables of
//! docs/performance.md; `afterimage-isa check` compares them with the page, `afterimage-isa bless` rewrites the page.
//! A model: no memory system, no divergence within a wave.

mod gpu;
mod passes;
mod perf;
mod radv;
mod spirv;
mod table;

use gpu::GPUS;
use passes::{Pass, methods};
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;
use table::{Figures, page_changes, rewritten};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Page with the tables.
const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/performance.md");

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(e) => {
            // Not by a macro for standard error, which tests capture.
            let _ = writeln!(std::io::stderr(), "afterimage-isa: {e}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    if args == ["compile"] {
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
    match args[..] {
        [] => print!("{}", table::all(&methods, &figures)),
        ["check"] => {
            let page = std::fs::read_to_string(PAGE)?;
            let known = table::driver_of(&page).ok_or("docs/performance.md names no driver of the tables")?;
            if known != figures.driver {
                return skip(&format!("the page has figures of {known}, this is {}", figures.driver));
            }
            let changes = page_changes(&page, &figures);
            if !changes.is_empty() {
                let how = "AFTERIMAGE_BLESS=1 cargo test -p afterimage-isa accepts them";
                return Err(format!("cycles differ from docs/performance.md; {how}:\n{}", changes.join("\n")).into());
            }
        }
        ["bless"] => {
            let page = std::fs::read_to_string(PAGE)?;
            std::fs::write(Path::new(PAGE), rewritten(&page, &methods, &figures))?;
        }
        _ => return Err("usage: afterimage-isa [check | bless]".into()),
    }
    Ok(())
}

fn skip(why: &str) -> Result<()> {
    writeln!(std::io::stderr(), "\nSKIPPED: cycles of the passes were not compared: {why}\n")?;
    Ok(())
}
