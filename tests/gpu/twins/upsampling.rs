//! Functions of temporal upsampling: taau.

use super::matching::{like, push, stored_color};
use super::probe::{Out, Probe, Row, Rows};
use super::values::*;
use afterimage::kernel::taau;
use afterimage::kernel::taau::SamplesAround;
use afterimage_testing::Draws;
use glam::{Vec2, Vec3};

fn samples(r: &Row<'_>) -> SamplesAround {
    let weights = Vec2::new(r.f(3), r.f(4));
    SamplesAround { difference: r.v(0), weights, sum: r.v(5), squares: r.v(8), count: r.f(11) }
}

fn put_samples(o: &mut Out, a: SamplesAround) {
    o.v(a.difference);
    o.f(a.weights.x);
    o.f(a.weights.y);
    o.v(a.sum);
    o.v(a.squares);
    o.f(a.count);
}

/// Sums over some of nine samples of any lattice, as the pass makes them, and the nearest one's color.
fn push_samples(d: &mut Draws, row: &mut Vec<u32>) {
    let centre = Vec3::from(stored_color(d));
    let (level, tail, flat) = (d.bits() % 5, taau::tail(d.range(0.0, 2.0)), d.bits().is_multiple_of(4));
    let step = (1 << level) as f32;
    let (at, jitter) = ([0; 2].map(|_| (d.uniform() * step).floor()), [0; 2].map(|_| d.range(-0.5, 0.5)));
    let mut around = SamplesAround::default();
    for tap in 0..9 {
        if d.bits() & 7 == 0 && tap != 4 {
            continue;
        }
        let color = if flat || tap == 4 { centre } else { Vec3::from(like(d, centre.to_array())) };
        let offset = [0, 1].map(|i| ([tap % 3, tap / 3][i] as f32 - 1.0) * step - at[i] + 0.5 * step - jitter[i]);
        around = taau::add_around(around, centre, color, taau::sample_weights(Vec2::from(offset), level, tail));
    }
    let weights = around.weights.max(Vec2::splat(taau::LEAST_SAMPLE_WEIGHT));
    push(row, &around.difference.to_array());
    push(row, &weights.to_array());
    push(row, &around.sum.to_array());
    push(row, &around.squares.to_array());
    push(row, &[around.count]);
    push(row, &centre.to_array());
}

