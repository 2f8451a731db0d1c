//! Functions of weighted reservoirs beyond the paper: sharper weights, means, references of the gate.

use super::matching::{like, push, stored_color};
use super::*;
use afterimage::kernel::wrs;
use afterimage::kernel::wrs::{Decision, Reference, SamplerCode};

/// A color channel as candidates have it.
fn channel(d: &mut Draws) -> u32 {
    signed(d, -26, 15)
}

/// A color and a level.
fn reference(d: &mut Draws, row: &mut Vec<u32>) {
    row.extend([channel(d), channel(d), channel(d), [0, 5, 63][d.bits() as usize % 3]]);
}

shape!(Reference { color: Vec3, level: u32 });

pub const PROBES: &[Probe] = &[
    probe!(wrs::unspread, |rows| {
        rows.random(|d, row| {
            let candidate = stored_color(d);
            let [nearest, mean] =
                [0; 2].map(|_| like(d, candidate).map(|x| x.max(0.0) * [1.0, 1.0, 8.0][d.bits() as usize % 3]));
            push(row, &[candidate, nearest, mean].concat());
        })
    }),
    probe!(wrs::sharpen, |rows| {
        let weights = [floats(&[0.0, 0.003, 0.5]), around(&[1.0])].concat();
        rows.cross(&[&weights, &[1, 2, 3, 8]]).random(|d, row| row.extend([scaled(d, -8, 0), 1 + d.bits() % 8]))
    }),
    probe!(wrs::at_rate, |rows| rows
        .cross(&[&floats(&[1.0, 0.003, 1e-30, 1e-37]), &around(&[0.0, 0.5, 1.0, 3.0, 8.85]), &[1, 2, 3, 4]])
        .random(|d, row| row.extend([scaled(d, -90, 0), range(d, 0.0, 8.8), 1 + d.bits() % 4]))),
    probe!(wrs::level_code, |rows| rows.cross(&[&around(&[0.125, 0.375, 4.125, 7.875, 8.0])]).each(&[F(0.0, 8.0)])),
    probe!(wrs::pack_reference, |rows| {
        let channels = [floats(&[0.0, -1.0, 65504.0, 0.3]), around(&[1.0, 0.984_375, 0.992_187_5])].concat();
        rows.mixed(&[&channels, &channels, &channels, &[0, 16, 63]])
            .each(&[&[Signed(-26, 15); 3][..], &[N(64)]].concat())
    }),
    probe!(wrs::unpack_reference, |rows| rows.cross(&[&words()]).each(&[Bits])),
    probe!(wrs::compared, |rows| rows.each(&[Of(reference), Of(reference)])),
    probe!(
        wrs::next_reference,
        |candidate: Vec3, level: u32, past: Reference, take: bool| wrs::next_reference(candidate, level, take, past),
        "next_reference($0, $1, $3, $2)",
        |rows| rows.each(&[Of(reference), Of(reference), N(2)])
    ),
    probe!(
        wrs::combined,
        |candidate: Vec3, weight: f32, stored: Vec3, w_sum: f32, take: bool, sampler: SamplerCode| {
            let decision = Decision { take, w_sum, log_key: 0.0, gate: 1.0, survival: 1.0 };
            wrs::combined(candidate, weight, stored, &decision, sampler)
        },
        "combined($0, $1, $2, Decision($4, $3, 0.0, 1.0, 1.0), $5)",
        |rows| {
            rows.random(|d, row| {
                let weight = f32::from_bits(scaled(d, -20, 0));
                let kept = [0.0, f32::from_bits(scaled(d, -30, 8))][d.bits() as usize & 1];
                row.extend([channel(d), channel(d), channel(d), weight.to_bits()]);
                row.extend([channel(d), channel(d), channel(d), (weight + kept).to_bits(), d.bits() & 1, d.bits() % 3]);
            })
        }
    ),
];
