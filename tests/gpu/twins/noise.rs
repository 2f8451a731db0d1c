//! Functions of noisy candidates: noise.

use super::matching::{channels, push};
use super::probe::{Out, Probe, Row, Rows};
use super::values::*;
use afterimage::kernel::noise;
use afterimage::kernel::noise::Noise;
use afterimage_testing::Draws;
use glam::Vec4;

fn known(r: &Row<'_>, k: usize) -> Noise {
    Noise { samples: r.f(k), variance: r.f(k + 1) }
}

fn put(o: &mut Out, n: Noise) {
    o.f(n.samples);
    o.f(n.variance);
}

fn put4(o: &mut Out, v: Vec4) {
    o.v(v.truncate());
    o.f(v.w);
}

fn texel(r: &Row<'_>, k: usize) -> Vec4 {
    r.v(k).extend(r.f(k + 3))
}

/// Samples and variance, as stored or from a frame's input.
fn noise(d: &mut Draws) -> [f32; 2] {
    let variance = match d.bits() % 4 {
        0 => 0.0,
        1 => d.range(0.0, 1e-3),
        2 => d.range(0.0, 2.0),
        _ => d.range(0.0, 65504.0),
    };
    [1.0 + (d.bits() % 64) as f32, variance]
}

fn counts() -> Vec<u32> {
    floats(&[1.0, 2.0, 3.0, 32.0, 1000.0, 32768.0])
}

fn variances() -> Vec<u32> {
    floats(&[0.0, 6e-8, 1e-4, 0.5, 1.0, 100.0, 65504.0])
}

/// Two noises, history first, and `more` values of a list.
fn pair_rows(name: &str, more: &[&[u32]]) -> Rows {
    let (n, v) = (counts(), variances());
    let mut lists: Vec<&[u32]> = vec![&n, &v, &n, &v];
    lists.extend(more);
    Rows::new(4 + more.len()).mixed(name, &lists).random(name, |d, row| {
        let (history, candidate) = (noise(d), noise(d));
        push(row, &[history, candidate].concat());
        for list in more {
            row.push(list[d.bits() as usize % list.len()]);
        }
    })
}

/// Four texels of the candidates' mip chain, some unusable, and `fractions` numbers in [0, 1].
fn texel_rows(name: &str, fractions: usize) -> Rows {
    let width = 16 + fractions;
    let (c, alpha, at) = (channels(), floats(&[-1.0, 0.0, -0.0, 0.5, 65504.0]), floats(&[0.0, 0.25, 0.5, 1.0]));
    let lists: Vec<&[u32]> = (0..width)
        .map(|i| match i {
            16.. => &at[..],
            _ if i % 4 == 3 => &alpha,
            _ => &c,
        })
        .collect();
    Rows::new(width).mixed(name, &lists).random(name, |d, row| {
        for _ in 0..4 {
            push(row, &[d.range(0.0, 4.0), d.range(0.0, 4.0), d.range(0.0, 4.0)]);
            let alpha = if d.bits() % 3 == 0 { -1.0 } else { d.range(0.0, 9.0) };
            push(row, &[alpha]);
        }
        (0..fractions).for_each(|_| row.push(range(d, 0.0, 1.0)));
    })
}

/// A sum of noises in the making.
fn sum_of(r: &Row<'_>) -> noise::NoiseSum {
    noise::NoiseSum { weight: r.f(0), spread: r.f(1), variance: r.f(2) }
}

