//! Functions of noisy candidates: noise, mip_noise.

use super::matching::{channels, push};
use super::*;
use afterimage::kernel::noise::Noise;
use afterimage::kernel::{mip_noise, noise};

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
fn pair_rows(rows: Rows, more: &[&[u32]]) -> Rows {
    let (n, v) = (counts(), variances());
    let mut lists: Vec<&[u32]> = vec![&n, &v, &n, &v];
    lists.extend(more);
    rows.mixed(&lists).random(|d, row| {
        let (history, candidate) = (noise(d), noise(d));
        push(row, &[history, candidate].concat());
        for list in more {
            row.push(list[d.bits() as usize % list.len()]);
        }
    })
}

/// Four texels of the candidates' mip chain, some unusable, and `fractions` numbers in [0, 1].
fn texel_rows(rows: Rows, fractions: usize) -> Rows {
    let (c, alpha, at) = (channels(), floats(&[-1.0, 0.0, -0.0, 0.5, 65504.0]), floats(&[0.0, 0.25, 0.5, 1.0]));
    let lists = [[&c[..], &c, &c, &alpha].repeat(4), vec![&at; fractions]].concat();
    rows.mixed(&lists).random(|d, row| {
        for _ in 0..4 {
            push(row, &[d.range(0.0, 4.0), d.range(0.0, 4.0), d.range(0.0, 4.0)]);
            let alpha = if d.bits() % 3 == 0 { -1.0 } else { d.range(0.0, 9.0) };
            push(row, &[alpha]);
        }
        (0..fractions).for_each(|_| row.push(range(d, 0.0, 1.0)));
    })
}

shape!(Noise { samples: f32, variance: f32 });
shape!(noise::NoiseSum { weight: f32, spread: f32, variance: f32 });

pub const PROBES: &[Probe] = &[
    probe!(noise::candidate_noise, |rows| {
        // Squares of the smallest normal numbers are denormal, which a device may flush.
        let errors: Vec<u32> = any().into_iter().filter(|&x| !(1..0x2000_0000).contains(&(x & 0x7fff_ffff))).collect();
        rows.cross(&[&errors, &any()]).random(|d, row| {
            push(row, &[d.range(0.0, 300.0), (d.bits() % 100) as f32]);
        })
    }),
    probe!(noise::pack_noise, |rows| {
        rows.cross(&[&counts(), &variances()]).each(&[Of(|d, row| push(row, &noise(d)))])
    }),
    probe!(noise::unpack_noise, |rows| rows.cross(&[&words()]).each(&[Bits])),
    probe!(mip_noise::candidate_texel, |rows| {
        let (c, n, v) = (channels(), counts(), variances());
        rows.mixed(&[&c, &c, &c, &[0, 1], &n, &v])
    }),
    probe!(mip_noise::candidate_mean, |rows| texel_rows(rows, 0)),
    probe!(mip_noise::candidate_bilinear, |rows| texel_rows(rows, 2)),
    probe!(noise::history_share, |rows| pair_rows(rows, &[&floats(&[0.0, 0.5, 0.9, 0.98])])),
    probe!(mip_noise::noise_difference, |rows| pair_rows(rows, &[&channels(), &floats(&[0.01, 0.7, 1.0, 8192.0])])),
    probe!(noise::expected_noise, |rows| pair_rows(rows, &[&channels()])),
    probe!(noise::noise_need, |rows| {
        rows.cross(&[&counts(), &variances(), &channels()]).random(|d, row| {
            push(row, &noise(d));
            push(row, &[d.range(0.0, 2.0)]);
        })
    }),
    probe!(noise::add_noise, |rows| {
        rows.each(&[F(0.0, 4.0), F(0.0, 4.0), F(0.0, 9.0), Of(|d, row| push(row, &noise(d))), F(0.0, 1.0)])
    }),
    probe!(noise::mean_noise, |rows| {
        let sums = floats(&[0.0, 1e-8, 1e-4, 1.0]);
        rows.cross(&[&sums, &sums, &variances()]).each(&[F(0.0, 4.0), F(0.0, 4.0), F(0.0, 9.0)])
    }),
    probe!(noise::noise_confidence, |rows| {
        rows.cross(&[&counts(), &variances(), &channels()]).random(|d, row| {
            push(row, &[1.0 + (d.bits() % 99) as f32, d.range(0.0, 0.02), d.range(0.0, 2.0)]);
        })
    }),
    probe!(mip_noise::discount_coarser, |rows| pair_rows(rows, &[&floats(&[-3.0, -0.1, 0.0, 0.1, 0.25, 1.0, 8.0])])),
    probe!(noise::noisy_share, |rows| rows.cross(&[&counts(), &floats(&[0.0, 1.0, 2.0, 13.0, 450.0])])),
    probe!(noise::borrowed, |rows| {
        rows.random(|d, row| {
            push(row, &[d.range(0.0, 99.0)]);
            push(row, &noise(d));
            push(row, &[d.range(0.0, 2.0)]);
        })
    }),
    probe!(mip_noise::sample_difference, |rows| rows.cross(&[&counts(), &variances(), &channels()])),
    probe!(noise::noise_after, |rows| {
        let share = floats(&[0.0, 0.5, 0.9, 0.98, 1.0]);
        pair_rows(rows, &[&share, &floats(&[0.0, 0.3, 1.0])])
    }),
    probe!(noise::expose_noise, |rows| {
        let ratio = floats(&[1.0, 0.5, 2.0, 1e-3, 1e12]);
        rows.cross(&[&counts(), &variances(), &ratio])
    }),
];
