//! Elementary functions, colour and acuity: f32 kernels against f64, hard cases H30-H40 and H61-H65.

mod common;

use afterimage::kernel::{acuity, approx, color, scrub, wrs};
use approx_crate::assert_abs_diff_eq;
use common::Draws;
use glam::{DVec3, Vec3};
use proptest::prelude::*;

// The kernel has a module of the same name.
use ::approx as approx_crate;

fn ulps(a: f32, b: f64) -> f64 {
    let b32 = b as f32;
    let spacing = f64::from(f32::from_bits(b32.abs().to_bits() + 1)) - f64::from(b32.abs());
    (f64::from(a) - b).abs() / spacing
}

/// Logarithmic sweep over [low, high].
fn sweep(low: f64, high: f64, n: usize) -> impl Iterator<Item = f32> {
    (0..=n).map(move |i| (low * (high / low).powf(i as f64 / n as f64)) as f32)
}

// ---- f64 oracles -------------------------------------------------------------------------------------------------------

fn srgb_encode64(x: f64) -> f64 {
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

fn srgb_decode64(x: f64) -> f64 {
    if x <= 0.040_45 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}

fn lab64(c: DVec3) -> DVec3 {
    // BT.709 primaries and the white point x = 0.3127, y = 0.3290, solved in exact fractions.
    let x = 0.412_390_799_3 * c.x + 0.357_584_339_4 * c.y + 0.180_480_788_4 * c.z;
    let y = 0.212_639_005_9 * c.x + 0.715_168_678_8 * c.y + 0.072_192_315_4 * c.z;
    let z = 0.019_330_818_7 * c.x + 0.119_194_779_8 * c.y + 0.950_532_152_2 * c.z;
    let f = |t: f64| {
        if t > 216.0 / 24389.0 { t.cbrt() } else { (24389.0 / 27.0 * t + 16.0) / 116.0 }
    };
    let (fx, fy, fz) = (f(x / 0.950_455_927_1), f(y), f(z / 1.089_057_750_8));
    DVec3::new(116.0 * fy - 16.0, 500.0 * (fx - fy), 200.0 * (fy - fz))
}

fn delta_e94_64(r: DVec3, s: DVec3) -> f64 {
    let d = r - s;
    let c1 = r.y.hypot(r.z);
    let c2 = s.y.hypot(s.z);
    let dc = c1 - c2;
    let dh2 = (d.y * d.y + d.z * d.z - dc * dc).max(0.0);
    let (sc, sh) = (1.0 + 0.045 * c1, 1.0 + 0.015 * c1);
    (d.x * d.x + (dc / sc).powi(2) + dh2 / (sh * sh)).sqrt()
}

// ---- elementary functions ----------------------------------------------------------------------------------------------

#[test]
fn h38_cbrt_is_within_4_ulp_and_exact_at_0_and_1() {
    assert_eq!(color::cbrt(0.0).to_bits(), 0);
    assert_eq!(color::cbrt(1.0), 1.0);
    assert_eq!(color::cbrt(-1.0), -1.0);
    let worst = sweep(1e-30, 1e30, 400_000).map(|x| ulps(color::cbrt(x), f64::from(x).cbrt())).fold(0.0, f64::max);
    println!("cbrt: worst error {worst:.2} ulp");
    assert!(worst <= 2.0);
    // The planted error: one Halley step is not enough.
    let x = 0.3_f32;
    let r = f32::from_bits(x.to_bits() / 3 + 0x2a51_4067);
    let one_step = r - r * ((r * r * r - x) / (2.0 * r * r * r + x));
    assert!(ulps(one_step, f64::from(x).cbrt()) > 4.0);
}

#[test]
fn exp_exp2_and_ln_hold_their_stated_accuracy() {
    let worst_exp = (-870_000..880_000)
        .map(|i| i as f32 * 1e-4)
        .map(|x| (f64::from(approx::exp(x)) / f64::from(x).exp() - 1.0).abs())
        .fold(0.0, f64::max);
    let worst_ln = sweep(1.2e-38, 3.4e38, 400_000)
        .chain(sweep(0.5, 2.0, 100_000))
        .map(|x| {
            let exact = f64::from(x).ln();
            (f64::from(approx::ln(x)) - exact).abs() / exact.abs().max(0.5)
        })
        .fold(0.0, f64::max);
    let worst_exp2 = (-1_260_000..1_270_000)
        .map(|i| i as f32 * 1e-4)
        .map(|x| (f64::from(approx::exp2(x)) / f64::from(x).exp2() - 1.0).abs())
        .fold(0.0, f64::max);
    println!("exp: {worst_exp:.2e} relative, exp2: {worst_exp2:.2e} relative, ln: {worst_ln:.2e}");
    assert!(worst_exp < 2e-7 && worst_exp2 < 2e-7 && worst_ln < 2e-7);
    assert_eq!(approx::exp(0.0), 1.0);
    assert!((-126..=127).all(|n| approx::exp2(n as f32) == 2.0_f32.powi(n)));
    assert_eq!(approx::ln(1.0), 0.0);
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
    println!("atan2: worst error {worst:.2e} rad");
    assert!(worst < 3e-7);
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
    println!("srgb encode {:.2e}, decode {:.2e}, round trip {:.2e}", worst[0], worst[1], worst[2]);
    assert!(worst[0] < 6e-7 && worst[1] < 7e-7 && worst[2] < 1e-6);
    // All 256 codes survive the round trip.
    for code in 0..=255_u32 {
        let back = color::srgb_encode(color::srgb_decode(code as f32 / 255.0)) * 255.0;
        assert_eq!(back.round() as u32, code);
    }
    assert_eq!(color::srgb_encode(-0.5), -color::srgb_encode(0.5));
}

// ---- Lab and Delta E 94 ------------------------------------------------------------------------------------------------

#[test]
fn h40_delta_e94_matches_f64_on_published_pairs() {
    // Lab pairs of Sharma, Wu and Dalal (2004), and identities; Delta E 94 from the f64 formula.
    let pairs = [
        ([50.0, 2.6772, -79.7751], [50.0, 0.0, -82.7485]),
        ([50.0, -1.3802, -84.2814], [50.0, 0.0, -82.7485]),
        ([50.0, 2.49, -0.001], [50.0, -2.49, 0.0009]),
        ([50.0, 2.5, 0.0], [73.0, 25.0, -18.0]),
        ([60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387]),
        ([22.7233, 20.0904, -46.694], [23.0331, 14.973, -42.5619]),
        ([2.0776, 0.0795, -1.135], [0.9033, -0.0636, -0.5514]),
        ([0.0, 0.0, 0.0], [100.0, 0.0, 0.0]),
    ];
    for (a, b) in pairs {
        let exact = delta_e94_64(a.into(), b.into());
        let got = color::delta_e94(Vec3::from(a.map(|v| v as f32)), Vec3::from(b.map(|v| v as f32)));
        assert_abs_diff_eq!(f64::from(got), exact, epsilon = 1e-4);
    }
    // Hand calculation: dL = 3, dC = 4 at C1 = 0, so both weights are 1.
    assert_eq!(color::delta_e94(Vec3::new(50.0, 0.0, 0.0), Vec3::new(53.0, 4.0, 0.0)), 5.0);
}

#[test]
fn lab_matches_f64_and_white_is_100() {
    let white = color::lab(Vec3::ONE);
    assert_abs_diff_eq!(white.x, 100.0, epsilon = 1e-4);
    assert!(white.y.abs() < 1e-3 && white.z.abs() < 1e-3);
    let mut draws = Draws::new("lab");
    let mut worst = 0.0_f64;
    for _ in 0..100_000 {
        let c = Vec3::new(draws.uniform(), draws.uniform(), draws.uniform());
        worst = worst.max((color::lab(c).as_dvec3() - lab64(c.as_dvec3())).length());
    }
    println!("lab: worst distance to f64 {worst:.2e}");
    assert!(worst < 2e-4);
}

#[test]
fn h30_hue_term_never_makes_nan() {
    let mut draws = Draws::new("same hue");
    // How often the term under the root is negative before the clamp, and how often the whole sum under it would be.
    let (mut negative_term, mut negative_sum) = (0, 0);
    for i in 0..400_000 {
        let (l, a, b) = (draws.range(0.0, 100.0), draws.range(-80.0, 80.0), draws.range(-80.0, 80.0));
        // Half of the pairs differ in chroma, half by rounding alone.
        let s = if i % 2 == 0 { draws.range(0.1, 2.0) } else { 1.0 + draws.range(-4e-7, 4e-7) };
        let (x, y) = (Vec3::new(l, a, b), Vec3::new(l, a * s, b * s));
        let d = x - y;
        let c1 = (x.y * x.y + x.z * x.z).sqrt();
        let dc = c1 - (y.y * y.y + y.z * y.z).sqrt();
        let dh2 = d.y * d.y + d.z * d.z - dc * dc;
        let (sc, sh) = (1.0 + 0.045 * c1, 1.0 + 0.015 * c1);
        negative_term += usize::from(dh2 < 0.0);
        negative_sum += usize::from(dc * dc / (sc * sc) + dh2 / (sh * sh) < 0.0);
        assert!(color::delta_e94(x, y).is_finite());
    }
    println!("negative hue term in {negative_term} of 400000 pairs, negative sum in {negative_sum}");
    assert!(negative_term > 40_000 && negative_sum > 100, "the case must really occur");
}

#[test]
fn h31_greys_differ_by_lightness_alone() {
    assert_eq!(color::delta_e94(Vec3::new(40.0, 0.0, 0.0), Vec3::new(65.0, 0.0, 0.0)), 25.0);
    let near = color::delta_e94(Vec3::new(40.0, 1e-20, 0.0), Vec3::new(40.0, 0.0, 1e-20));
    assert!(near.is_finite());
}

#[test]
fn h32_the_candidate_is_the_reference() {
    let grey = Vec3::new(50.0, 0.0, 0.0);
    let vivid = Vec3::new(50.0, 100.0, 0.0);
    let ratio = color::delta_e94(grey, vivid) / color::delta_e94(vivid, grey);
    assert_abs_diff_eq!(ratio, 5.5, epsilon = 1e-3);
    let (a, b) = (Vec3::new(0.9, 0.1, 0.1), Vec3::new(0.3, 0.3, 0.3));
    assert_eq!(wrs::difference(a, b, wrs::GateCode::DeltaE94), color::delta_e94(color::lab(a), color::lab(b)),);
}

#[test]
fn h33_lab_is_continuous_at_its_knee() {
    let knee = 216.0_f32 / 24389.0;
    for y in [f32::from_bits(knee.to_bits() - 1), knee, f32::from_bits(knee.to_bits() + 1)] {
        assert_abs_diff_eq!(color::lab(Vec3::splat(y)).x, 8.0, epsilon = 2e-5);
    }
    // Slope of 903.3 from both sides, over steps wide enough for f32.
    for step in [-1e-4_f32, 1e-4] {
        let slope = (color::lab(Vec3::splat(knee + step)).x - color::lab(Vec3::splat(knee)).x) / step;
        assert_abs_diff_eq!(slope, 903.3, epsilon = 6.0);
    }
}

#[test]
fn h34_h35_dark_noise_and_8_bit_steps_pass_the_gate() {
    let differs = |a: f32, b: f32| wrs::difference(Vec3::splat(a), Vec3::splat(b), wrs::GateCode::DeltaE94);
    // L* of 0.002 is 1.8, of 1/255 is 3.54: neither shuts the default gate by more than that many percent, and an offset
    // of one 8-bit step leaves it fully open.
    assert_abs_diff_eq!(differs(0.0, 0.002), 1.81, epsilon = 0.01);
    assert_abs_diff_eq!(differs(0.0, 1.0 / 255.0), 3.54, epsilon = 0.01);
    assert!(wrs::gate(differs(0.0, 1.0 / 255.0), 0.0, 0.01) > 0.96);
    assert_eq!(wrs::gate(differs(0.0, 1.0 / 255.0), 3.6, 0.01), 1.0);
}

#[test]
fn h20_h37_strong_and_hdr_colours_stay_finite_and_clamp_the_gate() {
    let colours = [0.0, 1.0, 1e4, 65504.0, 1e30, -1.0, -65504.0, -1e30, f32::MAX, f32::MIN];
    let mut beyond_100 = false;
    for a in colours {
        for b in colours {
            for (x, y) in [(Vec3::splat(a), Vec3::splat(b)), (Vec3::new(a, b, 0.5), Vec3::new(b, 0.1, a))] {
                let d = wrs::difference(x, y, wrs::GateCode::DeltaE94);
                assert!(d.is_finite() && d >= 0.0, "{x} {y}: {d}");
                beyond_100 |= d > 100.0;
                let g = wrs::gate(d, 0.0, 0.01);
                assert!((0.0..=1.0).contains(&g));
            }
        }
    }
    assert!(beyond_100);
}

proptest! {
    #![proptest_config(common::property("kernel math 1", 1000))]
    #[test]
    fn h36_lab_is_finite_for_any_finite_colour(r in proptest::num::f32::ANY, g in proptest::num::f32::ANY, b in proptest::num::f32::ANY) {
        let (c, valid) = scrub::color(Vec3::new(r, g, b));
        prop_assert_eq!(valid, r.is_finite() && g.is_finite() && b.is_finite());
        prop_assert!(color::lab(c).is_finite());
        prop_assert!(c.abs().max_element() <= 65504.0);
    }

    #[test]
    fn h39_equal_colours_differ_by_exactly_0(r in -1e5f32..1e5, g in -1e5f32..1e5, b in -1e5f32..1e5) {
        let c = Vec3::new(r, g, b);
        prop_assert_eq!(wrs::difference(c, c, wrs::GateCode::DeltaE94).to_bits(), 0);
        prop_assert_eq!(color::delta_e94(color::lab(c), color::lab(c)).to_bits(), 0);
        prop_assert_eq!(wrs::gate(0.0, 0.0, 0.01), 1.0);
    }

    #[test]
    fn delta_e94_matches_f64(l1 in 0f32..100., a1 in -100f32..100., b1 in -100f32..100., l2 in 0f32..100., a2 in -100f32..100., b2 in -100f32..100.) {
        let (x, y) = (Vec3::new(l1, a1, b1), Vec3::new(l2, a2, b2));
        let exact = delta_e94_64(x.as_dvec3(), y.as_dvec3());
        // Near-equal hues lose half the digits of dH^2, whose root then shows.
        prop_assert!((f64::from(color::delta_e94(x, y)) - exact).abs() < 5e-2_f64.min(1e-4 * exact + 3e-2));
    }
}

// ---- scrub -------------------------------------------------------------------------------------------------------------

#[test]
fn h17_h18_bad_weights_count_as_0() {
    for bad in
        [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, -0.0, 0.0, f32::from_bits(1), f32::from_bits(0xffc0_0001)]
    {
        assert_eq!(scrub::weight(bad).to_bits(), 0);
    }
    for good in [f32::MIN_POSITIVE, 1e-20, 1.0, f32::MAX] {
        assert_eq!(scrub::weight(good), good);
    }
}

// ---- acuity ------------------------------------------------------------------------------------------------------------

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
            let got = f64::from(acuity::eccentricity_deg(ray32, gaze32)).to_radians();
            worst = worst.max((got - exact).abs());
            let by_acos = f64::from(ray32.normalize().dot(gaze32.normalize()).clamp(-1.0, 1.0).acos());
            worst_acos = worst_acos.max((by_acos - exact).abs());
        }
    }
    println!("eccentricity: worst error {worst:.2e} rad; by acos {worst_acos:.2e}");
    assert!(worst < 1e-6);
    assert!(worst_acos > 1e-5, "the planted error must show");
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
    println!("cell density: worst relative error {worst:.2e}");
    assert!(worst < 2e-6);
}

proptest! {
    #![proptest_config(common::property("kernel math 2", 1000))]
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
    assert_abs_diff_eq!(acuity::candidate_weight(90.0, 2.5, inv), 0.0013, epsilon = 1e-4);
}

#[test]
fn sin_cos_turns_holds_its_stated_accuracy_and_is_exact_at_the_quarters() {
    let error = |x: f32, [s, c]: [f32; 2]| {
        let angle = f64::from(x) * std::f64::consts::TAU;
        (f64::from(s) - angle.sin()).abs().max((f64::from(c) - angle.cos()).abs())
    };
    let turns = || (-400_000..=400_000).map(|i| i as f32 * 5e-6);
    let worst = turns().map(|x| error(x, approx::sin_cos_turns(x))).fold(0.0, f64::max);
    println!("sin_cos_turns: worst error {worst:.2e}");
    assert!(worst < 2e-7);
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
