//! Same surface or not: hard cases H41-H50 on the depth kernel and the pass.

mod common;

use afterimage::convention::DepthConvention as Depth;
use afterimage::kernel::depth;
use afterimage::kernel::pack::{disparity_code, disparity_value};
use afterimage::kernel::reproject::{self, Verdict};
use common::Draws;
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

/// What a depth buffer of the convention stores for distance `z`, in f64.
fn stored(convention: Depth, z: f64) -> f64 {
    match convention {
        Depth::Linear => z,
        Depth::Forward { near, far } => {
            let (n, f) = (f64::from(near), f64::from(far));
            if f.is_infinite() { 1.0 - n / z } else { f / (f - n) * (1.0 - n / z) }
        }
        Depth::Reversed { near, far } => 1.0 - stored(Depth::Forward { near, far }, z),
        Depth::Orthographic { near, far } => (z - f64::from(near)) / f64::from(far - near),
    }
}

/// Distance that a stored value stands for, in conventions that store distances.
fn stored64(convention: Depth, value: f32) -> f64 {
    match convention {
        Depth::Orthographic { near, far } => f64::from(near) + f64::from(value.clamp(0.0, 1.0)) * f64::from(far - near),
        _ => f64::from(value),
    }
}

fn invertible(convention: Depth) -> bool {
    matches!(convention, Depth::Linear | Depth::Orthographic { .. })
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
            // A forward buffer holds 24 bits of 1 - near / z: far away little is left of them.
            let rounding = if name.starts_with("forward") { 1e-6 * z } else { 1e-5 };
            assert!((got * z - 1.0).abs() < rounding.max(2e-6), "{name}, z = {z}: {got}");
        }
    }
}

#[test]
fn h41_the_sky_is_the_same_sky_and_never_an_object() {
    let sky = [
        (Depth::Linear, f32::INFINITY),
        (Depth::Linear, 1e38),
        (Depth::Forward { near: 0.1, far: f32::INFINITY }, 1.0),
        (Depth::Reversed { near: 0.1, far: f32::INFINITY }, 0.0),
    ];
    for (convention, value) in sky {
        let d = depth::disparity(value, convention.disparity_map());
        assert_eq!(d, 0.0, "{convention:?}");
        let remembered = disparity_value(disparity_code(d));
        assert!(same(d, remembered));
        for z in [0.1, 1.0, 1e3, 1e6] {
            let object = depth::disparity(stored(convention, z) as f32, convention.disparity_map());
            if object > 0.0 {
                assert!(!same(object, remembered) && !same(d, disparity_value(disparity_code(object))));
            }
        }
    }
    // With a finite far plane the sky is a surface at the far plane: the same as itself.
    for convention in [Depth::Forward { near: 0.1, far: 1000.0 }, Depth::Orthographic { near: 0.0, far: 10.0 }] {
        let d = depth::disparity(1.0, convention.disparity_map());
        assert!(d > 0.0 && same(d, disparity_value(disparity_code(d))));
    }
}

proptest! {
    #![proptest_config(common::property("depth", 4000))]

    #[test]
    fn h42_h47_any_stored_depth_gives_a_finite_disparity_or_none(bits in any::<u32>()) {
        let value = f32::from_bits(bits);
        for (name, convention) in CONVENTIONS {
            let d = depth::disparity(value, convention.disparity_map());
            prop_assert!(d.is_finite() && (d >= 0.0 || d == depth::INVALID_DISPARITY), "{name}: {value} gives {d}");
            let positive = stored64(convention, value) > 0.0;
            let expect_none = value.is_nan() || (invertible(convention) && !positive);
            prop_assert!(!expect_none || d < 0.0, "{name}: {value} gives {d}");
            let back = disparity_value(disparity_code(d));
            prop_assert!(back.is_finite());
            if d < 0.0 {
                prop_assert!(!same(d, d) && !same(1.0, d), "an unknown surface is never the same");
            }
        }
    }

    #[test]
    fn h43_storage_neither_flushes_nor_accepts_for_ever(z in 1e-3f32..1e5) {
        let d = depth::disparity(z, Depth::Linear.disparity_map());
        let remembered = disparity_value(disparity_code(d));
        prop_assert!(same(d, remembered), "the stored surface is recognised at every distance");
        for factor in [0.97_f32, 1.03] {
            let other = depth::disparity(z * factor, Depth::Linear.disparity_map());
            prop_assert!(!same(other, remembered), "3 % is another surface at every distance");
        }
    }

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
        // Without the prediction a metre at three metres is a flush.
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
}

