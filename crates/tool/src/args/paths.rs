//! What paths are traced: `--max-depth`, `--integrator`, `--bsdf`, `--effects`.

use crate::failure::Failure;
use afterimage_lab::trace::effects::{Effect, Effects};
use afterimage_lab::trace::settings::{Bsdf, Integrator, MAX_DEPTH, TraceSettings};
use clap::{Args, ValueEnum};

/// What paths are traced.
#[derive(Args, Clone, Debug)]
pub struct PathArgs {
    /// Most scattering events after the camera ray, 0 to 64
    #[arg(long, default_value_t = 3, value_name = "N")]
    pub max_depth: u32,
    /// How paths find light: both ways, by looking for lights, or by chance (the thesis' way)
    #[arg(long, value_enum, default_value = "mis")]
    pub integrator: IntegratorName,
    /// How surfaces scatter: the principled model, or the thesis' Lambert and Phong
    #[arg(long, value_enum, default_value = "auto")]
    pub bsdf: BsdfName,
    /// What the kernels are specialised to: what the scene needs, all, or a list of names (trace -v prints them)
    #[arg(long, default_value = "auto", value_name = "auto|all|LIST")]
    effects: String,
}

/// Names of integrators.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum IntegratorName {
    /// Both ways, weighted by the power heuristic
    Mis,
    /// By looking for lights
    Nee,
    /// By chance
    Naive,
}

/// Names of scattering models.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BsdfName {
    /// The principled model
    Auto,
    /// Lambert and Phong
    Phong,
}

impl PathArgs {
    /// The library's form.
    pub fn settings(&self, seed: u64) -> Result<TraceSettings, Failure> {
        if self.max_depth > MAX_DEPTH {
            return Err(Failure::Input(format!("--max-depth {}: expected 0 to {MAX_DEPTH}", self.max_depth)));
        }
        Ok(TraceSettings {
            integrator: match self.integrator {
                IntegratorName::Mis => Integrator::Mis,
                IntegratorName::Nee => Integrator::Nee,
                IntegratorName::Naive => Integrator::Naive,
            },
            bsdf: match self.bsdf {
                BsdfName::Auto => Bsdf::Principled,
                BsdfName::Phong => Bsdf::Phong,
            },
            max_depth: self.max_depth,
            seed,
            effects: parse_effects(&self.effects)?,
        })
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
                        "--effects: '{name}' is none; expected auto, all, none, or a list of {}",
                        names.join(", ")
                    ))
                })
            };
            list.split(',').map(|name| find(name.trim())).collect::<Result<Effects, _>>().map(Some)
        }
    }
}
