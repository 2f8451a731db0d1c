//! Evidence on inputs: doctor.

use super::*;
use afterimage::kernel::doctor;

/// Signals: 0, and what a frame has.
fn signals(d: &mut Draws, row: &mut Vec<u32>, count: usize) {
    row.extend((0..count).map(|_| if d.bits().is_multiple_of(8) { 0 } else { scaled(d, -20, 6) }));
}

/// Coordinates, sizes and lattice levels.
fn lengths() -> Vec<u32> {
    vec![1, 2, 3, 5, 16, 45, 80, 481, 1920, 8192]
}

pub const PROBES: &[Probe] = &[
    probe!(doctor::signal, |rows| rows.cross(&[&[any(), around(&[1e-30, 64.0])].concat()]).each(&[Bits])),
    probe!(doctor::root_mean, |rows| rows.random(|d, row| signals(d, row, 4))),
    probe!(doctor::lattice_len, |rows| rows
        .cross(&[&(0..300).chain(lengths()).collect::<Vec<_>>(), &(0..=8).collect::<Vec<_>>()])),
    probe!(doctor::lattice_coordinate, |rows| rows.each(&[F(-5000.0, 5000.0), N(9)])),
    probe!(doctor::lattice_texel, |rows| {
        rows.cross(&[&(0..64).collect::<Vec<_>>(), &(0..=8).collect::<Vec<_>>(), &lengths()])
    }),
    probe!(doctor::spline, |rows| rows.each(&[Of(|d, row| signals(d, row, 4)), F(0.0, 1.0)])),
    probe!(doctor::stored_motion, |rows| rows
        .cross(&[&[normal(), around(&[65536.0, -65536.0])].concat()])
        .each(&[Signed(-20, 20)])),
    probe!(doctor::fixed, |rows| rows
        .cross(&[&[floats(&[0.0, 64.0]), around(&[1.0, 0.5, 4.7683716e-7])].concat()])
        .each(&[Scaled(-26, 6)])),
    probe!(doctor::disparity_factor, |rows| rows.cross(&[&(0..7).collect::<Vec<_>>()])),
    probe!(doctor::kink_class, |rows| rows.cross(&[&(0..300).collect::<Vec<_>>()])),
    probe!(doctor::bend, |rows| rows.random(|d, row| signals(d, row, 3))),
    probe!(doctor::is_code, |rows| {
        let codes: Vec<f32> = (0..=256).map(|i| i as f32 / 255.0).collect();
        rows.cross(&[&around(&codes[1..])]).each(&[F(0.0, 1.1)])
    }),
    probe!(doctor::kept_bits, |rows| rows.cross(&[&any()]).each(&[Bits])),
];
