//! Lab and Delta E 94 against f64 and published values.

use super::*;
use afterimage_testing::holds;

#[test]
fn lab_matches_f64_and_white_is_100() {
    let white = lab::lab(Vec3::ONE);
    assert_abs_diff_eq!(white.x, 100.0, epsilon = 1e-4);
    assert!(white.y.abs() < 1e-3 && white.z.abs() < 1e-3);
    let mut draws = Draws::new("lab");
    let mut worst = 0.0_f64;
    for _ in 0..100_000 {
        let c = Vec3::new(draws.uniform(), draws.uniform(), draws.uniform());
        worst = worst.max((lab::lab(c).as_dvec3() - lab64(c.as_dvec3())).length());
    }
    assert!(worst < 2e-4, "lab: worst distance to f64 {worst:.2e}");
}

#[test]
fn h32_the_candidate_is_the_reference() {
    let labs: Vec<Vec3> = srgb_grid().into_iter().map(lab::lab).collect();
    let mut most = 0.0_f32;
    for &grey in labs.iter().filter(|l| l.y.hypot(l.z) < 0.1) {
        for &vivid in &labs {
            let back = lab::delta_e94(vivid, grey);
            // Of clearly different colors.
            most = if back > 2.0 { most.max(lab::delta_e94(grey, vivid) / back) } else { most };
        }
    }
    let (grey, vivid) = (Vec3::new(50.0, 0.0, 0.0), Vec3::new(50.0, 100.0, 0.0));
    let ratio = lab::delta_e94(grey, vivid) / lab::delta_e94(vivid, grey);
    assert_abs_diff_eq!(ratio, 5.5, epsilon = 1e-3);
    assert!((6.0..7.1).contains(&most), "{most}");
    let (a, b) = (Vec3::new(0.9, 0.1, 0.1), Vec3::new(0.3, 0.3, 0.3));
    let reference_first = lab::delta_e94(lab::lab(a), lab::lab(b));
    assert_eq!(wrs::difference(a, b, DELTA_E), reference_first);
    assert_ne!(wrs::difference(b, a, DELTA_E), reference_first);
    holds!("H32", Cpu, "up to {most:.2}x apart in sRGB; the candidate is the reference");
}

/// Lab pairs 1 to 34 of Sharma, Wu and Dalal, "The CIEDE2000 color-difference formula", 2005, table 1.
const SHARMA: [[[f64; 3]; 2]; 34] = [
    [[50.0, 2.6772, -79.7751], [50.0, 0.0, -82.7485]],
    [[50.0, 3.1571, -77.2803], [50.0, 0.0, -82.7485]],
    [[50.0, 2.8361, -74.02], [50.0, 0.0, -82.7485]],
    [[50.0, -1.3802, -84.2814], [50.0, 0.0, -82.7485]],
    [[50.0, -1.1848, -84.8006], [50.0, 0.0, -82.7485]],
    [[50.0, -0.9009, -85.5211], [50.0, 0.0, -82.7485]],
    [[50.0, 0.0, 0.0], [50.0, -1.0, 2.0]],
    [[50.0, -1.0, 2.0], [50.0, 0.0, 0.0]],
    [[50.0, 2.49, -0.001], [50.0, -2.49, 0.0009]],
    [[50.0, 2.49, -0.001], [50.0, -2.49, 0.001]],
    [[50.0, 2.49, -0.001], [50.0, -2.49, 0.0011]],
    [[50.0, 2.49, -0.001], [50.0, -2.49, 0.0012]],
    [[50.0, -0.001, 2.49], [50.0, 0.0009, -2.49]],
    [[50.0, -0.001, 2.49], [50.0, 0.001, -2.49]],
    [[50.0, -0.001, 2.49], [50.0, 0.0011, -2.49]],
    [[50.0, 2.5, 0.0], [50.0, 0.0, -2.5]],
    [[50.0, 2.5, 0.0], [73.0, 25.0, -18.0]],
    [[50.0, 2.5, 0.0], [61.0, -5.0, 29.0]],
    [[50.0, 2.5, 0.0], [56.0, -27.0, -3.0]],
    [[50.0, 2.5, 0.0], [58.0, 24.0, 15.0]],
    [[50.0, 2.5, 0.0], [50.0, 3.1736, 0.5854]],
    [[50.0, 2.5, 0.0], [50.0, 3.2972, 0.0]],
    [[50.0, 2.5, 0.0], [50.0, 1.8634, 0.5757]],
    [[50.0, 2.5, 0.0], [50.0, 3.2592, 0.335]],
    [[60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387]],
    [[63.0109, -31.0961, -5.8663], [62.8187, -29.7946, -4.0864]],
    [[61.2901, 3.7196, -5.3901], [61.4292, 2.248, -4.962]],
    [[35.0831, -44.1164, 3.7933], [35.0232, -40.0716, 1.5901]],
    [[22.7233, 20.0904, -46.694], [23.0331, 14.973, -42.5619]],
    [[36.4612, 47.858, 18.3852], [36.2715, 50.5065, 21.2231]],
    [[90.8027, -2.0831, 1.441], [91.1528, -1.6435, 0.0447]],
    [[90.9257, -0.5406, -0.9208], [88.6381, -0.8985, -0.7239]],
    [[6.7747, -0.2908, -2.4247], [5.8714, -0.0985, -2.2286]],
    [[2.0776, 0.0795, -1.135], [0.9033, -0.0636, -0.5514]],
];

#[test]
fn h40_delta_e94_matches_f64_and_published_values() {
    let of = |a: [f64; 3], b: [f64; 3]| lab::delta_e94(DVec3::from(a).as_vec3(), DVec3::from(b).as_vec3());
    let mut worst = 0.0_f64;
    for [a, b] in SHARMA {
        for (a, b) in [(a, b), (b, a)] {
            worst = worst.max((f64::from(of(a, b)) - delta_e94_64(a.into(), b.into())).abs());
            assert_eq!(of(a, a), 0.0);
        }
    }
    // Values of Lindbloom's calculator of color differences (brucelindbloom.com), graphic arts.
    for (a, b, published) in [
        ([0.0, 0.0, 0.0], [0.0, 0.0, 0.0], 0.0),
        ([100.0, 0.0, 0.0], [0.0, 0.0, 0.0], 100.0),
        ([100.0, -50.0, 50.0], [20.0, 10.0, -20.0], 89.358_114),
        ([10.3454, 3.2151, -189.123], [51.7781, -22.5151, 1.0001], 51.361_909),
    ] {
        worst = worst.max((f64::from(of(a, b)) - published).abs());
    }
    assert!(worst < 1e-4, "{worst:e}");
    // Hand calculation: dL = 3, dC = 4 at C1 = 0, so both weights are 1.
    assert_eq!(of([50.0, 0.0, 0.0], [53.0, 4.0, 0.0]), 5.0);
    holds!("H40", Cpu, "{worst:.1e} at most from f64 and from published values, 34 pairs both ways");
}
