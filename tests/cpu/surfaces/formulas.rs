//! Formulas of both kernels against f64.

use super::rig::*;
use afterimage::kernel::matched::{
    gain, mip_bilinear, mip_mean, moves_alike, reuse_weight, root_difference, smooth_step,
};
use afterimage::kernel::pack::disparity_code;
use afterimage::kernel::resample::{
    Gathered, Resampled, Tap, catmull_rom, gather_around, has_code, resolve, sharp_sum, tap_codes, taps_around,
};
use afterimage::kernel::taa;
use glam::{DVec3, Vec3, Vec4};

fn color(draws: &mut Draws, brightest: f32) -> Vec3 {
    Vec3::new(draws.range(0.0, brightest), draws.range(0.0, brightest), draws.range(0.0, brightest))
}

#[test]
fn catmull_rom_weights_sum_to_one_and_are_exact_on_texels() {
    assert_eq!(catmull_rom(0.0), [0.0, 1.0, 0.0, 0.0]);
    let mut draws = Draws::new("catmull-rom");
    for _ in 0..100_000 {
        let t = draws.uniform();
        let weights = catmull_rom(t);
        assert!((weights.iter().sum::<f32>() - 1.0).abs() <= 1e-6, "{t}");
        // Keys 1981 with a = -1/2, by distance.
        for (i, &w) in weights.iter().enumerate() {
            let d = (f64::from(t) + 1.0 - i as f64).abs();
            let expected = if d < 1.0 { (1.5 * d - 2.5) * d * d + 1.0 } else { ((-0.5 * d + 2.5) * d - 4.0) * d + 2.0 };
            assert!((f64::from(w) - expected).abs() < 1e-6, "{t}, texel {i}");
        }
    }
}

#[test]
fn twelve_taps_are_the_sixteen_without_corners() {
    let mut read = vec![];
    let taps = taps_around([1, 1], [0.3, 0.7], [4, 4]);
    let mut sum = 0.0;
    gather_around(&taps, |texel| {
        read.push(texel);
        let [x, y] = texel.map(|i| i as usize);
        sum += taps.sharp_x[x] * taps.sharp_y[y];
        Tap { color: Vec3::ZERO, lod: 0.0, same: true }
    });
    assert!((sum - sharp_sum(&taps)).abs() <= 1e-6, "{sum}, not {}", sharp_sum(&taps));
    read.sort_by_key(|[x, y]| [*y, *x]);
    let expected: Vec<_> = (0..4)
        .flat_map(|y| (0..4).map(move |x| [x, y]))
        .filter(|&[x, y]| !([0, 3].contains(&x) && [0, 3].contains(&y)))
        .collect();
    assert_eq!(read, expected);
    // At the corner of an image the taps beyond it are the border's.
    let mut corner = vec![];
    gather_around(&taps_around([-1, 4], [0.5, 0.0], [5, 5]), |texel| {
        corner.push(texel);
        Tap { color: Vec3::ZERO, lod: 0.0, same: true }
    });
    assert_eq!(corner[..4], [[0, 4], [0, 4], [0, 4], [1, 4]]);
    assert_eq!(corner[8..], [[0, 3], [0, 3], [0, 4], [0, 4]]);
}

#[test]
fn codes_of_a_surface_are_those_within_a_tenth() {
    let mut draws = Draws::new("tap codes");
    for _ in 0..100_000 {
        let expected = draws.range(-20.0, 20.0).exp2();
        let codes = tap_codes(expected);
        let ratio = draws.range(0.7, 1.4);
        let same = has_code(disparity_code(expected * ratio) << 16, codes);
        // A step of a code is at most 2^-10.
        let within = |slack: f32| ratio >= 0.9 - slack && ratio <= 1.0 / 0.9 + slack;
        assert!(!same || within(0.002), "{expected} * {ratio}");
        assert!(same || !within(-0.002), "{expected} * {ratio}");
    }
    let (sky, unknown) = (disparity_code(0.0) << 16, disparity_code(-1.0) << 16);
    assert!(has_code(sky, tap_codes(0.0)) && !has_code(sky, tap_codes(1e-3)));
    assert!(!has_code(unknown, tap_codes(1e30)) && !has_code(unknown, tap_codes(-1.0)));
}

