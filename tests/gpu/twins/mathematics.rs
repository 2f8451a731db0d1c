//! Functions of numbers: approx, acuity, color, depth.

use super::*;
use afterimage::kernel::depth::{DisparityMap, INVALID_DISPARITY};
use afterimage::kernel::{acuity, approx, color, depth, lab, lens};

fn one(rows: Rows, table: &[u32], random: fn(&mut Draws) -> u32) -> Rows {
    rows.cross(&[table]).random(|d, row| row.push(random(d)))
}

pub const PROBES: &[Probe] = &[
    probe!(approx::atan2_upper, |rows| rows
        .cross(&[&positive(), &finite()])
        .cross(&[&around(&[0.414_213_56]), &around(&[1.0, -1.0])])
        .each(&[Scaled(-3, 3), Signed(-3, 3)])
        .random_of("wide", |d, row| row.extend([scaled(d, -60, 60), signed(d, -60, 60)]))),
    probe!(approx::exp_approx, |rows| {
        let steps: Vec<f32> = (-126..=128).map(|n| (n as f32 - 0.5) * std::f32::consts::LN_2).collect();
        one(rows, &[finite(), around(&[-87.0, 88.0]), around(&steps)].concat(), |d| range(d, -90.0, 90.0))
            .random_of("any", |d, row| row.push(finite_bits(d)))
    }),
    probe!(approx::exp2_approx, |rows| {
        let steps: Vec<f32> = (-127..=128).map(|n| n as f32 - 0.5).collect();
        one(rows, &[finite(), around(&[-126.0, 127.0]), around(&steps)].concat(), |d| range(d, -130.0, 130.0))
            .random_of("any", |d, row| row.push(finite_bits(d)))
    }),
    probe!(approx::ln_approx, |rows| {
        one(
            rows,
            &[normal(), around(&[std::f32::consts::FRAC_1_SQRT_2, 1.0, std::f32::consts::SQRT_2])].concat(),
            |d| scaled(d, -126, 127),
        )
        .random_of("draws", |d, row| row.push(range(d, 0.0, 1.0)))
        .within(|r| r.f(0) >= f32::MIN_POSITIVE)
    }),
    probe!(lens::eccentricity_deg, |rows| {
        let axis = floats(&[0.0, -0.0, 1.0, -1.0, 1e-4, 1e5]);
        rows.cross(&[&axis, &axis, &axis, &axis, &axis, &axis])
            .random_of("eccentricity", |d, row| row.extend((0..6).map(|_| range(d, -2.0, 2.0))))
            .random_of("eccentricity, near", |d, row| {
                let ray = [d.range(-1.0, 1.0), d.range(-1.0, 1.0), 1.0];
                row.extend(ray.map(f32::to_bits));
                row.extend(ray.map(|x| (x + d.range(-1e-4, 1e-4)).to_bits()));
            })
    }),
    probe!(acuity::candidate_weight, |rows| {
        let degrees = [around(&[2.5, 5.0, 20.0, 90.0]), floats(&[0.0, 1e-6, 180.0])].concat();
        let density = |fovea: f32| 1.0 / acuity::cell_density(fovea);
        rows.cross(&[&degrees, &degrees, &floats(&[0.0, 2.5, 5.0].map(density))]).random(|d, row| {
            let fovea = d.range(0.0, 20.0);
            row.extend([d.range(0.0, 120.0), fovea, density(fovea)].map(f32::to_bits));
        })
    }),
    probe!(color::cbrt, |rows| {
        one(rows, &[finite(), around(&[1e-30, -1e-30, 216.0 / 24389.0])].concat(), finite_bits)
            .random_of("colors", |d, row| row.push(signed(d, -20, 17)))
    }),
    probe!(color::srgb_encode, |rows| {
        one(rows, &[finite(), around(&[0.003_130_8, -0.003_130_8])].concat(), |d| range(d, -1.5, 1.5))
            .random_of("any", |d, row| row.push(signed(d, -100, 17)))
    }),
    probe!(color::srgb_decode, |rows| {
        // Above 1e9 its square and fifth power leave the floats.
        one(rows, &[finite(), around(&[0.040_45, -0.040_45])].concat(), |d| range(d, -1.5, 1.5))
            .random_of("any", |d, row| row.push(signed(d, -100, 17)))
            .within(|r| r.f(0).abs() < 1e9)
    }),
    probe!(lab::lab, |rows| {
        // Greys put the luminance at the threshold (H33).
        let greys: Vec<u32> = (-40..40).map(|k: i32| (216.0_f32 / 24389.0).to_bits().wrapping_add_signed(k)).collect();
        let mut rows = rows.mixed(&[&finite(), &finite(), &finite()]);
        rows.words.extend(greys.iter().flat_map(|&g| [g; 3]));
        rows.each(&[F(-0.1, 1.2); 3]).random_of("wide", |d, row| row.extend((0..3).map(|_| signed(d, -20, 17))))
    }),
    probe!(lab::delta_e94, |rows| {
        let axis = floats(&[0.0, -0.0, 50.0, -50.0, 1e-4, 4000.0, 100.0]);
        rows.cross(&[&axis, &axis, &axis, &axis, &axis, &axis]).each(&[F(-120.0, 120.0); 6]).random_of(
            "same hue",
            |d, row| {
                let (l, a, b, k) = (d.range(0.0, 100.0), d.range(-80.0, 80.0), d.range(-80.0, 80.0), d.range(0.9, 1.1));
                row.extend([l, a, b, l, a * k, b * k].map(f32::to_bits));
            },
        )
    }),
    probe!(
        depth::disparity,
        |depth: f32, a: f32, b: f32, flags: u32| {
            depth::disparity(depth, DisparityMap { a, b, invert: flags & 1 != 0, clamp: flags & 2 != 0 })
        },
        "disparity($0, DisparityMap($1, $2, $3))",
        |rows| {
            let a = floats(&[1.0, -1.0, 10.0, -9.99, 0.001, 1e-3, 1e5]);
            let b = floats(&[0.0, -0.0, 10.0, 1e-5, -1e-5, 1.0]);
            rows.cross(&[&any(), &a, &b, &[0, 1, 2, 3]])
                .cross(&[&around(&[1e-30, 1e30, 1.0]), &floats(&[1.0]), &floats(&[0.0]), &[0, 1, 2, 3]])
                .each(&[Bits, Signed(-10, 10), Signed(-10, 10), N(4)])
                .random_of("depths", |d, row| {
                    row.extend([range(d, -0.1, 1.1), signed(d, -10, 10), signed(d, -10, 10), d.bits() & 3]);
                })
        }
    ),
    probe!(depth::previous_disparity, |rows| {
        let stretch = [around(&[1.0, 1e-6, -1e-6]), floats(&[0.0, 0.5, -1.0])].concat();
        let shift = floats(&[0.0, -0.0, 1.0, -1.0, 1e3, -1e-6]);
        let rows = rows.cross(&[&[positive(), floats(&[INVALID_DISPARITY, -0.0])].concat(), &stretch, &shift]);
        rows.each(&[Scaled(-20, 10), F(-1.0, 2.0), F(-3.0, 3.0)])
    }),
    probe!(depth::same_surface, |rows| {
        let disparities = [positive(), floats(&[INVALID_DISPARITY, -0.0])].concat();
        rows.mixed(&[&disparities, &disparities, &floats(&[0.0, 0.01, 0.1]), &floats(&[0.0, 0.01])]).random(|d, row| {
            // Within a few ulp of the threshold, on either side.
            let (larger, relative) = (d.range(0.001, 10.0), d.range(0.0, 0.1));
            let slope = if d.bits() & 1 == 0 { 0.0 } else { d.range(0.0, 0.01) };
            let smaller = larger - (relative * larger + slope);
            let nudged = f32::from_bits(smaller.abs().to_bits().saturating_add(d.bits() % 7).saturating_sub(3));
            row.extend([larger, nudged, relative, slope].map(f32::to_bits));
        })
    }),
    probe!(depth::one_sided_slope, |rows| {
        let taps = floats(&[INVALID_DISPARITY, 0.0, 0.5, 0.5_f32.next_up(), 1.0, 3.0, 1e-10]);
        rows.cross(&[&taps, &taps, &taps]).each(&[Scaled(-20, 10); 3])
    }),
    probe!(approx::sin_cos_turns, |rows| {
        let eighths: Vec<f32> = (-16..=16).map(|n| n as f32 * 0.125).collect();
        rows.cross(&[&[around(&eighths[..16]), around(&eighths[17..]), draws()].concat()])
            .random_of("turns", |d, row| row.push(range(d, 0.0, 1.0)))
            .random_of("turns, many", |d, row| row.push(range(d, -1e5, 1e5)))
    }),
];
