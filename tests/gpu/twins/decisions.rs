//! Functions of a pixel's decision and of its debug views: wrs, debug_view.

use super::probe::{Out, Probe, Row, Rows};
use super::state::draw;
use super::values::*;
use afterimage::kernel::debug_view::PixelTrace;
use afterimage::kernel::wrs::{BiasCode, GateCode, Past, SamplerCode, WrsParams};
use afterimage::kernel::{debug_view, pack, wrs};
use afterimage::{DebugView, Verdict};
use afterimage_testing::Draws;

fn gate_code(code: u32) -> GateCode {
    [GateCode::Off, GateCode::DeltaE94, GateCode::Lightness][code as usize]
}

/// A stored color and a candidate like it, unlike it, or equal to it.
fn color_pair(d: &mut Draws) -> [f32; 6] {
    let [a, b, c] = [0; 3].map(|_| f32::from_bits(scaled(d, -9, 1)));
    let spread = [0.0, 0.01, 0.2, 0.9][d.bits() as usize % 4];
    let mut near = |x: f32| x * (1.0 + spread * d.range(-1.0, 1.0));
    [a, b, c, near(a), near(b), near(c)]
}

/// Codes first, so that the table can cross them.
const STEP_IN: usize = 16;

fn step(r: &Row<'_>, o: &mut Out) {
    let params = WrsParams {
        sampler: [SamplerCode::AChao, SamplerCode::AEs][r.u(0) as usize],
        bias: [BiasCode::None, BiasCode::Exponential, BiasCode::Bernoulli][r.u(1) as usize],
        exponential_survival: r.f(3),
        gate: gate_code(r.u(2)),
        gate_offset: r.f(4),
        inv_gate_divisor: r.f(5),
    };
    let past = Past { color: r.v(10), w_sum: r.f(13), log_key: r.f(14) };
    let d = wrs::step(r.v(6), r.f(9), past, &params, r.f(15));
    o.b(d.take);
    [d.w_sum, d.log_key, d.gate, d.survival].into_iter().for_each(|x| o.f(x));
}

fn step_rows() -> Rows {
    let color = floats(&[0.0, 0.5, 1.0, 65504.0, -0.01]);
    // Sanitized and unpacked weights: 0, or from the smallest normal number to 2^100.
    let sums: Vec<u32> = normal().into_iter().filter(|&x| f32::from_bits(x) <= pack::MAX_W_SUM).collect();
    let keys = floats(&[0.0, -1e-8, -1.0, -50.0, -1e30, f32::MIN]);
    let codes: [&[u32]; 3] = [&[0, 1], &[0, 1, 2], &[0, 1, 2]];
    let mut lists: Vec<&[u32]> = codes.to_vec();
    let [survival, offset, inverse] = [floats(&[0.0, 0.5, 0.98, 1.0]), floats(&[0.0, 2.3]), floats(&[0.01, 0.1, 1e6])];
    let weights = [floats(&[0.0, f32::MIN_POSITIVE, 1e-3, 0.5]), around(&[1.0])].concat();
    let draws = draws();
    lists.extend([&survival[..], &offset, &inverse, &color, &color, &color, &weights, &color, &color, &color]);
    lists.extend([&sums[..], &keys, &draws]);
    Rows::new(STEP_IN)
        .mixed("step", &lists)
        .random("step", |d, row| {
            row.extend([d.bits() % 2, d.bits() % 3, d.bits() % 3]);
            row.extend([range(d, 0.0, 1.0), range(d, 0.0, 5.0), range(d, 0.005, 0.5)]);
            let [a, b, c, x, y, z] = color_pair(d).map(f32::to_bits);
            row.extend([
                a,
                b,
                c,
                range(d, 0.0, 1.0),
                x,
                y,
                z,
                scaled(d, -10, 10),
                signed(d, -10, 10) | 1 << 31,
                draw(d),
            ]);
        })
        .random("step, near the threshold", |d, row| {
            // A draw within a few steps of w / (w_sum + w), where `<` and `<=` part.
            let (w, sum) = ((d.bits() % 64) as f32 / 64.0, (d.bits() % 64) as f32 / 64.0);
            let at = if w + sum > 0.0 { w / (w + sum) } else { 0.0 };
            let drawn = ((at * 16_777_216.0) as u32 + d.bits() % 3).saturating_sub(1).min(16_777_215);
            row.extend([0, 0, 0]);
            row.extend([1.0, 0.0, 0.1, 0.5, 0.5, 0.5, w, 0.2, 0.5, 0.5, sum, 0.0].map(f32::to_bits));
            row.push((drawn as f32 / 16_777_216.0).to_bits());
        })
        .within(|r| r.f(9) == 0.0 || r.f(9) >= f32::MIN_POSITIVE)
}