/// Twelve taps at `fraction`; those in `other`, bits in the order of reading, are on another surface.
fn read(fraction: [f32; 2], other: u32, surface: impl Fn([i32; 2]) -> Surface) -> (Gathered, Resampled) {
    let taps = taps_around([1, 1], fraction, [4, 4]);
    let mut order = 0..12;
    let g = gather_around(&taps, |texel| {
        let Surface { color, lod, .. } = surface(texel);
        Tap { color, lod, same: other >> order.next().unwrap() & 1 == 0 }
    });
    (g, resolve(g, sharp_sum(&taps), surface([1, 1])))
}

#[test]
fn reading_keeps_constants_and_ramps_whatever_is_missing() {
    let mut draws = Draws::new("gather");
    for _ in 0..50_000 {
        let fraction = [draws.uniform(), draws.uniform()];
        let other = if draws.uniform() < 0.5 { 0 } else { draws.bits() & draws.bits() & 0xfff };
        let c = color(&mut draws, 8.0);
        let flat = Surface { color: c, lod: 1.5, disparity: 1.0 };
        let (g, r) = read(fraction, other, |_| flat);
        assert_eq!(g.complete, other == 0);
        assert!((r.sharp - c).abs().max_element() <= 4e-6 * c.max_element(), "{} for {c}", r.sharp);
        assert!((r.smooth - c).abs().max_element() <= 4e-6 * c.max_element());
        assert!((r.lod - 1.5).abs() < 1e-5);
        if other == 0 {
            // A ramp is reproduced; the other taps make up for the missing corners' weight of up to 1/64.
            let ramp = |[x, y]: [i32; 2]| Surface { color: Vec3::splat(10.0 + x as f32 + 2.0 * y as f32), ..flat };
            let (_, r) = read(fraction, 0, ramp);
            let expected = 10.0 + 1.0 + fraction[0] + 2.0 * (1.0 + fraction[1]);
            assert!((r.smooth.x - expected).abs() < 2e-5, "{} for {expected}", r.smooth.x);
            assert!((r.sharp.x - expected).abs() < 0.06, "{} for {expected}", r.sharp.x);
        } else {
            assert_eq!(r.sharp, r.smooth, "no lobes over an edge");
        }
    }
    let bright =
        |at: [i32; 2]| Surface { color: Vec3::splat(if at == [0, 1] { 1.0 } else { 0.0 }), lod: 0.0, disparity: 1.0 };
    assert_eq!(read([0.5, 0.0], 0, bright).1.sharp, Vec3::ZERO, "lobes below black are cut");
}

#[test]
fn a_sharp_reading_keeps_more_contrast_than_a_smooth_one() {
    // The response of the Catmull-Rom weights half way between texels is 9/8 cos(w/2) - 1/8 cos(3w/2), that of linear
    // ones cos(w/2).
    for period in [3.0_f64, 4.0, 6.0, 8.0, 16.0] {
        let w = std::f64::consts::TAU / period;
        // A crest half way between the second and the third column.
        let wave = |[x, _]: [i32; 2]| {
            let v = 2.0 + (w * (f64::from(x) - 1.5)).cos();
            Surface { color: Vec3::splat(v as f32), lod: 0.0, disparity: 1.0 }
        };
        let r = read([0.5, 0.0], 0, wave).1;
        let sharp = 2.0 + 1.125 * (0.5 * w).cos() - 0.125 * (1.5 * w).cos();
        assert!((f64::from(r.sharp.x) - sharp).abs() < 1e-5, "period {period}");
        assert!((f64::from(r.smooth.x) - 2.0 - (0.5 * w).cos()).abs() < 1e-5);
    }
}

#[test]
fn root_difference_is_a_distance_of_a_hundred_from_black_to_white() {
    assert!((root_difference(Vec3::ZERO, Vec3::ONE) - 100.0).abs() < 1e-4);
    let mut draws = Draws::new("root difference");
    for _ in 0..100_000 {
        let brightest = draws.range(-12.0, 16.0).exp2();
        let (x, y) = (color(&mut draws, brightest), color(&mut draws, brightest));
        assert_eq!(root_difference(x, x), 0.0);
        assert_eq!(root_difference(x, y), root_difference(y, x));
        let roots = |c: Vec3| {
            let c = c.as_dvec3();
            DVec3::new(c.x.sqrt(), c.y.sqrt(), c.z.sqrt())
        };
        let d = roots(x) - roots(y);
        let (luma, orange) = ((d.x + 2.0 * d.y + d.z) / 4.0, (d.x - d.z) / 2.0);
        let green = (2.0 * d.y - d.x - d.z) / 4.0;
        let expected = 100.0 * (luma * luma + 0.5 * (orange * orange + green * green)).sqrt();
        let bound = 1e-5 * 100.0 * f64::from(brightest).sqrt();
        assert!((f64::from(root_difference(x, y)) - expected).abs() <= bound, "{x} {y}");
    }
    assert_eq!(root_difference(Vec3::splat(-1.0), Vec3::ZERO), 0.0, "below black is black");
}

