//! Settings of the path tracer.

use afterimage_lab::scene::effects::Effects;

/// Strategy by which paths collect light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Integrator {
    /// Next event estimation and scattered rays, combined by the power heuristic (Veach 1997). Least noise.
    #[default]
    Mis,
    /// Next event estimation only: a light sample at every surface.
    Nee,
    /// Scattered rays only, as in the thesis. They never hit punctual lights, which have no size.
    Naive,
}

/// Scattering model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Bsdf {
    /// Disney's principled model with glTF's parameters.
    #[default]
    Principled,
    /// The thesis' model: Lambert and Phong lobes, sampled uniformly over the hemisphere.
    Phong,
}

/// Settings of a tracer. The defaults are those of the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TraceSettings {
    /// Strategy by which paths collect light. Default: multiple importance sampling.
    pub integrator: Integrator,
    /// Scattering model. Default: the principled model.
    pub bsdf: Bsdf,
    /// Maximum number of scattering events after the camera ray, 0 to 64. 0 shows emission only, 1 adds direct light.
    /// Time grows in proportion. Default 3.
    pub max_depth: u32,
    /// Seed of all random draws: the same seed and frame number give the same image. Default 0.
    pub seed: u64,
    /// Effects to simulate; `None`: those that the scene needs. Effects left out are missing from the image; effects
    /// that the scene does not need do not change the image. Default `None`.
    pub effects: Option<Effects>,
}

impl Default for TraceSettings {
    fn default() -> Self {
        Self { integrator: Integrator::Mis, bsdf: Bsdf::Principled, max_depth: 3, seed: 0, effects: None }
    }
}

/// Largest [`TraceSettings::max_depth`].
pub const MAX_DEPTH: u32 = 64;
