//! Functions of temporal antialiasing and upsampling: taa, taau.

use super::matching::{channels, like, push, stored_color};
use super::surfaces::fraction;
use super::*;
use afterimage::kernel::color::to_ycocg;
use afterimage::kernel::taa;
use afterimage::kernel::taau;
use afterimage::kernel::taau::SamplesAround;

/// Sums over some of nine samples, as the pass makes them, and the nearest one's color.
fn push_samples(d: &mut Draws, row: &mut Vec<u32>) {
    let centre = Vec3::from(stored_color(d));
    let (tail, flat) = (taau::tail(d.range(0.0, 2.0)), d.bits().is_multiple_of(4));
    let narrowing = taau::narrowing(d.range(0.0, 6.0));
    let jitter = [0; 2].map(|_| d.range(-0.5, 0.5));
    let mut around = SamplesAround::default();
    for tap in 0..9 {
        if d.bits() & 7 == 0 && tap != 4 {
            continue;
        }
        let color = if flat || tap == 4 { centre } else { Vec3::from(like(d, centre.to_array())) };
        let offset = [0, 1].map(|i| [tap % 3, tap / 3][i] as f32 - 1.0 - jitter[i]);
        around = taau::add_around(around, centre, color, taau::sample_weights(Vec2::from(offset), tail, narrowing));
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
        let v = to_ycocg(Vec3::from(if flat { center } else { like(d, center) }));
        sum += v;
        squares += v * v;
    }
    push(row, &sum.to_array());
    push(row, &squares.to_array());
}

shape!(SamplesAround { difference: Vec3, weights: Vec2, sum: Vec3, squares: Vec3, count: f32 });
shape!(taau::Accumulated { color: Vec3, confidence: f32, share: f32, kept: f32 });

pub const PROBES: &[Probe] = &[
    probe!(taa::root_luma, |rows| {
        let c = channels();
        rows.cross(&[&c, &c, &c]).each(&[Signed(-24, 18); 3])
    }),
    probe!(taa::confidence_of, |rows| {
        let codes: Vec<f32> = (0..=62).map(|i| i as f32 / 7.0).collect();
        rows.cross(&[&floats(&codes)]).each(&[F(0.0, 8.9)])
    }),
    probe!(taa::lod_of, |rows| {
        let edges = [floats(&[0.0, 1e-4, 2.0, 3.02, 20.0]), around(&[16.0])].concat();
        rows.cross(&[&edges]).each(&[F(0.0, 17.0)])
    }),
    probe!(taa::confidence_limit, |rows| {
        let at = [around(&[0.25, 0.5]), floats(&[0.0, 1.0 / 16_777_216.0, 1.0_f32.next_down()])].concat();
        rows.cross(&[&at, &at, &floats(&[0.6, 1.0])])
            .random(|d, row| push(row, &[fraction(d), fraction(d), d.range(0.5, 1.0)]))
    }),
    probe!(taa::agreeing, |rows| {
        rows.cross(&[&floats(&[0.0]), &floats(&[0.0]), &floats(&[0.0, 1.0]), &floats(&[0.0, 9.0])]).random(|d, row| {
            let (count, mean) = (1 + d.bits() % 9, d.range(0.0, 2.0));
            let spread = [0.0, 0.001, 0.3][d.bits() as usize % 3];
            let lumas: Vec<f32> = (0..count).map(|_| mean + spread * d.uniform()).collect();
            let squares = lumas.iter().map(|v| v * v).sum();
            let past = count as f32 * (mean + [0.0, 0.001, 0.3][d.bits() as usize % 3] * d.uniform());
            push(row, &[lumas.iter().sum(), squares, past, count as f32]);
        })
    }),
    probe!(taa::candidate_share, |rows| {
        let confidence = [around(&[1.0, 9.0]), floats(&[0.0, 1e-30, 16.0])].concat();
        let trust = [around(&[0.6, 0.9]), floats(&[1e-30, 0.25, 1.0])].concat();
        rows.cross(&[&confidence, &trust]).each(&[F(0.0, 16.0), F(0.0, 1.0)])
    }),
    probe!(taa::blend_clipped, |rows| {
        rows.random(|d, row| {
            let candidate = stored_color(d);
            let history = like(d, candidate);
            push(row, &like(d, candidate));
            push(row, &history.map(|x| x.max(0.0)));
            push_box(d, row, candidate);
            push(row, &[[0.1, 0.4, 1.0, d.range(0.1, 1.0)][d.bits() as usize % 4]]);
            push(row, &[[1.0, 16.0, d.range(0.0, 6.0)][d.bits() as usize % 3]]);
        })
    }),
    probe!(taau::tail, |rows| rows.cross(&[&around(&[0.5, 1.0])]).each(&[F(0.0, 1.0)])),
    probe!(taau::narrowing, |rows| rows.cross(&[&around(&[2.0, 4.0])]).each(&[F(0.0, 17.0)])),
    probe!(taau::sample_weights, |rows| {
        let offsets = floats(&[0.0, 0.5, -0.5, 1.0, -2.0, 3.0, 511.5]);
        let (tails, narrowings) = (floats(&[0.002, 0.02]), floats(&[1.0, 1.4]));
        let random = [F(-1.5, 1.5), F(-1.5, 1.5), F(0.002, 0.02), F(1.0, 1.4)];
        rows.cross(&[&offsets, &offsets, &tails, &narrowings]).each(&random)
    }),
    probe!(taau::add_around, |rows| {
        rows.random(|d, row| {
            push_samples(d, row);
            let color = stored_color(d);
            push(row, &color);
            push(row, &[d.uniform(), d.range(0.0, 1.02)]);
        })
    }),
    probe!(taau::accumulate, |rows| {
        rows.random(|d, row| {
            push_samples(d, row);
            let centre = [12, 13, 14].map(|i| f32::from_bits(row[row.len() - 15 + i]));
            let history = like(d, centre);
            push(row, &history.map(|x| x.max(0.0)));
            push(row, &[[0.0, 2.0, 16.0, d.range(0.0, 16.0)][d.bits() as usize % 4]]);
            push(row, &[[1.0, 0.25, d.range(0.01, 1.0)][d.bits() as usize % 3]]);
        })
    }),
];