#[test]
fn smooth_step_gain_and_reuse_weight_agree_with_f64() {
    let mut draws = Draws::new("smr formulas");
    let step = |from: f64, width: f64, x: f64| {
        let t = ((x - from) / width).clamp(0.0, 1.0);
        3.0 * t * t - 2.0 * t * t * t
    };
    for _ in 0..100_000 {
        let (from, width, x) = (draws.range(-2.0, 5.0), draws.range(0.1, 4.0), draws.range(-5.0, 12.0));
        let expected = step(from.into(), width.into(), x.into());
        assert!((f64::from(smooth_step(from, width, x)) - expected).abs() < 1e-5);

        let (c, h, changed) = (draws.range(0.0, 2.0), draws.range(0.0, 2.0), draws.uniform());
        let ratio = ((f64::from(c) + 0.002) / (f64::from(h) + 0.002)).clamp(0.2, 5.0);
        let expected = 1.0 + (ratio - 1.0) * f64::from(changed) * step(0.05, 0.1, (ratio - 1.0).abs());
        assert!((f64::from(gain(c, h, changed)) - expected).abs() < 1e-4, "{c} {h} {changed}");

        let (lod, history, accumulate) = (draws.range(0.0, 4.0), draws.range(0.0, 4.0), draws.range(0.0, 0.98));
        let finer = ((f64::from(lod) - f64::from(history)) / 0.1).clamp(0.0, 1.0);
        let coarser = ((f64::from(history) - f64::from(lod)) / 0.25).clamp(0.0, 1.0);
        let share = finer + (1.0 - finer) * (1.0 - coarser) * f64::from(lod).min(1.0) * f64::from(accumulate);
        let w = reuse_weight(lod, history, accumulate, false, [1.0; 2]);
        assert!((f64::from(w.finer) - finer).abs() < 1e-5 && (f64::from(w.share) - share).abs() < 1e-5);
        assert!((0.0..=1.0).contains(&w.share));
    }
    for changed in [0.0, 0.5, 1.0] {
        assert_eq!(gain(0.3, 0.3, changed), 1.0, "the same light is no change");
        assert_eq!(gain(1.03, 1.0, changed), 1.0, "nor are a few percent");
    }
    assert_eq!((smooth_step(3.0, 6.0, 3.0), smooth_step(3.0, 6.0, 9.0)), (0.0, 1.0));
    assert_eq!(reuse_weight(2.0, 1.0, 0.9, false, [1.0; 2]).share, 1.0, "finer history is reused wholly");
    assert_eq!(reuse_weight(1.0, 1.5, 0.9, false, [1.0; 2]).share, 0.0, "coarser history never");
    for history in [0.0, 0.1, 3.0] {
        assert_eq!(reuse_weight(0.0, history, 0.98, false, [1.0; 2]).share, 0.0, "nor any in the fovea");
    }
}

