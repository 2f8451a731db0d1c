//! Evidence on inputs: doctor.

use super::probe::{Probe, Rows};
use super::values::*;
use afterimage::kernel::doctor;

/// Signals: 0, and what a frame has.
fn signals(d: &mut afterimage_testing::Draws, row: &mut Vec<u32>, count: usize) {
    row.extend((0..count).map(|_| if d.bits().is_multiple_of(8) { 0 } else { scaled(d, -20, 6) }));
}

/// Coordinates, sizes and lattice levels.
fn lengths() -> Vec<u32> {
    vec![1, 2, 3, 5, 16, 45, 80, 481, 1920, 8192]
}

pub const PROBES: &[Probe] = &[
    Probe {
        name: "signal",
        module: "doctor",
        words: [1, 1],
        wgsl: "out_f(signal(in_f(0u)));",
        rust: |r, o| o.f(doctor::signal(r.f(0))),
        rows: || {
            Rows::new(1)
                .cross(&[&[any(), around(&[1e-30, 64.0])].concat()])
                .random("signal", |d, row| row.push(bits(d)))
        },
    },
    Probe {
        name: "root_mean",
        module: "doctor",
        words: [4, 1],
        wgsl: "out_f(root_mean(in_f(0u), in_f(1u), in_f(2u), in_f(3u)));",
        rust: |r, o| o.f(doctor::root_mean(r.f(0), r.f(1), r.f(2), r.f(3))),
        rows: || Rows::new(4).random("root_mean", |d, row| signals(d, row, 4)),
    },
    Probe {
        name: "lattice_offset",
        module: "doctor",
        words: [1, 1],
        wgsl: "out_u(lattice_offset(in_u(0u)));",
        rust: |r, o| o.u(doctor::lattice_offset(r.u(0))),
        rows: || Rows::new(1).cross(&[&(0..=8).collect::<Vec<_>>()]),
    },
    Probe {
        name: "lattice_len",
        module: "doctor",
        words: [2, 1],
        wgsl: "out_u(lattice_len(in_u(0u), in_u(1u)));",
        rust: |r, o| o.u(doctor::lattice_len(r.u(0), r.u(1))),
        rows: || Rows::new(2).cross(&[&(0..300).chain(lengths()).collect::<Vec<_>>(), &(0..=8).collect::<Vec<_>>()]),
    },
    Probe {
        name: "lattice_coordinate",
        module: "doctor",
        words: [2, 1],
        wgsl: "out_f(lattice_coordinate(in_f(0u), in_u(1u)));",
        rust: |r, o| o.f(doctor::lattice_coordinate(r.f(0), r.u(1))),
        rows: || {
            Rows::new(2).random("lattice_coordinate", |d, row| {
                row.push(range(d, -5000.0, 5000.0));
                row.push(d.bits() % 9);
            })
        },
    },
    Probe {
        name: "lattice_texel",
        module: "doctor",
        words: [3, 1],
        wgsl: "out_u(lattice_texel(in_u(0u), in_u(1u), in_u(2u)));",
        rust: |r, o| o.u(doctor::lattice_texel(r.u(0), r.u(1), r.u(2))),
        rows: || Rows::new(3).cross(&[&(0..64).collect::<Vec<_>>(), &(0..=8).collect::<Vec<_>>(), &lengths()]),
    },
    Probe {
        name: "interpolate",
        module: "doctor",
        words: [3, 1],
        wgsl: "out_f(interpolate(in_f(0u), in_f(1u), in_f(2u)));",
        rust: |r, o| o.f(doctor::interpolate(r.f(0), r.f(1), r.f(2))),
        rows: || {
            Rows::new(3).random("interpolate", |d, row| {
                signals(d, row, 2);
                row.push(range(d, 0.0, 1.0));
            })
        },
    },
    Probe {
        name: "spline",
        module: "doctor",
        words: [5, 1],
        wgsl: "out_f(spline(vec4<f32>(in_f(0u), in_f(1u), in_f(2u), in_f(3u)), in_f(4u)));",
        rust: |r, o| o.f(doctor::spline([r.f(0), r.f(1), r.f(2), r.f(3)], r.f(4))),
        rows: || {
            Rows::new(5).random("spline", |d, row| {
                signals(d, row, 4);
                row.push(range(d, 0.0, 1.0));
            })
        },
    },
    Probe {
        name: "stored_motion",
        module: "doctor",
        words: [1, 1],
        wgsl: "out_f(stored_motion(in_f(0u)));",
        rust: |r, o| o.f(doctor::stored_motion(r.f(0))),
        rows: || {
            Rows::new(1)
                .cross(&[&[normal(), around(&[65536.0, -65536.0])].concat()])
                .random("stored_motion", |d, row| row.push(signed(d, -20, 20)))
        },
    },
    Probe {
        name: "fixed",
        module: "doctor",
        words: [1, 1],
        wgsl: "out_u(fixed(in_f(0u)));",
        rust: |r, o| o.u(doctor::fixed(r.f(0))),
        rows: || {
            Rows::new(1)
                .cross(&[&[floats(&[0.0, 64.0]), around(&[1.0, 0.5, 4.7683716e-7])].concat()])
                .random("fixed", |d, row| row.push(scaled(d, -26, 6)))
        },
    },
    Probe {
        name: "boundary_class",
        module: "doctor",
        words: [1, 1],
        wgsl: "out_u(boundary_class(in_u(0u)));",
        rust: |r, o| o.u(doctor::boundary_class(r.u(0))),
        rows: || Rows::new(1).cross(&[&(0..300).collect::<Vec<_>>()]),
    },
    Probe {
        name: "kink_class",
        module: "doctor",
        words: [1, 1],
        wgsl: "out_u(kink_class(in_u(0u)));",
        rust: |r, o| o.u(doctor::kink_class(r.u(0))),
        rows: || Rows::new(1).cross(&[&(0..300).collect::<Vec<_>>()]),
    },
    Probe {
        name: "bend",
        module: "doctor",
        words: [3, 1],
        wgsl: "out_f(bend(in_f(0u), in_f(1u), in_f(2u)));",
        rust: |r, o| o.f(doctor::bend(r.f(0), r.f(1), r.f(2))),
        rows: || Rows::new(3).random("bend", |d, row| signals(d, row, 3)),
    },
    Probe {
        name: "is_code",
        module: "doctor",
        words: [1, 1],
        wgsl: "out_b(is_code(in_f(0u)));",
        rust: |r, o| o.b(doctor::is_code(r.f(0))),
        rows: || {
            let codes: Vec<f32> = (0..=256).map(|i| i as f32 / 255.0).collect();
            Rows::new(1).cross(&[&around(&codes[1..])]).random("is_code", |d, row| row.push(range(d, 0.0, 1.1)))
        },
    },
    Probe {
        name: "kept_bits",
        module: "doctor",
        words: [1, 1],
        wgsl: "out_u(kept_bits(in_f(0u)));",
        rust: |r, o| o.u(doctor::kept_bits(r.f(0))),
        rows: || Rows::new(1).cross(&[&any()]).random("kept_bits", |d, row| row.push(bits(d))),
    },
];
