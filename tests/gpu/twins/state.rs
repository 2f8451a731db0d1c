//! Functions of bits and reservoirs: sanitize, rng, pack, reproject, reservoir.

use super::*;
use afterimage::kernel::reproject::{Verdict, ViewMotion};
use afterimage::kernel::reservoir::Reservoir;
use afterimage::kernel::rng::Purpose;
use afterimage::kernel::stored_reservoir::Stored;
use afterimage::kernel::{pack, reproject, reservoir, rng, sanitize, stored_reservoir};

code!(Purpose: Select, Key, Path);
shape!(Stored { color: Vec3, disparity: f32, w_sum: f32, age: u32 });
shape!(ViewMotion { x: Vec4, y: Vec4, z: Vec4, per_tangent: Vec2, zoom: Vec2, shift_px: Vec2, ahead: f32, sky: f32 });
shape!(Reservoir { w_sum: f32, count: u32 });

pub fn draw(d: &mut Draws) -> u32 {
    d.uniform().to_bits()
}

pub const PROBES: &[Probe] = &[
    probe!(sanitize::color, sanitize::color, "let s = color($0); out_v(s.color); out_b(s.usable);", |rows| {
        let table = any().into_iter().filter(|x| x & 0x7fff_ffff >= 0x0080_0000 || x & 0x7fff_ffff == 0);
        let table: Vec<u32> = table.collect();
        rows.mixed(&[&table, &table, &table]).each(&[Signed(-126, 129); 3])
    }),
    probe!(rng::stream_key, |rows| {
        let w = words();
        rows.mixed(&[&w, &w, &w, &[0, 1], &w, &w])
    }),
    probe!(rng::bits, |rows| {
        // H28: a million of (x, y, frame), four keys and frames across the wrap of the low word (H26).
        let mut rows = rows;
        for i in 0..1_000_000_u32 {
            let frame = (i / 10_000).wrapping_sub(50);
            rows.words.extend([i % 100, i / 100 % 100, frame, [0, 1, 0x9e37_79b9, !0][i as usize % 4]]);
        }
        rows
    }),
    probe!(rng::unit_draw, |rows| {
        let top: Vec<u32> = (0..600).map(|k| !k).collect();
        rows.cross(&[&top]).cross(&[&words()]).each(&[Bits])
    }),
    probe!(pack::half_bits, |rows| rows
        .cross(&[&any()])
        .each(&[Bits])
        .random_of("range", |d, row| row.push(signed(d, -26, 17)))
        // Ties.
        .random_of("ties", |d, row| row.push(signed(d, -26, 17) & !0xfff))),
    probe!(pack::half_value, |rows| rows.cross(&[&(0..65536).map(|x| x | 0xabcd_0000).collect::<Vec<_>>()])),
    probe!(pack::disparity_code, |rows| {
        let ends = around(&[2.0_f32.powi(-32), 2.0_f32.powi(32), -1.0]);
        rows.cross(&[&[finite(), ends, vec![0x7f80_0000, 0xff80_0000]].concat()])
            .random(|d, row| row.push(finite_bits(d)))
            .random_of("range", |d, row| row.push(scaled(d, -34, 34)))
    }),
    probe!(pack::disparity_value, |rows| rows.cross(&[&(0..65536).collect::<Vec<_>>()])),
    probe!(stored_reservoir::pack, |rows| {
        let sums = [finite(), vec![0x7f80_0000, 0xff80_0000], around(&[stored_reservoir::MAX_W_SUM])].concat();
        let disparities = [positive(), floats(&[-1.0])].concat();
        rows.mixed(&[&finite(), &finite(), &finite(), &disparities, &sums, &words()])
            .each(&[&[Signed(-26, 17); 3][..], &[Scaled(-34, 34), Scaled(-126, 102), N(300)]].concat())
    }),
    probe!(stored_reservoir::unpack, |rows| {
        rows.mixed(&[&any(), &any(), &any()]).each(&[Bits; 3]).random_of("sound", |d, row| {
            row.extend(stored_reservoir::pack(Stored {
                color: Vec3::from_array([0; 3].map(|_| f32::from_bits(signed(d, -20, 15)))),
                disparity: f32::from_bits(scaled(d, -34, 34)),
                w_sum: f32::from_bits(scaled(d, -126, 100)),
                age: d.bits() % 256,
            }));
        })
    }),
    probe!(
        reproject::nearest,
        |x: u32, y: u32, motion: [f32; 2], size: [u32; 2]| match reproject::nearest(x, y, motion, size) {
            Ok(at) => (Verdict::Valid, at),
            Err(verdict) => (verdict, [0, 0]),
        },
        "let p = nearest($0, $1, $2, $3); out_u(p.verdict); out_u(p.at.x); out_u(p.at.y);",
        |rows| {
            let x = [0, 1, 2, 15, 16, 17, 4095, 65535];
            let size = [1, 2, 16, 17, 4096, 65536];
            let motion = [any(), around(&[0.5, -0.5, -1.0, -1.5, 15.5, 65536.0, -65536.0])].concat();
            rows.mixed(&[&x, &x, &motion, &motion, &size, &size])
                .random(|d, row| {
                    let size = [1 + d.bits() % 300, 1 + d.bits() % 300];
                    row.extend([d.bits() % size[0], d.bits() % size[1], range(d, -40.0, 40.0), range(d, -40.0, 40.0)]);
                    row.extend(size);
                })
                .random_of("halves", |d, row| {
                    let mut half = || around(&[(d.bits() % 64) as f32 / 2.0 - 16.0])[d.bits() as usize % 3];
                    let motion = [half(), half()];
                    row.extend([d.bits() % 16, d.bits() % 16, motion[0], motion[1], 16, 16]);
                })
        }
    ),
    probe!(reproject::camera_vector, |rows| {
        let camera = |d: &mut Draws, row: &mut Vec<u32>, turn: f32| {
            row.extend([range(d, -1.5, 1.5), range(d, -1.5, 1.5)]);
            let disparities = [0.0, 0.01, -1.0, d.uniform(), 10.0 * d.uniform()];
            row.push(disparities[d.bits() as usize % 5].to_bits());
            for i in 0..12 {
                row.push(if i % 4 == 3 { range(d, -0.5, 0.5) } else { range(d, -turn, turn) });
            }
            row.extend([range(d, 100.0, 2000.0), range(d, 100.0, 2000.0)]);
            let zoomed = d.bits() & 1 == 1;
            row.extend((0..4).map(|_| if zoomed { range(d, -20.0, 20.0) } else { 0 }));
            row.extend([range(d, 1.0 - turn, 1.0 + turn), [0, 0.01_f32.to_bits()][d.bits() as usize % 2]]);
        };
        rows.random(|d, row| camera(d, row, 0.01)).random_of("large turns", |d, row| camera(d, row, 1.5))
    }),
    probe!(reproject::world_motion_px, |rows| rows.each(&[F(-9.0, 9.0); 4]).each(&[Scaled(-20, 20); 4])),
    probe!(reproject::has_no_vector, |rows| {
        let none = floats(&[0.0, -1.0, 0.5, f32::MAX]);
        let given = [any(), none.clone()].concat();
        rows.mixed(&[&given, &given, &none, &none]).random(|d, row| {
            let none = [range(d, -9.0, 9.0), range(d, -9.0, 9.0)];
            row.extend([if d.bits() & 1 == 0 { none[0] } else { 0 }, none[1], none[0], none[1]]);
        })
    }),
    probe!(
        reservoir::update,
        |mut r: Reservoir, w: f32, draw: f32| (reservoir::update(&mut r, w, draw), r),
        "var r = $0; let take = update(&r, $1, $2); out_b(take); out_f(r.w_sum); out_u(r.count);",
        |rows| {
            let rows = rows.cross(&[&normal(), &[0, 1, !1, !0], &any(), &draws()]);
            rows.each(&[Scaled(-10, 10), Bits, Scaled(-10, 10), F(0.0, 1.0)])
        }
    ),
    probe!(
        reservoir::combine,
        |first: Reservoir, second: Reservoir, draw: f32| {
            let (merged, keep_second) = reservoir::combine(first, second, draw);
            (keep_second, merged)
        },
        "let c = combine($0, $1, $2); out_b(c.keep_second); out_f(c.reservoir.w_sum); out_u(c.reservoir.count);",
        |rows| {
            rows.cross(&[&any(), &[0, 7, !0], &any(), &[1, !0], &draws()])
                .each(&[Scaled(-10, 10), Bits, Scaled(-10, 10), Bits, F(0.0, 1.0)])
                .random_of("near the threshold", |d, row| {
                    let [a, b] = [0; 2].map(|_| 2.0_f32.powi((d.bits() % 6) as i32));
                    row.extend([a.to_bits(), 1, b.to_bits(), 1, (b / (a + b)).to_bits()]);
                })
        }
    ),
    probe!(reservoir::bernoulli_survival, |rows| {
        rows.cross(&[&normal(), &normal()])
            .random_of("bernoulli", |d, row| row.extend([scaled(d, -20, 20), scaled(d, -20, 20)]))
            // Sums are at most 2^100, so that none overflows; quotients below the normal range are another matter.
            .within(|r| r.f(0) <= stored_reservoir::MAX_W_SUM && r.f(1) <= stored_reservoir::MAX_W_SUM)
    }),
    probe!(reservoir::exponential_survival, |rows| rows
        .cross(&[&finite()])
        .random_of("exponential", |d, row| row.push(range(d, 0.0, 100.0)))),
    probe!(rng::path_draws, |rows| {
        let w = words();
        rows.mixed(&[&w, &w, &w, &w]).each(&[Bits; 4])
    }),
];
