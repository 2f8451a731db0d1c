//! Hard cases of color on the device: its results, equal to Rust's in every bit.

use super::probe::named;
use super::values::floats;
use super::{decisions, mathematics};
use afterimage::kernel::sanitize;
use afterimage::shader::SHADERS;
use afterimage_testing::Draws;
use afterimage_testing::holds;
use glam::Vec3;

/// Words of a function of some floats, as floats.
fn on_device(name: &str, rows: &[Vec<f32>]) -> Option<Vec<Vec<f32>>> {
    let probe = mathematics::PROBES.iter().find(|p| p.name == name);
    let rows: Vec<_> = rows.iter().map(|r| floats(r)).collect();
    let out = probe.unwrap_or_else(|| named(decisions::PROBES, name)).outputs(&rows)?;
    Some(out.into_iter().map(|o| o.into_iter().map(f32::from_bits).collect()).collect())
}

/// Delta E 94 of pairs of linear colors, as the gate computes it; the first is the reference.
fn differences(pairs: &[[[f32; 3]; 2]]) -> Option<Vec<f32>> {
    let row = |[a, b]: &[[f32; 3]; 2]| [floats(a), floats(b), vec![1]].concat();
    let out = named(decisions::PROBES, "difference").outputs(&pairs.iter().map(row).collect::<Vec<_>>())?;
    Some(out.iter().map(|o| f32::from_bits(o[0])).collect())
}

#[test]
fn h30_hue_term_never_makes_nan() {
    let mut draws = Draws::new("same hue on the device");
    let mut negative = 0;
    let rows: Vec<Vec<f32>> = (0..100_000)
        .map(|_| {
            let (l, a, b) = (draws.range(0.0, 100.0), draws.range(-80.0, 80.0), draws.range(-80.0, 80.0));
            let s = draws.range(0.1, 2.0);
            let dc = a.hypot(b) - (a * s).hypot(b * s);
            negative += u32::from((a - a * s).powi(2) + (b - b * s).powi(2) - dc * dc < 0.0);
            vec![l, a, b, l, a * s, b * s]
        })
        .collect();
    let Some(out) = on_device("delta_e94", &rows) else { return };
    assert!(negative > 20_000 && out.iter().all(|o| o[0].is_finite() && o[0] >= 0.0));
    holds!("H30", Gpu, "no NaN in 100,000 same-hue pairs, the term negative in {} %", negative / 1000);
}

#[test]
fn h31_greys_differ_by_lightness_alone() {
    let heights: Vec<f32> = (0..=60).map(|e| 2.0_f32.powi(e - 60)).collect();
    let rows: Vec<_> = heights.iter().map(|&h| vec![40.0, 0.0, 0.0, 40.0, h, 0.0]).collect();
    let Some(out) = on_device("delta_e94", &rows) else { return };
    let slope = out.iter().zip(&heights).map(|(o, h)| (o[0] / h - 1.0).abs()).fold(0.0, f32::max);
    assert!(slope < 1e-6, "{slope}");
    let greys = on_device("delta_e94", &[vec![40.0, 0.0, 0.0, 65.0, 0.0, 0.0]]).unwrap();
    assert_eq!(greys[0][0], 25.0);
    holds!("H31", Gpu, "25 for L* 40 and 65; slope 1 within {slope:e} for chroma 2^-60 to 1");
}

#[test]
fn h33_lab_is_continuous_at_its_knee() {
    let knee = 216.0_f32 / 24389.0;
    let levels = [knee.next_down(), knee, knee.next_up(), knee - 1e-5, knee + 1e-5];
    let Some(out) = on_device("lab", &levels.map(|y| vec![y; 3])) else { return };
    let l: Vec<f32> = out.iter().map(|o| o[0]).collect();
    assert!(l[..3].iter().all(|l| (l - 8.0).abs() < 2e-5), "{l:?}");
    let slopes = [(l[1] - l[3]) / (levels[1] - levels[3]), (l[4] - l[1]) / (levels[4] - levels[1])];
    assert!((slopes[0] - 903.3).abs() < 0.3 && (slopes[1] - 903.0).abs() < 0.3, "{slopes:?}");
    holds!("H33", Gpu, "L* {} at the knee; slopes {:.1} and {:.1}", l[1], slopes[0], slopes[1]);
}

