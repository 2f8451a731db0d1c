//! Functions of weighted reservoirs beyond the paper: sharper weights, means, references of the gate.

use super::probe::{Probe, Rows};
use super::values::*;
use afterimage::kernel::wrs::{Decision, Reference, SamplerCode};
use afterimage::kernel::{pack, wrs};
use afterimage_testing::Draws;

/// A color channel as candidates have it.
fn channel(d: &mut Draws) -> u32 {
    signed(d, -26, 15)
}

fn sampler(code: u32) -> SamplerCode {
    [SamplerCode::AChao, SamplerCode::AEs, SamplerCode::AChaoMean][code as usize]
}

pub const PROBES: &[Probe] = &[
    Probe {
        name: "sharpen",
        module: "wrs",
        words: [2, 1],
        wgsl: "out_f(sharpen(in_f(0u), in_u(1u)));",
        rust: |r, o| o.f(wrs::sharpen(r.f(0), r.u(1))),
        rows: || {
            let weights = [floats(&[0.0, 0.003, 0.5]), around(&[1.0])].concat();
            Rows::new(2)
                .cross(&[&weights, &[1, 2, 3, 8]])
                .random("sharpen", |d, row| row.extend([scaled(d, -8, 0), 1 + d.bits() % 8]))
        },
    },
    Probe {
        name: "at_rate",
        module: "wrs",
        words: [3, 1],
        wgsl: "out_f(at_rate(in_f(0u), in_f(1u), in_u(2u)));",
        rust: |r, o| o.f(wrs::at_rate(r.f(0), r.f(1), r.u(2))),
        rows: || {
            Rows::new(3)
                .cross(&[&floats(&[1.0, 0.003, 1e-30, 1e-37]), &around(&[0.0, 0.5, 1.0, 3.0, 8.85]), &[1, 2, 3, 4]])
                .random("at_rate", |d, row| row.extend([scaled(d, -90, 0), range(d, 0.0, 8.8), 1 + d.bits() % 4]))
        },
    },
    Probe {
        name: "level_code",
        module: "wrs",
        words: [1, 1],
        wgsl: "out_u(level_code(in_f(0u)));",
        rust: |r, o| o.u(wrs::level_code(r.f(0))),
        rows: || {
            Rows::new(1)
                .cross(&[&around(&[0.125, 0.375, 4.125, 7.875, 8.0])])
                .random("level_code", |d, row| row.push(range(d, 0.0, 8.0)))
        },
    },
    Probe {
        name: "pack_reference",
        module: "wrs",
        words: [4, 1],
        wgsl: "out_u(pack_reference(Reference(in_v(0u), in_u(3u))));",
        rust: |r, o| o.u(wrs::pack_reference(Reference { color: r.v(0), level: r.u(3) })),
        rows: || {
            let channels = [floats(&[0.0, -1.0, 65504.0, 0.3]), around(&[1.0, 0.984_375, 0.992_187_5])].concat();
            Rows::new(4).mixed("pack_reference", &[&channels, &channels, &channels, &[0, 16, 63]]).random(
                "pack_reference",
                |d, row| {
                    row.extend([channel(d), channel(d), channel(d), d.bits() % 64]);
                },
            )
        },
    },
    Probe {
        name: "unpack_reference",
        module: "wrs",
        words: [1, 4],
        wgsl: "let r = unpack_reference(in_u(0u)); out_v(r.color); out_u(r.level);",
        rust: |r, o| {
            let reference = wrs::unpack_reference(r.u(0));
            o.v(reference.color);
            o.u(reference.level);
        },
        rows: || Rows::new(1).cross(&[&words()]).random("unpack_reference", |d, row| row.push(d.bits())),
    },
    Probe {
        name: "compared",
        module: "wrs",
        words: [8, 3],
        wgsl: "out_v(compared(in_v(0u), in_u(3u), Reference(in_v(4u), in_u(7u))));",
        rust: |r, o| o.v(wrs::compared(r.v(0), r.u(3), Reference { color: r.v(4), level: r.u(7) })),
        rows: || {
            Rows::new(8).random("compared", |d, row| {
                row.extend([channel(d), channel(d), channel(d), [0, 5, 63][d.bits() as usize % 3]]);
                row.extend([channel(d), channel(d), channel(d), [0, 5, 63][d.bits() as usize % 3]]);
            })
        },
    },
    Probe {
        name: "next_reference",
        module: "wrs",
        words: [9, 4],
        wgsl: "let r = next_reference(in_v(0u), in_u(3u), in_u(8u) == 1u, Reference(in_v(4u), in_u(7u))); out_v(r.color); out_u(r.level);",
        rust: |r, o| {
            let past = Reference { color: r.v(4), level: r.u(7) };
            let next = wrs::next_reference(r.v(0), r.u(3), r.u(8) == 1, past);
            o.v(next.color);
            o.u(next.level);
        },
        rows: || {
            Rows::new(9).random("next_reference", |d, row| {
                row.extend([channel(d), channel(d), channel(d), [0, 5, 63][d.bits() as usize % 3]]);
                row.extend([channel(d), channel(d), channel(d), [0, 5, 63][d.bits() as usize % 3], d.bits() & 1]);
            })
        },
    },
    Probe {
        name: "combined",
        module: "wrs",
        words: [10, 3],
        wgsl: "out_v(combined(in_v(0u), in_f(3u), in_v(4u), Decision(in_u(8u) == 1u, in_f(7u), 0.0, 1.0, 1.0), in_u(9u)));",
        rust: |r, o| {
            let decision = Decision { take: r.u(8) == 1, w_sum: r.f(7), log_key: 0.0, gate: 1.0, survival: 1.0 };
            o.v(wrs::combined(r.v(0), r.f(3), r.v(4), &decision, sampler(r.u(9))));
        },
        rows: || {
            Rows::new(10).random("combined", |d, row| {
                let weight = f32::from_bits(scaled(d, -20, 0));
                let kept = [0.0, f32::from_bits(scaled(d, -30, 8))][d.bits() as usize & 1];
                row.extend([channel(d), channel(d), channel(d), weight.to_bits()]);
                row.extend([channel(d), channel(d), channel(d), (weight + kept).to_bits(), d.bits() & 1, d.bits() % 3]);
            })
        },
    },
    Probe {
        name: "unpack_sample",
        module: "pack",
        words: [2, 5],
        wgsl: "let s = unpack_sample(vec2<u32>(in_u(0u), in_u(1u))); out_v(s.color); out_f(s.disparity); out_b(s.valid);",
        rust: |r, o| {
            let (color, disparity, valid) = pack::unpack_sample([r.u(0), r.u(1)]);
            // The bits of an invalid color say nothing.
            o.v(color);
            o.f(disparity);
            o.b(valid);
        },
        rows: || {
            let finite = |d: &mut Draws| d.bits() & 0xbbff_bbff;
            Rows::new(2).random("unpack_sample", |d, row| row.extend([finite(d), finite(d)]))
        },
    },
];
