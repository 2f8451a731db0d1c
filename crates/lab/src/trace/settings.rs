//! How light is followed.

use super::effects::Effects;

/// How paths find light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integrator {
    /// Both by looking for lights and by meeting them, weighted by the power heuristic (Veach 1997): least noise.
    #[default]
    Mis,
    /// By looking for lights at every surface.
    Nee,
    /// By meeting them only: the thesis' tracer. Punctual lights, which have no size, are never met.
    Naive,
}

/// How surfaces scatter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Bsdf {
    /// Disney's principled model in glTF's parameters.
    #[default]
    Principled,
    /// The thesis' model: Lambert and Phong, sampled uniformly.
    Phong,
}

/// What a tracer is made for. The defaults are those of the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TraceSettings {
    /// How paths find light. Default: both ways.
    pub integrator: Integrator,
    /// How surfaces scatter. Default: the principled model.
    pub bsdf: Bsdf,
    /// Most scattering events after the camera ray, 0 to 64; 0 shows only what emits, 1 direct light. More costs time in
    /// proportion. Default 3.
    pub max_depth: u32,
    /// Seed of all draws: same seed, same frames, same image. Default 0.
    pub seed: u64,
    /// What is simulated; `None`: what the scene needs. Effects that are left out are not there, those that nothing needs change
    /// no bit of the image. Default `None`.
    pub effects: Option<Effects>,
}

impl Default for TraceSettings {
    fn default() -> Self {
        Self { integrator: Integrator::Mis, bsdf: Bsdf::Principled, max_depth: 3, seed: 0, effects: None }
    }
}

/// Largest [`TraceSettings::max_depth`].
pub const MAX_DEPTH: u32 = 64;
