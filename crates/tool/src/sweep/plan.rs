//! Plan of a sweep, read from a file.

use super::grid::{Axis, Grid, Options, parse_switch};
use afterimage_lab::error::InputError;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// Size limit of the file, bytes.
const MAX_BYTES: u64 = 1 << 20;
/// Limit on the measurements of a sweep.
pub const MAX_POINTS: usize = 100_000;
/// Limit on the number of seeds.
const MAX_SEEDS: u64 = 1000;
const EXPECTED: &str =
    "expected seeds = N, [common] option = value, [axes] option = [values], [switches] of = [options]";

/// Plan of a sweep.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Options that differ between points.
    pub grid: Grid,
    /// Options that all points share.
    pub common: Options,
    /// Number of seeds for randomized methods.
    pub seeds: u64,
}

impl Default for Plan {
    fn default() -> Self {
        Self { grid: Grid::default(), common: Options::new(), seeds: 1 }
    }
}

/// The plan in TOML.
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

/// A value of an option.
#[derive(Deserialize)]
#[serde(untagged)]
enum Value {
    Flag(bool),
    Integer(i64),
    Number(f64),
    Text(String),
}

impl Value {
    /// The value in the syntax of `--axis`.
    fn axis_text(&self) -> String {
        match self {
            Self::Flag(true) => "on".into(),
            Self::Flag(false) => "-".into(),
            Self::Integer(v) => v.to_string(),
            Self::Number(v) => v.to_string(),
            Self::Text(text) => text.clone(),
        }
    }
}

impl Plan {
    /// Reads a plan from a file and adds it to this one.
    ///
    /// # Errors
    /// If the file cannot be read or is larger than 1 MiB, and those of [`Plan::add`].
    pub fn add_file(&mut self, path: &Path) -> Result<(), InputError> {
        let name = path.display().to_string();
        let wrong = |problem: String| InputError::invalid(&name, problem, "expected a plan of at most 1 MiB");
        let unreadable = |e: std::io::Error| wrong(format!("cannot be read ({e})"));
        let length = std::fs::metadata(path).map_err(unreadable)?.len();
        if length > MAX_BYTES {
            return Err(wrong(format!("has {length} bytes")));
        }
        self.add(&name, &std::fs::read_to_string(path).map_err(unreadable)?)
    }

    /// Adds a plan in TOML, which overrides earlier axes of the same options. `name`: its name in errors.
    ///
    /// # Errors
    /// If the text is not TOML of the form in docs/sweep.md.
    pub fn add(&mut self, name: &str, text: &str) -> Result<(), InputError> {
        let wrong = |problem: String| InputError::invalid(name, problem, EXPECTED);
        let file: PlanFile = toml::from_str(text).map_err(|e| {
            let reason = e.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
            wrong(format!("is no plan of a sweep ({reason})"))
        })?;
        self.seeds = file.seeds.unwrap_or(self.seeds);
        for (names, values) in &file.axes {
            let texts: Vec<String> = values.iter().map(Value::axis_text).collect();
            let axis = Axis::new(names, texts.iter().map(String::as_str));
            self.put(axis.map_err(|e| wrong(format!("axis {}: {e}", names.escape_debug())))?);
        }
        for (option, value) in &file.common {
            if let (name, Some(value)) = parse_switch(&format!("{option}={}", value.axis_text())) {
                self.common.insert(name, value);
            }
        }
        self.grid.switches.extend(file.switches.of.iter().map(|s| parse_switch(s)));
        Ok(())
    }

    /// Adds an axis, which replaces earlier axes and common values of its options.
    pub fn put(&mut self, axis: Axis) {
        self.grid.axes.retain(|a| !a.options.iter().any(|o| axis.options.contains(o)));
        self.common.retain(|name, _| !axis.options.contains(name));
        self.grid.axes.push(axis);
    }

    /// Checks whether the plan can be measured.
    ///
    /// # Errors
    /// If an option is reserved for the sweep or is both common and an axis, or for more than 1000 seeds or 100,000
    /// points.
    pub fn check(&self) -> Result<(), InputError> {
        if !(1..=MAX_SEEDS).contains(&self.seeds) {
            let range = format!("1 to {MAX_SEEDS}");
            let subject = format!("--seeds {}", self.seeds);
            return Err(InputError::request(subject, format!("is not in {range}"), format!("expected {range}")));
        }
        let axes = &self.grid.axes;
        for reserved in ["out", "input", "seed", "help"] {
            let is_taken = self.common.contains_key(reserved)
                || axes.iter().any(|a| a.options.iter().any(|o| o == reserved))
                || self.grid.switches.iter().any(|s| s.0 == reserved);
            if is_taken {
                let remedy = "expected an option of run, or --seeds N";
                return Err(InputError::request(reserved, "is set by the sweep itself", remedy));
            }
        }
        if let Some(name) = self.common.keys().find(|name| axes.iter().any(|a| a.options.contains(name))) {
            let problem = "is an axis of the sweep and cannot be the same for all points";
            return Err(InputError::request(name, problem, format!("expected --axis {name}=VALUE")));
        }
        let combinations = axes.iter().map(|a| a.values.len()).try_fold(1_usize, usize::checked_mul);
        if combinations.is_none_or(|n| n.saturating_mul(self.seeds as usize) > MAX_POINTS) {
            let text = format!("have more than {MAX_POINTS} combinations");
            return Err(InputError::request("the axes", text, "leave some out"));
        }
        Ok(())
    }
}