pub const PROBES: &[Probe] = &[
    Probe {
        name: "positive",
        module: "noise",
        words: [1, 1],
        wgsl: "out_f(positive(in_f(0u)));",
        // The Rust function is private; this is its definition.
        rust: |r, o| o.f(if r.f(0).is_nan() || r.f(0).is_sign_negative() { 0.0 } else { r.f(0) }),
        rows: || Rows::new(1).cross(&[&any()]).random("positive", |d, row| row.push(bits(d))),
    },
    Probe {
        name: "candidate_noise",
        module: "noise",
        words: [2, 2],
        wgsl: "let n = candidate_noise(vec2<f32>(in_f(0u), in_f(1u))); out_f(n.samples); out_f(n.variance);",
        rust: |r, o| put(o, noise::candidate_noise([r.f(0), r.f(1)])),
        rows: || {
            // Squares of the smallest normal numbers are denormal, which a device may flush.
            let errors: Vec<u32> =
                any().into_iter().filter(|&x| !(1..0x2000_0000).contains(&(x & 0x7fff_ffff))).collect();
            Rows::new(2).cross(&[&errors, &any()]).random("candidate_noise", |d, row| {
                push(row, &[d.range(0.0, 300.0), (d.bits() % 100) as f32]);
            })
        },
    },
    Probe {
        name: "pack_noise",
        module: "noise",
        words: [2, 1],
        wgsl: "out_u(pack_noise(Noise(in_f(0u), in_f(1u))));",
        rust: |r, o| o.u(noise::pack_noise(known(r, 0))),
        rows: || {
            Rows::new(2).cross(&[&counts(), &variances()]).random("pack_noise", |d, row| {
                let n = noise(d);
                push(row, &n);
            })
        },
    },
    Probe {
        name: "unpack_noise",
        module: "noise",
        words: [1, 2],
        wgsl: "let n = unpack_noise(in_u(0u)); out_f(n.samples); out_f(n.variance);",
        rust: |r, o| put(o, noise::unpack_noise(r.u(0))),
        rows: || Rows::new(1).cross(&[&words()]).random("unpack_noise", |d, row| row.push(bits(d))),
    },
    Probe {
        name: "candidate_texel",
        module: "noise",
        words: [6, 4],
        wgsl: "let t = candidate_texel(in_v(0u), in_u(3u) != 0u, Noise(in_f(4u), in_f(5u))); out_v(t.xyz); out_f(t.w);",
        rust: |r, o| put4(o, noise::candidate_texel(r.v(0), r.u(3) != 0, known(r, 4))),
        rows: || {
            let (c, n, v) = (channels(), counts(), variances());
            Rows::new(6).mixed("candidate_texel", &[&c, &c, &c, &[0, 1], &n, &v])
        },
    },
    Probe {
        name: "candidate_mean",
        module: "noise",
        words: [16, 4],
        wgsl: "let m = candidate_mean(vec4<f32>(in_v(0u), in_f(3u)), vec4<f32>(in_v(4u), in_f(7u)), vec4<f32>(in_v(8u), in_f(11u)), vec4<f32>(in_v(12u), in_f(15u)));
    out_v(m.xyz); out_f(m.w);",
        rust: |r, o| put4(o, noise::candidate_mean(texel(r, 0), texel(r, 4), texel(r, 8), texel(r, 12))),
        rows: || texel_rows("candidate_mean", 0),
    },
    Probe {
        name: "candidate_bilinear",
        module: "noise",
        words: [18, 4],
        wgsl: "let m = candidate_bilinear(vec4<f32>(in_v(0u), in_f(3u)), vec4<f32>(in_v(4u), in_f(7u)), vec4<f32>(in_v(8u), in_f(11u)), vec4<f32>(in_v(12u), in_f(15u)), vec2<f32>(in_f(16u), in_f(17u)));
    out_v(m.xyz); out_f(m.w);",
        rust: |r, o| {
            let (top, bottom) = ([texel(r, 0), texel(r, 4)], [texel(r, 8), texel(r, 12)]);
            put4(o, noise::candidate_bilinear(top, bottom, [r.f(16), r.f(17)]));
        },
        rows: || texel_rows("candidate_bilinear", 2),
    },
    Probe {
        name: "history_share",
        module: "noise",
        words: [5, 1],
        wgsl: "out_f(history_share(Noise(in_f(0u), in_f(1u)), Noise(in_f(2u), in_f(3u)), in_f(4u)));",
        rust: |r, o| o.f(noise::history_share(known(r, 0), known(r, 2), r.f(4))),
        rows: || pair_rows("history_share", &[&floats(&[0.0, 0.5, 0.9, 0.98])]),
    },
    Probe {
        name: "pooled_variance",
        module: "noise",
        words: [4, 1],
        wgsl: "out_f(pooled_variance(Noise(in_f(0u), in_f(1u)), Noise(in_f(2u), in_f(3u))));",
        rust: |r, o| o.f(noise::pooled_variance(known(r, 0), known(r, 2))),
        rows: || pair_rows("pooled_variance", &[]),
    },
    Probe {
        name: "root_slope",
        module: "noise",
        words: [1, 1],
        wgsl: "out_f(root_slope(in_f(0u)));",
        rust: |r, o| o.f(noise::root_slope(r.f(0))),
        rows: || {
            Rows::new(1).cross(&[&channels()]).random("root_slope", |d, row| {
                let luma = d.range(-1.0, 100.0);
                push(row, &[luma]);
            })
        },
    },
    Probe {
        name: "noise_difference",
        module: "noise",
        words: [5, 1],
        wgsl: "out_f(noise_difference(Noise(in_f(0u), in_f(1u)), Noise(in_f(2u), in_f(3u)), in_f(4u)));",
        rust: |r, o| o.f(noise::noise_difference(known(r, 0), known(r, 2), r.f(4))),
        rows: || pair_rows("noise_difference", &[&channels()]),
    },
    Probe {
        name: "expected_noise",
        module: "noise",
        words: [5, 1],
        wgsl: "out_f(expected_noise(Noise(in_f(0u), in_f(1u)), Noise(in_f(2u), in_f(3u)), in_f(4u)));",
        rust: |r, o| o.f(noise::expected_noise(known(r, 0), known(r, 2), r.f(4))),
        rows: || pair_rows("expected_noise", &[&channels()]),
    },
    Probe {
        name: "add_noise",
        module: "noise",
        words: [6, 3],
        wgsl: "let s = add_noise(NoiseSum(in_f(0u), in_f(1u), in_f(2u)), Noise(in_f(3u), in_f(4u)), in_f(5u));
            out_f(s.weight); out_f(s.spread); out_f(s.variance);",
        rust: |r, o| {
            let sum = noise::add_noise(sum_of(r), known(r, 3), r.f(5));
            [sum.weight, sum.spread, sum.variance].into_iter().for_each(|v| o.f(v));
        },
        rows: || Rows::new(6).random("add_noise", |d, row| {
            let n = noise(d);
            push(row, &[d.range(0.0, 4.0), d.range(0.0, 4.0), d.range(0.0, 9.0), n[0], n[1], d.range(0.0, 1.0)]);
        }),
    },
    Probe {
        name: "mean_noise",
        module: "noise",
        words: [3, 2],
        wgsl: "let n = mean_noise(NoiseSum(in_f(0u), in_f(1u), in_f(2u))); out_f(n.samples); out_f(n.variance);",
        rust: |r, o| put(o, noise::mean_noise(sum_of(r))),
        rows: || {
            let sums = floats(&[0.0, 1e-8, 1e-4, 1.0]);
            Rows::new(3).cross(&[&sums, &sums, &variances()]).random("mean_noise", |d, row| {
                push(row, &[d.range(0.0, 4.0), d.range(0.0, 4.0), d.range(0.0, 9.0)]);
            })
        },
    },
    Probe {
        name: "noise_visibility",
        module: "noise",
        words: [3, 1],
        wgsl: "out_f(noise_visibility(Noise(in_f(0u), in_f(1u)), in_f(2u)));",
        rust: |r, o| o.f(noise::noise_visibility(known(r, 0), r.f(2))),
        rows: || {
            Rows::new(3).random("noise_visibility", |d, row| {
                let n = noise(d);
                push(row, &[n[0], n[1], d.range(0.0, 4.0)]);
            })
        },
    },
    Probe {
        name: "noise_confidence",
        module: "noise",
        words: [3, 1],
        wgsl: "out_f(noise_confidence(Noise(in_f(0u), in_f(1u)), in_f(2u)));",
        rust: |r, o| o.f(noise::noise_confidence(known(r, 0), r.f(2))),
        rows: || {
            Rows::new(3).cross(&[&counts(), &variances(), &channels()]).random("noise_confidence", |d, row| {
                push(row, &[1.0 + (d.bits() % 99) as f32, d.range(0.0, 0.02), d.range(0.0, 2.0)]);
            })
        },
    },
    Probe {
        name: "discount_coarser",
        module: "noise",
        words: [5, 2],
        wgsl: "let n = discount_coarser(Noise(in_f(0u), in_f(1u)), Noise(in_f(2u), in_f(3u)), in_f(4u)); out_f(n.samples); out_f(n.variance);",
        rust: |r, o| put(o, noise::discount_coarser(known(r, 0), known(r, 2), r.f(4))),
        rows: || pair_rows("discount_coarser", &[&floats(&[-3.0, -0.1, 0.0, 0.1, 0.25, 1.0, 8.0])]),
    },
    Probe {
        name: "sample_difference",
        module: "noise",
        words: [3, 1],
        wgsl: "out_f(sample_difference(Noise(in_f(0u), in_f(1u)), in_f(2u)));",
        rust: |r, o| o.f(noise::sample_difference(known(r, 0), r.f(2))),
        rows: || Rows::new(3).cross(&[&counts(), &variances(), &channels()]),
    },
    Probe {
        name: "noise_after",
        module: "noise",
        words: [6, 2],
        wgsl: "let n = noise_after(Noise(in_f(0u), in_f(1u)), Noise(in_f(2u), in_f(3u)), in_f(4u), in_f(5u)); out_f(n.samples); out_f(n.variance);",
        rust: |r, o| put(o, noise::noise_after(known(r, 0), known(r, 2), r.f(4), r.f(5))),
        rows: || {
            let share = floats(&[0.0, 0.5, 0.9, 0.98, 1.0]);
            pair_rows("noise_after", &[&share, &floats(&[0.0, 0.3, 1.0])])
        },
    },
    Probe {
        name: "expose_noise",
        module: "noise",
        words: [3, 2],
        wgsl: "let n = expose_noise(Noise(in_f(0u), in_f(1u)), in_f(2u)); out_f(n.samples); out_f(n.variance);",
        rust: |r, o| put(o, noise::expose_noise(known(r, 0), r.f(2))),
        rows: || {
            let ratio = floats(&[1.0, 0.5, 2.0, 1e-3, 1e12]);
            Rows::new(3).cross(&[&counts(), &variances(), &ratio])
        },
    },
];
