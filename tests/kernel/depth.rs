//! Depth test: hard cases H41-H45, H48 and H49 on the depth kernel.

use afterimage::DepthConvention as Depth;
use afterimage::kernel::depth;
use afterimage::kernel::pack::{disparity_code, disparity_value, half_bits, half_value};
use afterimage_testing::holds;
use proptest::prelude::*;

const CONVENTIONS: [(&str, Depth); 8] = [
    ("linear", Depth::Linear),
    ("forward", Depth::Forward { near: 0.1, far: 1000.0 }),
    ("forward, infinite", Depth::Forward { near: 0.1, far: f32::INFINITY }),
    ("reversed", Depth::Reversed { near: 0.1, far: 1000.0 }),
    ("reversed, infinite", Depth::Reversed { near: 0.1, far: f32::INFINITY }),
    ("reversed, close near plane", Depth::Reversed { near: 0.01, far: 1e5 }),
    ("orthographic", Depth::Orthographic { near: 0.5, far: 1000.0 }),
    ("orthographic from behind", Depth::Orthographic { near: -10.0, far: 1000.0 }),
];

/// Value that a depth buffer of the convention stores for distance `z`, in f64.
fn stored(convention: Depth, z: f64) -> f64 {
    match convention {
        Depth::Linear => z,
        Depth::Forward { near, far } => {
            let (n, f) = (f64::from(near), f64::from(far));
            if f.is_infinite() { 1.0 - n / z } else { f / (f - n) * (1.0 - n / z) }
        }
        Depth::Reversed { near, far } => 1.0 - stored(Depth::Forward { near, far }, z),
        Depth::Orthographic { near, far } => (z - f64::from(near)) / f64::from(far - near),
        other => panic!("{other:?}: a convention that this test does not know"),
    }
}

fn same(a: f32, b: f32) -> bool {
    depth::same_surface(a, b, 0.02, 0.0)
}

#[test]
fn every_convention_gives_the_disparity() {
    for (name, convention) in CONVENTIONS {
        convention.validate().unwrap();
        let map = convention.disparity_map();
        for z in [1.0, 2.5, 10.0, 80.0, 400.0] {
            let got = f64::from(depth::disparity(stored(convention, z) as f32, map));
            // A forward buffer stores 24 bits of 1 - near / z, few of which distinguish large distances.
            let rounding = if name.starts_with("forward") { 1e-6 * z } else { 1e-5 };
            assert!((got * z - 1.0).abs() < rounding.max(2e-6), "{name}, z = {z}: {got}");
        }
    }
}

proptest! {
    #![proptest_config(afterimage_testing::property("depth", 4000))]

    #[test]
    fn h45_a_dolly_is_predicted(z in 1.5f32..100., rx in -0.9f32..0.9, ry in -0.6f32..0.6, step in -1f32..1.) {
        // The camera drives `step` towards the wall: what is at z now was at z + step.
        let now = 1.0 / z;
        let expected = depth::previous_disparity(now, 1.0, step);
        prop_assert!((expected * (z + step) - 1.0).abs() < 1e-5);
        prop_assert!(same(expected, disparity_value(disparity_code(1.0 / (z + step)))));
        // A camera that also turned: stretch = m20 rx + m21 ry + m22.
        let stretch = 0.1 * rx - 0.05 * ry + 0.99;
        let z_previous = z * stretch + step;
        if z_previous > 0.1 {
            prop_assert!((depth::previous_disparity(now, stretch, step) * z_previous - 1.0).abs() < 1e-4);
        }
        // Without the prediction, history is rejected for a metre at three metres.
        if z < 3.0 && step > 0.9 {
            prop_assert!(!same(now, 1.0 / (z + step)));
        }
    }
}

#[test]
fn h42_values_just_outside_the_buffer_s_range_are_clamped() {
    let map = Depth::Reversed { near: 0.1, far: 1000.0 }.disparity_map();
    assert_eq!(depth::disparity(1.0 + 1e-6, map), depth::disparity(1.0, map));
    assert_eq!(depth::disparity(-1e-6, map), depth::disparity(0.0, map));
    assert!((depth::disparity(1.0, map) - 10.0).abs() < 1e-5);
    let mut worst = 0.0_f32;
    for (name, convention) in CONVENTIONS.into_iter().filter(|(_, c)| c.disparity_map().clamp) {
        let d = |v: f32| depth::disparity(v, convention.disparity_map());
        for beyond in [f32::EPSILON, 1e-6, 1e-3, 1e30, f32::INFINITY] {
            assert_eq!((d(1.0 + beyond), d(-beyond)), (d(1.0), d(0.0)), "{name}, by {beyond}");
        }
        worst = worst.max(d(0.0)).max(d(1.0));
    }
    assert!(worst.is_finite());
    holds!("H42", Cpu, "7 encodings, by 1 ulp to infinity beyond either end: as at the end; at the most {worst} / m");
}