#[test]
fn h44_a_grazing_plane_is_never_flushed_by_jitter() {
    // A floor seen at up to 89.9 degrees from its normal: disparity linear in the row, 0 at the horizon. The depth sample moves
    // by up to half a pixel from frame to frame, and reprojection rounds by up to half a pixel.
    let mut draws = Draws::new("grazing");
    for angle_deg in [60.0_f32, 85.0, 89.0, 89.9] {
        let focal = 1000.0_f32;
        let per_row = (90.0 - angle_deg).to_radians().tan() / focal;
        for _ in 0..20_000 {
            let row = draws.range(1.0, 1000.0);
            let d = |y: f32| (0.01 + per_row * y).max(0.0);
            let slope = depth::slope(5, 1, [9, 3], |_, y| d(row + y as f32 - 1.0));
            let (now, before) = (d(row), d(row + draws.range(-1.0, 1.0)));
            assert!(depth::same_surface(now, disparity_value(disparity_code(before)), 0.02, slope));
        }
    }
    // The planted error: without the slope a steep floor flushes.
    let d = |y: f32| 1e-3 * y;
    assert!(!depth::same_surface(d(5.0), d(6.0), 0.02, 0.0));
    assert!(depth::same_surface(d(5.0), d(6.0), 0.02, depth::slope(5, 1, [9, 3], |_, y| d(4.0 + y as f32))));
}

#[test]
fn a_silhouette_is_not_slope() {
    // Object (disparity 1) left of background (0.1): on both sides the slope along x is 0.
    let step = |x: u32, _: u32| if x < 4 { 1.0 } else { 0.1 };
    assert_eq!(depth::slope(3, 1, [9, 3], step), 0.0);
    assert_eq!(depth::slope(4, 1, [9, 3], step), 0.0);
    // A wire, and a single pixel, are no slope either.
    assert_eq!(depth::slope(4, 1, [9, 3], |x, _| if x == 4 { 1.0 } else { 0.1 }), 0.0);
    assert_eq!(depth::slope(4, 1, [9, 3], |x, y| if (x, y) == (4, 1) { 0.1 } else { 1.0 }), 0.0);
    // Invalid neighbours and borders are ignored.
    assert_eq!(depth::slope(0, 0, [1, 1], |_, _| 0.5), 0.0);
    assert_eq!(depth::slope(1, 0, [3, 1], |x, _| if x == 1 { 0.5 } else { -1.0 }), 0.0);
}

#[test]
fn h48_moving_planes_do_not_change_the_disparity() {
    for z in [0.5, 3.0, 40.0] {
        let a = Depth::Reversed { near: 0.1, far: 1000.0 };
        let b = Depth::Reversed { near: 0.3, far: 5000.0 };
        let read = |c: Depth| depth::disparity(stored(c, z) as f32, c.disparity_map());
        assert!((read(a) / read(b) - 1.0).abs() < 1e-3);
        assert!(same(read(a), disparity_value(disparity_code(read(b)))));
    }
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

#[test]
fn h57_the_border_is_where_it_should_be() {
    let size = [100, 50];
    let at = |x, y, mx: f32, my: f32| reproject::nearest(x, y, [mx, my], size);
    assert_eq!(at(0, 0, 99.0, 49.0), Ok([99, 49]), "the last texel's centre");
    assert_eq!(at(0, 0, 99.49, 0.0), Ok([99, 0]));
    assert_eq!(at(0, 0, 99.51, 0.0), Err(Verdict::OffScreen), "0.01 px outside");
    assert_eq!(at(0, 0, -0.5, 0.0), Ok([0, 0]));
    assert_eq!(at(0, 0, -0.51, 0.0), Err(Verdict::OffScreen));
    assert_eq!(at(0, 49, 0.0, 0.51), Err(Verdict::OffScreen));
}

proptest! {
    #![proptest_config(common::property("reproject", 4000))]

    #[test]
    fn h54_any_motion_is_inside_or_refused(x in 0u32..3840, y in 0u32..2160, mx in any::<u32>(), my in any::<u32>()) {
        let motion = [f32::from_bits(mx), f32::from_bits(my)];
        match reproject::nearest(x, y, motion, [3840, 2160]) {
            Ok([qx, qy]) => {
                prop_assert!(qx < 3840 && qy < 2160);
                prop_assert!((f64::from(qx) - f64::from(x) - f64::from(motion[0])).abs() <= 0.5 + 1e-3);
                prop_assert!((f64::from(qy) - f64::from(y) - f64::from(motion[1])).abs() <= 0.5 + 1e-3);
            }
            Err(verdict) => {
                let garbage = motion.iter().any(|m| !m.is_finite() || m.abs() > reproject::MAX_MOTION_PX);
                prop_assert_eq!(verdict == Verdict::BadMotion, garbage);
            }
        }
    }

    #[test]
    fn h51_no_motion_is_the_identity(x in 0u32..16384, y in 0u32..16384) {
        prop_assert_eq!(reproject::nearest(x, y, [0.0, -0.0], [16384, 16384]), Ok([x, y]));
    }
}

#[test]
fn h55_half_float_motion_drifts_by_its_quantum() {
    use afterimage::kernel::pack::{half_bits, half_value};
    // A motion of 0.5 in uv, kept as a half, moves in steps of 2^-11: 1.875 px of 3840. In pixels below 1024 the step is 0.5 px.
    let quantum = |v: f32| half_value(half_bits(v) + 1) - half_value(half_bits(v));
    assert_eq!(quantum(0.5) * 3840.0, 1.875);
    assert_eq!(quantum(1000.0), 0.5);
    assert!(quantum(60.0) < 0.04, "motion of 60 px in pixels: a thirtieth of a pixel");
}
