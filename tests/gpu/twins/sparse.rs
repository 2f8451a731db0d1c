//! Reconstruction of planned frames: stored_sample, reconstruction, candidate.

use super::*;
use afterimage::kernel::noise::Noise;
use afterimage::kernel::reconstruction::Reconstruction;
use afterimage::kernel::stored_sample::Around;
use afterimage::kernel::{antialias, candidate, reconstruction, stored_sample};

shape!(stored_sample::StoredSample { color: Vec3, lod: f32, disparity: f32, place_px: Vec2 });
shape!(Around {
    weight: f32,
    color: Vec3,
    lod: f32,
    place: Vec2,
    square: Vec3,
    color_x: Vec3,
    color_y: Vec3,
    range: [Vec3; 2],
    nearest: stored_sample::StoredSample,
    cost: f32
});
shape!(stored_sample::Interpolated { color: Vec3, lod: f32, range: [Vec3; 2], nearest: stored_sample::StoredSample });
shape!(reconstruction::Observation { sampled: Vec3, history: Vec3, error: f32, confidence: f32, deviation: f32 });
shape!(reconstruction::ObservedAround {
    sampled: Vec3,
    history: Vec3,
    error: f32,
    deviation: f32,
    weight: f32,
    squared: f32,
    spatial: f32,
    known: f32
});
shape!(reconstruction::Rectification { gain as "gains": Vec3, fit: f32, center_fit: f32, is_own: bool });
shape!(reconstruction::QuadRectification {
    gain as "gains": Vec3,
    fit: f32,
    center_fits: [f32; 4],
    is_own: bool,
    disparities: [f32; 4]
});
shape!(Reconstruction {
    candidate: Vec3,
    lod: f32,
    range: [Vec3; 2],
    history: Vec3,
    history_lod: f32,
    nearest: stored_sample::StoredSample,
    lod_loss_per_stop: f32,
    gain: Vec3,
    fit: f32,
    trust: f32,
    accumulate: f32
});
shape!(reconstruction::Reconstructed {
    color: Vec3,
    stored: stored_sample::StoredSample,
    share: f32,
    keeps_nearest: bool,
    stored_share: f32
});
shape!(candidate::SampleSums {
    color: Vec3,
    alpha: f32,
    weight: f32,
    gain as "gains": Vec3,
    fit: f32,
    known: f32,
    lowest: Vec3,
    highest: Vec3,
    beside: Vec3,
    nearest_px2: f32
});
shape!(candidate::SampleMean { color: Vec3, alpha: f32, lod: f32, gain as "gains": Vec3, fit: f32 });
shape!(candidate::NoisySums { sum: Vec4, weight: f32 });
shape!(candidate::Borrowed { color: Vec3, noise: Noise });
shape!(reconstruction::Accumulated { result: reconstruction::Reconstructed, noise: Noise });

pub(super) fn color(d: &mut Draws) -> [u32; 3] {
    [0; 3].map(|_| scaled(d, -14, 6))
}

/// Motions in the world, at the limits and beside them.
fn moved_px() -> Vec<u32> {
    let beside = |v: f32| [v.next_down(), v, v.next_up()];
    floats(&[[0.0, 0.3, 1000.0], beside(0.125), beside(0.5), beside(2.0)].concat())
}

const COLOR: Word = Of(|d, row| row.extend(color(d)));

fn push_stored(d: &mut Draws, row: &mut Vec<u32>) {
    row.extend(color(d));
    row.push(range(d, 0.0, 8.0));
    row.push(scaled(d, -20, 20));
    row.extend([range(d, -1.3, 1.3), range(d, -1.3, 1.3)]);
}

fn times(v: u32, by: u32) -> u32 {
    (f32::from_bits(v) * f32::from_bits(by)).to_bits()
}

/// An observation whose colors are often close to each other.
fn push_observation(d: &mut Draws, row: &mut Vec<u32>) {
    let sampled = color(d);
    row.extend(sampled);
    let near = d.bits().is_multiple_of(2);
    for v in sampled {
        row.push(if near { times(v, range(d, 0.7, 1.4)) } else { scaled(d, -14, 6) });
    }
    row.extend([range(d, 0.0, 40.0), range(d, 0.0, 1.0), range(d, 0.0, 40.0)]);
}

