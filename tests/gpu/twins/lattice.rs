//! Samples of sparse frames: lattice.

use super::probe::{Probe, Rows};
use super::values::*;
use afterimage::kernel::lattice;
use glam::{Vec2, Vec4};

pub const PROBES: &[Probe] = &[
    Probe {
        name: "between",
        module: "lattice",
        words: [4, 3],
        wgsl: "let b = between(in_u(0u), in_u(1u), in_u(2u), in_u(3u)); out_u(b.points.x); out_u(b.points.y);
            out_f(b.fraction);",
        rust: |r, o| {
            let b = lattice::between(r.u(0), r.u(1), r.u(2), r.u(3));
            o.u(b.points[0]);
            o.u(b.points[1]);
            o.f(b.fraction);
        },
        rows: || {
            let ends = [0, 1, 2, 7, 255, 256, 257, 16383];
            Rows::new(4)
                .cross(&[&ends, &ends, &(0..=8).collect::<Vec<_>>(), &[1, 2, 3, 64, 16384]])
                .random("between", |d, row| {
                    row.extend([d.bits() % 16384, d.bits() % 16384, d.bits() % 9, 1 + d.bits() % 16384])
                })
        },
    },
    Probe {
        name: "nearest_point",
        module: "lattice",
        words: [3, 1],
        wgsl: "out_u(bitcast<u32>(nearest_point(in_u(0u), in_u(1u), in_u(2u))));",
        rust: |r, o| o.u(lattice::nearest_point(r.u(0), r.u(1), r.u(2)) as u32),
        rows: || {
            let ends = [0, 1, 2, 3, 7, 255, 256, 257, 16383];
            Rows::new(3)
                .cross(&[&ends, &ends, &(0..=8).collect::<Vec<_>>()])
                .random("nearest_point", |d, row| row.extend([d.bits() % 16384, d.bits() % 16384, d.bits() % 9]))
        },
    },
    Probe {
        name: "point_offset_px",
        module: "lattice",
        words: [4, 1],
        wgsl: "out_f(point_offset_px(in_u(0u), in_u(1u), in_u(2u), bitcast<i32>(in_u(3u))));",
        rust: |r, o| o.f(lattice::point_offset_px(r.u(0), r.u(1), r.u(2), r.u(3) as i32)),
        rows: || {
            let (ends, points) = ([0, 1, 7, 255, 16383], [0, 1, 2, 64, !0, !1, !200]);
            Rows::new(4).cross(&[&ends, &ends, &(0..=8).collect::<Vec<_>>(), &points])
        },
    },
    Probe {
        name: "place_weight",
        module: "lattice",
        words: [2, 1],
        wgsl: "out_f(place_weight(vec2<f32>(in_f(0u), in_f(1u))));",
        rust: |r, o| o.f(lattice::place_weight(Vec2::new(r.f(0), r.f(1)))),
        rows: || {
            let offsets: Vec<f32> = (-256..=256).map(|i| i as f32).collect();
            Rows::new(2).cross(&[&floats(&offsets), &floats(&[-255.0, -3.0, 0.0, 1.0, 8.0])])
        },
    },
    Probe {
        name: "point_weight",
        module: "lattice",
        words: [2, 1],
        wgsl: "out_f(point_weight(in_f(0u), in_u(1u)));",
        rust: |r, o| o.f(lattice::point_weight(r.f(0), r.u(1))),
        rows: || {
            let fractions: Vec<f32> = (0..256).map(|i| i as f32 / 256.0).collect();
            Rows::new(2).cross(&[&floats(&fractions), &[0, 1]])
        },
    },
    Probe {
        name: "add_sample",
        module: "lattice",
        words: [11, 5],
        wgsl: "let s = add_sample(SampleMean(vec4<f32>(in_v(0u), in_f(3u)), in_f(4u)), vec4<f32>(in_v(5u), in_f(8u)),
            in_u(9u) != 0u, in_f(10u)); out_v(s.sum.xyz); out_f(s.sum.w); out_f(s.weight);",
        rust: |r, o| {
            let mean = lattice::SampleMean { sum: r.v(0).extend(r.f(3)), weight: r.f(4) };
            let mean = lattice::add_sample(mean, r.v(5).extend(r.f(8)), r.u(9) != 0, r.f(10));
            o.v(mean.sum.truncate());
            o.f(mean.sum.w);
            o.f(mean.weight);
        },
        rows: || {
            Rows::new(11).random("add_sample", |d, row| {
                row.extend((0..4).map(|_| signed(d, -20, 16)));
                row.push(range(d, 0.0, 1.0));
                row.extend((0..4).map(|_| signed(d, -20, 16)));
                row.push(d.bits() % 4);
                row.push(((d.bits() % 65536) as f32 / 65536.0).to_bits());
            })
        },
    },
    Probe {
        name: "sample_mean",
        module: "lattice",
        words: [5, 4],
        wgsl: "let m = sample_mean(SampleMean(vec4<f32>(in_v(0u), in_f(3u)), in_f(4u))); out_v(m.xyz); out_f(m.w);",
        rust: |r, o| {
            let mean: Vec4 = lattice::sample_mean(lattice::SampleMean { sum: r.v(0).extend(r.f(3)), weight: r.f(4) });
            o.v(mean.truncate());
            o.f(mean.w);
        },
        rows: || {
            Rows::new(5).random("sample_mean", |d, row| {
                row.extend((0..4).map(|_| signed(d, -16, 16)));
                row.push(((d.bits() % 65537) as f32 / 65536.0).to_bits());
            })
        },
    },
    Probe {
        name: "add_geometry",
        module: "lattice",
        words: [9, 4],
        wgsl:
            "let g = add_geometry(GeometryMean(in_f(0u), vec2<f32>(in_f(1u), in_f(2u)), in_f(3u)), in_f(4u), in_f(5u),
            vec2<f32>(in_f(6u), in_f(7u)), in_f(8u)); out_f(g.disparity); out_f(g.motion.x); out_f(g.motion.y);
            out_f(g.weight);",
        rust: |r, o| {
            let mean = lattice::GeometryMean { disparity: r.f(0), motion: Vec2::new(r.f(1), r.f(2)), weight: r.f(3) };
            let g = lattice::add_geometry(mean, r.f(4), r.f(5), Vec2::new(r.f(6), r.f(7)), r.f(8));
            [g.disparity, g.motion.x, g.motion.y, g.weight].into_iter().for_each(|v| o.f(v));
        },
        rows: || {
            Rows::new(9).random("add_geometry", |d, row| {
                row.extend([range(d, 0.0, 4.0), signed(d, -8, 8), signed(d, -8, 8), range(d, 0.0, 1.0)]);
                row.extend([range(d, 0.1, 2.0), range(d, 0.1, 2.0), signed(d, -8, 8)]);
                row.push(if d.bits().is_multiple_of(8) { f32::NAN.to_bits() } else { signed(d, -8, 8) });
                row.push(((d.bits() % 5) as f32 / 4.0).to_bits());
            })
        },
    },
    Probe {
        name: "filled_geometry",
        module: "lattice",
        words: [7, 3],
        wgsl: "out_v(filled_geometry(GeometryMean(in_f(0u), vec2<f32>(in_f(1u), in_f(2u)), in_f(3u)), in_f(4u),
            vec2<f32>(in_f(5u), in_f(6u))));",
        rust: |r, o| {
            let mean = lattice::GeometryMean { disparity: r.f(0), motion: Vec2::new(r.f(1), r.f(2)), weight: r.f(3) };
            o.v(lattice::filled_geometry(mean, r.f(4), Vec2::new(r.f(5), r.f(6))));
        },
        rows: || {
            Rows::new(7).random("filled_geometry", |d, row| {
                row.extend([range(d, 0.0, 4.0), signed(d, -8, 8), signed(d, -8, 8)]);
                row.push(((d.bits() % 5) as f32 / 4.0).to_bits());
                row.extend([range(d, -0.1, 2.0), signed(d, -8, 8), signed(d, -8, 8)]);
            })
        },
    },
];
