//! Settings of the path tracer: `--max-depth`, `--integrator`, `--bsdf`, `--effects`.

use super::{Named, by_name};
use crate::failure::Failure;
use afterimage_lab::scene::effects::{Effect, Effects};
use afterimage_trace::settings::{Bsdf, Integrator, MAX_DEPTH, TraceSettings};
use clap::Args;

/// Heading of these options in the help.
const HEADING: &str = "Path tracing";

/// Settings of the path tracer.
#[derive(Args, Clone, Debug)]
pub struct PathArgs {
    /// Largest number of scattering events after the camera ray, 0 to 64
    #[arg(long, default_value_t = 3, value_name = "N", help_heading = HEADING)]
    pub max_depth: u32,
    /// Integrator: multiple importance sampling, next-event estimation, or BSDF sampling alone (as in the thesis)
    #[arg(long, value_parser = by_name::<Integrator>(), default_value = "mis", help_heading = HEADING)]
    pub integrator: Integrator,
    /// Scattering model of surfaces: principled, or Lambert and Phong as in the thesis
    #[arg(long, value_parser = by_name::<Bsdf>(), default_value = "auto", help_heading = HEADING)]
    pub bsdf: Bsdf,
    /// Effects compiled into the kernels: those that the scene needs, all, or a list of names (trace -v prints them)
    #[arg(long, default_value = "auto", value_name = "auto|all|LIST", help_heading = HEADING)]
    effects: String,
}

impl PathArgs {
    /// Converts the options to the library's settings.
    pub fn settings(&self, seed: u64) -> Result<TraceSettings, Failure> {
        if self.max_depth > MAX_DEPTH {
            return Err(Failure::Input(format!("--max-depth {}: expected 0 to {MAX_DEPTH}", self.max_depth)));
        }
        Ok(TraceSettings {
            integrator: self.integrator,
            bsdf: self.bsdf,
            max_depth: self.max_depth,
            seed,
            effects: parse_effects(&self.effects)?,
        })
    }
}

impl Named for Integrator {
    fn rows() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (Self::Mis, "mis", "Multiple importance sampling of lights and BSDF, power heuristic"),
            (Self::Nee, "nee", "Next-event estimation"),
            (Self::Naive, "naive", "BSDF sampling alone"),
        ]
    }
}

impl Named for Bsdf {
    fn rows() -> Vec<(Self, &'static str, &'static str)> {
        vec![(Self::Principled, "auto", "The principled model"), (Self::Phong, "phong", "Lambert and Phong")]
    }
}

fn parse_effects(text: &str) -> Result<Option<Effects>, Failure> {
    match text {
        "auto" => Ok(None),
        "all" => Ok(Some(Effects::all())),
        "none" => Ok(Some(Effects::NONE)),
        list => {
            let find = |name: &str| {
                Effect::ALL.iter().copied().find(|e| e.name() == name).ok_or_else(|| {
                    let names: Vec<_> = Effect::ALL.iter().map(|e| e.name()).collect();
                    Failure::Input(format!(
                        "--effects: '{name}' is no effect; expected auto, all, none, or a list of {}",
                        names.join(", ")
                    ))
                })
            };
            list.split(',').map(|name| find(name.trim())).collect::<Result<Effects, _>>().map(Some)
        }
    }
}
