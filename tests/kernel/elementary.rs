//! Elementary functions, sRGB and acuity: f32 kernels against f64, hard cases H17, H18 and H61-H65.

use afterimage::kernel::{acuity, approx, color, lens};
use afterimage_testing::holds;
use approx_crate::assert_abs_diff_eq;
use glam::DVec3;
use proptest::prelude::*;

// The kernel has a module of the same name.
use ::approx as approx_crate;

/// Logarithmic sweep over [low, high].
fn sweep(low: f64, high: f64, n: usize) -> impl Iterator<Item = f32> {
    (0..=n).map(move |i| (low * (high / low).powf(i as f64 / n as f64)) as f32)
}

fn srgb_encode64(x: f64) -> f64 {
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

fn srgb_decode64(x: f64) -> f64 {
    if x <= 0.040_45 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}

/// Largest error over some values.
fn worst(values: impl Iterator<Item = f32>, error: impl Fn(f32) -> f64) -> f64 {
    values.map(error).fold(0.0, f64::max)
}

/// Of a value against an exact one.
fn relative(value: f32, exact: f64) -> f64 {
    (f64::from(value) / exact - 1.0).abs()
}

#[test]
fn exp_exp2_and_ln_hold_their_stated_accuracy() {
    let thousandths = |range: std::ops::Range<i32>| range.map(|i| i as f32 / 1e3);
    let worst_exp = worst(thousandths(-87_000..88_000), |x| relative(approx::exp_approx(x), f64::from(x).exp()));
    let worst_exp2 = worst(thousandths(-126_000..127_000), |x| relative(approx::exp2_approx(x), f64::from(x).exp2()));
    let worst_ln = worst(sweep(1.2e-38, 3.4e38, 100_000).chain(sweep(0.5, 2.0, 100_000)), |x| {
        let exact = f64::from(x).ln();
        (f64::from(approx::ln_approx(x)) - exact).abs() / exact.abs().max(0.5)
    });
    assert!(
        worst_exp < 2e-7 && worst_exp2 < 2e-7 && worst_ln < 2e-7,
        "exp: {worst_exp:.2e} relative, exp2: {worst_exp2:.2e} relative, ln: {worst_ln:.2e}"
    );
    assert_eq!(approx::exp_approx(0.0), 1.0);
    assert!((-126..=127).all(|n| approx::exp2_approx(n as f32) == 2.0_f32.powi(n)));
    assert_eq!(approx::ln_approx(1.0), 0.0);
}

#[test]
fn atan2_is_within_its_stated_error_all_around() {
    let mut worst = 0.0_f64;
    for i in 0..=100_000 {
        let angle = f64::from(i) * std::f64::consts::PI / 100_000.0;
        for radius in [1e-15_f64, 1.0, 1e15] {
            let (y, x) = ((radius * angle.sin()) as f32, (radius * angle.cos()) as f32);
            let exact = f64::from(y.max(0.0)).atan2(f64::from(x));
            worst = worst.max((f64::from(approx::atan2_upper(y.max(0.0), x)) - exact).abs());
        }
    }
    assert!(worst < 3e-7, "atan2: worst error {worst:.2e} rad");
    assert_eq!(approx::atan2_upper(0.0, 0.0), 0.0);
}

#[test]
fn srgb_transfer_holds_its_stated_accuracy_and_inverts() {
    let mut worst = [0.0_f64; 3];
    for i in 0..=1_000_000 {
        let x = i as f32 / 1_000_000.0;
        let (encoded, decoded) = (color::srgb_encode(x), color::srgb_decode(x));
        if i > 0 {
            worst[0] = worst[0].max((f64::from(encoded) / srgb_encode64(f64::from(x)) - 1.0).abs());
            worst[1] = worst[1].max((f64::from(decoded) / srgb_decode64(f64::from(x)) - 1.0).abs());
        }
        worst[2] = worst[2].max(f64::from((color::srgb_decode(encoded) - x).abs()));
    }
    assert!(
        worst[0] < 6e-7 && worst[1] < 7e-7 && worst[2] < 1e-6,
        "srgb encode {:.2e}, decode {:.2e}, round trip {:.2e}",
        worst[0],
        worst[1],
        worst[2]
    );
    // All 256 codes survive the round trip.
    for code in 0..=255_u32 {
        let back = color::srgb_encode(color::srgb_decode(code as f32 / 255.0)) * 255.0;
        assert_eq!(back.round() as u32, code);
    }
    assert_eq!(color::srgb_encode(-0.5), -color::srgb_encode(0.5));
}

#[test]
fn h61_eccentricity_is_exact_where_acos_reads_0() {
    let mut worst = 0.0_f64;
    let mut worst_acos = 0.0_f64;
    for e in sweep(1e-5, 179.9, 20_000) {
        let angle = f64::from(e).to_radians();
        for roll in [0.0_f64, 0.7, 2.0, 4.0] {
            let gaze = DVec3::new(0.3, -0.2, 1.0).normalize();
            let side = gaze.cross(DVec3::X).normalize();
            let up = gaze.cross(side);
            let ray = gaze * angle.cos() + (side * roll.cos() + up * roll.sin()) * angle.sin();
            let (ray32, gaze32) = (ray.as_vec3() * 3.0, gaze.as_vec3() * 0.5);
            let (r, g) = (ray32.as_dvec3(), gaze32.as_dvec3());
            let exact = r.cross(g).length().atan2(r.dot(g));
            let got = f64::from(lens::eccentricity_deg(ray32, gaze32)).to_radians();
            worst = worst.max((got - exact).abs());
            let by_acos = f64::from(ray32.normalize().dot(gaze32.normalize()).clamp(-1.0, 1.0).acos());
            worst_acos = worst_acos.max((by_acos - exact).abs());
        }
    }
    assert!(worst < 1e-6, "eccentricity: worst error {worst:.2e} rad; by acos {worst_acos:.2e}");
    assert!(worst_acos > 1e-5, "the planted error must show");
    holds!(
        "H61",
        Cpu,
        "80000 pairs of rays, 1e-5 to 179.9 degrees: off by {worst:.1e} rad at the most; by acos {worst_acos:.1e}"
    );
}

#[test]
fn p7_weight_matches_the_paper_s_table_and_f64() {
    let inv = 1.0 / acuity::cell_density(2.5);
    let table = [
        (3.0, 0.787),
        (4.0, 0.535),
        (5.0, 0.395),
        (7.5, 0.229),
        (10.0, 0.157),
        (15.0, 0.092),
        (20.0, 0.061),
        (30.0, 0.030),
        (35.0, 0.022),
    ];
    for (e, w) in table {
        assert_abs_diff_eq!(acuity::candidate_weight(e, 2.5, inv), w, epsilon = 6e-4);
    }
    let density64 = |e: f64| {
        2.0 * 14804.6 / (1.0 + e / 41.03) * (0.9851 * (1.0 + e / 1.058).powi(-2) + (1.0 - 0.9851) * (-e / 22.14).exp())
    };
    let worst = sweep(1e-3, 180.0, 50_000)
        .map(|e| (f64::from(acuity::cell_density(e)) / density64(f64::from(e)) - 1.0).abs())
        .fold(0.0, f64::max);
    assert!(worst < 2e-6, "cell density: worst relative error {worst:.2e}");
}

proptest! {
    #![proptest_config(afterimage_testing::property("kernel math 2", 1000))]
    #[test]
    fn p7_h64_h65_weight_is_1_inside_then_falls_and_stays_positive(r_f in 0f32..20., e in 0f32..180., step in 1e-2f32..10.) {
        let inv = 1.0 / acuity::cell_density(r_f);
        let w = |e: f32| acuity::candidate_weight(e, r_f, inv);
        prop_assert_eq!(w(r_f), 1.0);
        prop_assert_eq!(w(0.5 * r_f), 1.0);
        prop_assert!((w(r_f * (1.0 + 1e-5) + 1e-6) - 1.0).abs() < 1e-3, "continuous at the fovea's edge");
        prop_assert!(w(e) > 0.0 && w(e) <= 1.0);
        if r_f >= 1.0 && e <= 110.0 {
            prop_assert!(w(e) > 6.1e-5, "above a half's smallest normal");
        }
        if e > r_f {
            prop_assert!(w(e + step) < w(e));
        }
    }
}

#[test]
fn h65_weight_at_90_degrees_has_its_floor() {
    let inv = 1.0 / acuity::cell_density(2.5);
    let at = |e: f32| acuity::candidate_weight(e, 2.5, inv);
    assert_abs_diff_eq!(at(90.0), 0.0013, epsilon = 1e-4);
    // Down to straight behind, a sum of weights is a normal half from its first frame on.
    let least = (0..=90_000).map(|i| at(90.0 + i as f32 * 1e-3)).fold(f32::MAX, f32::min);
    assert!(least > 6.104e-5, "{least}");
    let sum = afterimage::kernel::pack::half_value(afterimage::kernel::pack::half_bits(least));
    assert!((sum / least - 1.0).abs() < 1e-3);
    holds!("H65", Cpu, "w(90) = {:.5}, w(180) = {least:.2e}: above a half's least normal, 6.1e-5", at(90.0));
}

#[test]
fn h64_a_fovea_of_nothing_has_weight_1_at_the_gaze_point_alone() {
    let inv = 1.0 / acuity::cell_density(0.0);
    let w = |e: f32| acuity::candidate_weight(e, 0.0, inv);
    assert_eq!(w(0.0), 1.0);
    // To the precision of f32 near a weight of 1, which falls by 2 / 1.058 a degree.
    let nearest = (0..1000).map(|i| 1e-9 * 1.02_f32.powi(i)).find(|&e| w(e) < 1.0).unwrap();
    assert!(nearest < 2e-7, "{nearest}");
    assert!((0..=180_000).all(|i| w(i as f32 * 1e-3).is_normal() && (i == 0 || w(i as f32 * 1e-3) < 1.0)));
    holds!("H64", Cpu, "w(0) = 1, below 1 from {nearest:.1e} degrees on; finite and normal to 180 degrees");
}

#[test]
fn sin_cos_turns_holds_its_stated_accuracy_and_is_exact_at_the_quarters() {
    let error = |x: f32, [s, c]: [f32; 2]| {
        let angle = f64::from(x) * std::f64::consts::TAU;
        (f64::from(s) - angle.sin()).abs().max((f64::from(c) - angle.cos()).abs())
    };
    let turns = || (-400_000..=400_000).map(|i| i as f32 * 5e-6);
    let worst = turns().map(|x| error(x, approx::sin_cos_turns(x))).fold(0.0, f64::max);
    assert!(worst < 2e-7, "sin_cos_turns: worst error {worst:.2e}");
    for (x, exact) in [(0.0, [0.0, 1.0]), (0.25, [1.0, 0.0]), (0.5, [0.0, -1.0]), (0.75, [-1.0, 0.0])] {
        assert_eq!(approx::sin_cos_turns(x), exact);
    }
    // The planted error: one term fewer of the sine.
    let short = |r: f32| {
        let z = r * r;
        [((81.593_765 * z - 41.341_67) * z + 6.283_185_5) * r, (r * std::f32::consts::TAU).cos()]
    };
    assert!(error(0.12, short(0.12)) > 1e-6);
}
