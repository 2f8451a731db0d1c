//! Functions of stored surfaces: surface, resample.

use super::matching::{channels, like, push, stored_color};
use super::probe::{Probe, Rows, probe};
use super::shape::*;
use super::values::*;
use afterimage::kernel::resample;
use afterimage::kernel::resample::{FourTaps, Gathered, Resampled, Tap, TapsAround};
use afterimage::kernel::resize;
use afterimage::kernel::surface;
use afterimage::kernel::surface::{MAX_LOD, Surface};
use afterimage_testing::Draws;
use glam::Vec3;

shape!(Surface { color: Vec3, lod: f32, disparity: f32 });
shape!(Tap { color: Vec3, lod: f32, same: bool });
shape!(Gathered { sharp: Vec3, smooth as "smooth_color": Vec3, smooth_sum: f32, lod: f32, complete: bool });
shape!(Resampled { sharp: Vec3, smooth as "smooth_color": Vec3, lod: f32 });
shape!(TapsAround { texel: [i32; 2], last: [i32; 2], fraction: [f32; 2], sharp_x: [f32; 4], sharp_y: [f32; 4] });
shape!(FourTaps {
    texels: [[i32; 2]; 4],
    sharp_x: [f32; 4],
    sharp_rows: [f32; 2],
    linear_x: [f32; 2],
    linear_row: f32
});

fn push_tap(d: &mut Draws, row: &mut Vec<u32>, color: [f32; 3], same: bool) {
    push(row, &color);
    push(row, &[(d.bits() % 63) as f32 / 7.0]);
    row.push(same.into());
}

/// Two words of arbitrary bits; with every code of a level of detail, also that of an empty texel.
fn packed_rows(rows: Rows) -> Rows {
    let edges = [words(), vec![0x3dff, 0x3e00, 0x3fff, 0xc000, 0xf7ff_fdff, 0xffff_0000]].concat();
    let empty = |d: &mut Draws, row: &mut Vec<u32>| row.extend([bits(d) & 0x0fff_ffff, bits(d) & !0xc000]);
    rows.cross(&[&edges, &edges]).random(|d, row| row.extend([bits(d), bits(d)])).random_of("empty", empty)
}

/// Fractions between texels: 0, every quarter, random.
pub fn fraction(d: &mut Draws) -> f32 {
    match d.bits() % 4 {
        0 => (d.bits() % 4) as f32 / 4.0,
        1 => (d.bits() % 65536) as f32 / 65536.0,
        _ => d.uniform(),
    }
}

fn fraction_rows(rows: Rows) -> Rows {
    let edges = [floats(&[0.0, 1.0 / 16_777_216.0]), around(&[0.25, 0.5, 0.75]), vec![1.0_f32.next_down().to_bits()]];
    rows.cross(&[&edges.concat()]).random(|d, row| push(row, &[fraction(d)]))
}

/// Positions around small images, and their sizes.
fn around_rows(rows: Rows) -> Rows {
    rows.random(|d, row| {
        let size = [1 + d.bits() % 9, 1 + d.bits() % 9];
        row.extend(size.map(|s| (d.bits() % (s + 2)).wrapping_sub(1)));
        push(row, &[fraction(d), fraction(d)]);
        row.extend(size);
    })
}