#[test]
fn h43_half_float_depth_neither_rejects_nor_accepts_for_ever() {
    let half = |v: f32| half_value(half_bits(v));
    let step = |v: f32| half_value(half_bits(v) + 1) - half(v);
    assert_eq!((step(100.0), step(1000.0)), (0.0625, 0.5));
    // One step of the half either way, as noise and jitter of the depth sample make it, is the same surface; 3 %
    // further is not.
    let farthest = |stored: fn(f32) -> f32, convention: Depth| {
        let map = convention.disparity_map();
        let read = |bits: u32| depth::disparity(half_value(bits), map);
        let distances = (0..50_000).map(|i| 10_f32.powf(5.0 * i as f32 / 50_000.0));
        let bad = distances.clone().find(|&z| {
            let bits = half_bits(stored(z));
            let stored_disparity = disparity_value(disparity_code(read(bits)));
            let still = [bits - 1, bits, bits + 1].into_iter().all(|b| same(read(b), stored_disparity));
            let other = [0.97, 1.03].into_iter().any(|k| same(read(half_bits(stored(z * k))), stored_disparity));
            !still || other
        });
        bad.unwrap_or(1e5)
    };
    let linear_m = farthest(|z| z, Depth::Linear);
    let reversed_m = farthest(|z| 0.1 / z, Depth::Reversed { near: 0.1, far: f32::INFINITY });
    println!("linear halves tell surfaces apart up to {linear_m} m, reversed ones up to {reversed_m} m");
    // The largest half is 65504: what is further is the sky, which is the same as itself and no object.
    assert!(linear_m * 1.03 > 65504.0 && reversed_m > 10_000.0);
    let sky = depth::disparity(f32::INFINITY, Depth::Linear.disparity_map());
    assert!(same(sky, disparity_value(disparity_code(sky))));
    assert!(!same(depth::disparity(65504.0, Depth::Linear.disparity_map()), disparity_value(disparity_code(sky))));
    let (linear_km, reversed_km) = (linear_m / 1000.0, reversed_m / 1000.0);
    holds!(
        "H43",
        Cpu,
        "steps of 6.25 cm at 100 m, 0.5 m at 1 km; 1 step is never rejected, 3 % always, to {linear_km:.1} km (reversed {reversed_km:.1})"
    );
}

#[test]
fn a_silhouette_is_not_slope() {
    // Object (disparity 1) left of background (0.1): on both sides the slope along x is 0.
    let step = |x: u32, _: u32| if x < 4 { 1.0 } else { 0.1 };
    assert_eq!(depth::slope(3, 1, [9, 3], step), 0.0);
    assert_eq!(depth::slope(4, 1, [9, 3], step), 0.0);
    // A wire, and a single pixel, do not count as slope either.
    assert_eq!(depth::slope(4, 1, [9, 3], |x, _| if x == 4 { 1.0 } else { 0.1 }), 0.0);
    assert_eq!(depth::slope(4, 1, [9, 3], |x, y| if (x, y) == (4, 1) { 0.1 } else { 1.0 }), 0.0);
    // Invalid neighbours and borders are ignored.
    assert_eq!(depth::slope(0, 0, [1, 1], |_, _| 0.5), 0.0);
    assert_eq!(depth::slope(1, 0, [3, 1], |x, _| if x == 1 { 0.5 } else { -1.0 }), 0.0);
}

#[test]
fn bad_planes_are_refused() {
    for bad in [
        Depth::Forward { near: 0.0, far: 1.0 },
        Depth::Reversed { near: 1.0, far: 0.5 },
        Depth::Reversed { near: f32::NAN, far: 1.0 },
        Depth::Forward { near: 1.0, far: f32::NAN },
        Depth::Orthographic { near: 0.0, far: f32::INFINITY },
    ] {
        let message = bad.validate().unwrap_err().to_string();
        assert!(message.contains("near"), "{message}");
    }
}
