//! Reconstruction of sparse frames: kept, sparse.

use super::probe::{Out, Probe, Row, Rows};
use super::values::*;
use afterimage::kernel::noise::Noise;
use afterimage::kernel::{kept, sparse};
use afterimage_testing::Draws;
use glam::Vec2;

/// Seven words of a kept sample.
pub(super) fn kept_of(r: &Row<'_>, at: usize) -> kept::Kept {
    kept::Kept {
        color: r.v(at),
        lod: r.f(at + 3),
        disparity: r.f(at + 4),
        place_px: Vec2::new(r.f(at + 5), r.f(at + 6)),
    }
}

pub(super) fn put_kept(o: &mut Out, k: kept::Kept) {
    o.v(k.color);
    o.f(k.lod);
    o.f(k.disparity);
    o.f(k.place_px.x);
    o.f(k.place_px.y);
}

/// Eight words of an observation.
fn observation_of(r: &Row<'_>, at: usize) -> sparse::Observation {
    sparse::Observation { sampled: r.v(at), history: r.v(at + 3), error: r.f(at + 6), sure: r.f(at + 7) }
}

pub(super) fn color(d: &mut Draws) -> [u32; 3] {
    [0; 3].map(|_| scaled(d, -14, 6))
}

fn push_kept(d: &mut Draws, row: &mut Vec<u32>) {
    row.extend(color(d));
    row.push(range(d, 0.0, 8.0));
    row.push(scaled(d, -20, 20));
    row.extend([range(d, -1.3, 1.3), range(d, -1.3, 1.3)]);
}

/// An observation whose colors are often close to each other.
fn push_observation(d: &mut Draws, row: &mut Vec<u32>) {
    let sampled = color(d);
    row.extend(sampled);
    let near = d.bits().is_multiple_of(2);
    for v in sampled {
        row.push(if near {
            (f32::from_bits(v) * f32::from_bits(range(d, 0.7, 1.4))).to_bits()
        } else {
            scaled(d, -14, 6)
        });
    }
    row.extend([range(d, 0.0, 40.0), range(d, 0.0, 1.0)]);
}

/// Three samples around a position, and how many to use.
fn around_rows(name: &'static str) -> Rows {
    Rows::new(28).random(name, |d, row| {
        for _ in 0..3 {
            push_kept(d, row);
            row.extend([range(d, -1.5, 1.5), range(d, -1.5, 1.5)]);
        }
        row.push(d.bits() % 4);
    })
}

fn around_of(r: &Row<'_>) -> kept::Around {
    (0..r.u(27) as usize).map(|i| 9 * i).fold(kept::Around::NOTHING, |a, at| {
        kept::add_kept(a, kept_of(r, at), Vec2::new(r.f(at + 7), r.f(at + 8)), true, kept::INVERSE_REACH)
    })
}

/// Twenty-nine words of a reconstruction.
pub(super) fn push_reconstruction(d: &mut Draws, row: &mut Vec<u32>) {
    row.extend(color(d));
    row.push(range(d, 0.0, 4.0));
    let (low, more) = (color(d), color(d));
    row.extend(low);
    row.extend((0..3).map(|i| (f32::from_bits(low[i]) + f32::from_bits(more[i])).to_bits()));
    row.extend(color(d));
    row.push(range(d, 0.0, 4.0));
    push_kept(d, row);
    row.push(d.bits() % 2);
    let lit = d.bits().is_multiple_of(2);
    row.extend([0; 3].map(|_| if lit { 1.0_f32.to_bits() } else { range(d, 0.2, 5.0) }));
    let sure = d.bits().is_multiple_of(2);
    row.extend([0; 2].map(|_| if sure { 1.0_f32.to_bits() } else { range(d, 0.0, 1.0) }));
    row.extend([range(d, 0.0, 0.98), 0]);
}