#[test]
fn h36_h37_negative_and_hdr_colors_give_finite_numbers() {
    // As the passes get them.
    let sanitized = |x: f32| sanitize::color(Vec3::splat(x)).0.x;
    let values = [0.0, -0.0, -1e-30, -1e-3, -1.0, 1.0, 1e4, 65504.0, -65504.0, 1e30, -1e30, f32::MAX, f32::MIN];
    let values = values.map(sanitized);
    let mut pairs = vec![];
    for a in values {
        for b in values {
            pairs.extend([[[a; 3], [b; 3]], [[a, b, 0.5], [b, 0.1, a]]]);
        }
    }
    let Some(out) = differences(&pairs) else { return };
    assert!(out.iter().all(|d| d.is_finite() && *d >= 0.0));
    let most = out.iter().copied().fold(0.0, f32::max);
    let l = on_device("lab", &[1e4, 65504.0, 1e30].map(|x| vec![sanitized(x); 3])).unwrap();
    assert_eq!(l[1], l[2], "saturates");
    holds!("H36", Gpu, "no NaN in {} pairs of negative and other colors", pairs.len());
    holds!("H37", Gpu, "L* {:.0} at 1e4, {:.0} at 65504 and 1e30; Delta E at most {most:.2e}", l[0][0], l[1][0]);
}

#[test]
fn h38_cbrt_is_within_4_ulp_and_no_power_is_called() {
    let rows: Vec<_> = (0..=100_000).map(|i| vec![(1e-30 * 1e60_f64.powf(f64::from(i) / 1e5)) as f32]).collect();
    let Some(out) = on_device("cbrt", &rows) else { return };
    let worst = rows.iter().zip(&out).fold(0.0_f64, |worst, (x, y)| {
        let exact = f64::from(x[0]).cbrt();
        let spacing = f64::from((exact as f32).next_up()) - f64::from(exact as f32);
        worst.max((f64::from(y[0]) - exact).abs() / spacing)
    });
    assert!(worst <= 4.0, "{worst}");
    assert_eq!(on_device("cbrt", &[vec![0.0], vec![1.0], vec![-1.0]]).unwrap(), [[0.0], [1.0], [-1.0]]);
    // The accuracy of the device's own powers and logarithms is implementation-defined.
    for pass in ["wrs_pass", "smr_pass", "taa_pass"] {
        let source = SHADERS.compose(pass).source;
        let code: String = source.lines().map(|l| l.split("//").next().unwrap()).collect::<Vec<_>>().join("\n");
        let called = |name: &str| {
            code.match_indices(name).any(|(i, _)| !code[..i].ends_with(|c: char| c.is_alphanumeric() || c == '_'))
        };
        assert!(!["pow(", "log2(", "log("].into_iter().any(called), "{pass}");
        assert!(called("cbrt(") || pass != "wrs_pass");
    }
    holds!("H38", Gpu, "worst error {worst:.2} ulp over 1e-30 to 1e30, exact at 0 and +-1; no pow in any pass");
}

#[test]
fn h39_equal_colors_differ_by_exactly_0() {
    let mut draws = Draws::new("equal on the device");
    let mut value = || loop {
        let x = f32::from_bits(draws.bits());
        if x.is_finite() {
            return x;
        }
    };
    let colors: Vec<[f32; 3]> = (0..50_000).map(|_| [value(), value(), value()]).collect();
    let Some(out) = differences(&colors.iter().map(|&c| [c, c]).collect::<Vec<_>>()) else { return };
    assert!(out.iter().all(|d| d.to_bits() == 0));
    let gates = on_device("gate", &[vec![0.0, 0.0, 0.01], vec![0.0, 2.3, 1e6]]).unwrap();
    assert_eq!(gates, [[1.0], [1.0]]);
    holds!("H39", Gpu, "exactly 0 for {} colors of any finite bits, factor exactly 1", colors.len());
}