fn verdict(code: u32) -> Verdict {
    let verdicts = [
        Verdict::Valid,
        Verdict::Reset,
        Verdict::BadMotion,
        Verdict::OffScreen,
        Verdict::Empty,
        Verdict::Disoccluded,
        Verdict::Distrusted,
    ];
    assert!(verdicts.iter().enumerate().all(|(i, &v)| v as usize == i) && verdicts.len() == Verdict::COUNT);
    verdicts[code as usize]
}

fn traced(r: &Row<'_>) -> PixelTrace {
    PixelTrace {
        quality: r.f(0),
        age: r.u(1),
        survival: r.f(2),
        verdict: verdict(r.u(3)),
        gate: r.f(4),
        motion: [r.f(5), r.f(6)],
        ..PixelTrace::default()
    }
}

pub const PROBES: &[Probe] = &[
    Probe {
        name: "heat",
        module: "debug_view",
        words: [1, 3],
        wgsl: "out_v(heat(in_f(0u)));",
        rust: |r, o| o.v(debug_view::heat(r.f(0))),
        rows: || {
            let table = [any(), around(&[0.2, 0.4, 0.6, 0.8, 1.0])].concat();
            Rows::new(1).cross(&[&table]).random("heat", |d, row| row.push(range(d, -0.2, 1.2)))
        },
    },
    Probe {
        name: "verdict_color",
        module: "debug_view",
        words: [1, 3],
        wgsl: "out_v(verdict_color(in_u(0u)));",
        rust: |r, o| o.v(debug_view::verdict_color(verdict(r.u(0)))),
        rows: || Rows::new(1).cross(&[&(0..Verdict::COUNT as u32).collect::<Vec<_>>()]),
    },
    Probe {
        name: "motion_color",
        module: "debug_view",
        words: [2, 3],
        wgsl: "out_v(motion_color(vec2<f32>(in_f(0u), in_f(1u))));",
        rust: |r, o| o.v(debug_view::motion_color([r.f(0), r.f(1)])),
        rows: || {
            let table = [any(), around(&[16.0, -16.0])].concat();
            Rows::new(2)
                .cross(&[&table, &table])
                .random("motion_color", |d, row| row.extend([range(d, -20.0, 20.0), range(d, -20.0, 20.0)]))
        },
    },
    Probe {
        name: "view_color",
        module: "debug_view",
        words: [8, 3],
        wgsl: "out_v(view_color(in_u(7u), PixelTrace(in_u(3u), 0.0, in_f(0u), in_u(1u), in_f(2u), in_f(4u), true, vec2<f32>(in_f(5u), in_f(6u)))));",
        rust: |r, o| {
            let view = DebugView::ALL[r.u(7) as usize - 1];
            assert_eq!(view as u32, r.u(7));
            o.v(debug_view::view_color(view, &traced(r)));
        },
        rows: || {
            Rows::new(8).random("view_color", |d, row| {
                row.extend([scaled(d, -126, 100), d.bits() % 256, range(d, 0.0, 1.0), d.bits() % 7]);
                row.extend([
                    range(d, 0.0, 1.0),
                    range(d, -20.0, 20.0),
                    range(d, -20.0, 20.0),
                    1 + d.bits() % DebugView::ALL.len() as u32,
                ]);
            })
        },
    },
    Probe {
        name: "scale_by_trust",
        module: "wrs",
        words: [4, 2],
        wgsl: "let p = scale_by_trust(Past(vec3<f32>(0.0), in_f(0u), in_f(1u)), in_f(2u), in_u(3u)); out_f(p.w_sum); out_f(p.log_key);",
        rust: |r, o| {
            let past = Past { w_sum: r.f(0), log_key: r.f(1), ..Past::EMPTY };
            let scaled = wrs::scale_by_trust(past, r.f(2), [SamplerCode::AChao, SamplerCode::AEs][r.u(3) as usize]);
            o.f(scaled.w_sum);
            o.f(scaled.log_key);
        },
        rows: || {
            let keys = floats(&[0.0, -1e-8, -1.0, -1e30, f32::MIN]);
            Rows::new(4)
                .cross(&[&normal(), &keys, &any(), &[0, 1]])
                .random("scale_by_trust", |d, row| {
                    row.extend([scaled(d, -10, 10), signed(d, -10, 10) | 1 << 31, range(d, 0.0, 1.0), d.bits() & 1]);
                })
                .within(|r| r.f(0) <= pack::MAX_W_SUM)
        },
    },
    Probe {
        name: "expose",
        module: "wrs",
        words: [4, 3],
        wgsl: "out_v(expose(in_v(0u), in_f(3u)));",
        rust: |r, o| o.v(wrs::expose(r.v(0), r.f(3))),
        rows: || {
            // As unpack leaves colors, and ratios as frames have them.
            let halves: Vec<u32> = (0..65536).filter(|h| h & 0x7c00 != 0x7c00).collect();
            let half = |d: &mut Draws| pack::half_value(halves[d.bits() as usize % halves.len()]).to_bits();
            Rows::new(4).random("expose", |d, row| row.extend([half(d), half(d), half(d), scaled(d, -40, 40)])).random(
                "expose, by stops",
                |d, row| {
                    let ratio = 2.0_f32.powi(d.bits() as i32 % 17).to_bits();
                    row.extend([half(d), half(d), half(d), ratio]);
                },
            )
        },
    },
    Probe {
        name: "gate",
        module: "wrs",
        words: [3, 1],
        wgsl: "out_f(gate(in_f(0u), in_f(1u), in_f(2u)));",
        rust: |r, o| o.f(wrs::gate(r.f(0), r.f(1), r.f(2))),
        rows: || {
            let inverse = floats(&[0.01, 0.1, 1.0, 1e6]);
            Rows::new(3)
                .cross(&[&[positive(), around(&[2.3, 12.3])].concat(), &floats(&[0.0, 2.3]), &inverse])
                .random("gate", |d, row| row.extend([range(d, 0.0, 30.0), range(d, 0.0, 5.0), range(d, 0.01, 1.0)]))
        },
    },
    Probe {
        name: "difference",
        module: "wrs",
        words: [7, 1],
        wgsl: "out_f(difference(in_v(0u), in_v(3u), in_u(6u)));",
        rust: |r, o| o.f(wrs::difference(r.v(0), r.v(3), gate_code(r.u(6)))),
        rows: || {
            let color = floats(&[0.0, -0.0, 0.18, 1.0, -0.01, 65504.0, 1e30]);
            Rows::new(7).cross(&[&color, &color, &color, &color, &color, &color, &[0, 1, 2]]).random(
                "difference",
                |d, row| {
                    row.extend(color_pair(d).map(f32::to_bits));
                    row.push(d.bits() % 3);
                },
            )
        },
    },
    Probe {
        name: "step",
        module: "wrs",
        words: [STEP_IN, 5],
        wgsl: "let params = WrsParams(in_u(0u), in_u(1u), in_f(3u), in_u(2u), in_f(4u), in_f(5u));
    let d = step(in_v(6u), in_f(9u), Past(in_v(10u), in_f(13u), in_f(14u)), params, in_f(15u));
    out_b(d.take); out_f(d.w_sum); out_f(d.log_key); out_f(d.gate); out_f(d.survival);",
        rust: step,
        rows: step_rows,
    },
];
