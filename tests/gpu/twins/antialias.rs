//! Antialiasing of jittered frames: antialias.

use super::probe::{Probe, Rows};
use super::sparse::{color, light_of, push_light, push_reconstruction, put_kept, reconstruction_of};
use super::values::*;
use afterimage::kernel::{antialias, sparse};
use glam::Vec2;

pub const PROBES: &[Probe] = &[
    Probe {
        name: "mean_of",
        module: "antialias",
        words: [1, 2],
        wgsl: "let m = mean_of(in_f(0u)); out_f(m.lod); out_f(m.samples);",
        rust: |r, o| {
            let m = antialias::mean_of(r.f(0));
            o.f(m.lod);
            o.f(m.samples);
        },
        rows: || {
            let stored: Vec<u32> = (0..63).map(|code| (code as f32 * (1.0 / 7.0)).to_bits()).collect();
            Rows::new(1).cross(&[&stored]).cross(&[&floats(&[-1.0])])
        },
    },
    Probe {
        name: "stored_lod",
        module: "antialias",
        words: [2, 1],
        wgsl: "out_f(stored_lod(Mean(in_f(0u), in_f(1u))));",
        rust: |r, o| o.f(antialias::stored_lod(antialias::Mean { lod: r.f(0), samples: r.f(1) })),
        rows: || {
            let lods = floats(&[-1.0, 0.0, 0.05, 0.1, 0.11, 1.0, 2.5, 6.0, 8.0]);
            Rows::new(2)
                .cross(&[&lods, &floats(&[1.0, 1.4, 2.0, 16.0, 31.0, 40.0])])
                .random("stored_lod", |d, row| row.extend([range(d, -1.0, 7.0), range(d, 0.0, 33.0)]))
        },
    },
    Probe {
        name: "stands_before",
        module: "antialias",
        words: [7, 1],
        wgsl: "out_u(u32(stands_before(in_f(0u), in_f(1u), vec2<f32>(in_f(2u), in_f(3u)),
            vec2<f32>(in_f(4u), in_f(5u)), in_u(6u) != 0u)));",
        rust: |r, o| {
            let [own, other] = [2, 4].map(|at| Vec2::new(r.f(at), r.f(at + 1)));
            o.u(u32::from(antialias::stands_before(r.f(0), r.f(1), own, other, r.u(6) != 0)));
        },
        rows: || {
            Rows::new(7).random("stands_before", |d, row| {
                row.extend([range(d, -1.0, 2.0), range(d, -1.0, 2.0)]);
                row.extend([0; 4].map(|_| range(d, -1.0, 1.0)));
                row.push(d.bits() % 2);
            })
        },
    },
    Probe {
        name: "move_together",
        module: "antialias",
        words: [6, 1],
        wgsl: "out_b(move_together(vec2<f32>(in_f(0u), in_f(1u)), vec2<f32>(in_f(2u), in_f(3u)),
            vec2<f32>(in_f(4u), in_f(5u))));",
        rust: |r, o| {
            let [own, nearest, farthest] = [0, 2, 4].map(|at| Vec2::new(r.f(at), r.f(at + 1)));
            o.u(u32::from(antialias::move_together(own, nearest, farthest)));
        },
        rows: || {
            Rows::new(6).random("move_together", |d, row| {
                row.extend([0; 6].map(|_| range(d, -0.2, 0.2)));
            })
        },
    },
    Probe {
        name: "may_show",
        module: "antialias",
        words: [6, 1],
        wgsl: "out_b(may_show(in_f(0u), in_f(1u), vec2<f32>(in_f(2u), in_f(3u)), vec2<f32>(in_f(4u), in_f(5u))));",
        rust: |r, o| {
            let [place, offset] = [2, 4].map(|at| Vec2::new(r.f(at), r.f(at + 1)));
            o.u(u32::from(antialias::may_show(r.f(0), r.f(1), place, offset)));
        },
        rows: || {
            let disparities = floats(&[-1.0, 0.0, 0.48, 0.49, 0.5, 0.51, 1.0, 1.02]);
            let [places, offsets] = [floats(&[-0.5, 0.0, 0.3]), floats(&[-1.0, 0.0, 1.0])];
            Rows::new(6).cross(&[&disparities, &disparities, &places, &places, &offsets, &offsets])
        },
    },
    Probe {
        name: "is_of_surfaces",
        module: "antialias",
        words: [3, 1],
        wgsl: "out_b(is_of_surfaces(in_f(0u), in_f(1u), in_f(2u)));",
        rust: |r, o| o.u(u32::from(antialias::is_of_surfaces(r.f(0), r.f(1), r.f(2)))),
        rows: || {
            let disparities = floats(&[-1.0, 0.0, 0.48, 0.49, 0.5, 0.51, 1.0, 1.02, 1.03, 1e30]);
            Rows::new(3).cross(&[&disparities, &disparities, &disparities]).random("is_of_surfaces", |d, row| {
                row.extend([0; 3].map(|_| range(d, 0.9, 1.1)));
            })
        },
    },
    Probe {
        name: "add_near",
        module: "antialias",
        words: [10, 7],
        wgsl: "let n = add_near(Near(in_v(0u), in_v(3u), in_f(6u)), in_v(7u)); out_v(n.sum); out_v(n.squares);
            out_f(n.count);",
        rust: |r, o| {
            let near = antialias::Near { sum: r.v(0), squares: r.v(3), count: r.f(6) };
            let n = antialias::add_near(near, r.v(7));
            o.v(n.sum);
            o.v(n.squares);
            o.f(n.count);
        },
        rows: || {
            Rows::new(10).random("add_near", |d, row| {
                row.extend([0; 6].map(|_| range(d, -2.0, 2.0)));
                row.push(range(d, 0.0, 8.0));
                row.extend(color(d));
            })
        },
    },
    Probe {
        name: "clip",
        module: "antialias",
        words: [10, 4],
        wgsl: "let c = clip(Near(in_v(0u), in_v(3u), in_f(6u)), in_v(7u)); out_v(c.change); out_f(c.kept);",
        rust: |r, o| {
            let near = antialias::Near { sum: r.v(0), squares: r.v(3), count: r.f(6) };
            let c = antialias::clip(near, r.v(7));
            o.v(c.change);
            o.f(c.kept);
        },
        rows: || {
            Rows::new(10).random("clip", |d, row| {
                let count = 1.0 + (d.bits() % 9) as f32;
                let sum = [0; 3].map(|_| d.range(-1.0, 2.0) * count);
                row.extend(sum.map(f32::to_bits));
                row.extend(sum.map(|v| (v * v / count + d.range(0.0, 1.0)).to_bits()));
                row.push(count.to_bits());
                row.extend(color(d));
            })
        },
    },
    Probe {
        name: "clipped",
        module: "antialias",
        words: [6, 3],
        wgsl: "out_v(clipped(in_v(0u), in_v(3u)));",
        rust: |r, o| o.v(antialias::clipped(r.v(0), r.v(3))),
        rows: || {
            Rows::new(6).random("clipped", |d, row| {
                row.extend(color(d));
                let still = d.bits().is_multiple_of(4);
                row.extend([0; 3].map(|_| if still { 0 } else { range(d, -0.5, 0.5) }));
            })
        },
    },
    Probe {
        name: "scattered_error",
        module: "antialias",
        words: [11, 1],
        wgsl: "out_f(scattered_error(Light(in_v(0u), in_v(3u), in_f(6u), in_f(7u), in_f(8u), in_f(9u)), in_f(10u)));",
        rust: |r, o| o.f(antialias::scattered_error(light_of(r), r.f(10))),
        rows: || {
            Rows::new(11).random("scattered_error", |d, row| {
                push_light(d, row);
                row.push(range(d, 0.0, 4000.0));
            })
        },
    },
    Probe {
        name: "average",
        module: "antialias",
        words: [33, 12],
        wgsl: "let a = average(Reconstruction(in_v(0u), in_f(3u), in_v(4u), in_v(7u), in_v(10u), in_f(13u),
            Kept(in_v(14u), in_f(17u), in_f(18u), vec2<f32>(in_f(19u), in_f(20u))), in_u(21u) != 0u, in_v(22u),
            in_f(25u), in_f(26u), in_f(27u)), in_f(29u), vec2<f32>(in_f(30u), in_f(31u)), in_f(32u));
            let r = a.result; out_v(r.color); out_v(r.kept.color); out_f(r.kept.lod); out_f(r.kept.disparity);
            out_f(r.kept.place_px.x); out_f(r.kept.place_px.y); out_f(r.share); out_f(a.samples);",
        rust: |r, o| {
            let a = antialias::average(&reconstruction_of(r), r.f(29), Vec2::new(r.f(30), r.f(31)), r.f(32));
            o.v(a.result.color);
            put_kept(o, a.result.kept);
            o.f(a.result.share);
            o.f(a.samples);
        },
        rows: || {
            Rows::new(33).random("average", |d, row| {
                push_reconstruction(d, row);
                if d.bits().is_multiple_of(2) {
                    row[17] = 0;
                }
                row.extend([range(d, 1.0, 31.0), range(d, -0.5, 0.5), range(d, -0.5, 0.5), range(d, 0.0, 1.0)]);
            })
        },
    },
    Probe {
        name: "kept_mean",
        module: "antialias",
        words: [30, 12],
        wgsl: "let given = Reconstruction(in_v(0u), in_f(3u), in_v(4u), in_v(7u), in_v(10u), in_f(13u),
            Kept(in_v(14u), in_f(17u), in_f(18u), vec2<f32>(in_f(19u), in_f(20u))), in_u(21u) != 0u, in_v(22u),
            in_f(25u), in_f(26u), in_f(27u)); let a = kept_mean(given, reconstruct(given), in_f(29u));
            let r = a.result; out_v(r.color); out_v(r.kept.color); out_f(r.kept.lod); out_f(r.kept.disparity);
            out_f(r.kept.place_px.x); out_f(r.kept.place_px.y); out_f(r.share); out_f(a.samples);",
        rust: |r, o| {
            let given = reconstruction_of(r);
            let a = antialias::kept_mean(&given, sparse::reconstruct(&given), r.f(29));
            o.v(a.result.color);
            put_kept(o, a.result.kept);
            o.f(a.result.share);
            o.f(a.samples);
        },
        rows: || {
            Rows::new(30).random("kept_mean", |d, row| {
                push_reconstruction(d, row);
                if d.bits().is_multiple_of(2) {
                    (row[13], row[17]) = (0, 0);
                }
                row.push(range(d, 1.0, 31.0));
            })
        },
    },
];
