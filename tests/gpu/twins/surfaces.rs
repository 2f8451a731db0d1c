//! Functions of stored surfaces and of temporal antialiasing: surface, resample, taa.

use super::matching::{channels, like, push, stored_color};
use super::probe::{Out, Probe, Row, Rows};
use super::values::*;
use afterimage::kernel::resample;
use afterimage::kernel::resample::{Gathered, Resampled};
use afterimage::kernel::resize;
use afterimage::kernel::surface;
use afterimage::kernel::surface::{MAX_LOD, Surface};
use afterimage::kernel::taa;
use afterimage_testing::Draws;
use glam::Vec3;

fn stored(r: &Row<'_>, k: usize) -> Surface {
    Surface { color: r.v(k), lod: r.f(k + 3), disparity: r.f(k + 4) }
}

fn gathered(r: &Row<'_>) -> Gathered {
    Gathered { sharp: r.v(0), sharp_sum: r.f(3), smooth: r.v(4), smooth_sum: r.f(7), lod: r.f(8), missing: r.u(9) }
}

fn put_gathered(o: &mut Out, g: &Gathered) {
    o.v(g.sharp);
    o.f(g.sharp_sum);
    o.v(g.smooth);
    o.f(g.smooth_sum);
    o.f(g.lod);
    o.u(g.missing);
}

fn put_resampled(o: &mut Out, r: &Resampled) {
    o.v(r.sharp);
    o.v(r.smooth);
    o.f(r.lod);
}

/// Two words of arbitrary bits; with every code of a level of detail, also that of an empty texel.
fn packed_rows(name: &str) -> Rows {
    let edges = [words(), vec![0x3dff, 0x3e00, 0x3fff, 0xc000, 0xf7ff_fdff, 0xffff_0000]].concat();
    let empty = |d: &mut Draws, row: &mut Vec<u32>| row.extend([bits(d) | 0xf000_0000, bits(d) | 0xc000]);
    Rows::new(2)
        .cross(&[&edges, &edges])
        .random(name, |d, row| row.extend([bits(d), bits(d)]))
        .random(&format!("{name}, empty"), empty)
}

/// Fractions between texels: 0, every quarter, random.
fn fraction(d: &mut Draws) -> f32 {
    match d.bits() % 4 {
        0 => (d.bits() % 4) as f32 / 4.0,
        1 => (d.bits() % 65536) as f32 / 65536.0,
        _ => d.uniform(),
    }
}

fn fraction_rows(name: &str) -> Rows {
    let edges = [floats(&[0.0, 1.0 / 16_777_216.0]), around(&[0.25, 0.5, 0.75]), vec![1.0_f32.next_down().to_bits()]];
    Rows::new(1).cross(&[&edges.concat()]).random(name, |d, row| push(row, &[fraction(d)]))
}

/// Taps of one reading: color, level of detail, whether it shows the surface, its weights' texel. The fractions come
/// first.
const READING: usize = 2 + 12 * 5;

fn read_twelve(r: &Row<'_>, o: &mut Out) {
    let (sharp, smooth) =
        ([0, 1].map(|i| resample::catmull_rom(r.f(i))), [0, 1].map(|i| resample::linear_weights(r.f(i))));
    let mut g = Gathered::default();
    for tap in 0..12 {
        let (k, [x, y]) = (2 + 5 * tap, resample::tap_at(tap as u32).map(|i| i as usize));
        let s = Surface { color: r.v(k), lod: r.f(k + 3), disparity: 1.0 };
        g = resample::gather(g, s, r.u(k + 4) != 0, sharp[0][x] * sharp[1][y], smooth[0][x] * smooth[1][y]);
    }
    put_resampled(o, &resample::resolve(g, Surface { color: r.v(2), lod: r.f(5), disparity: 1.0 }));
}

