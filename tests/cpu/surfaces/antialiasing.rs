//! taa's pass against f64.

use super::rig::*;
use glam::DVec3;

fn roots(c: [f32; 3]) -> DVec3 {
    DVec3::from_array(c.map(|v| f64::from(v).sqrt()))
}

fn to_ycocg(r: DVec3) -> DVec3 {
    DVec3::new((r.x + 2.0 * r.y + r.z) / 4.0, (r.x - r.z) / 2.0, (2.0 * r.y - r.x - r.z) / 4.0)
}

fn to_roots(y: DVec3) -> DVec3 {
    DVec3::new(y.x + y.y - y.z, y.x + y.z, y.x - y.y - y.z)
}

/// Squared thirds of a deviation by which means may differ: as far as jitter explains.
const JITTER: f64 = 1.0 / 9.0;
const ROUNDING: f64 = 5e-4;

/// History of `n` samples, pulled towards the mean of 3x3 pixels until it is within two standard deviations (five from
/// four samples on), and one sample of the candidate, all as square roots. History of more than two samples whose mean
/// is off counts for fewer.
fn expected(color: &Color, stored: &Color, lods: &[f32], [x, y]: [usize; 2]) -> (DVec3, bool) {
    let [w, h] = SIZE.map(|s| s as usize);
    let around = |image: &Color| -> Vec<_> {
        (0..9)
            .map(|tap| {
                let (i, j) = ((x + tap % 3).max(1) - 1, (y + tap / 3).max(1) - 1);
                to_ycocg(roots(image.at(i.min(w - 1), j.min(h - 1))))
            })
            .collect()
    };
    let (now, past) = (around(color), around(stored));
    let mean = now.iter().sum::<DVec3>() / 9.0;
    let variance = now.iter().map(|v| (v - mean) * (v - mean)).sum::<DVec3>() / 9.0;
    let mut n = ((8.0 - f64::from(lods[y * w + x])) / 2.0).powi(2);
    if n > 2.0 {
        let off = mean.x - past.iter().map(|v| v.x).sum::<f64>() / 9.0;
        n = n.min(16.0).min((variance.x * JITTER + ROUNDING.powi(2)) * 16.0 / (off * off + ROUNDING.powi(2)));
    }
    let sigmas = 2.0 + 3.0 * (n / 2.0 - 1.0).clamp(0.0, 1.0);
    let extent = sigmas * DVec3::new(variance.x.sqrt(), variance.y.sqrt(), variance.z.sqrt()) + ROUNDING;
    let away = past[4] - mean;
    let inside = (extent / away.abs().max(DVec3::splat(1e-6))).min_element().min(1.0);
    let clipped = to_roots(mean + away * inside).max(DVec3::ZERO);
    let shown = (n * clipped + roots(color.at(x, y))) / (n + 1.0);
    (shown * shown, inside < 1.0)
}

#[test]
fn history_is_a_mean_within_some_deviations_of_its_neighbourhood() {
    let mut post = context(MethodKind::Taa);
    let mut history = post.step(0, &sharp(noise(SIZE, "taa 0")));
    let mut clipped = 0;
    for index in 1..6 {
        // Half as rough as the first frame, so that much of it is out of bounds.
        let color = noise(SIZE, &format!("taa {index}")).map(|c| c.map(|v| 0.25 + 0.5 * v));
        let made = post.step(index, &sharp(color.clone()));
        let stored = history.stored();
        let lods: Vec<_> = history.surfaces().iter().map(|s| s.lod).collect();
        for px in pixels(SIZE) {
            let (expected, is_clipped) = expected(&color, &stored, &lods, px.map(|v| v as usize));
            let off = (DVec3::from_array(pixel(&made.shown, px).map(f64::from)) - expected).abs().max_element();
            assert!(off < 1e-4, "frame {index} {px:?}: {off}");
            clipped += u32::from(is_clipped);
        }
        history = made;
    }
    assert!((200..9_000).contains(&clipped), "{clipped} of {} clipped", 5 * 41 * 52);
}
