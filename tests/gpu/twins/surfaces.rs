//! Functions of stored surfaces: surface, resample.

use super::matching::{channels, like, push, stored_color};
use super::probe::{Out, Probe, Row, Rows};
use super::values::*;
use afterimage::kernel::resample;
use afterimage::kernel::resample::{FourTaps, Gathered, Resampled, Tap};
use afterimage::kernel::resize;
use afterimage::kernel::surface;
use afterimage::kernel::surface::{MAX_LOD, Surface};
use afterimage_testing::Draws;

fn stored(r: &Row<'_>, k: usize) -> Surface {
    Surface { color: r.v(k), lod: r.f(k + 3), disparity: r.f(k + 4) }
}

fn gathered(r: &Row<'_>) -> Gathered {
    Gathered { sharp: r.v(0), smooth: r.v(3), smooth_sum: r.f(6), lod: r.f(7), complete: r.u(8) != 0 }
}

fn put_gathered(o: &mut Out, g: &Gathered) {
    o.v(g.sharp);
    o.v(g.smooth);
    o.f(g.smooth_sum);
    o.f(g.lod);
    o.b(g.complete);
}

/// A tap in five words.
fn tap(r: &Row<'_>, k: usize) -> Tap {
    Tap { color: r.v(k), lod: r.f(k + 3), same: r.u(k + 4) != 0 }
}

