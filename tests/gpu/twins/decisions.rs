//! Functions of a pixel's decision and of its debug views: wrs, debug_view.

use super::state::draw;
use super::*;
use afterimage::kernel::debug_view::PixelTrace;
use afterimage::kernel::wrs::{BiasCode, Decision, GateCode, Past, SamplerCode, WrsParams};
use afterimage::kernel::{color, debug_view, pack, stored_reservoir, wrs};
use afterimage::{DebugView, Verdict};

/// A stored color and a candidate like it, unlike it, or equal to it.
fn color_pair(d: &mut Draws) -> [f32; 6] {
    let [a, b, c] = [0; 3].map(|_| f32::from_bits(scaled(d, -9, 1)));
    let spread = [0.0, 0.01, 0.2, 0.9][d.bits() as usize % 4];
    let mut near = |x: f32| x * (1.0 + spread * d.range(-1.0, 1.0));
    [a, b, c, near(a), near(b), near(c)]
}

/// Codes first, so that the table can cross them.
fn step_rows(rows: Rows) -> Rows {
    let color = floats(&[0.0, 0.5, 1.0, 65504.0, -0.01]);
    // Sanitized and unpacked weights: 0, or from the smallest normal number to 2^100.
    let sums: Vec<u32> = normal().into_iter().filter(|&x| f32::from_bits(x) <= stored_reservoir::MAX_W_SUM).collect();
    let keys = floats(&[0.0, -1e-8, -1.0, -50.0, -1e30, f32::MIN]);
    let codes: [&[u32]; 3] = [&[0, 1], &[0, 1, 2], &[0, 1, 2]];
    let mut lists: Vec<&[u32]> = codes.to_vec();
    let [survival, offset, inverse] = [floats(&[0.0, 0.5, 0.98, 1.0]), floats(&[0.0, 2.3]), floats(&[0.01, 0.1, 1e6])];
    let weights = [floats(&[0.0, f32::MIN_POSITIVE, 1e-3, 0.5]), around(&[1.0])].concat();
    let draws = draws();
    lists.extend([&survival[..], &offset, &inverse, &color, &color, &color, &weights, &color, &color, &color]);
    lists.extend([&sums[..], &keys, &draws]);
    rows.mixed(&lists)
        .random(|d, row| {
            row.extend([d.bits() % 2, d.bits() % 3, d.bits() % 3]);
            row.extend([range(d, 0.0, 1.0), range(d, 0.0, 5.0), range(d, 0.005, 0.5)]);
            let [a, b, c, x, y, z] = color_pair(d).map(f32::to_bits);
            row.extend([a, b, c, range(d, 0.0, 1.0), x, y, z, scaled(d, -10, 10)]);
            row.extend([signed(d, -10, 10) | 1 << 31, draw(d)]);
        })
        .random_of("near the threshold", |d, row| {
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

code!(SamplerCode: AChao, AEs, AChaoMean);
code!(BiasCode: None, Exponential, Bernoulli);
code!(GateCode: Off, DeltaE94, Lightness);
code!(Verdict: Valid, Reset, BadMotion, OffScreen, Empty, Disoccluded, Distrusted);
shape!(Past { color: Vec3, w_sum: f32, log_key: f32 });
shape!(Decision { take: bool, w_sum: f32, log_key: f32, gate: f32, survival: f32 });

pub const PROBES: &[Probe] = &[
    probe!(
        debug_view::view_color,
        |quality: f32, age: u32, history_share: f32, verdict: Verdict, agreement: f32, motion: [f32; 2], view: u32| {
            let trace = PixelTrace { quality, age, history_share, verdict, agreement, motion, ..PixelTrace::default() };
            debug_view::view_color(*DebugView::ALL.iter().find(|&&v| v as u32 == view).unwrap(), &trace)
        },
        "view_color($6, PixelTrace($3, 0.0, $0, $1, $2, $4, true, $5))",
        |rows| {
            rows.random(|d, row| {
                row.extend([scaled(d, -126, 100), d.bits() % 256, range(d, 0.0, 1.0), d.bits() % 7]);
                row.extend([range(d, 0.0, 1.0), range(d, -20.0, 20.0), range(d, -20.0, 20.0)]);
                row.push(1 + d.bits() % DebugView::ALL.len() as u32);
            })
        }
    ),
    probe!(
        wrs::scale_by_trust,
        |w_sum: f32, log_key: f32, trust: f32, sampler: SamplerCode| {
            let scaled = wrs::scale_by_trust(Past { w_sum, log_key, ..Past::EMPTY }, trust, sampler);
            (scaled.w_sum, scaled.log_key)
        },
        "let p = scale_by_trust(Past(vec3f(0.0), $0, $1), $2, $3); out_f(p.w_sum); out_f(p.log_key);",
        |rows| {
            let keys = floats(&[0.0, -1e-8, -1.0, -1e30, f32::MIN]);
            rows.cross(&[&normal(), &keys, &any(), &[0, 1]])
                .random(|d, row| {
                    row.extend([scaled(d, -10, 10), signed(d, -10, 10) | 1 << 31, range(d, 0.0, 1.0), d.bits() & 1]);
                })
                .within(|r| r.f(0) <= stored_reservoir::MAX_W_SUM)
        }
    ),
    probe!(color::expose, |rows| {
        // As unpack leaves colors, and ratios as frames have them.
        let halves: Vec<u32> = (0..65536).filter(|h| h & 0x7c00 != 0x7c00).collect();
        let half = |d: &mut Draws| pack::half_value(halves[d.bits() as usize % halves.len()]).to_bits();
        let stops = |d: &mut Draws| 2.0_f32.powi(d.bits() as i32 % 17).to_bits();
        rows.random(|d, row| row.extend([half(d), half(d), half(d), scaled(d, -40, 40)]))
            .random_of("by stops", |d, row| row.extend([half(d), half(d), half(d), stops(d)]))
    }),
    probe!(wrs::gate, |rows| {
        let inverse = floats(&[0.01, 0.1, 1.0, 1e6]);
        let rows = rows.cross(&[&[positive(), around(&[2.3, 12.3])].concat(), &floats(&[0.0, 2.3]), &inverse]);
        rows.each(&[F(0.0, 30.0), F(0.0, 5.0), F(0.01, 1.0)])
    }),
    probe!(wrs::difference, |rows| {
        let color = floats(&[0.0, -0.0, 0.18, 1.0, -0.01, 65504.0, 1e30]);
        rows.cross(&[&color, &color, &color, &color, &color, &color, &[0, 1, 2]]).random(|d, row| {
            row.extend(color_pair(d).map(f32::to_bits));
            row.push(d.bits() % 3);
        })
    }),
    probe!(
        wrs::decide_sample,
        |sampler: SamplerCode,
         bias: BiasCode,
         gate: GateCode,
         exponential_survival: f32,
         gate_offset: f32,
         inv_gate_divisor: f32,
         candidate: Vec3,
         weight: f32,
         past: Past,
         draw: f32| {
            let params = WrsParams { sampler, bias, exponential_survival, gate, gate_offset, inv_gate_divisor };
            wrs::decide_sample(candidate, weight, past, &params, draw)
        },
        "decide_sample($6, $7, $8, WrsParams($0, $1, $3, $2, $4, $5), $9)",
        step_rows
    ),
];