pub const PROBES: &[Probe] = &[
    probe!(resize::old_position, |rows| {
        let ratios = [around(&[0.5, 1.0, 4.0 / 3.0]), floats(&[1.0 / 16384.0, 16384.0])].concat();
        rows.cross(&[&[0, 1, 2, 719, 16383], &ratios, &[1, 2, 1080, 16384]])
            .random(|d, row| row.extend([d.bits() % 16384, range(d, 0.1, 8.0), 1 + d.bits() % 16384]))
    }),
    probe!(resize::resized_lod, |rows| {
        let lods = [around(&[0.5, 4.0, MAX_LOD]), floats(&[0.0])].concat();
        rows.cross(&[&lods, &floats(&[-14.0, -1.0, -0.1, 0.0, 0.1, 1.0, 14.0])])
            .random(|d, row| row.extend([range(d, 0.0, 9.0), range(d, -3.0, 3.0)]))
    }),
    probe!(surface::float14_bits, |rows| {
        // Every value of a code, and the borders between.
        let codes = (0..=0x3fff_u32).map(surface::float14_value).flat_map(|x| [x, x.next_up(), -x]);
        let codes: Vec<u32> = codes.map(f32::to_bits).collect();
        rows.cross(&[&[finite(), codes].concat()])
            .random(|d, row| row.push(finite_bits(d)))
            .random_of("halves", |d, row| row.push(signed(d, -26, 17)))
    }),
    probe!(surface::float14_value, |rows| rows.cross(&[&(0..0x4000).collect::<Vec<u32>>()])),
    probe!(surface::pack_surface, |rows| {
        let halves: Vec<f32> = (0..=125).map(|i| i as f32 / 14.0).collect();
        let lods = [around(&halves[1..]), floats(&[0.0, -0.0, -1.0, 100.0, 1e30])].concat();
        let disparities = [positive(), floats(&[-1.0, -0.0])].concat();
        rows.mixed(&[&finite(), &channels(), &finite(), &lods, &disparities]).random(|d, row| {
            row.extend((0..3).map(|_| signed(d, -26, 17)));
            row.extend([range(d, -0.5, 9.5), scaled(d, -20, 20)]);
        })
    }),
    probe!(surface::unpack_surface, packed_rows),
    probe!(surface::lod_code, packed_rows),
    probe!(surface::lod_value, |rows| rows.cross(&[&(0..64).collect::<Vec<_>>()])),
    probe!(surface::surface_color, packed_rows),
    probe!(surface::mip_texel, packed_rows),
    probe!(surface::round_mip, |rows| {
        let x = finite();
        rows.mixed(&[&x, &x, &x, &x]).random(|d, row| row.extend((0..4).map(|_| signed(d, -26, 17))))
    }),
    probe!(resample::taps_around, around_rows),
    probe!(
        resample::sharp_sum,
        |_: [i32; 2], fraction: [f32; 2], _: [u32; 2]| resample::sharp_sum(&resample::taps_around(
            [0; 2], fraction, [1; 2]
        )),
        "sharp_sum(taps_around(vec2<i32>(0), $1, vec2<u32>(1u)))",
        around_rows
    ),
    probe!(
        resample::taps_of,
        |texel: [i32; 2], fraction: [f32; 2], round: u32| resample::taps_of(
            &resample::taps_around(texel, fraction, [9, 7]),
            round
        ),
        "let t = taps_of(taps_around($0, $1, vec2<u32>(9u, 7u)), $2);
    out_u(u32(t.a.x)); out_u(u32(t.a.y)); out_u(u32(t.b.x)); out_u(u32(t.b.y)); out_u(u32(t.c.x)); out_u(u32(t.c.y));
    out_u(u32(t.d.x)); out_u(u32(t.d.y)); out_v(t.sharp_x.xyz); out_f(t.sharp_x.w);
    out_f(t.sharp_rows.x); out_f(t.sharp_rows.y); out_f(t.linear_x.x); out_f(t.linear_x.y); out_f(t.linear_row);",
        |rows| {
            rows.random(|d, row| {
                row.extend([d.bits() % 9, d.bits() % 7]);
                push(row, &[fraction(d), fraction(d)]);
                row.push(d.bits() % resample::ROUNDS);
            })
        }
    ),
    probe!(resample::codes_between, |rows| {
        let disparities = [positive(), floats(&[-1.0, -0.0])].concat();
        let factors = [floats(&[0.5, 0.9, 0.95, 1.0]), floats(&[1.0, 1.05, 1.1, 2.0])];
        rows.cross(&[&disparities, &factors[0], &factors[1]]).random(|d, row| {
            row.extend([scaled(d, -34, 34), (1.0 - fraction(d)).to_bits(), (1.0 + fraction(d)).to_bits()])
        })
    }),
    probe!(resample::tap_codes, |rows| {
        let disparities = [positive(), floats(&[-1.0, -0.0])].concat();
        rows.cross(&[&disparities]).random(|d, row| row.push(scaled(d, -34, 34)))
    }),
    probe!(resample::tap_codes_between, |rows| {
        let disparities = [positive(), floats(&[-1.0, 0.0])].concat();
        let rows = rows.cross(&[&disparities, &disparities]);
        rows.random(|d, row| row.extend([scaled(d, -34, 34), scaled(d, -34, 34)]))
    }),
    probe!(resample::has_code, |rows| {
        let codes = [0, 1, 2, 7, 8, 9, 0xfffe, 0xffff];
        let words: Vec<u32> = codes.iter().flat_map(|c| [c << 16, c << 16 | 0xffff]).collect();
        rows.cross(&[&words, &codes, &codes])
    }),
    probe!(resample::surface_tap, |rows| {
        rows.random(|d, row| {
            let words = [bits(d) & [u32::MAX, 0x0fff_ffff][d.bits() as usize % 2], bits(d) & !0xc000];
            row.extend(words);
            row.extend([(words[1] >> 16).saturating_sub(d.bits() % 4), d.bits() % 4, d.bits() % 2]);
        })
    }),
    probe!(resample::second_corner, |rows| {
        let f = floats(&[0.0, 0.1, 0.25, 0.499_999_97, 0.5, 0.75, 0.9, 1e-30]);
        rows.cross(&[&f, &f]).random(|d, row| push(row, &[d.uniform(), d.uniform()]))
    }),
    probe!(resample::corner_weight, |rows| {
        let f = floats(&[0.0, 0.1, 0.25, 0.5, 0.9, 1e-30]);
        rows.cross(&[&[0, 1, 2, 3], &f, &f]).random(|d, row| {
            row.push(d.bits() % 4);
            push(row, &[d.uniform(), d.uniform()]);
        })
    }),
    probe!(resample::catmull_rom, fraction_rows),
    probe!(
        resample::gather,
        |g: Gathered, taps: [Tap; 4], sharp_x: [f32; 4], sharp_rows: [f32; 2], linear_x: [f32; 2], linear_row: f32| {
            resample::gather(g, taps, &FourTaps { texels: [[0; 2]; 4], sharp_x, sharp_rows, linear_x, linear_row })
        },
        "let at = vec2<i32>(0); gather($0, $1, FourTaps(at, at, at, at, $2, $3, $4, $5))",
        |rows| {
            rows.random(|d, row| {
                let (past, color) = (stored_color(d), stored_color(d));
                push(row, &past.map(|x| x * d.range(-0.1, 1.1)));
                push(row, &past.map(|x| x * d.uniform()));
                push(row, &[d.uniform(), d.range(0.0, MAX_LOD)]);
                row.push(d.bits() % 2);
                for _ in 0..4 {
                    let same = d.bits() % 8 != 0;
                    let near = like(d, color).map(|x| x.max(0.0));
                    push_tap(d, row, near, same);
                }
                push(row, &[0; 6].map(|_| d.range(-0.13, 1.0)));
                push(row, &[0; 3].map(|_| if d.bits() & 1 == 0 { 0.0 } else { d.uniform() }));
            })
        }
    ),
    // Twelve taps, as the pass takes them.
    probe!(
        resample::nothing_gathered,
        |fraction: [f32; 2], color: Vec3, lod: f32, read: [Tap; 12]| {
            let (taps, mut read) = (resample::taps_around([8, 8], fraction, [16, 16]), read.into_iter());
            let gathered = resample::gather_around(&taps, |_| read.next().unwrap());
            resample::resolve(gathered, resample::sharp_sum(&taps), Surface { color, lod, disparity: 1.0 })
        },
        "let taps = taps_around(vec2<i32>(8), vec2<f32>(in_f(0u), in_f(1u)), vec2<u32>(16u));
    var g = nothing_gathered();
    // A variable count, as in the passes: Mesa unrolls constant ones, and reorders their sums.
    let rounds = select(0u, ROUNDS, in_f(0u) >= 0.0);
    for (var round = 0u; round < rounds; round++) {
        let k = 6u + 20u * round; let four = taps_of(taps, round);
        let a = Tap(in_v(k), in_f(k + 3u), in_u(k + 4u) != 0u);
        let b = Tap(in_v(k + 5u), in_f(k + 8u), in_u(k + 9u) != 0u);
        let c = Tap(in_v(k + 10u), in_f(k + 13u), in_u(k + 14u) != 0u);
        let d = Tap(in_v(k + 15u), in_f(k + 18u), in_u(k + 19u) != 0u);
        g = gather(g, a, b, c, d, four);
    }
    let r = resolve(g, sharp_sum(taps), Surface(in_v(2u), in_f(5u), 1.0));
    out_v(r.sharp); out_v(r.smooth_color); out_f(r.lod);",
        |rows| {
            let mut rows = rows.random(|d, row| {
                let (center, share) = (stored_color(d), d.bits() % 4);
                push(row, &[fraction(d), fraction(d)]);
                push(row, &center);
                push(row, &[(d.bits() % 63) as f32 / 7.0]);
                for _ in 0..12 {
                    let same = share == 0 || d.bits() % 4 < share;
                    let near = like(d, center).map(|x| x.max(0.0));
                    push_tap(d, row, near, same);
                }
            });
            // A third is enough of rows that long.
            rows.words.truncate(rows.width * 33_000);
            rows
        }
    ),
    probe!(
        resample::resolve,
        |g: Gathered, weights: f32, color: Vec3, lod: f32| {
            resample::resolve(g, weights, Surface { color, lod, disparity: 1.0 })
        },
        "resolve($0, $1, Surface($2, $3, 1.0))",
        |rows| {
            let (c, h) = (channels(), floats(&[0.0, 6e-8, 0.18, 1.0, 65504.0]));
            let (sharp, smooth) = (floats(&[0.9, 1.0, 1.05]), [around(&[0.01, 1.0]), floats(&[0.0, 0.5])].concat());
            let (lod, complete) = (floats(&[0.0, 1.0, 8.9]), [0, 1]);
            let mut lists: Vec<&[u32]> = vec![&c, &c, &c, &h, &h, &h, &smooth, &lod, &complete, &sharp];
            lists.extend([&h[..], &h, &h, &lod]);
            rows.mixed(&lists)
        }
    ),
];
