//! Reservoir arithmetic: closed forms P1-P8 and hard cases H03, H05-H14, H16, with statistics and planted errors.

mod growth;
mod law;
mod properties;
mod storage;
mod weighted;

use afterimage::kernel::reservoir::Reservoir;
use afterimage::kernel::stored_reservoir;
use afterimage::kernel::stored_reservoir::Stored;
use afterimage::kernel::wrs;
use afterimage::kernel::wrs::{BiasCode, GateCode, Past, SamplerCode, WrsParams};
use afterimage::kernel::{pack, reservoir};
use afterimage_testing::{Draws, accept, p_of_counts, p_of_rate, reject};
use glam::Vec3;
use proptest::prelude::*;

const PAPER: WrsParams = WrsParams {
    sampler: SamplerCode::AChao,
    bias: BiasCode::Bernoulli,
    exponential_survival: 1.0,
    gate: GateCode::Off,
    gate_offset: 0.0,
    inv_gate_divisor: 0.01,
};

/// History sum after one frame, with a gate of constant value `g` (as if the colors differed by 1 - g).
fn recur(a: f32, b: f32, g: f32) -> f32 {
    a * (reservoir::bernoulli_survival(a, b) * g) + b
}

/// History sum after one frame in f64, from eq. 7 as printed.
fn recur64(a: f64, b: f64, g: f64) -> f64 {
    g * a * (1.0 - b / (a + b)) + b
}

fn past(w_sum: f32) -> Past {
    Past { color: Vec3::new(0.1, 0.2, 0.3), w_sum, log_key: f32::MIN }
}

fn step(params: &WrsParams, w_sum: f32, weight: f32, draw: f32) -> wrs::Decision {
    wrs::decide_sample(Vec3::new(0.3, 0.2, 0.1), weight, past(w_sum), params, draw)
}

fn stored(w_sum: f32, age: u32) -> Stored {
    Stored { color: Vec3::new(0.25, 0.5, 1.0), disparity: 0.1, w_sum, age }
}
