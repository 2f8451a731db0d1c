//! Frames shaded by quads: quads.

use super::probe::{Probe, probe};
use super::values::*;
use afterimage::kernel::quads;
use afterimage_testing::Draws;

/// Offsets of quads, beyond the reach of neighbours, too.
fn offsets() -> Vec<u32> {
    (-10..10).map(|v: i32| v as u32).collect()
}

/// A window with few quads, two offsets in any order, and a row.
fn in_window(d: &mut Draws, row: &mut Vec<u32>) {
    let offset = |d: &mut Draws, low: i32, count: u32| (low + (d.bits() % count) as i32) as u32;
    row.push(d.bits() & d.bits() & d.bits() & 0xffff);
    row.extend([offset(d, -8, 29), offset(d, -20, 28), offset(d, -10, 20)]);
}

pub const PROBES: &[Probe] = &[
    probe!(quads::region, |rows| {
        rows.cross(&[&floats(&[0.0, 2.5, 7.0, 90.0]), &floats(&[0.0, 2.5]), &floats(&[0.0, 2.5, 7.5])])
    }),
    probe!(quads::in_turn, |rows| {
        rows.random(|d, row| {
            row.extend([d.bits() % 64, d.bits() % 64, 1 << (d.bits() % 3), d.bits() % 2]);
        })
    }),
    probe!(quads::asked_px, |rows| {
        rows.random(|d, row| {
            row.extend([d.bits() % 4096, d.bits() % 4096, d.bits()]);
        })
    }),
    probe!(quads::need_of_new, |rows| {
        rows.random(|d, row| {
            row.extend([d.bits() % 16, d.bits() % 16, d.bits() % 4, d.bits() % 4]);
        })
    }),
    probe!(quads::need, |rows| {
        let lods = floats(&[0.0, 0.2, 2.0, 8.0]);
        rows.cross(&[&lods, &floats(&[1.0, 15.0, 16.0]), &floats(&[0.0, 60.0, 61.0])]).random(|d, row| {
            row.extend([range(d, 0.0, 4.0), range(d, 1.0, 31.0), range(d, 0.0, 90.0)]);
        })
    }),
    probe!(quads::acuity, |rows| { rows.random(|d, row| row.push(range(d, 0.0, 180.0))) }),
    probe!(quads::in_pattern, |rows| {
        rows.random(|d, row| {
            row.extend([d.bits() % 16, d.bits() % 16, 4, d.bits() % 4, d.bits() % 4]);
        })
    }),
    probe!(quads::share_in_block, |rows| {
        rows.random(|d, row| {
            row.extend([0; 4].map(|_| (d.bits() % 3) as f32).map(f32::to_bits));
            row.push(d.bits() % 4);
        })
    }),
    probe!(quads::window, |rows| { rows.random(|d, row| row.extend([d.bits(), d.bits() % 4096])) }),
    probe!(quads::offset_bits, |rows| {
        let all = |range: std::ops::RangeInclusive<i32>| range.map(|v| v as u32).collect::<Vec<_>>();
        rows.cross(&[&all(-8..=20), &all(-20..=7)])
    }),
    probe!(quads::first_of, |rows| { rows.random(in_window) }),
    probe!(quads::last_of, |rows| { rows.random(in_window) }),
    probe!(quads::octant_offsets, |rows| { rows.cross(&[&(0..=8).collect::<Vec<_>>()]) }),
    probe!(quads::neighbour, |rows| { rows.cross(&[&offsets(), &offsets()]) }),
    probe!(quads::neighbour_offset, |rows| { rows.cross(&[&(0..256).collect::<Vec<_>>()]) }),
    probe!(quads::quad_key, |rows| {
        rows.random(|d, row| {
            row.push(scaled(d, -30, 20));
            row.extend([0; 4].map(|_| d.bits()));
        })
    }),
];
