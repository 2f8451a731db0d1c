//! Functions of numbers: approx, acuity, color, depth.

use super::probe::{Probe, Rows};
use super::values::*;
use afterimage::kernel::depth::{DisparityMap, INVALID_DISPARITY};
use afterimage::kernel::{acuity, approx, color, depth};

fn one(name: &'static str, table: &[u32], random: fn(&mut afterimage_testing::Draws) -> u32) -> Rows {
    Rows::new(1).cross(&[table]).random(name, |d, row| row.push(random(d)))
}

pub const PROBES: &[Probe] = &[
    Probe {
        name: "atan2_upper",
        module: "approx",
        words: [2, 1],
        wgsl: "out_f(atan2_upper(in_f(0u), in_f(1u)));",
        rust: |r, o| o.f(approx::atan2_upper(r.f(0), r.f(1))),
        rows: || {
            Rows::new(2)
                .cross(&[&positive(), &finite()])
                .cross(&[&around(&[0.414_213_56]), &around(&[1.0, -1.0])])
                .random("atan2_upper", |d, row| row.extend([scaled(d, -3, 3), signed(d, -3, 3)]))
                .random("atan2_upper, wide", |d, row| row.extend([scaled(d, -60, 60), signed(d, -60, 60)]))
        },
    },
    Probe {
        name: "exp",
        module: "approx",
        words: [1, 1],
        wgsl: "out_f(exp(in_f(0u)));",
        rust: |r, o| o.f(approx::exp(r.f(0))),
        rows: || {
            let steps: Vec<f32> = (-126..=128).map(|n| (n as f32 - 0.5) * std::f32::consts::LN_2).collect();
            one("exp", &[finite(), around(&[-87.0, 88.0]), around(&steps)].concat(), |d| range(d, -90.0, 90.0))
                .random("exp, any", |d, row| row.push(finite_bits(d)))
        },
    },
    Probe {
        name: "exp2",
        module: "approx",
        words: [1, 1],
        wgsl: "out_f(exp2(in_f(0u)));",
        rust: |r, o| o.f(approx::exp2(r.f(0))),
        rows: || {
            let steps: Vec<f32> = (-127..=128).map(|n| n as f32 - 0.5).collect();
            one("exp2", &[finite(), around(&[-126.0, 127.0]), around(&steps)].concat(), |d| range(d, -130.0, 130.0))
                .random("exp2, any", |d, row| row.push(finite_bits(d)))
        },
    },
    Probe {
        name: "ln",
        module: "approx",
        words: [1, 1],
        wgsl: "out_f(ln(in_f(0u)));",
        rust: |r, o| o.f(approx::ln(r.f(0))),
        rows: || {
            one(
                "ln",
                &[normal(), around(&[std::f32::consts::FRAC_1_SQRT_2, 1.0, std::f32::consts::SQRT_2])].concat(),
                |d| scaled(d, -126, 127),
            )
            .random("ln, draws", |d, row| row.push(range(d, 0.0, 1.0)))
            .within(|r| r.f(0) >= f32::MIN_POSITIVE)
        },
    },
    Probe {
        name: "eccentricity_deg",
        module: "acuity",
        words: [6, 1],
        wgsl: "out_f(eccentricity_deg(in_v(0u), in_v(3u)));",
        rust: |r, o| o.f(acuity::eccentricity_deg(r.v(0), r.v(3))),
        rows: || {
            let axis = floats(&[0.0, -0.0, 1.0, -1.0, 1e-4, 1e5]);
            Rows::new(6)
                .cross(&[&axis, &axis, &axis, &axis, &axis, &axis])
                .random("eccentricity", |d, row| row.extend((0..6).map(|_| range(d, -2.0, 2.0))))
                .random("eccentricity, near", |d, row| {
                    let ray = [d.range(-1.0, 1.0), d.range(-1.0, 1.0), 1.0];
                    row.extend(ray.map(f32::to_bits));
                    row.extend(ray.map(|x| (x + d.range(-1e-4, 1e-4)).to_bits()));
                })
        },
    },
    Probe {
        name: "cell_density",
        module: "acuity",
        words: [1, 1],
        wgsl: "out_f(cell_density(in_f(0u)));",
        rust: |r, o| o.f(acuity::cell_density(r.f(0))),
        rows: || {
            one("cell_density", &[positive(), around(&[90.0, 180.0])].concat(), |d| range(d, 0.0, 180.0))
                .random("cell_density, wide", |d, row| row.push(scaled(d, -40, 8)))
        },
    },
    Probe {
        name: "candidate_weight",
        module: "acuity",
        words: [3, 1],
        wgsl: "out_f(candidate_weight(in_f(0u), in_f(1u), in_f(2u)));",
        rust: |r, o| o.f(acuity::candidate_weight(r.f(0), r.f(1), r.f(2))),
        rows: || {
            let degrees = [around(&[2.5, 5.0, 20.0, 90.0]), floats(&[0.0, 1e-6, 180.0])].concat();
            let density = |fovea: f32| 1.0 / acuity::cell_density(fovea);
            Rows::new(3).cross(&[&degrees, &degrees, &floats(&[0.0, 2.5, 5.0].map(density))]).random(
                "candidate_weight",
                |d, row| {
                    let fovea = d.range(0.0, 20.0);
                    row.extend([d.range(0.0, 120.0), fovea, density(fovea)].map(f32::to_bits));
                },
            )
        },
    },
    Probe {
        name: "cbrt",
        module: "color",
        words: [1, 1],
        wgsl: "out_f(cbrt(in_f(0u)));",
        rust: |r, o| o.f(color::cbrt(r.f(0))),
        rows: || {
            one("cbrt", &[finite(), around(&[1e-30, -1e-30, 216.0 / 24389.0])].concat(), finite_bits)
                .random("cbrt, colors", |d, row| row.push(signed(d, -20, 17)))
        },
    },
    Probe {
        name: "srgb_encode",
        module: "color",
        words: [1, 1],
        wgsl: "out_f(srgb_encode(in_f(0u)));",
        rust: |r, o| o.f(color::srgb_encode(r.f(0))),
        rows: || {
            one("srgb_encode", &[finite(), around(&[0.003_130_8, -0.003_130_8])].concat(), |d| range(d, -1.5, 1.5))
                .random("srgb_encode, any", |d, row| row.push(signed(d, -100, 17)))
        },
    },
    Probe {
        name: "srgb_decode",
        module: "color",
        words: [1, 1],
        wgsl: "out_f(srgb_decode(in_f(0u)));",
        rust: |r, o| o.f(color::srgb_decode(r.f(0))),
        rows: || {
            // Above 1e9 its square and fifth power leave the floats.
            one("srgb_decode", &[finite(), around(&[0.040_45, -0.040_45])].concat(), |d| range(d, -1.5, 1.5))
                .random("srgb_decode, any", |d, row| row.push(signed(d, -100, 17)))
                .within(|r| r.f(0).abs() < 1e9)
        },
    },
    Probe {
        name: "luma",
        module: "color",
        words: [3, 1],
        wgsl: "out_f(luma(in_v(0u)));",
        rust: |r, o| o.f(color::luma(r.v(0))),
        rows: || {
            let table = finite().into_iter().filter(|&x| f32::from_bits(x).abs() < 1e30).collect::<Vec<_>>();
            Rows::new(3)
                .mixed("luma", &[&table, &table, &table])
                .random("luma", |d, row| row.extend((0..3).map(|_| signed(d, -20, 17))))
        },
    },
    Probe {
        name: "lab",
        module: "color",
        words: [3, 3],
        wgsl: "out_v(lab(in_v(0u)));",
        rust: |r, o| o.v(color::lab(r.v(0))),
        rows: || {
            // Greys put the luminance at the threshold (H33).
            let greys: Vec<u32> =
                (-40..40).map(|k: i32| (216.0_f32 / 24389.0).to_bits().wrapping_add_signed(k)).collect();
            let mut rows = Rows::new(3).mixed("lab", &[&finite(), &finite(), &finite()]);
            rows.words.extend(greys.iter().flat_map(|&g| [g; 3]));
            rows.random("lab", |d, row| row.extend((0..3).map(|_| range(d, -0.1, 1.2))))
                .random("lab, wide", |d, row| row.extend((0..3).map(|_| signed(d, -20, 17))))
        },
    },
    Probe {
        name: "delta_e94",
        module: "color",
        words: [6, 1],
        wgsl: "out_f(delta_e94(in_v(0u), in_v(3u)));",
        rust: |r, o| o.f(color::delta_e94(r.v(0), r.v(3))),
        rows: || {
            let axis = floats(&[0.0, -0.0, 50.0, -50.0, 1e-4, 4000.0, 100.0]);
            Rows::new(6)
                .cross(&[&axis, &axis, &axis, &axis, &axis, &axis])
                .random("delta_e94", |d, row| row.extend((0..6).map(|_| range(d, -120.0, 120.0))))
                .random("delta_e94, same hue", |d, row| {
                    let (l, a, b, k) =
                        (d.range(0.0, 100.0), d.range(-80.0, 80.0), d.range(-80.0, 80.0), d.range(0.9, 1.1));
                    row.extend([l, a, b, l, a * k, b * k].map(f32::to_bits));
                })
        },
    },
    Probe {
        name: "disparity",
        module: "depth",
        words: [4, 1],
        wgsl: "out_f(disparity(in_f(0u), DisparityMap(in_f(1u), in_f(2u), in_u(3u))));",
        rust: |r, o| {
            let map = DisparityMap { a: r.f(1), b: r.f(2), invert: r.u(3) & 1 != 0, clamp: r.u(3) & 2 != 0 };
            o.f(depth::disparity(r.f(0), map));
        },
        rows: || {
            let a = floats(&[1.0, -1.0, 10.0, -9.99, 0.001, 1e-3, 1e5]);
            let b = floats(&[0.0, -0.0, 10.0, 1e-5, -1e-5, 1.0]);
            Rows::new(4)
                .cross(&[&any(), &a, &b, &[0, 1, 2, 3]])
                .cross(&[&around(&[1e-30, 1e30, 1.0]), &floats(&[1.0]), &floats(&[0.0]), &[0, 1, 2, 3]])
                .random("disparity", |d, row| {
                    row.extend([bits(d), signed(d, -10, 10), signed(d, -10, 10), d.bits() & 3]);
                })
                .random("disparity, depths", |d, row| {
                    row.extend([range(d, -0.1, 1.1), signed(d, -10, 10), signed(d, -10, 10), d.bits() & 3]);
                })
        },
    },
    Probe {
        name: "distance_of",
        module: "depth",
        words: [1, 1],
        wgsl: "out_f(distance_of(in_f(0u)));",
        rust: |r, o| o.f(depth::distance_of(r.f(0))),
        rows: || {
            Rows::new(1).cross(&[&floats(&[-1.0, 0.0, 1e-31, 1e-20, 1.0])]).random("distance_of", |d, row| {
                row.push(scaled(d, -60, 60));
            })
        },
    },
    Probe {
        name: "previous_disparity",
        module: "depth",
        words: [3, 1],
        wgsl: "out_f(previous_disparity(in_f(0u), in_f(1u), in_f(2u)));",
        rust: |r, o| o.f(depth::previous_disparity(r.f(0), r.f(1), r.f(2))),
        rows: || {
            let stretch = [around(&[1.0, 1e-6, -1e-6]), floats(&[0.0, 0.5, -1.0])].concat();
            let shift = floats(&[0.0, -0.0, 1.0, -1.0, 1e3, -1e-6]);
            Rows::new(3).cross(&[&[positive(), floats(&[INVALID_DISPARITY, -0.0])].concat(), &stretch, &shift]).random(
                "previous_disparity",
                |d, row| {
                    row.extend([scaled(d, -20, 10), range(d, -1.0, 2.0), range(d, -3.0, 3.0)]);
                },
            )
        },
    },
    Probe {
        name: "same_surface",
        module: "depth",
        words: [4, 1],
        wgsl: "out_b(same_surface(in_f(0u), in_f(1u), in_f(2u), in_f(3u)));",
        rust: |r, o| o.b(depth::same_surface(r.f(0), r.f(1), r.f(2), r.f(3))),
        rows: || {
            let disparities = [positive(), floats(&[INVALID_DISPARITY, -0.0])].concat();
            Rows::new(4)
                .mixed("same_surface", &[&disparities, &disparities, &floats(&[0.0, 0.01, 0.1]), &floats(&[0.0, 0.01])])
                .random("same_surface", |d, row| {
                    // Within a few ulp of the threshold, on either side.
                    let (larger, relative) = (d.range(0.001, 10.0), d.range(0.0, 0.1));
                    let slope = if d.bits() & 1 == 0 { 0.0 } else { d.range(0.0, 0.01) };
                    let smaller = larger - (relative * larger + slope);
                    let nudged = f32::from_bits(smaller.abs().to_bits().saturating_add(d.bits() % 7).saturating_sub(3));
                    row.extend([larger, nudged, relative, slope].map(f32::to_bits));
                })
        },
    },
    Probe {
        name: "one_sided_slope",
        module: "depth",
        words: [3, 1],
        wgsl: "out_f(one_sided_slope(in_f(0u), in_f(1u), in_f(2u)));",
        rust: |r, o| o.f(depth::one_sided_slope(r.f(0), r.f(1), r.f(2))),
        rows: || {
            let taps = floats(&[INVALID_DISPARITY, 0.0, 0.5, 0.5_f32.next_up(), 1.0, 3.0, 1e-10]);
            Rows::new(3)
                .cross(&[&taps, &taps, &taps])
                .random("one_sided_slope", |d, row| row.extend((0..3).map(|_| scaled(d, -20, 10))))
        },
    },
    Probe {
        name: "sin_cos_turns",
        module: "approx",
        words: [1, 2],
        wgsl: "let r = sin_cos_turns(in_f(0u)); out_f(r.x); out_f(r.y);",
        rust: |r, o| approx::sin_cos_turns(r.f(0)).into_iter().for_each(|x| o.f(x)),
        rows: || {
            let eighths: Vec<f32> = (-16..=16).map(|n| n as f32 * 0.125).collect();
            Rows::new(1)
                .cross(&[&[around(&eighths[..16]), around(&eighths[17..]), draws()].concat()])
                .random("turns", |d, row| row.push(range(d, 0.0, 1.0)))
                .random("turns, many", |d, row| row.push(range(d, -1e5, 1e5)))
        },
    },
];