/// Three samples around a position, and how many to use.
fn around_rows(rows: Rows) -> Rows {
    rows.random(|d, row| {
        for _ in 0..3 {
            push_stored(d, row);
            row.extend([range(d, -1.5, 1.5), range(d, -1.5, 1.5)]);
        }
        row.push(d.bits() % 4);
    })
}

/// Words of a reconstruction.
pub(super) fn push_reconstruction(d: &mut Draws, row: &mut Vec<u32>) {
    row.extend(color(d));
    row.push(range(d, 0.0, 4.0));
    let (low, more) = (color(d), color(d));
    row.extend(low);
    row.extend((0..3).map(|i| (f32::from_bits(low[i]) + f32::from_bits(more[i])).to_bits()));
    row.extend(color(d));
    row.push(range(d, 0.0, 4.0));
    push_stored(d, row);
    row.push(range(d, 0.0, 4.0));
    let lit = d.bits().is_multiple_of(2);
    row.extend([0; 3].map(|_| if lit { 1.0_f32.to_bits() } else { range(d, 0.2, 5.0) }));
    let confidence = d.bits().is_multiple_of(2);
    row.extend([0; 2].map(|_| if confidence { 1.0_f32.to_bits() } else { range(d, 0.0, 1.0) }));
    row.push(range(d, 0.0, 0.98));
}

/// Three samples with their texels.
type Samples = [(stored_sample::StoredSample, Vec2); 3];

/// Sums over the first `count` samples.
fn around(samples: Samples, count: u32) -> Around {
    samples[..count as usize].iter().fold(Around::NOTHING, |a, &(sample, texel_px)| {
        stored_sample::add_stored(a, sample, texel_px, true, stored_sample::INVERSE_REACH)
    })
}

/// WGSL of [`around`], `a`, and code that follows.
macro_rules! around {
    ($rest:literal) => {
        concat!(
            "var a = nothing_around(); for (var i = 0u; i < in_u(27u); i++) { let b = 9u * i;
            a = add_stored(a, StoredSample(in_v(b), in_f(b + 3u), in_f(b + 4u), vec2f(in_f(b + 5u), in_f(b + 6u))),
                vec2f(in_f(b + 7u), in_f(b + 8u)), true, INVERSE_REACH); }
            ",
            $rest
        )
    };
}

