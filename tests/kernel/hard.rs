//! The laws of hard cases that hold on the CPU and on a device, for the Rust functions.

use crate::kernel_hard::*;
use afterimage::kernel::reservoir::Reservoir;
use afterimage::kernel::wrs::{BiasCode, GateCode, Past, SamplerCode, WrsParams};
use afterimage::kernel::{color, lab, reservoir, rng, wrs};
use glam::Vec3;

/// Results of a function for one row.
fn call(function: &str, row: &[u32]) -> Vec<u32> {
    let f = |k: usize| f32::from_bits(row[k]);
    let v = |k: usize| Vec3::new(f(k), f(k + 1), f(k + 2));
    let floats = |values: &[f32]| values.iter().map(|x| x.to_bits()).collect();
    let gate = |k: usize| [GateCode::Off, GateCode::DeltaE94, GateCode::Lightness][row[k] as usize];
    match function {
        "bernoulli_survival" => floats(&[reservoir::bernoulli_survival(f(0), f(1))]),
        "cbrt" => floats(&[color::cbrt(f(0))]),
        "combine" => {
            let [first, second] = [0, 2].map(|k| Reservoir { w_sum: f(k), count: row[k + 1] });
            let (merged, keep_second) = reservoir::combine(first, second, f(4));
            vec![keep_second.into(), merged.w_sum.to_bits(), merged.count]
        }
        "delta_e94" => floats(&[lab::delta_e94(v(0), v(3))]),
        "difference" => floats(&[wrs::difference(v(0), v(3), gate(6))]),
        "gate" => floats(&[wrs::gate(f(0), f(1), f(2))]),
        "lab" => floats(&lab::lab(v(0)).to_array()),
        "decide_sample" => {
            let params = WrsParams {
                sampler: [SamplerCode::AChao, SamplerCode::AEs][row[0] as usize],
                bias: [BiasCode::None, BiasCode::Exponential, BiasCode::Bernoulli][row[1] as usize],
                gate: gate(2),
                exponential_survival: f(3),
                gate_offset: f(4),
                inv_gate_divisor: f(5),
            };
            let d = wrs::decide_sample(v(6), f(9), Past { color: v(10), w_sum: f(13), log_key: f(14) }, &params, f(15));
            [vec![d.take.into()], floats(&[d.w_sum, d.log_key, d.gate, d.survival])].concat()
        }
        "unit_draw" => floats(&[rng::unit_draw(row[0])]),
        "update" => {
            let mut r = Reservoir { w_sum: f(0), count: row[1] };
            let take = reservoir::update(&mut r, f(2), f(3));
            vec![take.into(), r.w_sum.to_bits(), r.count]
        }
        other => panic!("{other}"),
    }
}

/// What a law measured.
fn run_law(law: fn(Call<'_>) -> Option<String>) -> Option<String> {
    law(&|function, rows| Some(rows.iter().map(|row| call(function, row)).collect()))
}

kernel_laws!(Cpu, run_law);