fn push_tap(d: &mut Draws, row: &mut Vec<u32>, color: [f32; 3], same: bool) {
    push(row, &color);
    push(row, &[(d.bits() % 63) as f32 / 7.0]);
    row.push(same.into());
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
pub fn fraction(d: &mut Draws) -> f32 {
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

/// Positions around small images, and their sizes.
fn around_rows(name: &str) -> Rows {
    Rows::new(6).random(name, |d, row| {
        let size = [1 + d.bits() % 9, 1 + d.bits() % 9];
        row.extend(size.map(|s| (d.bits() % (s + 2)).wrapping_sub(1)));
        push(row, &[fraction(d), fraction(d)]);
        row.extend(size);
    })
}

/// Words of one reading: the position, the size of the image, the nearest texel, and twelve taps.
const READING: usize = 2 + 4 + 12 * 5;

fn read_twelve(r: &Row<'_>, o: &mut Out) {
    let taps = resample::taps_around([8, 8], [r.f(0), r.f(1)], [16, 16]);
    let mut k = 1;
    let gathered = resample::gather_around(&taps, |_| {
        k += 5;
        tap(r, k)
    });
    put_resampled(o, &resample::resolve(gathered, resample::sharp_sum(&taps), nearest(r, 2)));
}

fn nearest(r: &Row<'_>, k: usize) -> Surface {
    Surface { color: r.v(k), lod: r.f(k + 3), disparity: 1.0 }
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
        name: "float14_bits",
        module: "surface",
        words: [1, 1],
        wgsl: "out_u(float14_bits(in_f(0u)));",
        rust: |r, o| o.u(surface::float14_bits(r.f(0))),
        rows: || {
            // Every value of a code, and the borders between.
            let codes = (0..=0x3fff_u32).map(surface::float14_value).flat_map(|x| [x, x.next_up(), -x]);
            let codes: Vec<u32> = codes.map(f32::to_bits).collect();
            Rows::new(1)
                .cross(&[&[finite(), codes].concat()])
                .random("float14_bits", |d, row| row.push(finite_bits(d)))
                .random("float14_bits, halves", |d, row| row.push(signed(d, -26, 17)))
        },
    },
    Probe {
        name: "float14_value",
        module: "surface",
        words: [1, 1],
        wgsl: "out_f(float14_value(in_u(0u)));",
        rust: |r, o| o.f(surface::float14_value(r.u(0))),
        rows: || Rows::new(1).cross(&[&(0..0x4000).collect::<Vec<u32>>()]),
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
        name: "lod_code",
        module: "surface",
        words: [2, 1],
        wgsl: "out_u(lod_code(vec2<u32>(in_u(0u), in_u(1u))));",
        rust: |r, o| o.u(surface::lod_code([r.u(0), r.u(1)])),
        rows: || packed_rows("lod_code"),
    },
    Probe {
        name: "surface_color",
        module: "surface",
        words: [2, 3],
        wgsl: "out_v(surface_color(vec2<u32>(in_u(0u), in_u(1u))));",
        rust: |r, o| o.v(surface::surface_color([r.u(0), r.u(1)])),
        rows: || packed_rows("surface_color"),
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
        name: "taps_around",
        module: "resample",
        words: [6, 14],
        wgsl: "let at = vec2<i32>(bitcast<i32>(in_u(0u)), bitcast<i32>(in_u(1u)));
    let t = taps_around(at, vec2<f32>(in_f(2u), in_f(3u)), vec2<u32>(in_u(4u), in_u(5u)));
    out_u(bitcast<u32>(t.texel.x)); out_u(bitcast<u32>(t.texel.y)); out_u(u32(t.last.x)); out_u(u32(t.last.y));
    out_f(t.fraction.x); out_f(t.fraction.y);
    out_v(t.sharp_x.xyz); out_f(t.sharp_x.w); out_v(t.sharp_y.xyz); out_f(t.sharp_y.w);",
        rust: |r, o| {
            let t = resample::taps_around([r.u(0) as i32, r.u(1) as i32], [r.f(2), r.f(3)], [r.u(4), r.u(5)]);
            t.texel.iter().chain(&t.last).for_each(|&i| o.u(i as u32));
            t.fraction.iter().chain(&t.sharp_x).chain(&t.sharp_y).for_each(|&x| o.f(x));
        },
        rows: || around_rows("taps_around"),
    },
    Probe {
        name: "sharp_sum",
        module: "resample",
        words: [6, 1],
        wgsl: "out_f(sharp_sum(taps_around(vec2<i32>(0), vec2<f32>(in_f(2u), in_f(3u)), vec2<u32>(1u))));",
        rust: |r, o| o.f(resample::sharp_sum(&resample::taps_around([0; 2], [r.f(2), r.f(3)], [1; 2]))),
        rows: || around_rows("sharp_sum"),
    },
    Probe {
        name: "taps_of",
        module: "resample",
        words: [5, 17],
        wgsl: "let at = vec2<i32>(bitcast<i32>(in_u(0u)), bitcast<i32>(in_u(1u)));
    let t = taps_of(taps_around(at, vec2<f32>(in_f(2u), in_f(3u)), vec2<u32>(9u, 7u)), in_u(4u));
    out_u(u32(t.a.x)); out_u(u32(t.a.y)); out_u(u32(t.b.x)); out_u(u32(t.b.y)); out_u(u32(t.c.x)); out_u(u32(t.c.y));
    out_u(u32(t.d.x)); out_u(u32(t.d.y)); out_v(t.sharp_x.xyz); out_f(t.sharp_x.w);
    out_f(t.sharp_rows.x); out_f(t.sharp_rows.y); out_f(t.linear_x.x); out_f(t.linear_x.y); out_f(t.linear_row);",
        rust: |r, o| {
            let around = resample::taps_around([r.u(0) as i32, r.u(1) as i32], [r.f(2), r.f(3)], [9, 7]);
            let t = resample::taps_of(&around, r.u(4));
            t.texels.iter().flatten().for_each(|&i| o.u(i as u32));
            t.sharp_x.iter().chain(&t.sharp_rows).chain(&t.linear_x).chain([&t.linear_row]).for_each(|&w| o.f(w));
        },
        rows: || {
            Rows::new(5).random("taps_of", |d, row| {
                row.extend([d.bits() % 9, d.bits() % 7]);
                push(row, &[fraction(d), fraction(d)]);
                row.push(d.bits() % resample::ROUNDS);
            })
        },
    },
    Probe {
        name: "codes_between",
        module: "resample",
        words: [3, 2],
        wgsl: "let c = codes_between(in_f(0u), in_f(1u), in_f(2u)); out_u(c.x); out_u(c.y);",
        rust: |r, o| resample::codes_between(r.f(0), r.f(1), r.f(2)).into_iter().for_each(|x| o.u(x)),
        rows: || {
            let disparities = [positive(), floats(&[-1.0, -0.0])].concat();
            let factors = [floats(&[0.5, 0.9, 0.95, 1.0]), floats(&[1.0, 1.05, 1.1, 2.0])];
            Rows::new(3).cross(&[&disparities, &factors[0], &factors[1]]).random("codes_between", |d, row| {
                row.extend([scaled(d, -34, 34), (1.0 - fraction(d)).to_bits(), (1.0 + fraction(d)).to_bits()])
            })
        },
    },
    Probe {
        name: "tap_codes",
        module: "resample",
        words: [1, 2],
        wgsl: "let c = tap_codes(in_f(0u)); out_u(c.x); out_u(c.y);",
        rust: |r, o| resample::tap_codes(r.f(0)).into_iter().for_each(|x| o.u(x)),
        rows: || {
            let disparities = [positive(), floats(&[-1.0, -0.0])].concat();
            Rows::new(1).cross(&[&disparities]).random("tap_codes", |d, row| row.push(scaled(d, -34, 34)))
        },
    },
    Probe {
        name: "tap_codes_between",
        module: "resample",
        words: [2, 2],
        wgsl: "let c = tap_codes_between(in_f(0u), in_f(1u)); out_u(c.x); out_u(c.y);",
        rust: |r, o| resample::tap_codes_between(r.f(0), r.f(1)).into_iter().for_each(|x| o.u(x)),
        rows: || {
            let disparities = [positive(), floats(&[-1.0, 0.0])].concat();
            let rows = Rows::new(2).cross(&[&disparities, &disparities]);
            rows.random("tap_codes_between", |d, row| row.extend([scaled(d, -34, 34), scaled(d, -34, 34)]))
        },
    },
    Probe {
        name: "has_code",
        module: "resample",
        words: [3, 1],
        wgsl: "out_b(has_code(in_u(0u), vec2<u32>(in_u(1u), in_u(2u))));",
        rust: |r, o| o.b(resample::has_code(r.u(0), [r.u(1), r.u(2)])),
        rows: || {
            let codes = [0, 1, 2, 7, 8, 9, 0xfffe, 0xffff];
            let words: Vec<u32> = codes.iter().flat_map(|c| [c << 16, c << 16 | 0xffff]).collect();
            Rows::new(3).cross(&[&words, &codes, &codes])
        },
    },
    Probe {
        name: "surface_tap",
        module: "resample",
        words: [5, 5],
        wgsl: "let t = surface_tap(vec2<u32>(in_u(0u), in_u(1u)), vec2<u32>(in_u(2u), in_u(3u)), in_u(4u) != 0u);
    out_v(t.color); out_f(t.lod); out_b(t.same);",
        rust: |r, o| {
            let t = resample::surface_tap([r.u(0), r.u(1)], [r.u(2), r.u(3)], r.u(4) != 0);
            o.v(t.color);
            o.f(t.lod);
            o.b(t.same);
        },
        rows: || {
            Rows::new(5).random("surface_tap", |d, row| {
                let words = [bits(d) | [0, 0xf000_0000][d.bits() as usize % 2], bits(d) | 0xc000];
                row.extend(words);
                row.extend([(words[1] >> 16).saturating_sub(d.bits() % 4), d.bits() % 4, d.bits() % 2]);
            })
        },
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
        name: "gather",
        module: "resample",
        words: [9 + 4 * 5 + 9, 9],
        wgsl: "let before = Gathered(in_v(0u), in_v(3u), in_f(6u), in_f(7u), in_u(8u) != 0u);
    let a = Tap(in_v(9u), in_f(12u), in_u(13u) != 0u); let b = Tap(in_v(14u), in_f(17u), in_u(18u) != 0u);
    let c = Tap(in_v(19u), in_f(22u), in_u(23u) != 0u); let d = Tap(in_v(24u), in_f(27u), in_u(28u) != 0u);
    let at = vec2<i32>(0);
    let four = FourTaps(at, at, at, at, vec4<f32>(in_v(29u), in_f(32u)), vec2<f32>(in_f(33u), in_f(34u)),
        vec2<f32>(in_f(35u), in_f(36u)), in_f(37u));
    let g = gather(before, a, b, c, d, four);
    out_v(g.sharp); out_v(g.smooth_color); out_f(g.smooth_sum); out_f(g.lod); out_b(g.complete);",
        rust: |r, o| {
            let taps = [9, 14, 19, 24].map(|k| tap(r, k));
            let four = FourTaps {
                texels: [[0; 2]; 4],
                sharp_x: [29, 30, 31, 32].map(|k| r.f(k)),
                sharp_rows: [r.f(33), r.f(34)],
                linear_x: [r.f(35), r.f(36)],
                linear_row: r.f(37),
            };
            put_gathered(o, &resample::gather(gathered(r), taps, &four));
        },
        rows: || {
            Rows::new(38).random("gather", |d, row| {
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
        },
    },
    Probe {
        // Twelve taps, as the pass takes them.
        name: "nothing_gathered",
        module: "resample",
        words: [READING, 7],
        wgsl: "let taps = taps_around(vec2<i32>(8), vec2<f32>(in_f(0u), in_f(1u)), vec2<u32>(16u));
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
        rust: read_twelve,
        rows: || {
            let mut rows = Rows::new(READING).random("nothing_gathered", |d, row| {
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
            rows.words.truncate(READING * 33_000);
            rows
        },
    },
    Probe {
        name: "resolve",
        module: "resample",
        words: [14, 7],
        wgsl: "let g = Gathered(in_v(0u), in_v(3u), in_f(6u), in_f(7u), in_u(8u) != 0u);
    let r = resolve(g, in_f(9u), Surface(in_v(10u), in_f(13u), 1.0));
    out_v(r.sharp); out_v(r.smooth_color); out_f(r.lod);",
        rust: |r, o| put_resampled(o, &resample::resolve(gathered(r), r.f(9), nearest(r, 10))),
        rows: || {
            let (c, h) = (channels(), floats(&[0.0, 6e-8, 0.18, 1.0, 65504.0]));
            let (sharp, smooth) = (floats(&[0.9, 1.0, 1.05]), [around(&[0.01, 1.0]), floats(&[0.0, 0.5])].concat());
            let (lod, complete) = (floats(&[0.0, 1.0, 8.9]), [0, 1]);
            let mut lists: Vec<&[u32]> = vec![&c, &c, &c, &h, &h, &h, &smooth, &lod, &complete, &sharp];
            lists.extend([&h[..], &h, &h, &lod]);
            Rows::new(14).mixed("resolve", &lists)
        },
    },
];
