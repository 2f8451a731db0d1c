//! Functions of levels of detail and of the foveation filters: foveate.

use super::probe::{Probe, Rows};
use super::values::*;
use afterimage::kernel::foveate;

/// Widths of a blur from 0 to the widest.
fn sigma(d: &mut afterimage_testing::Draws) -> u32 {
    if d.bits() & 1 == 0 { range(d, 0.0, 2.0) } else { range(d, 0.0, 127.5) }
}

/// A color: of all magnitudes, dark to the largest half.
fn color(d: &mut afterimage_testing::Draws, row: &mut Vec<u32>) {
    row.extend((0..3).map(|_| signed(d, -24, 16)));
}

pub const PROBES: &[Probe] = &[
    Probe {
        name: "ramp",
        module: "foveate",
        words: [3, 1],
        wgsl: "out_f(ramp(in_f(0u), in_f(1u), in_f(2u)));",
        rust: |r, o| o.f(foveate::ramp(r.f(0), r.f(1), r.f(2))),
        rows: || {
            let x = [around(&[2.5, 5.0, 7.5, 0.5]), floats(&[0.0, 180.0])].concat();
            Rows::new(3)
                .cross(&[&x, &x, &floats(&[0.0, 0.5, 2.5, 1e-7])])
                .random("ramp", |d, row| row.extend([range(d, 0.0, 30.0), range(d, 0.0, 20.0), range(d, 0.0, 10.0)]))
        },
    },
    Probe {
        name: "region_lod",
        module: "foveate",
        words: [6, 1],
        wgsl: "out_f(region_lod(in_f(0u), in_f(1u), in_f(2u), in_f(3u), in_f(4u), in_f(5u)));",
        rust: |r, o| o.f(foveate::region_lod(r.f(0), r.f(1), r.f(2), r.f(3), r.f(4), r.f(5))),
        rows: || {
            let e = [around(&[2.5, 5.0, 7.5, 20.0, 22.5]), floats(&[0.0, 180.0])].concat();
            let lod = floats(&[0.0, 1.0, 2.0, 4.0]);
            Rows::new(6)
                .cross(&[&e, &floats(&[0.0, 2.5, 5.0]), &floats(&[5.0, 20.0]), &floats(&[0.0, 2.5]), &lod, &lod])
                .random("region_lod", |d, row| {
                    row.extend([60.0, 10.0, 30.0, 5.0, 3.0, 6.0].map(|most| range(d, 0.0, most)));
                })
        },
    },
    Probe {
        name: "blur_lod",
        module: "foveate",
        words: [5, 1],
        wgsl: "out_f(blur_lod(in_f(0u), in_f(1u), in_f(2u), in_f(3u), in_f(4u)));",
        rust: |r, o| o.f(foveate::blur_lod(r.f(0), r.f(1), r.f(2), r.f(3), r.f(4))),
        rows: || {
            let e = [around(&[2.5, 7.5, 20.0]), floats(&[0.0, 180.0])].concat();
            let sigma = floats(&[0.0, 0.5, 3.5, 7.5, 127.5]);
            Rows::new(5).cross(&[&e, &floats(&[0.0, 2.5]), &floats(&[2.5, 7.5]), &sigma, &sigma]).random(
                "blur_lod",
                |d, row| {
                    row.extend([180.0, 10.0, 30.0, 31.5, 127.5].map(|most| range(d, 0.0, most)));
                },
            )
        },
    },
    Probe {
        name: "blur_sigma_px",
        module: "foveate",
        words: [1, 1],
        wgsl: "out_f(blur_sigma_px(in_f(0u)));",
        rust: |r, o| o.f(foveate::blur_sigma_px(r.f(0))),
        rows: || {
            let whole: Vec<f32> = (0..=16).map(|i| 0.5 * i as f32).collect();
            Rows::new(1)
                .cross(&[&around(&whole)])
                .random("blur_sigma_px", |d, row| row.push(range(d, 0.0, 8.0)))
                .random("blur_sigma_px, small", |d, row| row.push(scaled(d, -30, 0)))
                .within(|r| r.f(0) == 0.0 || r.f(0) >= f32::MIN_POSITIVE)
        },
    },
    Probe {
        name: "gauss_center",
        module: "foveate",
        words: [1, 3],
        wgsl: "let t = gauss_center(in_f(0u)); out_f(t.weight); out_f(t.ratio); out_f(t.ratio_step);",
        rust: |r, o| {
            let t = foveate::gauss_center(r.f(0));
            [t.weight, t.ratio, t.ratio_step].into_iter().for_each(|x| o.f(x));
        },
        rows: || {
            Rows::new(1)
                .cross(&[&[around(&[0.125, 0.5, 7.5, 127.5]), floats(&[0.0])].concat()])
                .random("gauss_center", |d, row| row.push(sigma(d)))
        },
    },
    Probe {
        // All taps out to the edge, one after the other, as the pass takes them.
        name: "gauss_next",
        module: "foveate",
        words: [1, 3],
        wgsl: "var t = gauss_center(in_f(0u)); var side = 0.0;
    for (var d = 0u; d < gauss_radius(in_f(0u)); d++) { t = gauss_next(t); side += t.weight; }
    out_f(t.weight); out_f(t.ratio_step); out_f(1.0 + 2.0 * side);",
        rust: |r, o| {
            let mut t = foveate::gauss_center(r.f(0));
            let mut side = 0.0;
            for _ in 0..foveate::gauss_radius(r.f(0)) {
                t = foveate::gauss_next(t);
                side += t.weight;
            }
            [t.weight, t.ratio_step, 1.0 + 2.0 * side].into_iter().for_each(|x| o.f(x));
        },
        rows: || {
            Rows::new(1)
                .cross(&[&[around(&[0.125, 0.5, 1.0 / 3.0, 7.5, 127.5]), floats(&[0.0])].concat()])
                .random("gauss_next", |d, row| row.push(sigma(d)))
        },
    },
    Probe {
        name: "gauss_radius",
        module: "foveate",
        words: [1, 1],
        wgsl: "out_u(gauss_radius(in_f(0u)));",
        rust: |r, o| o.u(foveate::gauss_radius(r.f(0))),
        rows: || {
            let thirds: Vec<f32> = (0..=64).map(|i| i as f32 / 3.0).collect();
            Rows::new(1)
                .cross(&[&[around(&thirds[1..]), around(&[0.125, 127.5]), floats(&[0.0])].concat()])
                .random("gauss_radius", |d, row| row.push(sigma(d)))
        },
    },
    Probe {
        name: "level_len",
        module: "foveate",
        words: [2, 1],
        wgsl: "out_u(level_len(in_u(0u), in_u(1u)));",
        rust: |r, o| o.u(foveate::level_len(r.u(0), r.u(1))),
        rows: || Rows::new(2).cross(&[&lengths(), &levels()]),
    },
    Probe {
        name: "level_coordinate",
        module: "foveate",
        words: [2, 1],
        wgsl: "out_f(level_coordinate(in_f(0u), in_u(1u)));",
        rust: |r, o| o.f(foveate::level_coordinate(r.f(0), r.u(1))),
        rows: || {
            let px: Vec<u32> = lengths().iter().map(|&n| (n as f32 - 1.0).to_bits()).collect();
            Rows::new(2).cross(&[&px, &levels()]).random("level_coordinate", |d, row| {
                row.extend([range(d, 0.0, 16384.0), d.bits() % 9]);
            })
        },
    },
    Probe {
        name: "split",
        module: "foveate",
        words: [2, 2],
        wgsl: "let s = split(in_f(0u), in_u(1u)); out_u(s.whole); out_f(s.fraction);",
        rust: |r, o| {
            let (whole, fraction) = foveate::split(r.f(0), r.u(1));
            o.u(whole);
            o.f(fraction);
        },
        rows: || {
            // Not -0, whose sign clamp may lose.
            let v = [around(&[1.0, 2.0, 0.5, 16.0, 8191.0]), floats(&[0.0, -0.5, 1e9, -1e9])].concat();
            Rows::new(2).cross(&[&v, &lengths()]).random("split", |d, row| {
                row.extend([range(d, -1.0, 64.0), 1 + d.bits() % 64]);
            })
        },
    },
    Probe {
        name: "blend",
        module: "foveate",
        words: [7, 3],
        wgsl: "out_v(blend(in_v(0u), in_v(3u), in_f(6u)));",
        rust: |r, o| o.v(foveate::blend(r.v(0), r.v(3), r.f(6))),
        rows: || {
            Rows::new(7).random("blend", |d, row| {
                color(d, row);
                color(d, row);
                row.push(range(d, 0.0, 1.0));
            })
        },
    },
    Probe {
        name: "bilinear",
        module: "foveate",
        words: [14, 3],
        wgsl: "out_v(bilinear(in_v(0u), in_v(3u), in_v(6u), in_v(9u), vec2<f32>(in_f(12u), in_f(13u))));",
        rust: |r, o| o.v(foveate::bilinear([r.v(0), r.v(3)], [r.v(6), r.v(9)], [r.f(12), r.f(13)])),
        rows: || {
            Rows::new(14).random("bilinear", |d, row| {
                (0..4).for_each(|_| color(d, row));
                row.extend([range(d, 0.0, 1.0), range(d, 0.0, 1.0)]);
            })
        },
    },
    Probe {
        name: "mean_of_four",
        module: "foveate",
        words: [12, 3],
        wgsl: "out_v(mean_of_four(in_v(0u), in_v(3u), in_v(6u), in_v(9u)));",
        rust: |r, o| o.v(foveate::mean_of_four(r.v(0), r.v(3), r.v(6), r.v(9))),
        rows: || Rows::new(12).random("mean_of_four", |d, row| (0..4).for_each(|_| color(d, row))),
    },
    Probe {
        name: "block_center_px",
        module: "foveate",
        words: [3, 1],
        wgsl: "out_f(block_center_px(in_u(0u), in_u(1u), in_u(2u)));",
        rust: |r, o| o.f(foveate::block_center_px(r.u(0), r.u(1), r.u(2))),
        rows: || Rows::new(3).cross(&[&[0, 1, 2, 7, 8, 63, 1000], &levels(), &lengths()]),
    },
    Probe {
        name: "block_sample_level",
        module: "foveate",
        words: [1, 1],
        wgsl: "out_u(block_sample_level(in_u(0u)));",
        rust: |r, o| o.u(foveate::block_sample_level(r.u(0))),
        rows: || Rows::new(1).cross(&[&levels()]),
    },
    Probe {
        name: "block_sample",
        module: "foveate",
        words: [3, 1],
        wgsl: "out_u(block_sample(in_u(0u), in_u(1u), in_u(2u)));",
        rust: |r, o| o.u(foveate::block_sample(r.u(0), r.u(1), r.u(2))),
        rows: || Rows::new(3).cross(&[&[0, 1, 2, 7, 8, 63, 1000], &levels(), &lengths()]),
    },
];

/// Sides of images, in pixels or texels.
fn lengths() -> Vec<u32> {
    vec![1, 2, 3, 17, 64, 97, 255, 256, 257, 1080, 4097, 8192, 16384]
}

/// Levels of a mip chain.
fn levels() -> Vec<u32> {
    (0..=8).collect()
}
