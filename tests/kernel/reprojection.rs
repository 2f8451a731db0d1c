//! Previous positions of pixels: hard cases H54, H55 and H57 on the reprojection kernel.

use afterimage::Verdict;
use afterimage::kernel::pack::{half_bits, half_value};
use afterimage::kernel::reproject;
use afterimage_testing::holds;

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
    // At every pixel, to the last float: the edge is half a pixel beyond the last centre.
    for len in [1_u32, 2, 63, 1920, 16384] {
        let at = |to: f32| reproject::nearest(0, 0, [to, 0.0], [len, 1]);
        assert_eq!(at(len as f32 - 1.0), Ok([len - 1, 0]));
        assert_eq!((at(len as f32 - 0.51), at(len as f32 - 0.49)), (Ok([len - 1, 0]), Err(Verdict::OffScreen)));
    }
    holds!(
        "H57",
        Cpu,
        "last centre accepted; 0.01 px before the edge accepted, 0.01 px beyond it rejected, all borders"
    );
}

#[test]
fn h54_no_bit_pattern_of_a_vector_leads_outside() {
    // Every exponent and sign, mantissas of both ends, on both axes.
    let mut patterns: Vec<f32> =
        (0..=511_u32).flat_map(|e| [e << 23, e << 23 | 0x7f_ffff].map(f32::from_bits)).collect();
    patterns.extend([1e9, -1e9, 65536.0, 65537.0, 0.5, -0.5]);
    let (mut refused, mut inside) = (0, 0);
    for &a in &patterns {
        for &b in &patterns {
            match reproject::nearest(1000, 500, [a, b], [1920, 1080]) {
                Ok([x, y]) => {
                    assert!(x < 1920 && y < 1080);
                    inside += 1;
                }
                Err(verdict) => {
                    let bad = [a, b].iter().any(|v| v.is_nan() || v.abs() > reproject::MAX_MOTION_PX);
                    assert_eq!(verdict == Verdict::BadMotion, bad, "{a}, {b}");
                    refused += 1;
                }
            }
        }
    }
    assert!(refused > 100_000 && inside > 100_000);
    holds!("H54", Cpu, "{} vectors of every exponent: {inside} lead inside, {refused} refused", patterns.len().pow(2));
}

#[test]
fn h55_half_float_motion_drifts_by_its_quantum() {
    // A motion of 0.5 in uv, kept as a half, moves in steps of 2^-11: 1.875 px of 3840. In pixels below 1024 the step
    // is 0.5 px.
    let quantum = |v: f32| half_value(half_bits(v) + 1) - half_value(half_bits(v));
    assert_eq!(quantum(0.5) * 3840.0, 1.875);
    assert_eq!(quantum(1000.0), 0.5);
    assert!(quantum(60.0) < 0.04, "motion of 60 px in pixels: a thirtieth of a pixel");
    // Largest error of a vector: half a step, so that nearest reprojection drifts by a texel a frame at 0.5 uv of 3840.
    let off_px = |px: f32, scale: f32| (half_value(half_bits(px / scale)) * scale - px).abs();
    let sweep = |from: f32, to: f32| (0..100_000).map(move |i| from + (to - from) * i as f32 / 1e5);
    let uv = sweep(1920.0, 3840.0).map(|px| off_px(px, 3840.0)).fold(0.0, f32::max);
    let pixels = sweep(0.0, 1024.0).map(|px| off_px(px, 1.0)).fold(0.0, f32::max);
    assert!((0.93..=0.9375).contains(&uv) && (0.249..=0.25).contains(&pixels), "{uv}, {pixels}");
    holds!(
        "H55",
        Cpu,
        "quantum 1.875 px at 0.5 uv of 3840: off by up to {uv:.3} px a frame; in pixels below 1024 {pixels:.3}"
    );
}
