//! Frames shaded by quads: quads.

use super::*;
use afterimage::kernel::quads;

/// A window with few quads, two offsets in any order, and a row.
fn in_window(d: &mut Draws, row: &mut Vec<u32>) {
    let offset = |d: &mut Draws, low: i32, count: u32| (low + (d.bits() % count) as i32) as u32;
    row.push(d.bits() & d.bits() & d.bits() & 0xffff);
    row.extend([offset(d, -8, 29), offset(d, -20, 28), offset(d, -10, 20)]);
}

/// An offset in pixels other than 0.
fn offset(d: &mut Draws, row: &mut Vec<u32>) {
    let [x, y] = [0; 2].map(|_| (d.bits() % 35) as i32 - 17);
    row.extend([if (x, y) == (0, 0) { 1 } else { x } as u32, y as u32]);
}

shape!(quads::EvenPattern { steps: [u32; 2], middle: [u32; 2], periphery: [u32; 2], turn: u32 });
shape!(quads::PastAround { nearest_px2: f32, color: Vec3, lod: f32, samples: f32, lowest: Vec3, highest: Vec3 });

const STORED: Word = Of(|d, row| {
    row.push(range(d, 0.0, 2.0));
    row.extend([0; 3].map(|_| range(d, 0.0, 4.0)));
    row.extend([range(d, -1.0, 4.0), range(d, 1.0, 29.0)]);
    row.extend([0; 6].map(|_| range(d, 0.0, 4.0)));
});

/// With two stored samples: color of each, and its level of detail, number of samples and squared distance.
fn two_past(first: Vec3, of_first: Vec3, second: Vec3, of_second: Vec3) -> quads::PastAround {
    let one = quads::with_past(quads::no_past(), first, of_first.x, of_first.y, of_first.z);
    quads::with_past(one, second, of_second.x, of_second.y, of_second.z)
}

const TWO_PAST: &str = "let one = with_past(no_past(), $0, in_f(3u), in_f(4u), in_f(5u)); \
     let s = with_past(one, $2, in_f(9u), in_f(10u), in_f(11u)); out_f(s.nearest_px2); out_v(s.color); \
     out_f(s.lod); out_f(s.samples); out_v(s.lowest); out_v(s.highest);";

pub const PROBES: &[Probe] = &[
    probe!(quads::region, |rows| {
        rows.cross(&[&floats(&[0.0, 2.5, 7.0, 90.0]), &floats(&[0.0, 2.5]), &floats(&[0.0, 2.5, 7.5])])
    }),
    probe!(quads::in_turn, |rows| { rows.each(&[N(64), N(64), Of(|d, row| row.push(1 << (d.bits() % 3))), N(2)]) }),
    probe!(quads::is_even, |rows| {
        let step = |d: &mut Draws, row: &mut Vec<u32>| row.extend([0; 2].map(|_| 1 << (d.bits() % 3)));
        rows.each(&[Of(step), N(2), N(2), N(2), N(2), N(2), N(64), N(64), N(3)])
    }),
    probe!(quads::with_past, two_past, TWO_PAST, |rows| {
        let sample = [F(0.0, 4.0), F(0.0, 4.0), F(0.0, 4.0), F(-1.0, 4.0), F(1.0, 29.0), F(0.0, 2.0)];
        rows.each(&[sample, sample].concat())
    }),
    probe!(quads::need_around, |rows| rows.each(&[STORED])),
    probe!(quads::probed_px, |rows| rows.each(&[N(4096), N(4096), Bits])),
    probe!(quads::no_history_need, |rows| rows.each(&[N(16), N(16), N(4), N(4)])),
    probe!(quads::need, |rows| {
        let lods = floats(&[0.0, 0.2, 2.0, 8.0]);
        let rows = rows.cross(&[&lods, &floats(&[1.0, 15.0, 16.0]), &floats(&[0.0, 60.0, 61.0])]);
        rows.each(&[F(0.0, 4.0), F(1.0, 31.0), F(0.0, 90.0)])
    }),
    probe!(quads::acuity, |rows| rows.each(&[F(0.0, 180.0)])),
    probe!(quads::share_in_block, |rows| {
        rows.random(|d, row| {
            row.extend([0; 4].map(|_| (d.bits() % 3) as f32).map(f32::to_bits));
            row.push(d.bits() % 4);
        })
    }),
    probe!(quads::window, |rows| rows.each(&[Bits, N(4096)])),
    probe!(quads::first_of, |rows| rows.random(in_window)),
    probe!(quads::last_of, |rows| rows.random(in_window)),
    probe!(quads::octant_offsets, |rows| rows.cross(&[&(0..=8).collect::<Vec<_>>()])),
    probe!(quads::neighbour_offset, |rows| rows.cross(&[&(0..256).collect::<Vec<_>>()])),
    probe!(quads::place_in_quad, |rows| rows.each(&[N(9), N(9)])),
    probe!(quads::nearest_px, |rows| rows.each(&[Of(|d, row| row.push(1 + d.bits() % 15)), N(9), N(9), N(32), N(32)])),
    probe!(quads::quadrant_of, |rows| rows.random(offset)),
    probe!(quads::sample_code, |rows| rows.random(offset)),
    probe!(quads::sample_offset, |rows| rows.random(|d, row| row.push(d.bits() % (1 << 22)))),
    probe!(quads::known_samples, |rows| rows.each(&[F(0.0, 90.0)])),
    probe!(quads::path_key, |rows| {
        rows.random(|d, row| row.extend([d.bits() % quads::KEYS, 1 + d.bits() % 31, 1 + d.bits() % quads::MOST_PATHS]))
    }),
    probe!(quads::paths, |rows| {
        rows.random(|d, row| {
            let key = |d: &mut Draws| d.bits() % quads::KEYS;
            row.extend([key(d), key(d), 1 + d.bits() % 31, d.bits() & 1, 1 + key(d)]);
        })
    }),
    probe!(quads::quad_key, |rows| rows.each(&[Scaled(-30, 20), Bits, Bits, Bits, Bits])),
];