pub const PROBES: &[Probe] = &[
    probe!(stored_sample::pack_color, |rows| {
        let c: Vec<u32> = finite().into_iter().filter(|&x| x & 0x7fff_ffff == 0 || x & 0x7f80_0000 != 0).collect();
        rows.cross(&[&c, &c, &[0, 0x3f80_0000]]).each(&[Scaled(-14, 6); 3])
    }),
    probe!(stored_sample::pack_stored, |rows| rows.random(|d, row| {
        push_stored(d, row);
        if d.bits().is_multiple_of(8) {
            row[3] = (-1.0_f32).to_bits();
            row[4] = (-1.0_f32).to_bits();
        }
    })),
    probe!(stored_sample::unpack_stored, |rows| rows.each(&[Bits, Bits])),
    probe!(stored_sample::code_word, |rows| rows.each(&[Bits, Bits])),
    probe!(stored_sample::with_motion, |rows| rows.cross(&[&[0, !0], &[0, 1 << 19, !0], &moved_px()])),
    probe!(stored_sample::moved_alike, |rows| rows.cross(&[&[0], &[0, 1 << 19, !0, !(1 << 19)], &moved_px()])),
    probe!(stored_sample::resized_stored, |rows| rows.random(|d, row| {
        row.extend([d.bits(), d.bits()]);
        push_stored(d, row);
    })),
    probe!(stored_sample::moved_stored, |rows| {
        let (by, zoom) = (F(-0.5, 0.5), F(0.5, 2.0));
        rows.each(&[Of(push_stored), by, by, zoom, zoom, F(-1.0, 1.0)])
    }),
    probe!(stored_sample::pack_color_by, |rows| rows.each(&[COLOR, F(0.0, 1.0)])),
    probe!(
        stored_sample::add_stored,
        around,
        around!(
            "out_f(a.weight); out_v(a.color); out_f(a.lod); out_f(a.place.x); out_f(a.place.y); out_v(a.square);
            out_v(a.color_x); out_v(a.color_y); out_v(a.lowest); out_v(a.highest); out_v(a.nearest.color);
            out_f(a.nearest.lod); out_f(a.nearest.disparity); out_f(a.nearest.place_px.x);
            out_f(a.nearest.place_px.y); out_f(a.cost);"
        ),
        around_rows
    ),
    probe!(
        stored_sample::can_replace,
        |weight: f32| stored_sample::can_replace(Around { weight, ..Around::NOTHING }),
        "var a = nothing_around(); a.weight = $0; can_replace(a)",
        |rows| rows.each(&[F(0.0, 4.0)])
    ),
    probe!(
        stored_sample::interpolate,
        |samples: Samples, count: u32| stored_sample::interpolate(around(samples, count)),
        around!(
            "let k = interpolate(a); out_v(k.color); out_f(k.lod); out_v(k.lowest); out_v(k.highest);
            out_v(k.nearest.color); out_f(k.nearest.lod); out_f(k.nearest.disparity); out_f(k.nearest.place_px.x);
            out_f(k.nearest.place_px.y);"
        ),
        around_rows
    ),
    probe!(candidate::sample_codes, |rows| rows.each(&[Scaled(-34, 34)])),
    probe!(candidate::distance_weight, |rows| rows.each(&[F(0.0, 300.0)])),
    probe!(candidate::sample_weight, |rows| rows.each(&[F(0.0, 300.0), N(2)])),
    probe!(candidate::no_samples, |_: u32| candidate::no_samples(), "no_samples()", |rows| rows.each(&[N(2)])),
    probe!(candidate::add_sample, |rows| rows.random(|d, row| {
        push_sums(d, row);
        row.extend(color(d));
        row.push(range(d, 0.0, 1.0));
        row.extend([0; 3].map(|_| range(d, 0.2, 5.0)));
        row.extend([range(d, 0.0, 1.0), range(d, 0.0, 1.0), d.bits() % 2]);
        row.extend([range(d, 0.0, 1.0), range(d, 0.0, 300.0), d.bits() % 2]);
    })),
    probe!(candidate::has_surface, |rows| rows.random(push_sums)),
    probe!(candidate::is_beside, |rows| rows.random(push_sums)),
    probe!(candidate::sample_mean, |rows| rows.each(&[Of(push_sums), F(0.0, 8.0)])),
    probe!(candidate::add_noisy, |rows| {
        rows.each(&[COLOR, F(0.0, 4.0), F(0.0, 64.0), COLOR, F(1.0, 64.0), F(0.0, 2.0), F(0.0, 300.0)])
    }),
    probe!(candidate::noisy_mean, |rows| rows.each(&[COLOR, F(0.0, 4.0), F(0.01, 64.0)])),
    probe!(candidate::borrow_around, |rows| {
        rows.each(&[COLOR, F(1.0, 64.0), F(0.0, 2.0), COLOR, F(0.0, 2.0), F(0.0, 4096.0)])
    }),
    probe!(candidate::candidate_level, |rows| rows.each(&[F(0.0, 200.0), F(0.0, 8.0)])),
    probe!(reconstruction::no_observation, |_: u32| reconstruction::no_observation(), "no_observation()", |rows| rows
        .each(&[N(2)])),
    probe!(reconstruction::none_around, |_: u32| reconstruction::none_around(), "none_around()", |rows| rows
        .each(&[N(2)])),
    probe!(reconstruction::pack_observation, |rows| rows.random(push_observation)),
    probe!(reconstruction::unpack_observation, |rows| rows.each(&[Bits, Bits, COLOR])),
    probe!(reconstruction::is_observed, |rows| rows.each(&[Bits, Bits])),
    probe!(reconstruction::mean_observation, |rows| {
        rows.random(|d, row| {
            push_light(d, row);
            // Without any, and of a few.
            row[8] = [0.0_f32, 1.0, 2.0, 3.0, 4.0][d.bits() as usize % 5].to_bits();
            row.push(range(d, 0.0, 4.0));
        })
    }),
    probe!(reconstruction::spatial_weight, |rows| rows.each(&[F(0.0, 128.0), F(1.0, 128.0)])),
    probe!(reconstruction::neighbour_weight, |rows| rows.random(|d, row| {
        push_observation(d, row);
        if d.bits().is_multiple_of(2) {
            row[6] = (-1.0_f32).to_bits();
        }
        push_observation(d, row);
        row.push(range(d, 0.0, 1.0));
    })),
    probe!(reconstruction::gain_helps, |rows| rows.each(&[F(0.0, 60.0), F(0.0, 60.0), N(2)])),
    probe!(reconstruction::add_around, |rows| rows.each(&[Of(push_light), Of(push_light)])),
    probe!(reconstruction::block_weight, |rows| rows.each(&[Of(push_observation)])),
    probe!(
        reconstruction::block_gain,
        |l: reconstruction::ObservedAround| reconstruction::block_gain(l, reconstruction::mean_error(l)),
        "let l = $0; block_gain(l, mean_error(l))",
        |rows| rows.random(push_light)
    ),
    probe!(reconstruction::block_vote, |rows| rows.each(&[
        Of(push_observation),
        F(0.2, 5.0),
        F(0.2, 5.0),
        F(0.2, 5.0)
    ])),
    probe!(reconstruction::has_majority, |rows| rows.each(&[F(0.0, 60.0), F(0.0, 60.0)])),
    probe!(reconstruction::noisy_fit_around, |rows| rows.each(&[Of(push_light), F(0.0, 60.0)])),
    probe!(antialias::add_scatter, |rows| rows.each(&[F(0.0, 1000.0), Of(push_observation), F(0.0, 4.0)])),
    probe!(stored_sample::has_moved, |rows| rows.each(&[F(-0.1, 0.1), F(-0.1, 0.1), F(-0.1, 0.1), F(-0.1, 0.1)])),
    probe!(reconstruction::expected_error, |rows| rows.each(&[F(0.0, 3.0), F(0.0, 100.0), N(2)])),
    probe!(reconstruction::lod_loss_per_stop, |rows| rows.cross(&[&[0, 1], &[0, 1]])),
    probe!(reconstruction::pack_known, |rows| rows.each(&[F(0.0, 1.0), F(0.0, 80.0)])),
    probe!(reconstruction::known_confidence, |rows| rows.each(&[Bits])),
    probe!(reconstruction::known_deviation, |rows| rows.each(&[Bits])),
    probe!(reconstruction::noisy_lod_confidence, |rows| rows.each(&[
        F(0.0, 3.0),
        F(1.0, 80.0),
        F(0.0, 0.01),
        F(0.0, 2.0)
    ])),
    probe!(reconstruction::agreement, |rows| rows.each(&[Of(push_observation), Of(push_observation), F(0.0, 4.0)])),
    probe!(reconstruction::add_observation, |rows| {
        rows.each(&[Of(push_light), Of(push_observation), F(0.0, 4.0), F(0.0, 4.0)])
    }),
    probe!(
        reconstruction::relight,
        |l: reconstruction::ObservedAround| reconstruction::relight(l, reconstruction::mean_error(l)),
        "let l = $0; relight(l, mean_error(l))",
        |rows| rows.random(push_light)
    ),
    probe!(reconstruction::not_jitter, |rows| rows.each(&[Of(push_light), F(0.0, 100.0)])),
    probe!(reconstruction::mean_error, |rows| rows.random(push_light)),
    probe!(reconstruction::center_fit, |rows| rows.each(&[
        Of(push_observation),
        F(0.2, 5.0),
        F(0.2, 5.0),
        F(0.2, 5.0)
    ])),
    probe!(reconstruction::vote, |rows| rows.each(&[Of(push_observation), F(0.0, 12.0), F(0.0, 4.0)])),
    probe!(reconstruction::fit_by_votes, |rows| rows.each(&[Of(push_light), F(0.0, 12.0), F(0.0, 16.0), F(0.0, 1.0)])),
    probe!(reconstruction::fit_around, |rows| rows.each(&[Of(push_light), F(0.0, 60.0), F(0.0, 1.0)])),
    probe!(reconstruction::mean_fit, |rows| rows.each(&[Of(push_light), F(0.0, 1.0)])),
    probe!(reconstruction::pack_rectification, |rows| rows
        .each(&[&[F(0.2, 5.0); 3][..], &[F(0.0, 1.0); 5], &[N(2)], &[Scaled(-20, 20); 4]].concat())),
    probe!(reconstruction::unpack_rectification, |rows| rows.each(&[Bits, Bits, Bits, Bits, N(4)])),
    probe!(reconstruction::quad_code, |rows| rows.each(&[Bits, Bits, Bits, Bits, N(4)])),
    probe!(reconstruction::reconstruct, |r: Reconstruction| reconstruction::reconstruct(&r), |rows| rows
        .random(push_reconstruction)),
    probe!(reconstruction::result_alpha, |rows| rows.random(|d, row| {
        row.extend(color(d));
        push_stored(d, row);
        let share = |d: &mut Draws| if d.bits().is_multiple_of(4) { 1.0_f32.to_bits() } else { range(d, 0.0, 1.0) };
        row.extend([share(d), d.bits() % 2, share(d)]);
        row.extend([range(d, 0.0, 1.0), range(d, 0.0, 1.0), range(d, -0.5, 3.0)]);
    })),
    probe!(
        reconstruction::accumulate,
        |r: Reconstruction, past: Noise, now: Noise| reconstruction::accumulate(&r, past, now),
        |rows| rows.random(|d, row| {
            push_reconstruction(d, row);
            for _ in 0..2 {
                let variance = [0.0, d.range(0.0, 1e-3), d.range(0.0, 2.0)][d.bits() as usize % 3];
                row.extend([(1.0 + (d.bits() % 64) as f32).to_bits(), variance.to_bits()]);
            }
        })
    ),
];

