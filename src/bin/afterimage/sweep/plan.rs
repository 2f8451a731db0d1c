//! What a sweep measures: a preset or a file, and what the command line adds to it.

use super::SweepArgs;
use crate::failure::Failure;
use afterimage::sweep::grid::parse_switch;
use afterimage::sweep::{Axis, Grid, Options};
use clap::ValueEnum;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// Largest file that is read.
const MAX_BYTES: u64 = 1 << 20;
/// Most measurements of a sweep.
pub const MAX_POINTS: usize = 100_000;
/// Most repetitions with seeds of their own.
const MAX_SEEDS: u64 = 1000;

/// Sweeps that are ready.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PresetName {
    /// Methods, two foveae, the main switches; minutes
    Quick,
    /// Foveae, rates, simulators, all switches, three seeds; hours
    Full,
    /// Of scenes: sampling patterns, samples, depth of paths
    Traced,
    /// Foveae and methods of the paper, three seeds
    Paper,
    /// Of scenes: error against samples and time
    Convergence,
    /// Parts of the passes left out, on frames with broken pixels
    #[cfg(feature = "ablation")]
    Safeguards,
}

impl PresetName {
    fn text(self) -> &'static str {
        match self {
            Self::Quick => include_str!("presets/quick.toml"),
            Self::Full => include_str!("presets/full.toml"),
            Self::Traced => include_str!("presets/traced.toml"),
            Self::Paper => include_str!("presets/paper.toml"),
            #[cfg(feature = "ablation")]
            Self::Safeguards => include_str!("presets/safeguards.toml"),
            Self::Convergence => include_str!("presets/convergence.toml"),
        }
    }
}

/// What a sweep measures.
pub struct SweepPlan {
    pub grid: Grid,
    pub common: Options,
    pub seeds: u64,
}

/// The file.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct PlanFile {
    seeds: Option<u64>,
    #[serde(default)]
    common: BTreeMap<String, Value>,
    #[serde(default)]
    axes: BTreeMap<String, Vec<Value>>,
    #[serde(default)]
    switches: Switches,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Switches {
    #[serde(default)]
    of: Vec<String>,
}

/// A value as people write it.
#[derive(Deserialize)]
#[serde(untagged)]
enum Value {
    Flag(bool),
    Integer(i64),
    Number(f64),
    Text(String),
}

impl Value {
    /// As it is typed for an axis.
    fn typed(&self) -> String {
        match self {
            Self::Flag(true) => "on".into(),
            Self::Flag(false) => "-".into(),
            Self::Integer(v) => v.to_string(),
            Self::Number(v) => v.to_string(),
            Self::Text(text) => text.clone(),
        }
    }
}

impl SweepPlan {
    /// Of the arguments; the command line goes before the file, and the file before the preset.
    pub fn new(args: &SweepArgs) -> Result<Self, Failure> {
        let preset = args.preset.or((args.file.is_none() && args.axis.is_empty()).then_some(PresetName::Quick));
        let mut plan = Self { grid: Grid::default(), common: Options::new(), seeds: 1 };
        if let Some(preset) = preset {
            plan.add("the preset", preset.text())?;
        }
        if let Some(path) = &args.file {
            plan.add(&path.display().to_string(), &read(path)?)?;
        }
        for axis in &args.axis {
            plan.put(Axis::parse(axis)?);
        }
        plan.grid.switches.extend(args.switch.iter().map(|s| parse_switch(s)));
        for (name, value) in args.common()? {
            plan.common.insert(name, value);
        }
        plan.seeds = args.seeds.unwrap_or(plan.seeds);
        if !(1..=MAX_SEEDS).contains(&plan.seeds) {
            return Err(Failure::Input(format!("--seeds {}: expected 1 to {MAX_SEEDS}", plan.seeds)));
        }
        plan.check()?;
        Ok(plan)
    }

    fn add(&mut self, name: &str, text: &str) -> Result<(), Failure> {
        let wrong = |problem: String| Failure::Input(format!("{name}: {problem}"));
        let file: PlanFile = toml::from_str(text).map_err(|e| {
            wrong(format!(
                "is no plan of a sweep ({}); expected seeds = N, [common] option = value, [axes] option = [values], [switches] of = [..]",
                e.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
            ))
        })?;
        self.seeds = file.seeds.unwrap_or(self.seeds);
        for (names, values) in &file.axes {
            let typed: Vec<String> = values.iter().map(Value::typed).collect();
            self.put(
                Axis::new(names, typed.iter().map(String::as_str)).map_err(|e| wrong(format!("axis {names}: {e}")))?,
            );
        }
        for (option, value) in &file.common {
            if let (name, Some(value)) = parse_switch(&format!("{option}={}", value.typed())) {
                self.common.insert(name, value);
            }
        }
        self.grid.switches.extend(file.switches.of.iter().map(|s| parse_switch(s)));
        Ok(())
    }

    /// An axis takes the place of what was said of its options before.
    fn put(&mut self, axis: Axis) {
        self.grid.axes.retain(|a| !a.options.iter().any(|o| axis.options.contains(o)));
        self.common.retain(|name, _| !axis.options.contains(name));
        self.grid.axes.push(axis);
    }

    fn check(&self) -> Result<(), Failure> {
        for reserved in ["out", "input", "seed", "help"] {
            let is_taken = self.common.contains_key(reserved)
                || self.grid.axes.iter().any(|a| a.options.iter().any(|o| o == reserved))
                || self.grid.switches.iter().any(|s| s.0 == reserved);
            if is_taken {
                return Err(Failure::Input(format!(
                    "{reserved}: is the sweep's own; expected an option of run, or --seeds N"
                )));
            }
        }
        let axes = &self.grid.axes;
        if let Some(name) = self.common.keys().find(|name| axes.iter().any(|a| a.options.contains(name))) {
            let text = format!(
                "{name}: is an axis of the sweep and cannot be the same for all points; expected --axis {name}=VALUE"
            );
            return Err(Failure::Input(text));
        }
        let combinations = axes.iter().map(|a| a.values.len()).try_fold(1_usize, usize::checked_mul);
        if combinations.is_none_or(|n| n.saturating_mul(self.seeds as usize) > MAX_POINTS) {
            return Err(Failure::Input(format!("the axes have more than {MAX_POINTS} combinations; leave some out")));
        }
        Ok(())
    }
}

fn read(path: &Path) -> Result<String, Failure> {
    let wrong = |problem: String| Failure::Input(format!("{}: {problem}", path.display()));
    let length = std::fs::metadata(path).map_err(|e| wrong(format!("cannot be read ({e})")))?.len();
    if length > MAX_BYTES {
        return Err(wrong(format!("has {length} bytes; expected a plan of at most {MAX_BYTES}")));
    }
    std::fs::read_to_string(path).map_err(|e| wrong(format!("cannot be read ({e})")))
}
