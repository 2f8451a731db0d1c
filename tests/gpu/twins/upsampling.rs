//! Functions of temporal antialiasing and upsampling: taa, taau.

use super::matching::{channels, like, push, stored_color};
use super::probe::{Out, Probe, Row, Rows};
use super::surfaces::fraction;
use super::values::*;
use afterimage::kernel::taa;
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
    let narrowing = taau::narrowing(d.range(0.0, 6.0));
    let step = (1 << level) as f32;
    let (at, jitter) = ([0; 2].map(|_| (d.uniform() * step).floor()), [0; 2].map(|_| d.range(-0.5, 0.5)));
    let mut around = SamplesAround::default();
    for tap in 0..9 {
        if d.bits() & 7 == 0 && tap != 4 {
            continue;
        }
        let color = if flat || tap == 4 { centre } else { Vec3::from(like(d, centre.to_array())) };
        let offset = [0, 1].map(|i| ([tap % 3, tap / 3][i] as f32 - 1.0) * step - at[i] + 0.5 * step - jitter[i]);
        around =
            taau::add_around(around, centre, color, taau::sample_weights(Vec2::from(offset), level, tail, narrowing));
    }
    let weights = around.weights.max(Vec2::splat(taau::LEAST_SAMPLE_WEIGHT));
    push(row, &around.difference.to_array());
    push(row, &weights.to_array());
    push(row, &around.sum.to_array());
    push(row, &around.squares.to_array());
    push(row, &[around.count]);
    push(row, &centre.to_array());
}

/// Sums over nine neighbours, near each other or not, as the pass makes them.
fn push_box(d: &mut Draws, row: &mut Vec<u32>, center: [f32; 3]) {
    let (mut sum, mut squares) = (Vec3::ZERO, Vec3::ZERO);
    let flat = d.bits().is_multiple_of(4);
    for _ in 0..9 {
        let v = taa::to_ycocg(Vec3::from(if flat { center } else { like(d, center) }));
        sum += v;
        squares += v * v;
    }
    push(row, &sum.to_array());
    push(row, &squares.to_array());
}