/// Sums over samples around a pixel, the nearest of which is often beside it, or missing.
fn push_sums(d: &mut Draws, row: &mut Vec<u32>) {
    let weight = range(d, 0.001, 4.0);
    row.extend(color(d).map(|v| times(v, weight)));
    row.extend([times(weight, range(d, 0.0, 1.0)), weight]);
    let known = range(d, 1e-6, 4.0);
    row.extend([0; 3].map(|_| times(known, range(d, 0.2, 5.0))));
    row.extend([times(known, range(d, 0.0, 1.0)), known]);
    row.extend([color(d), color(d), color(d)].concat());
    row.push([range(d, 0.0, 4.0), 2.0_f32.to_bits(), range(d, 0.0, 300.0), 1e30_f32.to_bits()][d.bits() as usize % 4]);
}

/// Twelve words of sums over neighbours, whose means are often close to each other.
pub(super) fn push_light(d: &mut Draws, row: &mut Vec<u32>) {
    let weight = range(d, 0.0, 16.0);
    let (mean, near) = (color(d), d.bits().is_multiple_of(2));
    row.extend(mean.map(|v| times(v, weight)));
    for v in mean {
        let other = if near { times(v, range(d, 0.8, 1.25)) } else { scaled(d, -14, 6) };
        row.push(times(other, weight));
    }
    row.push(times(weight, range(d, 0.0, 20.0)));
    row.push(times(weight, range(d, 0.0, 20.0)));
    row.extend([weight, times(times(weight, weight), range(d, 0.11, 1.0)), range(d, 0.0, 16.0)]);
    row.push(times(weight, range(d, 1.0, 3.0)));
}