#[test]
fn vectors_move_alike_within_half_a_pixel_and_a_tenth() {
    let mut draws = Draws::new("moves alike");
    for _ in 0..100_000 {
        let own = [draws.range(-20.0, 20.0), draws.range(-20.0, 20.0)];
        let other = own.map(|v| v + draws.range(-5.0, 5.0));
        let (a, b) = (own.map(f64::from), other.map(f64::from));
        let within = 0.5 + 0.1 * (a[0].abs() + a[1].abs());
        let off = (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
        if (off - within).abs() > 1e-4 {
            assert_eq!(moves_alike(own, other), off < within, "{own:?} {other:?}");
        }
    }
    assert!(moves_alike([0.0; 2], [0.5, -0.5]) && !moves_alike([0.0; 2], [0.0, 0.51]));
    for bad in [f32::NAN, f32::INFINITY] {
        assert!(!moves_alike([0.0; 2], [bad, 0.0]) && !moves_alike([0.0; 2], [0.0, bad]));
    }
    assert!(!moves_alike([f32::NAN, 0.0], [f32::NAN, 0.0]));
}

#[test]
fn the_chain_reads_the_mean_of_what_is_covered() {
    let mut draws = Draws::new("chain");
    for _ in 0..20_000 {
        let mut texels = [Vec4::ZERO; 4];
        let c = color(&mut draws, 3.0);
        for t in &mut texels {
            let coverage = (draws.bits() % 5) as f32 * 0.25;
            *t = (c * coverage).extend(coverage);
        }
        let [a, b, d, e] = texels;
        let mean = mip_mean(a, b, d, e);
        assert!((mean - (a + b + d + e) / 4.0).abs().max_element() < 1e-6);
        let at = [draws.uniform(), draws.uniform()];
        let read = mip_bilinear([a, b], [d, e], at);
        let weights = [(1.0 - at[0]) * (1.0 - at[1]), at[0] * (1.0 - at[1]), (1.0 - at[0]) * at[1], at[0] * at[1]];
        let coverage: f32 = texels.iter().zip(weights).map(|(t, w)| t.w * w).sum();
        if coverage > 0.002 {
            assert!((read - c).abs().max_element() < 1e-3, "holes take nothing away: {read} for {c}");
        }
    }
    assert_eq!(mip_bilinear([Vec4::ZERO; 2], [Vec4::ZERO; 2], [0.3, 0.6]), Vec3::ZERO);
}

#[test]
fn taa_agrees_with_f64_and_stays_in_its_box() {
    let mut draws = Draws::new("taa formulas");
    for _ in 0..50_000 {
        let c = color(&mut draws, 4.0);
        let back = taa::roots_of_ycocg(taa::to_ycocg(c));
        let roots = Vec3::new(c.x.sqrt(), c.y.sqrt(), c.z.sqrt());
        assert!((back - roots).abs().max_element() < 1e-6);

        let (mean, extent) = (taa::to_ycocg(color(&mut draws, 1.0)), color(&mut draws, 0.2));
        let history = taa::to_ycocg(color(&mut draws, 1.0));
        let clipped = taa::clip_to_box(history, mean, extent);
        let off = (clipped - mean).abs() - extent;
        assert!(off.max_element() < 1e-6, "inside");
        let inside = ((history - mean).abs() - extent).max_element() <= 0.0;
        assert!(!inside || clipped == history, "what is inside stays");
        assert!((clipped - mean).cross(history - mean).length() < 1e-6, "on the way to the mean");

        let (at, spread) = ([draws.uniform(), draws.uniform()], draws.range(0.5, 1.0));
        let hump = |f: f32| 4.0 * f64::from(f) * (1.0 - f64::from(f));
        let limit = 1.0 / (hump(at[0]).max(hump(at[1])) * f64::from(spread) + 1.0 / 16.0);
        assert!((f64::from(taa::confidence_limit(at, spread)) / limit - 1.0).abs() < 1e-5);

        let (confidence, trust) = (draws.range(0.0, 16.0), draws.uniform());
        let expected = (1.0 / (f64::from(confidence) + 1.0)).max(1.0 - f64::from(trust));
        assert!((f64::from(taa::candidate_share(confidence, trust)) - expected).abs() < 1e-6);
        let stored = taa::confidence_of(taa::lod_of(confidence));
        assert!((stored - confidence).abs() < 1e-5, "{confidence} is stored as {stored}");
    }
    // History keeps 16 samples if jitter explains its difference, and none after a change of light.
    let lumas = [0.2, 0.4, 0.6];
    let (sum, squares) = (lumas.iter().sum::<f32>(), lumas.iter().map(|v| v * v).sum::<f32>());
    let third_of_deviation = (0.08_f32 / 3.0).sqrt() / 3.0;
    assert!((taa::agreeing(sum, squares, sum + 3.0 * third_of_deviation, 3.0) - 16.0).abs() < 1e-3);
    assert_eq!(taa::agreeing(3.0 * 0.5, 3.0 * 0.25, 1.5, 3.0), 16.0);
    assert!(taa::agreeing(3.0 * 0.5, 3.0 * 0.25, 3.0 * 0.45, 3.0) < 0.01);
    // Nine equal neighbours leave no room for another history.
    let (c, y) = (Vec3::new(0.25, 0.5, 0.75), taa::to_ycocg(Vec3::new(0.25, 0.5, 0.75)));
    let shown = taa::blend_clipped(c, Vec3::ONE, y * 9.0, y * y * 9.0, 0.1, 16.0);
    assert!((shown - c).abs().max_element() < 2e-3, "{shown}");
}
