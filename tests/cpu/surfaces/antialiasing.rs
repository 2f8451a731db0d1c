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

/// Nine tenths of the history, pulled towards the mean of 3x3 pixels until it is within two standard deviations, and a
/// tenth of the candidate, all as square roots.
fn expected(color: &Color, history: [f32; 3], x: usize, y: usize) -> (DVec3, bool) {
    let [w, h] = SIZE.map(|s| s as usize);
    let around: Vec<_> = (0..9)
        .map(|tap| {
            let (i, j) = ((x + tap % 3).max(1) - 1, (y + tap / 3).max(1) - 1);
            to_ycocg(roots(color.at(i.min(w - 1), j.min(h - 1))))
        })
        .collect();
    let mean = around.iter().sum::<DVec3>() / 9.0;
    let variance = around.iter().map(|v| (v - mean) * (v - mean)).sum::<DVec3>() / 9.0;
    let extent = 2.0 * DVec3::new(variance.x.sqrt(), variance.y.sqrt(), variance.z.sqrt());
    let away = to_ycocg(roots(history)) - mean;
    let inside = (extent / away.abs().max(DVec3::splat(1e-6))).min_element().min(1.0);
    let clipped = to_roots(mean + away * inside).max(DVec3::ZERO);
    let shown = 0.9 * clipped + 0.1 * roots(color.at(x, y));
    (shown * shown, inside < 1.0)
}

#[test]
fn history_is_kept_within_two_deviations_of_its_neighbourhood() {
    let mut post = context(MethodKind::Taa);
    let mut history = step(&mut post, 0, &Input::sharp(noise(SIZE, "taa 0"))).stored();
    let mut clipped = 0;
    for index in 1..6 {
        // Half as rough as the first frame, so that much of it is out of bounds.
        let color = noise(SIZE, &format!("taa {index}")).map(|c| c.map(|v| 0.25 + 0.5 * v));
        let made = step(&mut post, index, &Input::sharp(color.clone()));
        for y in 0..41 {
            for x in 0..52 {
                let (expected, is_clipped) = expected(&color, history.at(x, y), x, y);
                let off = (DVec3::from_array(made.shown.at(x, y).map(f64::from)) - expected).abs().max_element();
                assert!(off < 1e-4, "frame {index} ({x}, {y}): {off}");
                clipped += u32::from(is_clipped);
            }
        }
        history = made.stored();
    }
    println!("{clipped} of {} clipped", 5 * 41 * 52);
    assert!((200..9_000).contains(&clipped));
}