/// Sums over nine neighbours, near each other or not, as the pass makes them.
fn push_box(d: &mut Draws, row: &mut Vec<u32>, center: [f32; 3]) {
    let (mut sum, mut squares) = (Vec3::ZERO, Vec3::ZERO);
    let flat = d.bits().is_multiple_of(4);
    for _ in 0..9 {
        let v = taa::to_ycocg(Vec3::from(if flat { center } else { like(d, center) }));
        sum += v;
        squares += v * v;
    }
    push(row, &sum.to_array());
    push(row, &squares.to_array());
}

pub const PROBES: &[Probe] = &[
    Probe {
        name: "old_position",
        module: "resize",
        words: [3, 1],
        wgsl: "out_f(old_position(in_u(0u), in_f(1u), in_u(2u)));",
        rust: |r, o| o.f(resize::old_position(r.u(0), r.f(1), r.u(2))),
        rows: || {
            let ratios = [around(&[0.5, 1.0, 4.0 / 3.0]), floats(&[1.0 / 16384.0, 16384.0])].concat();
            Rows::new(3)
                .cross(&[&[0, 1, 2, 719, 16383], &ratios, &[1, 2, 1080, 16384]])
                .random("old_position", |d, row| {
                    row.extend([d.bits() % 16384, range(d, 0.1, 8.0), 1 + d.bits() % 16384])
                })
        },
    },
    Probe {
        name: "resized_lod",
        module: "resize",
        words: [2, 1],
        wgsl: "out_f(resized_lod(in_f(0u), in_f(1u)));",
        rust: |r, o| o.f(resize::resized_lod(r.f(0), r.f(1))),
        rows: || {
            let lods = [around(&[0.5, 4.0, MAX_LOD]), floats(&[0.0])].concat();
            Rows::new(2)
                .cross(&[&lods, &floats(&[-14.0, -1.0, -0.1, 0.0, 0.1, 1.0, 14.0])])
                .random("resized_lod", |d, row| row.extend([range(d, 0.0, 9.0), range(d, -3.0, 3.0)]))
        },
    },
    Probe {
        name: "half14_bits",
        module: "surface",
        words: [1, 1],
        wgsl: "out_u(half14_bits(in_f(0u)));",
        rust: |r, o| o.u(surface::half14_bits(r.f(0))),
        rows: || {
            // Every value of a code, and the borders between.
            let codes = (0..=0x3dff_u32).map(surface::half14_value).flat_map(|x| [x, x.next_up(), -x]);
            let codes: Vec<u32> = codes.map(f32::to_bits).collect();
            Rows::new(1)
                .cross(&[&[finite(), codes].concat()])
                .random("half14_bits", |d, row| row.push(finite_bits(d)))
                .random("half14_bits, halves", |d, row| row.push(signed(d, -26, 17)))
        },
    },
    Probe {
        name: "half14_value",
        module: "surface",
        words: [1, 1],
        wgsl: "out_f(half14_value(in_u(0u)));",
        rust: |r, o| o.f(surface::half14_value(r.u(0))),
        // Not the codes that no color has: infinity and NaNs.
        rows: || Rows::new(1).cross(&[&(0..65536).filter(|w| w & 0x3e00 != 0x3e00).collect::<Vec<u32>>()]),
    },
    Probe {
        name: "pack_surface",
        module: "surface",
        words: [5, 2],
        wgsl: "let w = pack_surface(Surface(in_v(0u), in_f(3u), in_f(4u))); out_u(w.x); out_u(w.y);",
        rust: |r, o| surface::pack_surface(stored(r, 0)).into_iter().for_each(|w| o.u(w)),
        rows: || {
            let halves: Vec<f32> = (0..=125).map(|i| i as f32 / 14.0).collect();
            let lods = [around(&halves[1..]), floats(&[0.0, -0.0, -1.0, 100.0, 1e30])].concat();
            let disparities = [positive(), floats(&[-1.0, -0.0])].concat();
            Rows::new(5).mixed("pack_surface", &[&finite(), &channels(), &finite(), &lods, &disparities]).random(
                "pack_surface",
                |d, row| {
                    row.extend((0..3).map(|_| signed(d, -26, 17)));
                    row.extend([range(d, -0.5, 9.5), scaled(d, -20, 20)]);
                },
            )
        },
    },
    Probe {
        name: "unpack_surface",
        module: "surface",
        words: [2, 5],
        wgsl: "let s = unpack_surface(vec2<u32>(in_u(0u), in_u(1u))); out_v(s.color); out_f(s.lod); out_f(s.disparity);",
        rust: |r, o| {
            let s = surface::unpack_surface([r.u(0), r.u(1)]);
            o.v(s.color);
            o.f(s.lod);
            o.f(s.disparity);
        },
        rows: || packed_rows("unpack_surface"),
    },
    Probe {
        name: "mip_texel",
        module: "surface",
        words: [2, 4],
        wgsl: "let t = mip_texel(vec2<u32>(in_u(0u), in_u(1u))); out_v(t.xyz); out_f(t.w);",
        rust: |r, o| surface::mip_texel([r.u(0), r.u(1)]).to_array().into_iter().for_each(|x| o.f(x)),
        rows: || packed_rows("mip_texel"),
    },
    Probe {
        name: "round_mip",
        module: "surface",
        words: [4, 4],
        wgsl: "let t = round_mip(vec4<f32>(in_v(0u), in_f(3u))); out_v(t.xyz); out_f(t.w);",
        rust: |r, o| surface::round_mip(r.v(0).extend(r.f(3))).to_array().into_iter().for_each(|x| o.f(x)),
        rows: || {
            let x = finite();
            Rows::new(4)
                .mixed("round_mip", &[&x, &x, &x, &x])
                .random("round_mip", |d, row| row.extend((0..4).map(|_| signed(d, -26, 17))))
        },
    },
    Probe {
        name: "tap_at",
        module: "resample",
        words: [1, 2],
        wgsl: "let t = tap_at(in_u(0u)); out_u(t.x); out_u(t.y);",
        rust: |r, o| resample::tap_at(r.u(0)).into_iter().for_each(|x| o.u(x)),
        rows: || Rows::new(1).cross(&[&(0..resample::TAPS).collect::<Vec<_>>()]),
    },
    Probe {
        name: "second_corner",
        module: "resample",
        words: [2, 1],
        wgsl: "out_u(second_corner(vec2<f32>(in_f(0u), in_f(1u))));",
        rust: |r, o| o.u(resample::second_corner([r.f(0), r.f(1)])),
        rows: || {
            let f = floats(&[0.0, 0.1, 0.25, 0.499_999_97, 0.5, 0.75, 0.9, 1e-30]);
            Rows::new(2).cross(&[&f, &f]).random("second_corner", |d, row| push(row, &[d.uniform(), d.uniform()]))
        },
    },
    Probe {
        name: "corner_weight",
        module: "resample",
        words: [3, 1],
        wgsl: "out_f(corner_weight(in_u(2u), vec2<f32>(in_f(0u), in_f(1u))));",
        rust: |r, o| o.f(resample::corner_weight(r.u(2), [r.f(0), r.f(1)])),
        rows: || {
            let f = floats(&[0.0, 0.1, 0.25, 0.5, 0.9, 1e-30]);
            Rows::new(3).cross(&[&f, &f, &[0, 1, 2, 3]]).random("corner_weight", |d, row| {
                push(row, &[d.uniform(), d.uniform()]);
                row.push(d.bits() % 4);
            })
        },
    },
    Probe {
        name: "catmull_rom",
        module: "resample",
        words: [1, 4],
        wgsl: "let w = catmull_rom(in_f(0u)); out_v(w.xyz); out_f(w.w);",
        rust: |r, o| resample::catmull_rom(r.f(0)).into_iter().for_each(|x| o.f(x)),
        rows: || fraction_rows("catmull_rom"),
    },
    Probe {
        name: "linear_weights",
        module: "resample",
        words: [1, 4],
        wgsl: "let w = linear_weights(in_f(0u)); out_v(w.xyz); out_f(w.w);",
        rust: |r, o| resample::linear_weights(r.f(0)).into_iter().for_each(|x| o.f(x)),
        rows: || fraction_rows("linear_weights"),
    },
    Probe {
        name: "gather",
        module: "resample",
        words: [18, 10],
        wgsl: "let before = Gathered(in_v(0u), in_f(3u), in_v(4u), in_f(7u), in_f(8u), in_u(9u));
    let g = gather(before, Surface(in_v(10u), in_f(13u), in_f(14u)), in_u(15u) != 0u, in_f(16u), in_f(17u));
    out_v(g.sharp); out_f(g.sharp_sum); out_v(g.smooth_color); out_f(g.smooth_sum); out_f(g.lod); out_u(g.missing);",
        rust: |r, o| put_gathered(o, &resample::gather(gathered(r), stored(r, 10), r.u(15) != 0, r.f(16), r.f(17))),
        rows: || {
            Rows::new(18).random("gather", |d, row| {
                let (past, color) = (stored_color(d), stored_color(d));
                push(row, &[past.map(|x| x * d.range(-0.1, 1.1)), [d.uniform(); 3]].concat()[..4]);
                push(row, &[past.map(|x| x * d.uniform()), [d.uniform(); 3]].concat()[..4]);
                push(row, &[d.range(0.0, MAX_LOD)]);
                row.push(d.bits() % 12);
                push(row, &[color, [d.range(0.0, MAX_LOD), d.uniform(), 0.0]].concat()[..5]);
                row.push(u32::from(d.bits() % 4 != 0));
                push(row, &[d.range(-0.13, 1.0), if d.bits() & 1 == 0 { 0.0 } else { d.uniform() }]);
            })
        },
    },
    Probe {
        // Twelve taps, one after the other, as the pass takes them.
        name: "resolve",
        module: "resample",
        words: [READING, 7],
        wgsl: "var sharp_x = catmull_rom(in_f(0u)); var sharp_y = catmull_rom(in_f(1u));
    var smooth_x = linear_weights(in_f(0u)); var smooth_y = linear_weights(in_f(1u));
    var g = Gathered(vec3<f32>(0.0), 0.0, vec3<f32>(0.0), 0.0, 0.0, 0u);
    for (var tap = 0u; tap < TAPS; tap++) {
        let k = 2u + 5u * tap; let at = tap_at(tap);
        let s = Surface(in_v(k), in_f(k + 3u), 1.0);
        g = gather(g, s, in_u(k + 4u) != 0u, sharp_x[at.x] * sharp_y[at.y], smooth_x[at.x] * smooth_y[at.y]);
    }
    let r = resolve(g, Surface(in_v(2u), in_f(5u), 1.0)); out_v(r.sharp); out_v(r.smooth_color); out_f(r.lod);",
        rust: read_twelve,
        rows: || {
            let mut rows = Rows::new(READING).random("resolve", |d, row| {
                let (center, share) = (stored_color(d), d.bits() % 4);
                push(row, &[fraction(d), fraction(d)]);
                for _ in 0..12 {
                    push(row, &like(d, center).map(|x| x.max(0.0)));
                    push(row, &[(d.bits() % 63) as f32 / 7.0]);
                    row.push(u32::from(share == 0 || d.bits() % 4 < share));
                }
            });
            // A third is enough of rows that long.
            rows.words.truncate(READING * 33_000);
            rows
        },
    },
    Probe {
        name: "resolve",
        module: "resample",
        words: [15, 7],
        wgsl: "let g = Gathered(in_v(0u), in_f(3u), in_v(4u), in_f(7u), in_f(8u), in_u(9u));
    let r = resolve(g, Surface(in_v(10u), in_f(13u), in_f(14u))); out_v(r.sharp); out_v(r.smooth_color); out_f(r.lod);",
        rust: |r, o| put_resampled(o, &resample::resolve(gathered(r), stored(r, 10))),
        rows: || {
            let (c, h) = (channels(), floats(&[0.0, 6e-8, 0.18, 1.0, 65504.0]));
            let (sharp, smooth) = (floats(&[0.9, 1.0, 1.05]), [around(&[0.01, 1.0]), floats(&[0.0, 0.5])].concat());
            let (lod, missing) = (floats(&[0.0, 1.0, 8.9]), [0, 1, 11, 12]);
            let mut lists: Vec<&[u32]> = vec![&c, &c, &c, &sharp, &h, &h, &h, &smooth, &lod, &missing];
            lists.extend([&h[..], &h, &h, &lod, &h]);
            Rows::new(15).mixed("resolve", &lists)
        },
    },
    Probe {
        name: "to_ycocg",
        module: "taa",
        words: [3, 3],
        wgsl: "out_v(to_ycocg(in_v(0u)));",
        rust: |r, o| o.v(taa::to_ycocg(r.v(0))),
        rows: || {
            let c = channels();
            Rows::new(3)
                .cross(&[&c, &c, &c])
                .random("to_ycocg", |d, row| row.extend((0..3).map(|_| signed(d, -24, 16))))
        },
    },
    Probe {
        name: "roots_of_ycocg",
        module: "taa",
        words: [3, 3],
        wgsl: "out_v(roots_of_ycocg(in_v(0u)));",
        rust: |r, o| o.v(taa::roots_of_ycocg(r.v(0))),
        rows: || {
            let y = floats(&[0.0, 0.25, -0.25, 1.0, -128.0, 256.0]);
            Rows::new(3)
                .cross(&[&y, &y, &y])
                .random("roots_of_ycocg", |d, row| row.extend((0..3).map(|_| signed(d, -12, 8))))
        },
    },
    Probe {
        name: "clip_to_box",
        module: "taa",
        words: [9, 3],
        wgsl: "out_v(clip_to_box(in_v(0u), in_v(3u), in_v(6u)));",
        rust: |r, o| o.v(taa::clip_to_box(r.v(0), r.v(3), r.v(6))),
        rows: || {
            let (y, extent) = (floats(&[0.0, 0.5, -0.25, 1e-7, 256.0]), floats(&[0.0, 1e-6, 0.5, 512.0]));
            Rows::new(9).mixed("clip_to_box", &[&y, &y, &y, &y, &y, &y, &extent, &extent, &extent]).random(
                "clip_to_box",
                |d, row| {
                    let mean = [d.range(0.0, 1.5), d.range(-0.5, 0.5), d.range(-0.5, 0.5)];
                    let away = [0.0, 0.01, 0.3][d.bits() as usize % 3];
                    push(row, &mean.map(|x| x + away * d.range(-1.0, 1.0)));
                    push(row, &mean);
                    row.extend((0..3).map(|_| range(d, 0.0, 0.3)));
                },
            )
        },
    },
    Probe {
        name: "candidate_share",
        module: "taa",
        words: [3, 1],
        wgsl: "out_f(candidate_share(vec2<f32>(in_f(0u), in_f(1u)), in_f(2u)));",
        rust: |r, o| o.f(taa::candidate_share([r.f(0), r.f(1)], r.f(2))),
        rows: || {
            let at = [around(&[0.25, 0.5]), floats(&[0.0, 1.0 / 16_777_216.0, 1.0_f32.next_down()])].concat();
            let trust = [around(&[0.6, 0.9]), floats(&[1e-30, 0.25, 1.0])].concat();
            Rows::new(3)
                .cross(&[&at, &at, &trust])
                .random("candidate_share", |d, row| push(row, &[fraction(d), fraction(d), d.range(0.0, 1.0)]))
        },
    },
    Probe {
        name: "blend_clipped",
        module: "taa",
        words: [13, 3],
        wgsl: "out_v(blend_clipped(in_v(0u), in_v(3u), in_v(6u), in_v(9u), in_f(12u)));",
        rust: |r, o| o.v(taa::blend_clipped(r.v(0), r.v(3), r.v(6), r.v(9), r.f(12))),
        rows: || {
            Rows::new(13).random("blend_clipped", |d, row| {
                let candidate = stored_color(d);
                let history = like(d, candidate);
                push(row, &like(d, candidate));
                push(row, &history.map(|x| x.max(0.0)));
                push_box(d, row, candidate);
                push(row, &[[0.1, 0.4, 1.0, d.range(0.1, 1.0)][d.bits() as usize % 4]]);
            })
        },
    },
];
