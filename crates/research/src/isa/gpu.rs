//! The GPUs, and what their compiler says of the passes.

use super::failure::Result;
use super::passes::methods;
use super::radv::Radv;
use super::spirv;
use serde_json::{Value, json};
use std::io::Write;
use std::path::Path;
use std::process::Command;

/// A GPU that RADV compiles for, with waves of 64.
pub struct Gpu {
    /// Name for RADV.
    pub family: &'static str,
    /// Whether it is of the older kind (GCN): its SIMDs are 16 wide.
    pub is_gcn: bool,
    /// A card of the kind, and its SIMDs, clock in GHz and bandwidth in GB/s.
    pub card: &'static str,
    pub simds: f64,
    pub ghz: f64,
    pub gigabytes: f64,
}

pub const GPUS: [Gpu; 3] = [
    Gpu { family: "gfx1100", is_gcn: false, card: "7900 XTX", simds: 192.0, ghz: 2.4, gigabytes: 960.0 },
    Gpu { family: "navi21", is_gcn: false, card: "6900 XT", simds: 160.0, ghz: 2.25, gigabytes: 512.0 },
    Gpu { family: "vega10", is_gcn: true, card: "Vega 64", simds: 256.0, ghz: 1.55, gigabytes: 484.0 },
];

/// In standard error, before what ACO says of a pass.
const MARK: &str = "the pass:";

/// What was said of the passes.
pub struct Compiled {
    /// Name and version of the driver.
    pub driver: String,
    /// For each pass the driver's statistics, and the code with ACO's estimates.
    pub passes: Vec<(Value, String)>,
}

impl Gpu {
    /// Compiles all `count` passes in a process of its own: its environment names the GPU, and ACO writes to its
    /// standard error.
    pub fn compile(&self, icd: &Path, count: usize) -> Result<Compiled> {
        let runtime = tempfile::tempdir()?;
        let mut command = Command::new(std::env::current_exe()?);
        command.args(["isa", "compile"]).env("RADV_FORCE_FAMILY", self.family).env("ACO_DEBUG", "perfinfo");
        // A pipeline that RADV finds in its cache says nothing.
        command.env("MESA_SHADER_CACHE_DISABLE", "1").env("RADV_DEBUG", "nocache");
        command.env("VK_ICD_FILENAMES", icd).env_remove("VK_DRIVER_FILES");
        let output = command.env("XDG_RUNTIME_DIR", runtime.path()).output()?;
        let log = String::from_utf8_lossy(&output.stderr);
        if !output.status.success() {
            let last: Vec<&str> = log.lines().rev().take(3).collect();
            return Err(format!("{}: {}: {}", self.family, output.status, last.join("; ")).into());
        }
        let said: Value = serde_json::from_slice(&output.stdout)?;
        let statistics = said["passes"].as_array().ok_or("no statistics")?;
        // Before the first mark are the driver's own shaders.
        let codes = log.split(MARK).skip(1);
        let passes_said: Vec<_> = statistics.iter().cloned().zip(codes.map(str::to_owned)).collect();
        assert_eq!(passes_said.len(), count, "{}: passes", self.family);
        let driver = said["driver"].as_str().ok_or("no driver")?.to_owned();
        Ok(Compiled { driver, passes: passes_said })
    }
}

/// In the process for one GPU: compiles all passes; writes JSON to standard output.
pub fn compile_all() -> Result<()> {
    let radv = Radv::new()?;
    let mut statistics = vec![];
    for pass in methods()?.iter().flat_map(|m| &m.passes) {
        let shader = spirv::shader(&pass.text, &pass.overrides).map_err(|e| format!("{}: {e}", pass.name))?;
        writeln!(std::io::stderr(), "{MARK}")?;
        statistics.push(Value::from(radv.compile(&shader)?));
    }
    println!("{}", json!({ "driver": radv.driver(), "passes": statistics }));
    Ok(())
}