pub const PROBES: &[Probe] = &[
    Probe {
        name: "lobe",
        module: "taau",
        words: [1, 1],
        wgsl: "out_f(lobe(in_f(0u)));",
        rust: |r, o| o.f(taau::lobe(r.f(0))),
        rows: || {
            let edges = [floats(&[0.0, 0.25, 0.5, 4.0, 16.0, 1e6]), around(&[1.0])].concat();
            Rows::new(1).cross(&[&edges]).random("lobe", |d, row| row.push(range(d, 0.0, 2.0)))
        },
    },
    Probe {
        name: "tail",
        module: "taau",
        words: [1, 1],
        wgsl: "out_f(tail(in_f(0u)));",
        rust: |r, o| o.f(taau::tail(r.f(0))),
        rows: || Rows::new(1).cross(&[&around(&[0.5, 1.0])]).random("tail", |d, row| row.push(range(d, 0.0, 1.0))),
    },
    Probe {
        name: "sample_weights",
        module: "taau",
        words: [4, 2],
        wgsl: "let w = sample_weights(vec2<f32>(in_f(0u), in_f(1u)), in_u(2u), in_f(3u)); out_f(w.x); out_f(w.y);",
        rust: |r, o| {
            let w = taau::sample_weights(Vec2::new(r.f(0), r.f(1)), r.u(2), r.f(3));
            o.f(w.x);
            o.f(w.y);
        },
        rows: || {
            let offsets = floats(&[0.0, 0.5, -0.5, 1.0, -2.0, 3.0, 511.5]);
            Rows::new(4).cross(&[&offsets, &offsets, &(0..=8).collect::<Vec<_>>(), &floats(&[0.002, 0.02])]).random(
                "sample_weights",
                |d, row| {
                    let level = d.bits() % 5;
                    let reach = 1.5 * (1 << level) as f32;
                    row.extend([range(d, -reach, reach), range(d, -reach, reach), level, range(d, 0.002, 0.02)]);
                },
            )
        },
    },
    Probe {
        name: "add_around",
        module: "taau",
        words: [20, 12],
        wgsl:
            "let a = add_around(SamplesAround(in_v(0u), vec2<f32>(in_f(3u), in_f(4u)), in_v(5u), in_v(8u), in_f(11u)),
        in_v(12u), in_v(15u), vec2<f32>(in_f(18u), in_f(19u)));
    out_v(a.difference); out_f(a.weights.x); out_f(a.weights.y); out_v(a.sum); out_v(a.squares); out_f(a.count);",
        rust: |r, o| put_samples(o, taau::add_around(samples(r), r.v(12), r.v(15), Vec2::new(r.f(18), r.f(19)))),
        rows: || {
            Rows::new(20).random("add_around", |d, row| {
                push_samples(d, row);
                let color = stored_color(d);
                push(row, &color);
                push(row, &[d.uniform(), d.range(0.0, 1.02)]);
            })
        },
    },
    Probe {
        name: "upsampled",
        module: "taau",
        words: [15, 3],
        wgsl: "let a = SamplesAround(in_v(0u), vec2<f32>(in_f(3u), in_f(4u)), in_v(5u), in_v(8u), in_f(11u));
    out_v(upsampled(a, in_v(12u)));",
        rust: |r, o| o.v(taau::upsampled(samples(r), r.v(12))),
        rows: || Rows::new(15).random("upsampled", push_samples),
    },
    Probe {
        name: "confidence_of",
        module: "taau",
        words: [1, 1],
        wgsl: "out_f(confidence_of(in_f(0u)));",
        rust: |r, o| o.f(taau::confidence_of(r.f(0))),
        rows: || {
            let codes: Vec<f32> = (0..=62).map(|i| i as f32 / 7.0).collect();
            Rows::new(1).cross(&[&floats(&codes)]).random("confidence_of", |d, row| row.push(range(d, 0.0, 8.9)))
        },
    },
    Probe {
        name: "lod_of",
        module: "taau",
        words: [1, 1],
        wgsl: "out_f(lod_of(in_f(0u)));",
        rust: |r, o| o.f(taau::lod_of(r.f(0))),
        rows: || {
            let edges = [floats(&[0.0, 1e-4, 2.0, 3.02]), around(&[4.0])].concat();
            Rows::new(1).cross(&[&edges]).random("lod_of", |d, row| row.push(range(d, 0.0, 4.0)))
        },
    },
    Probe {
        name: "confidence_limit",
        module: "taau",
        words: [2, 1],
        wgsl: "out_f(confidence_limit(vec2<f32>(in_f(0u), in_f(1u))));",
        rust: |r, o| o.f(taau::confidence_limit([r.f(0), r.f(1)])),
        rows: || {
            let at = [around(&[0.25, 0.5]), floats(&[0.0, 1.0 / 16_777_216.0, 1.0_f32.next_down()])].concat();
            Rows::new(2).cross(&[&at, &at]).random("confidence_limit", |d, row| push(row, &[d.uniform(), d.uniform()]))
        },
    },
    Probe {
        name: "accumulate",
        module: "taau",
        words: [20, 6],
        wgsl: "let a = SamplesAround(in_v(0u), vec2<f32>(in_f(3u), in_f(4u)), in_v(5u), in_v(8u), in_f(11u));
    let r = accumulate(a, in_v(12u), in_v(15u), in_f(18u), in_f(19u));
    out_v(r.color); out_f(r.confidence); out_f(r.share); out_f(r.kept);",
        rust: |r, o| {
            let made = taau::accumulate(samples(r), r.v(12), r.v(15), r.f(18), r.f(19));
            o.v(made.color);
            o.f(made.confidence);
            o.f(made.share);
            o.f(made.kept);
        },
        rows: || {
            Rows::new(20).random("accumulate", |d, row| {
                push_samples(d, row);
                let centre = [12, 13, 14].map(|i| f32::from_bits(row[row.len() - 15 + i]));
                let history = like(d, centre);
                push(row, &history.map(|x| x.max(0.0)));
                push(row, &[[0.0, 1.0, 2.0, d.range(0.0, 2.0)][d.bits() as usize % 4]]);
                push(row, &[[1.0, 0.25, d.range(0.01, 1.0)][d.bits() as usize % 3]]);
            })
        },
    },
];
