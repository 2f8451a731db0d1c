//! Antialiasing of jittered frames: antialias.

use super::sparse::{color, push_light, push_reconstruction};
use super::*;
use afterimage::kernel::reconstruction::{Reconstructed, Reconstruction};
use afterimage::kernel::{antialias, reconstruction};

shape!(antialias::Mean { lod: f32, samples: f32, deviation: f32, run: f32 });
shape!(antialias::Near { sum: Vec3, squares: Vec3, count: f32, change: Vec3, weight: f32 });
shape!(antialias::Placed { color: Vec3, place_px: Vec2 });
shape!(antialias::Clip { change: Vec3, kept: f32 });
shape!(antialias::Averaged { result: Reconstructed, mean: antialias::Mean });

const DISPARITIES: [f32; 8] = [-1.0, 0.0, 0.48, 0.49, 0.5, 0.51, 1.0, 1.02];

pub const PROBES: &[Probe] = &[
    probe!(antialias::mean_of, |rows| {
        let stored: Vec<u32> = (0..255).map(|code| (code as f32 * (1.0 / 7.0)).to_bits()).collect();
        rows.cross(&[&stored]).cross(&[&floats(&[-1.0])])
    }),
    probe!(antialias::mean_lod, |rows| rows.each(&[F(-1.0, 36.0)])),
    probe!(antialias::stored_lod, |rows| {
        let lods = floats(&[-1.0, 0.0, 0.1, 0.2, 0.21, 1.0, 2.5, 6.0, 8.0]);
        let (samples, deviations) = (floats(&[1.0, 1.4, 2.0, 16.0, 29.0, 40.0]), floats(&[0.0, 1.0, 7.5, 37.5, 90.0]));
        let (runs, draws) = (floats(&[-2.0, -1.0, 0.0, 1.0, 2.0]), floats(&[0.001, 0.5, 0.999]));
        let random = [F(-1.0, 1.0), F(0.0, 31.0), F(0.0, 40.0), Of(push_run), F(0.0, 1.0), F(0.0, 1.0)];
        rows.cross(&[&lods, &samples, &deviations, &runs, &draws, &draws]).each(&random)
    }),
    probe!(antialias::byte_draws, |rows| rows.each(&[Bits])),
    probe!(antialias::expected_mean_error, |rows| rows.random(|d, row| {
        row.push(range(d, -1.0, 3.0));
        push_samples(d, row);
        row.extend([range(d, 0.0, 100.0), d.bits() % 2]);
    })),
    probe!(antialias::with_regular_run, |rows| rows.random(|d, row| {
        row.push(0);
        push_samples(d, row);
        row.push(d.bits() % 5);
    })),
    probe!(antialias::next_run, |rows| rows.random(|d, row| {
        row.push(0);
        push_samples(d, row);
        row.extend([d.bits() % 2, range(d, 0.0, 40.0)]);
    })),
    probe!(antialias::count_in_run, |rows| rows.random(|d, row| {
        row.extend([range(d, 0.0, 29.0), 0]);
        push_samples(d, row);
        push_run(d, row);
    })),
    probe!(antialias::relit_samples, |rows| rows.each(&[F(1.0, 29.0), F(0.2, 5.0), F(0.9, 1.1), F(0.9, 1.1)])),
    probe!(antialias::kept_samples, |rows| rows.each(&[F(0.6, 40.0), F(0.0, 200.0)])),
    probe!(antialias::is_in_front, |rows| rows.each(&[&[F(-1.0, 2.0); 2][..], &[F(-1.0, 1.0); 4], &[N(2)]].concat())),
    probe!(antialias::move_together, |rows| rows.each(&[F(-0.2, 0.2); 6])),
    probe!(antialias::is_thin, |rows| {
        let disparities = floats(&DISPARITIES);
        rows.cross(&[&disparities, &disparities, &disparities])
    }),
    probe!(antialias::is_silhouette, |rows| {
        let disparities = floats(&DISPARITIES);
        rows.cross(&[&disparities, &disparities, &disparities]).each(&[F(0.9, 1.1); 3])
    }),
    probe!(antialias::is_edge, |rows| {
        let disparities = floats(&DISPARITIES);
        rows.cross(&[&disparities, &disparities, &disparities]).each(&[F(0.9, 1.1); 3])
    }),
    probe!(antialias::is_of_surfaces, |rows| {
        let disparities = floats(&[-1.0, 0.0, 0.48, 0.49, 0.5, 0.51, 1.0, 1.02, 1.03, 1e30]);
        rows.cross(&[&disparities, &disparities, &disparities]).each(&[F(0.9, 1.1); 3])
    }),
    probe!(antialias::add_near, |rows| rows.each(
        &[
            &[F(-2.0, 2.0); 6][..],
            &[F(0.0, 8.0)],
            &[F(-2.0, 2.0); 3],
            &[F(0.0, 1.0)],
            &[Scaled(-14, 6); 6],
            &[F(-1.5, 1.5); 2]
        ]
        .concat()
    )),
    probe!(antialias::surrounds_centre, |rows| {
        let places = floats(&[-0.6, -0.5, 0.0, 0.3, 0.5, 0.51]);
        rows.cross(&[&places, &places])
    }),
    probe!(antialias::centred_change, |rows| rows
        .each(&[&[F(-2.0, 2.0); 6][..], &[F(1.0, 9.0)], &[F(-2.0, 2.0); 3], &[F(0.25, 1.0)]].concat())),
    probe!(antialias::centred, |rows| rows
        .each(&[&[Scaled(-14, 6); 3][..], &[F(-0.5, 0.5); 2], &[F(-2.0, 2.0); 3], &[F(1.0, 30.0)]].concat())),
    probe!(antialias::clip, |rows| {
        rows.random(|d, row| {
            let count = 1.0 + (d.bits() % 9) as f32;
            let sum = [0; 3].map(|_| d.range(-1.0, 2.0) * count);
            row.extend(sum.map(f32::to_bits));
            row.extend(sum.map(|v| (v * v / count + d.range(0.0, 1.0)).to_bits()));
            row.push(count.to_bits());
            row.extend([range(d, -1.0, 1.0), range(d, -1.0, 1.0), range(d, -1.0, 1.0), range(d, 0.25, 1.0)]);
            row.extend(color(d));
        })
    }),
    probe!(antialias::clipped, |rows| {
        rows.random(|d, row| {
            row.extend(color(d));
            let still = d.bits().is_multiple_of(4);
            row.extend([0; 3].map(|_| if still { 0 } else { range(d, -0.5, 0.5) }));
        })
    }),
    probe!(antialias::scattered_error, |rows| rows.each(&[Of(push_light), F(0.0, 4000.0)])),
    probe!(
        antialias::average,
        |r: Reconstruction,
         past: antialias::Mean,
         place_px: Vec2,
         at_edge: bool,
         kept: f32,
         difference: f32,
         change: Vec3,
         is_centred: bool| {
            antialias::average(&r, past, place_px, at_edge, kept, difference, is_centred.then_some(change))
        },
        |rows| {
            rows.random(|d, row| {
                push_reconstruction(d, row);
                if d.bits().is_multiple_of(2) {
                    row[17] = 0;
                }
                row.push(0);
                push_samples(d, row);
                row.extend([range(d, -0.5, 0.5), range(d, -0.5, 0.5), d.bits() % 2]);
                row.extend([range(d, 0.0, 1.0), range(d, 0.0, 200.0)]);
                row.extend([range(d, -1.0, 1.0), range(d, -1.0, 1.0), range(d, -1.0, 1.0), d.bits() % 2]);
            })
        }
    ),
    probe!(
        antialias::average_beside,
        |r: Reconstruction, past: antialias::Mean, place_px: Vec2| antialias::average_beside(&r, past, place_px),
        |rows| {
            rows.random(|d, row| {
                push_reconstruction(d, row);
                row.push(0);
                push_samples(d, row);
                row.extend([range(d, -0.5, 0.5), range(d, -0.5, 0.5)]);
            })
        }
    ),
    probe!(
        antialias::stored_mean,
        |given: Reconstruction, past: antialias::Mean| {
            antialias::stored_mean(&given, reconstruction::reconstruct(&given), past)
        },
        "let given = $0; stored_mean(given, reconstruct(given), $1)",
        |rows| {
            rows.random(|d, row| {
                push_reconstruction(d, row);
                // Mostly a kept sample at full rate.
                if !d.bits().is_multiple_of(4) {
                    (row[13], row[17]) = (0, 0);
                }
                row.push(range(d, -1.0, 3.0));
                push_samples(d, row);
            })
        }
    ),
];

/// Number, deviation and run of the samples in a mean.
fn push_samples(d: &mut Draws, row: &mut Vec<u32>) {
    row.extend([range(d, 1.0, 29.0), range(d, 0.0, 40.0)]);
    push_run(d, row);
}

fn push_run(d: &mut Draws, row: &mut Vec<u32>) {
    row.push(((d.bits() % 5) as f32 - 2.0).to_bits());
}
