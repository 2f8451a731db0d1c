//! Weighted reservoirs.

use super::{Algorithm, Entry, HistoryLayout, PassShader, whole_frames};
use crate::foveation::FoveationKind;
use crate::kernel::acuity;
use crate::kernel::reservoir;
use crate::kernel::wrs::{BiasCode, GateCode, SamplerCode, WrsParams};
use crate::settings::{Bias, GateMetric, GateScale, Sampler, Settings};

pub(super) static ENTRY: Entry = Entry {
    name: "wrs",
    summary: "weighted reservoirs: A-Chao with Bernoulli bias",
    algorithm: Algorithm::Wrs,
    stages: whole_frames,
    history: |settings| HistoryLayout::Reservoirs { keys: has_keys(settings), references: has_references(settings) },
    history_traffic_bytes: |settings| {
        let extra = u32::from(has_keys(settings)) + u32::from(has_references(settings));
        let reservoir = 12 + 4 * extra;
        let noise = if settings.noisy { 4 } else { 0 };
        2 * reservoir + noise
    },
    shader: |settings| match settings.foveation.kind {
        FoveationKind::Quads => PassShader { name: "wrs_quad_pass", block_px: 1 },
        _ => PassShader { name: "wrs_pass", block_px: 1 },
    },
    overrides: |settings| {
        let params = wrs_params(settings);
        vec![
            ("SAMPLER", params.sampler as u32),
            ("BIAS", params.bias as u32),
            ("GATE", params.gate as u32),
            ("WEIGHT_EXPONENT", settings.method.wrs().weight_exponent),
            ("RATE_EXPONENT", settings.method.wrs().rate_exponent),
            ("HAS_REFERENCES", u32::from(has_references(settings))),
            ("FILTER", settings.foveation.kind as u32),
        ]
    },
};

fn has_keys(settings: &Settings) -> bool {
    settings.method.wrs().sampler == Sampler::AEs
}

/// Whether reservoirs have references of the gate.
pub(crate) fn has_references(settings: &Settings) -> bool {
    settings.method.wrs().gate.is_some_and(|gate| gate.scale == GateScale::Candidate)
}

/// Scale of candidate weights outside the fovea: `1 / cell_density(fovea radius)`.
pub(crate) fn inv_density_at_fovea(settings: &Settings) -> f32 {
    1.0 / acuity::cell_density(settings.foveation.fovea_radius_deg())
}

pub(crate) fn wrs_params(settings: &Settings) -> WrsParams {
    let wrs = settings.method.wrs();
    let (bias, exponential_survival) = match wrs.bias {
        Bias::Bernoulli => (BiasCode::Bernoulli, 1.0),
        Bias::Exponential { lambda } => (BiasCode::Exponential, reservoir::exponential_survival(lambda)),
        Bias::None => (BiasCode::None, 1.0),
    };
    let gate = wrs.gate.unwrap_or_default();
    WrsParams {
        sampler: match wrs.sampler {
            Sampler::AChao => SamplerCode::AChao,
            Sampler::AEs => SamplerCode::AEs,
            Sampler::AChaoMean => SamplerCode::AChaoMean,
        },
        bias,
        exponential_survival,
        gate: match (wrs.gate, gate.metric) {
            (None, _) => GateCode::Off,
            (_, GateMetric::DeltaE94) => GateCode::DeltaE94,
            (_, GateMetric::Lightness) => GateCode::Lightness,
        },
        gate_offset: gate.offset,
        inv_gate_divisor: 1.0 / gate.divisor,
    }
}