pub(super) fn reconstruction_of(r: &Row<'_>) -> sparse::Reconstruction {
    sparse::Reconstruction {
        candidate: r.v(0),
        lod: r.f(3),
        range: [r.v(4), r.v(7)],
        history: r.v(10),
        history_lod: r.f(13),
        nearest: kept_of(r, 14),
        moved: r.u(21) != 0,
        gain: r.v(22),
        fit: r.f(25),
        trust: r.f(26),
        accumulate: r.f(27),
    }
}

pub const PROBES: &[Probe] = &[
    Probe {
        name: "pack_color",
        module: "kept",
        words: [3, 1],
        wgsl: "out_u(pack_color(in_v(0u)));",
        rust: |r, o| o.u(kept::pack_color(r.v(0))),
        rows: || {
            let c: Vec<u32> = finite().into_iter().filter(|&x| x & 0x7fff_ffff == 0 || x & 0x7f80_0000 != 0).collect();
            Rows::new(3).cross(&[&c, &c, &[0, 0x3f80_0000]]).random("pack_color", |d, row| row.extend(color(d)))
        },
    },
    Probe {
        name: "unpack_color",
        module: "kept",
        words: [1, 3],
        wgsl: "out_v(unpack_color(in_u(0u)));",
        rust: |r, o| o.v(kept::unpack_color(r.u(0))),
        rows: || Rows::new(1).cross(&[&words()]).random("unpack_color", |d, row| row.push(bits(d))),
    },
    Probe {
        name: "pack_place",
        module: "kept",
        words: [1, 1],
        wgsl: "out_u(pack_place(in_f(0u)));",
        rust: |r, o| o.u(kept::pack_place(r.f(0))),
        rows: || Rows::new(1).random("pack_place", |d, row| row.push(range(d, -2.0, 2.0))),
    },
    Probe {
        name: "unpack_place",
        module: "kept",
        words: [1, 1],
        wgsl: "out_f(unpack_place(in_u(0u)));",
        rust: |r, o| o.f(kept::unpack_place(r.u(0))),
        rows: || Rows::new(1).cross(&[&(0..256).collect::<Vec<_>>()]),
    },
    Probe {
        name: "pack_kept",
        module: "kept",
        words: [7, 2],
        wgsl: "let w = pack_kept(Kept(in_v(0u), in_f(3u), in_f(4u), vec2<f32>(in_f(5u), in_f(6u)))); out_u(w.x); out_u(w.y);",
        rust: |r, o| kept::pack_kept(kept_of(r, 0)).into_iter().for_each(|w| o.u(w)),
        rows: || Rows::new(7).random("pack_kept", |d, row| {
            push_kept(d, row);
            if d.bits().is_multiple_of(8) {
                row[3] = (-1.0_f32).to_bits();
                row[4] = (-1.0_f32).to_bits();
            }
        }),
    },
    Probe {
        name: "unpack_kept",
        module: "kept",
        words: [2, 7],
        wgsl: "let k = unpack_kept(vec2<u32>(in_u(0u), in_u(1u))); out_v(k.color); out_f(k.lod); out_f(k.disparity);
            out_f(k.place_px.x); out_f(k.place_px.y);",
        rust: |r, o| put_kept(o, kept::unpack_kept([r.u(0), r.u(1)])),
        rows: || Rows::new(2).random("unpack_kept", |d, row| row.extend([bits(d), bits(d)])),
    },
    Probe {
        name: "is_empty",
        module: "kept",
        words: [2, 1],
        wgsl: "out_b(is_empty(vec2<u32>(in_u(0u), in_u(1u))));",
        rust: |r, o| o.b(kept::is_empty([r.u(0), r.u(1)])),
        rows: || Rows::new(2).random("is_empty", |d, row| row.extend([bits(d), bits(d) | (d.bits() & 63)])),
    },
    Probe {
        name: "code_word",
        module: "kept",
        words: [2, 1],
        wgsl: "out_u(code_word(vec2<u32>(in_u(0u), in_u(1u))));",
        rust: |r, o| o.u(kept::code_word([r.u(0), r.u(1)])),
        rows: || Rows::new(2).random("code_word", |d, row| row.extend([bits(d), bits(d)])),
    },
    Probe {
        name: "unpack_full",
        module: "kept",
        words: [2, 7],
        wgsl: "let k = unpack_full(vec2<u32>(in_u(0u), in_u(1u))); out_v(k.color); out_f(k.lod); out_f(k.disparity);
            out_f(k.place_px.x); out_f(k.place_px.y);",
        rust: |r, o| put_kept(o, kept::unpack_full([r.u(0), r.u(1)])),
        rows: || Rows::new(2).random("unpack_full", |d, row| row.extend([bits(d), bits(d)])),
    },
    Probe {
        name: "moved_kept",
        module: "kept",
        words: [12, 7],
        wgsl: "let k = moved_kept(Kept(in_v(0u), in_f(3u), in_f(4u), vec2<f32>(in_f(5u), in_f(6u))),
            vec2<f32>(in_f(7u), in_f(8u)), vec2<f32>(in_f(9u), in_f(10u)), in_f(11u)); out_v(k.color); out_f(k.lod);
            out_f(k.disparity); out_f(k.place_px.x); out_f(k.place_px.y);",
        rust: |r, o| {
            let (texel_px, scale) = (Vec2::new(r.f(7), r.f(8)), Vec2::new(r.f(9), r.f(10)));
            put_kept(o, kept::moved_kept(kept_of(r, 0), texel_px, scale, r.f(11)));
        },
        rows: || Rows::new(12).random("moved_kept", |d, row| {
            push_kept(d, row);
            row.extend([range(d, -0.5, 0.5), range(d, -0.5, 0.5), range(d, 0.5, 2.0), range(d, 0.5, 2.0)]);
            row.push(range(d, -1.0, 1.0));
        }),
    },
    Probe {
        name: "kept_weight",
        module: "kept",
        words: [1, 2],
        wgsl: "out_f(kept_weight(in_f(0u), INVERSE_REACH)); out_f(kept_weight(in_f(0u), INVERSE_MEAN_REACH));",
        rust: |r, o| {
            o.f(kept::kept_weight(r.f(0), kept::INVERSE_REACH));
            o.f(kept::kept_weight(r.f(0), kept::INVERSE_MEAN_REACH));
        },
        rows: || Rows::new(1).random("kept_weight", |d, row| row.push(range(d, 0.0, 20.0))),
    },
    Probe {
        name: "multiple",
        module: "kept",
        words: [3, 1],
        wgsl: "out_u(multiple(in_f(0u), in_u(1u), in_f(2u)));",
        rust: |r, o| o.u(kept::multiple(r.f(0), r.u(1), r.f(2))),
        rows: || Rows::new(3).random("multiple", |d, row| {
            let v = scaled(d, -24, 15);
            row.extend([v, (v >> 23).max(111), range(d, 0.0, 1.0)]);
        }),
    },
    Probe {
        name: "pack_color_by",
        module: "kept",
        words: [4, 1],
        wgsl: "out_u(pack_color_by(in_v(0u), in_f(3u)));",
        rust: |r, o| o.u(kept::pack_color_by(r.v(0), r.f(3))),
        rows: || Rows::new(4).random("pack_color_by", |d, row| {
            row.extend(color(d));
            row.push(range(d, 0.0, 1.0));
        }),
    },
    Probe {
        name: "add_kept",
        module: "kept",
        words: [28, 30],
        wgsl: "var a = nothing_around(); for (var i = 0u; i < in_u(27u); i++) { let b = 9u * i;
            a = add_kept(a, Kept(in_v(b), in_f(b + 3u), in_f(b + 4u), vec2<f32>(in_f(b + 5u), in_f(b + 6u))),
                vec2<f32>(in_f(b + 7u), in_f(b + 8u)), true, INVERSE_REACH); }
            out_f(a.weight); out_v(a.color); out_f(a.lod); out_f(a.place.x); out_f(a.place.y); out_v(a.square);
            out_v(a.color_x); out_v(a.color_y); out_v(a.lowest); out_v(a.highest); out_v(a.nearest.color); out_f(a.nearest.lod); out_f(a.nearest.disparity);
            out_f(a.nearest.place_px.x); out_f(a.nearest.place_px.y); out_f(a.cost);",
        rust: |r, o| {
            let a = around_of(r);
            o.f(a.weight);
            o.v(a.color);
            o.f(a.lod);
            o.f(a.place.x);
            o.f(a.place.y);
            o.v(a.square);
            o.v(a.color_x);
            o.v(a.color_y);
            a.range.into_iter().for_each(|c| o.v(c));
            put_kept(o, a.nearest);
            o.f(a.cost);
        },
        rows: || around_rows("add_kept"),
    },
    Probe {
        name: "stands_in",
        module: "kept",
        words: [1, 1],
        wgsl: "var a = nothing_around(); a.weight = in_f(0u); out_u(u32(stands_in(a)));",
        rust: |r, o| o.u(u32::from(kept::stands_in(kept::Around { weight: r.f(0), ..kept::Around::NOTHING }))),
        rows: || Rows::new(1).random("stands_in", |d, row| row.push(range(d, 0.0, 4.0))),
    },
    Probe {
        name: "interpolate",
        module: "kept",
        words: [28, 17],
        wgsl: "var a = nothing_around(); for (var i = 0u; i < in_u(27u); i++) { let b = 9u * i;
            a = add_kept(a, Kept(in_v(b), in_f(b + 3u), in_f(b + 4u), vec2<f32>(in_f(b + 5u), in_f(b + 6u))),
                vec2<f32>(in_f(b + 7u), in_f(b + 8u)), true, INVERSE_REACH); }
            let k = interpolate(a); out_v(k.color); out_f(k.lod); out_v(k.lowest); out_v(k.highest);
            out_v(k.nearest.color); out_f(k.nearest.lod);
            out_f(k.nearest.disparity); out_f(k.nearest.place_px.x); out_f(k.nearest.place_px.y);",
        rust: |r, o| {
            let k = kept::interpolate(around_of(r));
            o.v(k.color);
            o.f(k.lod);
            k.range.into_iter().for_each(|c| o.v(c));
            put_kept(o, k.nearest);
        },
        rows: || around_rows("interpolate"),
    },
    Probe {
        name: "candidate_level",
        module: "sparse",
        words: [2, 1],
        wgsl: "out_f(candidate_level(in_f(0u), in_f(1u)));",
        rust: |r, o| o.f(sparse::candidate_level(r.f(0), r.f(1))),
        rows: || Rows::new(2).random("candidate_level", |d, row| row.extend([range(d, 0.0, 200.0), range(d, 0.0, 8.0)])),
    },
    Probe {
        name: "expected_error",
        module: "sparse",
        words: [3, 1],
        wgsl: "out_f(expected_error(in_f(0u), in_f(1u), in_u(2u) != 0u));",
        rust: |r, o| o.f(sparse::expected_error(r.f(0), r.f(1), r.u(2) != 0)),
        rows: || Rows::new(3).random("expected_error", |d, row| {
            row.extend([range(d, 0.0, 3.0), range(d, 0.0, 100.0), d.bits() % 2])
        }),
    },
    Probe {
        name: "lod_confidence",
        module: "sparse",
        words: [1, 1],
        wgsl: "out_f(lod_confidence(in_f(0u)));",
        rust: |r, o| o.f(sparse::lod_confidence(r.f(0))),
        rows: || Rows::new(1).random("lod_confidence", |d, row| row.push(range(d, 0.0, 3.0))),
    },
    Probe {
        name: "noisy_lod_confidence",
        module: "sparse",
        words: [4, 1],
        wgsl: "out_f(noisy_lod_confidence(in_f(0u), Noise(in_f(1u), in_f(2u)), in_f(3u)));",
        rust: |r, o| {
            let past = Noise { samples: r.f(1), variance: r.f(2) };
            o.f(sparse::noisy_lod_confidence(r.f(0), past, r.f(3)));
        },
        rows: || Rows::new(4).random("noisy_lod_confidence", |d, row| {
            row.extend([range(d, 0.0, 3.0), range(d, 1.0, 80.0), range(d, 0.0, 0.01), range(d, 0.0, 2.0)]);
        }),
    },
    Probe {
        name: "ratio",
        module: "sparse",
        words: [2, 1],
        wgsl: "out_f(ratio(in_f(0u), in_f(1u)));",
        rust: |r, o| o.f(sparse::ratio(r.f(0), r.f(1))),
        rows: || Rows::new(2).random("ratio", |d, row| row.extend([scaled(d, -14, 6), scaled(d, -14, 6)])),
    },
    Probe {
        name: "ratios",
        module: "sparse",
        words: [6, 3],
        wgsl: "out_v(ratios(in_v(0u), in_v(3u)));",
        rust: |r, o| o.v(sparse::ratios(r.v(0), r.v(3))),
        rows: || Rows::new(6).random("ratios", |d, row| {
            row.extend(color(d));
            row.extend(color(d));
        }),
    },
    Probe {
        name: "agreement",
        module: "sparse",
        words: [17, 1],
        wgsl: "out_f(agreement(Observation(in_v(0u), in_v(3u), in_f(6u), in_f(7u)),
            Observation(in_v(8u), in_v(11u), in_f(14u), in_f(15u)), in_f(16u)));",
        rust: |r, o| o.f(sparse::agreement(observation_of(r, 0), observation_of(r, 8), r.f(16))),
        rows: || Rows::new(17).random("agreement", |d, row| {
            push_observation(d, row);
            push_observation(d, row);
            row.push(range(d, 0.0, 4.0));
        }),
    },
    Probe {
        name: "neighbour_weight",
        module: "sparse",
        words: [3, 1],
        wgsl: "out_f(neighbour_weight(vec2<i32>(in_v(0u).xy)));",
        rust: |r, o| o.f(sparse::neighbour_weight([r.f(0) as i32, r.f(1) as i32])),
        rows: || {
            let offsets = floats(&[-1.0, 0.0, 1.0]);
            Rows::new(3).cross(&[&offsets, &offsets, &[0]])
        },
    },
    Probe {
        name: "add_light",
        module: "sparse",
        words: [20, 10],
        wgsl: "let l = add_light(Light(in_v(0u), in_v(3u), in_f(6u), in_f(7u), in_f(8u), in_f(9u)),
            Observation(in_v(10u), in_v(13u), in_f(16u), in_f(17u)), in_f(18u), in_f(19u));
            out_v(l.sampled); out_v(l.history); out_f(l.error); out_f(l.weight); out_f(l.squared); out_f(l.spatial);",
        rust: |r, o| {
            let l = sparse::add_light(light_of(r), observation_of(r, 10), r.f(18), r.f(19));
            o.v(l.sampled);
            o.v(l.history);
            o.f(l.error);
            o.f(l.weight);
            o.f(l.squared);
            o.f(l.spatial);
        },
        rows: || Rows::new(20).random("add_light", |d, row| {
            push_light(d, row);
            push_observation(d, row);
            row.extend([range(d, 0.0, 4.0), range(d, 0.0, 4.0)]);
        }),
    },
    Probe {
        name: "relight",
        module: "sparse",
        words: [10, 3],
        wgsl: "let l = Light(in_v(0u), in_v(3u), in_f(6u), in_f(7u), in_f(8u), in_f(9u));
            out_v(relight(l, mean_error(l)));",
        rust: |r, o| o.v(sparse::relight(light_of(r), sparse::mean_error(light_of(r)))),
        rows: || Rows::new(10).random("relight", push_light),
    },
    Probe {
        name: "mean_error",
        module: "sparse",
        words: [10, 1],
        wgsl: "out_f(mean_error(Light(in_v(0u), in_v(3u), in_f(6u), in_f(7u), in_f(8u), in_f(9u))));",
        rust: |r, o| o.f(sparse::mean_error(light_of(r))),
        rows: || Rows::new(10).random("mean_error", push_light),
    },
    Probe {
        name: "errors_left",
        module: "sparse",
        words: [11, 1],
        wgsl: "out_f(errors_left(Observation(in_v(0u), in_v(3u), in_f(6u), in_f(7u)), in_v(8u)));",
        rust: |r, o| o.f(sparse::errors_left(observation_of(r, 0), r.v(8))),
        rows: || Rows::new(11).random("errors_left", |d, row| {
            push_observation(d, row);
            row.extend([0; 3].map(|_| range(d, 0.2, 5.0)));
        }),
    },
    Probe {
        name: "fit",
        module: "sparse",
        words: [2, 1],
        wgsl: "out_f(fit(in_f(0u), in_f(1u)));",
        rust: |r, o| o.f(sparse::fit(r.f(0), r.f(1))),
        rows: || Rows::new(2).random("fit", |d, row| row.extend([range(d, 0.0, 10.0), range(d, 0.0, 1.0)])),
    },
    Probe {
        name: "own_fit",
        module: "sparse",
        words: [11, 1],
        wgsl: "out_f(own_fit(Observation(in_v(0u), in_v(3u), in_f(6u), in_f(7u)), in_v(8u)));",
        rust: |r, o| o.f(sparse::own_fit(observation_of(r, 0), r.v(8))),
        rows: || Rows::new(11).random("own_fit", |d, row| {
            push_observation(d, row);
            row.extend([0; 3].map(|_| range(d, 0.2, 5.0)));
        }),
    },
    Probe {
        name: "mean_fit",
        module: "sparse",
        words: [11, 1],
        wgsl: "out_f(mean_fit(Light(in_v(0u), in_v(3u), in_f(6u), in_f(7u), in_f(8u), in_f(9u)), in_f(10u)));",
        rust: |r, o| o.f(sparse::mean_fit(light_of(r), r.f(10))),
        rows: || {
            Rows::new(11).random("mean_fit", |d, row| {
                push_light(d, row);
                row.push(range(d, 0.0, 1.0));
            })
        },
    },
    Probe {
        name: "pack_lit",
        module: "sparse",
        words: [7, 2],
        wgsl: "let w = pack_lit(Lit(in_v(0u), in_f(3u), in_f(6u), in_u(4u) != 0u, in_f(5u))); out_u(w.x); out_u(w.y);",
        rust: |r, o| {
            let lit = sparse::Lit { gain: r.v(0), fit: r.f(3), own_fit: r.f(6), is_own: r.u(4) != 0, disparity: r.f(5) };
            sparse::pack_lit(lit).into_iter().for_each(|w| o.u(w));
        },
        rows: || Rows::new(7).random("pack_lit", |d, row| {
            row.extend([0; 3].map(|_| range(d, 0.2, 5.0)));
            row.extend([range(d, 0.0, 1.0), d.bits() % 2, scaled(d, -20, 20), range(d, 0.0, 1.0)]);
        }),
    },
    Probe {
        name: "unpack_lit",
        module: "sparse",
        words: [2, 7],
        wgsl: "let l = unpack_lit(vec2<u32>(in_u(0u), in_u(1u))); out_v(l.gains); out_f(l.fit); out_f(l.own_fit);
            out_u(u32(l.is_own)); out_f(l.disparity);",
        rust: |r, o| {
            let lit = sparse::unpack_lit([r.u(0), r.u(1)]);
            o.v(lit.gain);
            o.f(lit.fit);
            o.f(lit.own_fit);
            o.u(u32::from(lit.is_own));
            o.f(lit.disparity);
        },
        rows: || Rows::new(2).random("unpack_lit", |d, row| row.extend([bits(d), bits(d)])),
    },
    Probe {
        name: "relit",
        module: "sparse",
        words: [12, 3],
        wgsl: "out_v(relit(in_v(0u), in_v(3u), in_v(6u), in_v(9u)));",
        rust: |r, o| o.v(sparse::relit(r.v(0), r.v(3), [r.v(6), r.v(9)])),
        rows: || Rows::new(12).random("relit", |d, row| {
            row.extend(color(d));
            row.extend([0; 3].map(|_| range(d, 0.2, 5.0)));
            let (low, more) = (color(d), color(d));
            row.extend(low);
            row.extend((0..3).map(|i| (f32::from_bits(low[i]) + f32::from_bits(more[i])).to_bits()));
        }),
    },
    Probe {
        name: "reconstruct",
        module: "sparse",
        words: [29, 11],
        wgsl: "let r = reconstruct(Reconstruction(in_v(0u), in_f(3u), in_v(4u), in_v(7u), in_v(10u), in_f(13u),
            Kept(in_v(14u), in_f(17u), in_f(18u), vec2<f32>(in_f(19u), in_f(20u))), in_u(21u) != 0u, in_v(22u),
            in_f(25u), in_f(26u), in_f(27u))); out_v(r.color); out_v(r.kept.color); out_f(r.kept.lod);
            out_f(r.kept.disparity); out_f(r.kept.place_px.x); out_f(r.kept.place_px.y); out_f(r.share);",
        rust: |r, o| {
            let result = sparse::reconstruct(&reconstruction_of(r));
            o.v(result.color);
            put_kept(o, result.kept);
            o.f(result.share);
        },
        rows: || Rows::new(29).random("reconstruct", push_reconstruction),
    },
    Probe {
        name: "accumulate",
        module: "sparse",
        words: [33, 13],
        wgsl: "let a = accumulate(Reconstruction(in_v(0u), in_f(3u), in_v(4u), in_v(7u), in_v(10u), in_f(13u),
            Kept(in_v(14u), in_f(17u), in_f(18u), vec2<f32>(in_f(19u), in_f(20u))), in_u(21u) != 0u, in_v(22u),
            in_f(25u), in_f(26u), in_f(27u)), Noise(in_f(29u), in_f(30u)), Noise(in_f(31u), in_f(32u)));
            let r = a.result; out_v(r.color); out_v(r.kept.color); out_f(r.kept.lod); out_f(r.kept.disparity);
            out_f(r.kept.place_px.x); out_f(r.kept.place_px.y); out_f(r.share); out_f(a.noise.samples);
            out_f(a.noise.variance);",
        rust: |r, o| {
            let known = |k: usize| Noise { samples: r.f(k), variance: r.f(k + 1) };
            let made = sparse::accumulate(&reconstruction_of(r), known(29), known(31));
            o.v(made.result.color);
            put_kept(o, made.result.kept);
            o.f(made.result.share);
            o.f(made.noise.samples);
            o.f(made.noise.variance);
        },
        rows: || Rows::new(33).random("accumulate", |d, row| {
            push_reconstruction(d, row);
            for _ in 0..2 {
                let variance = [0.0, d.range(0.0, 1e-3), d.range(0.0, 2.0)][d.bits() as usize % 3];
                row.extend([(1.0 + (d.bits() % 64) as f32).to_bits(), variance.to_bits()]);
            }
        }),
    },
];

/// Ten words of sums over neighbours, whose means are often close to each other.
pub(super) fn push_light(d: &mut Draws, row: &mut Vec<u32>) {
    let weight = range(d, 0.0, 16.0);
    let (mean, near) = (color(d), d.bits().is_multiple_of(2));
    let times = |v: u32, by: u32| (f32::from_bits(v) * f32::from_bits(by)).to_bits();
    row.extend(mean.map(|v| times(v, weight)));
    for v in mean {
        let other = if near { times(v, range(d, 0.8, 1.25)) } else { scaled(d, -14, 6) };
        row.push(times(other, weight));
    }
    row.push(times(weight, range(d, 0.0, 20.0)));
    row.extend([weight, times(times(weight, weight), range(d, 0.11, 1.0)), range(d, 0.0, 16.0)]);
}

pub(super) fn light_of(r: &Row<'_>) -> sparse::Light {
    sparse::Light { sampled: r.v(0), history: r.v(3), error: r.f(6), weight: r.f(7), squared: r.f(8), spatial: r.f(9) }
}
