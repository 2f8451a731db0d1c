//! Plan of a sweep: a preset or a file, with additions of the command line.

use super::SweepArgs;
use crate::failure::Failure;
use crate::sweep::grid::parse_switch;
use crate::sweep::{Axis, Plan};
use clap::ValueEnum;

/// Values of `--preset`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PresetName {
    /// Methods, two sizes of the fovea, the main switches; minutes
    Quick,
    /// Sizes of the fovea, rates, simulators, all switches, three seeds; hours
    Full,
    /// Scenes: sampling patterns, samples, path depth
    Traced,
    /// Rasterised scenes: foveation, sizes of the fovea and rates, against the time of the whole frame
    Raster,
    /// Quads: fovea, middle region, steps and budget, antialiased: for the view of --set hfov and --size
    Quads,
    /// Sizes of the fovea and methods of the paper, three seeds
    Paper,
    /// Scenes: error against samples and time
    Convergence,
}

impl PresetName {
    fn text(self) -> &'static str {
        match self {
            Self::Quick => include_str!("presets/quick.toml"),
            Self::Full => include_str!("presets/full.toml"),
            Self::Traced => include_str!("presets/traced.toml"),
            Self::Raster => include_str!("presets/raster.toml"),
            Self::Quads => include_str!("presets/quads.toml"),
            Self::Paper => include_str!("presets/paper.toml"),
            Self::Convergence => include_str!("presets/convergence.toml"),
        }
    }
}

/// The plan of the arguments. The command line overrides the file, and the file overrides the preset.
pub fn plan(args: &SweepArgs) -> Result<Plan, Failure> {
    let preset = args.preset.or((args.file.is_none() && args.axis.is_empty()).then_some(PresetName::Quick));
    let mut plan = Plan::default();
    if let Some(preset) = preset {
        plan.add("the preset", preset.text())?;
    }
    if let Some(path) = &args.file {
        plan.add_file(path)?;
    }
    for axis in &args.axis {
        plan.put(Axis::parse(axis)?);
    }
    plan.grid.switches.extend(args.switch.iter().map(|s| parse_switch(s)));
    for (name, value) in args.common()? {
        plan.common.insert(name, value);
    }
    plan.seeds = args.seeds.unwrap_or(plan.seeds);
    plan.check()?;
    Ok(plan)
}