pub const PROBES: &[Probe] = &[
    Probe {
        name: "to_ycocg",
        module: "taa",
        words: [3, 3],
        wgsl: "out_v(to_ycocg(in_v(0u)));",
        rust: |r, o| o.v(taa::to_ycocg(r.v(0))),
        rows: || {
            let c = channels();
            Rows::new(3)
                .cross(&[&c, &c, &c])
                .random("to_ycocg", |d, row| row.extend((0..3).map(|_| signed(d, -24, 16))))
        },
    },
    Probe {
        name: "root_luma",
        module: "taa",
        words: [3, 1],
        wgsl: "out_f(root_luma(in_v(0u)));",
        rust: |r, o| o.f(taa::root_luma(r.v(0))),
        rows: || {
            let c = channels();
            Rows::new(3)
                .cross(&[&c, &c, &c])
                .random("root_luma", |d, row| row.extend((0..3).map(|_| signed(d, -24, 18))))
        },
    },
    Probe {
        name: "roots_of_ycocg",
        module: "taa",
        words: [3, 3],
        wgsl: "out_v(roots_of_ycocg(in_v(0u)));",
        rust: |r, o| o.v(taa::roots_of_ycocg(r.v(0))),
        rows: || {
            let y = floats(&[0.0, 0.25, -0.25, 1.0, -128.0, 256.0]);
            Rows::new(3)
                .cross(&[&y, &y, &y])
                .random("roots_of_ycocg", |d, row| row.extend((0..3).map(|_| signed(d, -12, 8))))
        },
    },
    Probe {
        name: "clip_to_box",
        module: "taa",
        words: [9, 3],
        wgsl: "out_v(clip_to_box(in_v(0u), in_v(3u), in_v(6u)));",
        rust: |r, o| o.v(taa::clip_to_box(r.v(0), r.v(3), r.v(6))),
        rows: || {
            let (y, extent) = (floats(&[0.0, 0.5, -0.25, 1e-7, 256.0]), floats(&[0.0, 1e-6, 0.5, 512.0]));
            Rows::new(9).mixed("clip_to_box", &[&y, &y, &y, &y, &y, &y, &extent, &extent, &extent]).random(
                "clip_to_box",
                |d, row| {
                    let mean = [d.range(0.0, 1.5), d.range(-0.5, 0.5), d.range(-0.5, 0.5)];
                    let away = [0.0, 0.01, 0.3][d.bits() as usize % 3];
                    push(row, &mean.map(|x| x + away * d.range(-1.0, 1.0)));
                    push(row, &mean);
                    row.extend((0..3).map(|_| range(d, 0.0, 0.3)));
                },
            )
        },
    },
    Probe {
        name: "confidence_of",
        module: "taa",
        words: [1, 1],
        wgsl: "out_f(confidence_of(in_f(0u)));",
        rust: |r, o| o.f(taa::confidence_of(r.f(0))),
        rows: || {
            let codes: Vec<f32> = (0..=62).map(|i| i as f32 / 7.0).collect();
            Rows::new(1).cross(&[&floats(&codes)]).random("confidence_of", |d, row| row.push(range(d, 0.0, 8.9)))
        },
    },
    Probe {
        name: "lod_of",
        module: "taa",
        words: [1, 1],
        wgsl: "out_f(lod_of(in_f(0u)));",
        rust: |r, o| o.f(taa::lod_of(r.f(0))),
        rows: || {
            let edges = [floats(&[0.0, 1e-4, 2.0, 3.02, 20.0]), around(&[16.0])].concat();
            Rows::new(1).cross(&[&edges]).random("lod_of", |d, row| row.push(range(d, 0.0, 17.0)))
        },
    },
    Probe {
        name: "confidence_limit",
        module: "taa",
        words: [3, 1],
        wgsl: "out_f(confidence_limit(vec2<f32>(in_f(0u), in_f(1u)), in_f(2u)));",
        rust: |r, o| o.f(taa::confidence_limit([r.f(0), r.f(1)], r.f(2))),
        rows: || {
            let at = [around(&[0.25, 0.5]), floats(&[0.0, 1.0 / 16_777_216.0, 1.0_f32.next_down()])].concat();
            Rows::new(3)
                .cross(&[&at, &at, &floats(&[0.6, 1.0])])
                .random("confidence_limit", |d, row| push(row, &[fraction(d), fraction(d), d.range(0.5, 1.0)]))
        },
    },
    Probe {
        name: "settled",
        module: "taa",
        words: [1, 1],
        wgsl: "out_f(settled(in_f(0u)));",
        rust: |r, o| o.f(taa::settled(r.f(0))),
        rows: || Rows::new(1).cross(&[&around(&[2.0, 4.0])]).random("settled", |d, row| row.push(range(d, 0.0, 17.0))),
    },
    Probe {
        name: "agreeing",
        module: "taa",
        words: [4, 1],
        wgsl: "out_f(agreeing(in_f(0u), in_f(1u), in_f(2u), in_f(3u)));",
        rust: |r, o| o.f(taa::agreeing(r.f(0), r.f(1), r.f(2), r.f(3))),
        rows: || {
            Rows::new(4).cross(&[&floats(&[0.0]), &floats(&[0.0]), &floats(&[0.0, 1.0]), &floats(&[0.0, 9.0])]).random(
                "agreeing",
                |d, row| {
                    let (count, mean) = (1 + d.bits() % 9, d.range(0.0, 2.0));
                    let spread = [0.0, 0.001, 0.3][d.bits() as usize % 3];
                    let lumas: Vec<f32> = (0..count).map(|_| mean + spread * d.uniform()).collect();
                    let squares = lumas.iter().map(|v| v * v).sum();
                    let past = count as f32 * (mean + [0.0, 0.001, 0.3][d.bits() as usize % 3] * d.uniform());
                    push(row, &[lumas.iter().sum(), squares, past, count as f32]);
                },
            )
        },
    },
    Probe {
        name: "box_sigmas",
        module: "taa",
        words: [3, 1],
        wgsl: "out_f(box_sigmas(in_f(0u), in_f(1u), in_f(2u)));",
        rust: |r, o| o.f(taa::box_sigmas(r.f(0), r.f(1), r.f(2))),
        rows: || {
            let confidence = [around(&[2.0, 4.0]), floats(&[0.0, 16.0])].concat();
            Rows::new(3)
                .cross(&[&floats(&[1.5, 2.0]), &floats(&[5.0]), &confidence])
                .random("box_sigmas", |d, row| push(row, &[d.range(1.0, 2.0), d.range(2.0, 6.0), d.range(0.0, 6.0)]))
        },
    },
    Probe {
        name: "candidate_share",
        module: "taa",
        words: [2, 1],
        wgsl: "out_f(candidate_share(in_f(0u), in_f(1u)));",
        rust: |r, o| o.f(taa::candidate_share(r.f(0), r.f(1))),
        rows: || {
            let confidence = [around(&[1.0, 9.0]), floats(&[0.0, 1e-30, 16.0])].concat();
            let trust = [around(&[0.6, 0.9]), floats(&[1e-30, 0.25, 1.0])].concat();
            Rows::new(2)
                .cross(&[&confidence, &trust])
                .random("candidate_share", |d, row| push(row, &[d.range(0.0, 16.0), d.range(0.0, 1.0)]))
        },
    },
    Probe {
        name: "blend_clipped",
        module: "taa",
        words: [14, 3],
        wgsl: "out_v(blend_clipped(in_v(0u), in_v(3u), in_v(6u), in_v(9u), in_f(12u), in_f(13u)));",
        rust: |r, o| o.v(taa::blend_clipped(r.v(0), r.v(3), r.v(6), r.v(9), r.f(12), r.f(13))),
        rows: || {
            Rows::new(14).random("blend_clipped", |d, row| {
                let candidate = stored_color(d);
                let history = like(d, candidate);
                push(row, &like(d, candidate));
                push(row, &history.map(|x| x.max(0.0)));
                push_box(d, row, candidate);
                push(row, &[[0.1, 0.4, 1.0, d.range(0.1, 1.0)][d.bits() as usize % 4]]);
                push(row, &[[1.0, 16.0, d.range(0.0, 6.0)][d.bits() as usize % 3]]);
            })
        },
    },
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
        name: "narrowing",
        module: "taau",
        words: [1, 1],
        wgsl: "out_f(narrowing(in_f(0u)));",
        rust: |r, o| o.f(taau::narrowing(r.f(0))),
        rows: || {
            Rows::new(1).cross(&[&around(&[2.0, 4.0])]).random("narrowing", |d, row| row.push(range(d, 0.0, 17.0)))
        },
    },
    Probe {
        name: "sample_weights",
        module: "taau",
        words: [5, 2],
        wgsl: "let w = sample_weights(vec2<f32>(in_f(0u), in_f(1u)), in_u(2u), in_f(3u), in_f(4u)); out_f(w.x); out_f(w.y);",
        rust: |r, o| {
            let w = taau::sample_weights(Vec2::new(r.f(0), r.f(1)), r.u(2), r.f(3), r.f(4));
            o.f(w.x);
            o.f(w.y);
        },
        rows: || {
            let offsets = floats(&[0.0, 0.5, -0.5, 1.0, -2.0, 3.0, 511.5]);
            let (levels, tails, narrowings) =
                ((0..=8).collect::<Vec<_>>(), floats(&[0.002, 0.02]), floats(&[1.0, 1.4]));
            Rows::new(5).cross(&[&offsets, &offsets, &levels, &tails, &narrowings]).random(
                "sample_weights",
                |d, row| {
                    let level = d.bits() % 5;
                    let reach = 1.5 * (1 << level) as f32;
                    row.extend([range(d, -reach, reach), range(d, -reach, reach), level]);
                    row.extend([range(d, 0.002, 0.02), range(d, 1.0, 1.4)]);
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
                push(row, &[[0.0, 2.0, 16.0, d.range(0.0, 16.0)][d.bits() as usize % 4]]);
                push(row, &[[1.0, 0.25, d.range(0.01, 1.0)][d.bits() as usize % 3]]);
            })
        },
    },
];
