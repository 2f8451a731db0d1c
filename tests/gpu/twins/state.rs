//! Functions of bits and reservoirs: sanitize, rng, pack, reproject, reservoir.

use super::probe::{Out, Probe, Row, Rows};
use super::values::*;
use afterimage::kernel::pack::Stored;
use afterimage::kernel::reservoir::Reservoir;
use afterimage::kernel::rng::Purpose;
use afterimage::kernel::{pack, reproject, reservoir, rng, sanitize};
use afterimage_testing::Draws;

fn stored(r: &Row<'_>) -> Stored {
    Stored { color: r.v(0), disparity: r.f(3), w_sum: r.f(4), age: r.u(5) }
}

fn put_stored(o: &mut Out, s: &Stored) {
    o.v(s.color);
    o.f(s.disparity);
    o.f(s.w_sum);
    o.u(s.age);
}

pub fn draw(d: &mut Draws) -> u32 {
    d.uniform().to_bits()
}

pub const PROBES: &[Probe] = &[
    Probe {
        name: "is_finite",
        module: "sanitize",
        words: [1, 1],
        wgsl: "out_b(is_finite(in_f(0u)));",
        rust: |r, o| o.b(sanitize::is_finite(r.f(0))),
        rows: || Rows::new(1).cross(&[&any()]).random("is_finite", |d, row| row.push(bits(d))),
    },
    Probe {
        name: "color",
        module: "sanitize",
        words: [3, 4],
        wgsl: "let s = color(in_v(0u)); out_v(s.color); out_b(s.usable);",
        rust: |r, o| {
            let (color, usable) = sanitize::color(r.v(0));
            o.v(color);
            o.b(usable);
        },
        rows: || {
            let table = any().into_iter().filter(|x| x & 0x7fff_ffff >= 0x0080_0000 || x & 0x7fff_ffff == 0);
            let table: Vec<u32> = table.collect();
            Rows::new(3)
                .mixed("color", &[&table, &table, &table])
                .random("color", |d, row| row.extend((0..3).map(|_| signed(d, -126, 129))))
        },
    },
    Probe {
        name: "weight",
        module: "sanitize",
        words: [1, 1],
        wgsl: "out_f(weight(in_f(0u)));",
        rust: |r, o| o.f(sanitize::weight(r.f(0))),
        rows: || Rows::new(1).cross(&[&any()]).random("weight", |d, row| row.push(bits(d))),
    },
    Probe {
        name: "trust",
        module: "sanitize",
        words: [1, 1],
        wgsl: "out_f(trust(in_f(0u)));",
        rust: |r, o| o.f(sanitize::trust(r.f(0))),
        rows: || {
            Rows::new(1)
                .cross(&[&[any(), around(&[1.0])].concat()])
                .random("trust", |d, row| row.push(bits(d)))
                .random("trust, shares", |d, row| row.push(range(d, -0.5, 1.5)))
        },
    },
    Probe {
        name: "pcg4d",
        module: "rng",
        words: [4, 4],
        wgsl: "let v = pcg4d(vec4<u32>(in_u(0u), in_u(1u), in_u(2u), in_u(3u))); out_u(v.x); out_u(v.y); out_u(v.z); out_u(v.w);",
        rust: |r, o| rng::pcg4d([r.u(0), r.u(1), r.u(2), r.u(3)]).into_iter().for_each(|x| o.u(x)),
        rows: || {
            let w = words();
            Rows::new(4).cross(&[&w, &w, &w, &w]).random("pcg4d", |d, row| row.extend((0..4).map(|_| bits(d))))
        },
    },
    Probe {
        name: "stream_key",
        module: "rng",
        words: [6, 1],
        wgsl: "out_u(stream_key(vec2<u32>(in_u(0u), in_u(1u)), in_u(2u), in_u(3u), vec2<u32>(in_u(4u), in_u(5u))));",
        rust: |r, o| {
            let wide = |k: usize| u64::from(r.u(k)) | u64::from(r.u(k + 1)) << 32;
            o.u(rng::stream_key(wide(0), r.u(2), [Purpose::Select, Purpose::Key][r.u(3) as usize], wide(4)));
        },
        rows: || {
            let w = words();
            Rows::new(6).mixed("stream_key", &[&w, &w, &w, &[0, 1], &w, &w])
        },
    },
    Probe {
        name: "bits",
        module: "rng",
        words: [4, 1],
        wgsl: "out_u(bits(in_u(0u), in_u(1u), in_u(2u), in_u(3u)));",
        rust: |r, o| o.u(rng::bits(r.u(0), r.u(1), r.u(2), r.u(3))),
        rows: || {
            // H28: a million of (x, y, frame), four keys and frames across the wrap of the low word (H26).
            let mut rows = Rows::new(4);
            for i in 0..1_000_000_u32 {
                let frame = (i / 10_000).wrapping_sub(50);
                rows.words.extend([i % 100, i / 100 % 100, frame, [0, 1, 0x9e37_79b9, !0][i as usize % 4]]);
            }
            rows
        },
    },
    Probe {
        name: "unit_draw",
        module: "rng",
        words: [1, 1],
        wgsl: "out_f(unit_draw(in_u(0u)));",
        rust: |r, o| o.f(rng::unit_draw(r.u(0))),
        rows: || {
            let top: Vec<u32> = (0..600).map(|k| !k).collect();
            Rows::new(1).cross(&[&top]).cross(&[&words()]).random("unit_draw", |d, row| row.push(bits(d)))
        },
    },
    Probe {
        name: "half_bits",
        module: "pack",
        words: [1, 1],
        wgsl: "out_u(half_bits(in_f(0u)));",
        rust: |r, o| o.u(pack::half_bits(r.f(0))),
        rows: || {
            Rows::new(1)
                .cross(&[&any()])
                .random("half_bits", |d, row| row.push(bits(d)))
                .random("half_bits, range", |d, row| row.push(signed(d, -26, 17)))
                // Ties.
                .random("half_bits, ties", |d, row| row.push(signed(d, -26, 17) & !0xfff))
        },
    },
    Probe {
        name: "half_value",
        module: "pack",
        words: [1, 1],
        wgsl: "out_f(half_value(in_u(0u)));",
        rust: |r, o| o.f(pack::half_value(r.u(0))),
        rows: || Rows::new(1).cross(&[&(0..65536).map(|x| x | 0xabcd_0000).collect::<Vec<_>>()]),
    },
    Probe {
        name: "disparity_code",
        module: "pack",
        words: [1, 1],
        wgsl: "out_u(disparity_code(in_f(0u)));",
        rust: |r, o| o.u(pack::disparity_code(r.f(0))),
        rows: || {
            let ends = around(&[2.0_f32.powi(-32), 2.0_f32.powi(32), -1.0]);
            Rows::new(1)
                .cross(&[&[finite(), ends, vec![0x7f80_0000, 0xff80_0000]].concat()])
                .random("disparity_code", |d, row| row.push(finite_bits(d)))
                .random("disparity_code, range", |d, row| row.push(scaled(d, -34, 34)))
        },
    },
    Probe {
        name: "disparity_value",
        module: "pack",
        words: [1, 1],
        wgsl: "out_f(disparity_value(in_u(0u)));",
        rust: |r, o| o.f(pack::disparity_value(r.u(0))),
        rows: || Rows::new(1).cross(&[&(0..65536).collect::<Vec<_>>()]),
    },
    Probe {
        name: "pack",
        module: "pack",
        words: [6, 3],
        wgsl: "let w = pack(Stored(in_v(0u), in_f(3u), in_f(4u), in_u(5u))); out_u(w.x); out_u(w.y); out_u(w.z);",
        rust: |r, o| pack::pack(stored(r)).into_iter().for_each(|x| o.u(x)),
        rows: || {
            let sums = [finite(), vec![0x7f80_0000, 0xff80_0000], around(&[pack::MAX_W_SUM])].concat();
            let disparities = [positive(), floats(&[-1.0])].concat();
            Rows::new(6).mixed("pack", &[&finite(), &finite(), &finite(), &disparities, &sums, &words()]).random(
                "pack",
                |d, row| {
                    row.extend((0..3).map(|_| signed(d, -26, 17)));
                    row.extend([scaled(d, -34, 34), scaled(d, -126, 102), d.bits() % 300]);
                },
            )
        },
    },
    Probe {
        name: "unpack",
        module: "pack",
        words: [3, 6],
        wgsl: "let s = unpack(vec3<u32>(in_u(0u), in_u(1u), in_u(2u))); out_v(s.color); out_f(s.disparity); out_f(s.w_sum); out_u(s.age);",
        rust: |r, o| put_stored(o, &pack::unpack([r.u(0), r.u(1), r.u(2)])),
        rows: || {
            Rows::new(3)
                .mixed("unpack", &[&any(), &any(), &any()])
                .random("unpack", |d, row| row.extend((0..3).map(|_| bits(d))))
                .random("unpack, sound", |d, row| {
                    row.extend(pack::pack(Stored {
                        color: glam::Vec3::from_array([0; 3].map(|_| f32::from_bits(signed(d, -20, 15)))),
                        disparity: f32::from_bits(scaled(d, -34, 34)),
                        w_sum: f32::from_bits(scaled(d, -126, 100)),
                        age: d.bits() % 256,
                    }));
                })
        },
    },
    Probe {
        name: "nearest",
        module: "reproject",
        words: [6, 3],
        wgsl: "let p = nearest(in_u(0u), in_u(1u), vec2<f32>(in_f(2u), in_f(3u)), vec2<u32>(in_u(4u), in_u(5u)));
    out_u(p.verdict); out_u(p.at.x); out_u(p.at.y);",
        rust: |r, o| {
            let (verdict, at) = match reproject::nearest(r.u(0), r.u(1), [r.f(2), r.f(3)], [r.u(4), r.u(5)]) {
                Ok(at) => (reproject::Verdict::Valid, at),
                Err(verdict) => (verdict, [0, 0]),
            };
            o.u(verdict as u32);
            at.into_iter().for_each(|x| o.u(x));
        },
        rows: || {
            let x = [0, 1, 2, 15, 16, 17, 4095, 65535];
            let size = [1, 2, 16, 17, 4096, 65536];
            let motion = [any(), around(&[0.5, -0.5, -1.0, -1.5, 15.5, 65536.0, -65536.0])].concat();
            Rows::new(6)
                .mixed("nearest", &[&x, &x, &motion, &motion, &size, &size])
                .random("nearest", |d, row| {
                    let size = [1 + d.bits() % 300, 1 + d.bits() % 300];
                    row.extend([d.bits() % size[0], d.bits() % size[1], range(d, -40.0, 40.0), range(d, -40.0, 40.0)]);
                    row.extend(size);
                })
                .random("nearest, halves", |d, row| {
                    let mut half = || around(&[(d.bits() % 64) as f32 / 2.0 - 16.0])[d.bits() as usize % 3];
                    let motion = [half(), half()];
                    row.extend([d.bits() % 16, d.bits() % 16, motion[0], motion[1], 16, 16]);
                })
        },
    },
    Probe {
        name: "update",
        module: "reservoir",
        words: [4, 3],
        wgsl: "var r = Reservoir(in_f(0u), in_u(1u)); let take = update(&r, in_f(2u), in_f(3u)); out_b(take); out_f(r.w_sum); out_u(r.count);",
        rust: |r, o| {
            let mut kept = Reservoir { w_sum: r.f(0), count: r.u(1) };
            let take = reservoir::update(&mut kept, r.f(2), r.f(3));
            o.b(take);
            o.f(kept.w_sum);
            o.u(kept.count);
        },
        rows: || {
            Rows::new(4)
                .cross(&[&normal(), &[0, 1, !1, !0], &any(), &draws()])
                .random("update", |d, row| row.extend([scaled(d, -10, 10), d.bits(), scaled(d, -10, 10), draw(d)]))
        },
    },
    Probe {
        name: "combine",
        module: "reservoir",
        words: [5, 3],
        wgsl: "let c = combine(Reservoir(in_f(0u), in_u(1u)), Reservoir(in_f(2u), in_u(3u)), in_f(4u));
    out_b(c.keep_second); out_f(c.reservoir.w_sum); out_u(c.reservoir.count);",
        rust: |r, o| {
            let [first, second] = [0, 2].map(|k| Reservoir { w_sum: r.f(k), count: r.u(k + 1) });
            let (merged, keep_second) = reservoir::combine(first, second, r.f(4));
            o.b(keep_second);
            o.f(merged.w_sum);
            o.u(merged.count);
        },
        rows: || {
            Rows::new(5)
                .cross(&[&any(), &[0, 7, !0], &any(), &[1, !0], &draws()])
                .random("combine", |d, row| {
                    row.extend([scaled(d, -10, 10), d.bits(), scaled(d, -10, 10), d.bits(), draw(d)]);
                })
                .random("combine, near the threshold", |d, row| {
                    let [a, b] = [0; 2].map(|_| 2.0_f32.powi((d.bits() % 6) as i32));
                    row.extend([a.to_bits(), 1, b.to_bits(), 1, (b / (a + b)).to_bits()]);
                })
        },
    },
    Probe {
        name: "bernoulli_survival",
        module: "reservoir",
        words: [2, 1],
        wgsl: "out_f(bernoulli_survival(in_f(0u), in_f(1u)));",
        rust: |r, o| o.f(reservoir::bernoulli_survival(r.f(0), r.f(1))),
        rows: || {
            Rows::new(2)
                .cross(&[&normal(), &normal()])
                .random("bernoulli", |d, row| row.extend([scaled(d, -20, 20), scaled(d, -20, 20)]))
                // Sums are at most 2^100, so that none overflows; quotients below the normal range are another matter.
                .within(|r| r.f(0) <= pack::MAX_W_SUM && r.f(1) <= pack::MAX_W_SUM)
        },
    },
    Probe {
        name: "exponential_survival",
        module: "reservoir",
        words: [1, 1],
        wgsl: "out_f(exponential_survival(in_f(0u)));",
        rust: |r, o| o.f(reservoir::exponential_survival(r.f(0))),
        rows: || Rows::new(1).cross(&[&finite()]).random("exponential", |d, row| row.push(range(d, 0.0, 100.0))),
    },
    Probe {
        name: "a_es_log_key",
        module: "reservoir",
        words: [2, 1],
        wgsl: "out_f(a_es_log_key(in_f(0u), in_f(1u)));",
        rust: |r, o| o.f(reservoir::a_es_log_key(r.f(0), r.f(1))),
        rows: || {
            Rows::new(2)
                .cross(&[&draws(), &any()])
                .random("a_es_log_key", |d, row| row.extend([draw(d), scaled(d, -20, 3)]))
        },
    },
    Probe {
        name: "a_es_decay",
        module: "reservoir",
        words: [2, 1],
        wgsl: "out_f(a_es_decay(in_f(0u), in_f(1u)));",
        rust: |r, o| o.f(reservoir::a_es_decay(r.f(0), r.f(1))),
        rows: || {
            let keys: Vec<u32> = normal().into_iter().map(|x| x | 1 << 31).collect();
            let survivals = [around(&[1e-30, 0.5]), floats(&[0.0, -0.0, f32::MIN_POSITIVE, 1.0])].concat();
            Rows::new(2)
                .cross(&[&keys, &survivals])
                // Invalid keys.
                .cross(&[&floats(&[f32::NAN, -f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e-3, f32::MAX]), &survivals])
                .random("a_es_decay", |d, row| row.extend([scaled(d, -20, 20) | 1 << 31, range(d, 0.0, 1.0)]))
        },
    },
    Probe {
        name: "path_draws",
        module: "rng",
        words: [4, 4],
        wgsl: "let v = path_draws(in_u(0u), in_u(1u), in_u(2u), in_u(3u));
            out_f(v.x); out_f(v.y); out_f(v.z); out_f(v.w);",
        rust: |r, o| rng::path_draws(r.u(0), r.u(1), r.u(2), r.u(3)).into_iter().for_each(|x| o.f(x)),
        rows: || {
            let w = words();
            Rows::new(4).mixed("path_draws", &[&w, &w, &w, &w]).random("path_draws", |d, row| {
                row.extend((0..4).map(|_| bits(d)));
            })
        },
    },
];
