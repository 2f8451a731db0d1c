//! Reading between texels, and differences of colors, against f64.

use super::rig::*;
use afterimage::kernel::color::root_difference;
use afterimage::kernel::resample::{Gathered, Resampled, Tap, gather_around, resolve, sharp_sum, taps_around};
use glam::{DVec3, Vec3};

fn color(draws: &mut Draws, brightest: f32) -> Vec3 {
    Vec3::new(draws.range(0.0, brightest), draws.range(0.0, brightest), draws.range(0.0, brightest))
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
