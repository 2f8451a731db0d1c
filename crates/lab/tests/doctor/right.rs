//! Right inputs, ordinary and odd, are never accused.

use super::clips::{Clip, Delivered, Delivery, foveations};
use super::planted::{contain_jitter, jitter, leave_out_camera};
use afterimage::internal::{Foveation, FoveationKind};
use afterimage::{Gaze, Image};
use afterimage_testing::Draws;

/// Fails if a finding accuses; prints what is found.
fn is_not_accused(what: &str, delivery: &Delivery) {
    let findings = delivery.findings();
    let names: Vec<_> = findings.iter().map(|f| format!("{} {:?}", f.check.name(), f.outcome)).collect();
    println!("{what}: {}", names.join(", "));
    for finding in &findings {
        assert_eq!(finding.fault(), None, "{what}: {finding}");
        assert!((0.0..=1.0).contains(&finding.confidence), "{what}: {finding}");
        assert!(finding.evidence.iter().all(|e| e.1.is_finite()), "{what}: {finding}");
    }
}

fn all_foveations() -> Vec<Foveation> {
    let mut all = foveations().to_vec();
    all.push(Foveation::quads());
    let default = Foveation::default();
    all.extend(
        [FoveationKind::Mip, FoveationKind::Block, FoveationKind::Gauss, FoveationKind::Off]
            .map(|filter| Foveation { kind: filter, ..default }),
    );
    all
}

fn scene(name: &str) -> Clip {
    Clip::open(name, Some([240, 136]), 3, 4)
}

#[test]
fn clips_under_every_filter() {
    // Each scene has three of them.
    let mut in_turn = all_foveations().into_iter().cycle();
    for name in ["still", "lateral", "turn", "walk", "occluder", "light-step", "scroll"] {
        let clip = scene(&format!("analytic:{name}"));
        for foveation in in_turn.by_ref().take(3) {
            let what = format!("{name}, {:?} {}/{}", foveation.kind, foveation.rate_mid, foveation.rate_far);
            let mut delivery = Delivery::right(&clip, foveation);
            is_not_accused(&what, &delivery);
            // Vectors without the camera's motion, also in jittered frames.
            leave_out_camera(&mut delivery);
            is_not_accused(&format!("{what}, of objects alone"), &delivery);
            delivery.frames.iter_mut().enumerate().for_each(|(i, frame)| frame.view.jitter_px = jitter(i));
            is_not_accused(&format!("{what}, of objects alone, said to be jittered"), &delivery);
        }
    }
}

#[test]
fn gazes_everywhere() {
    let clip = scene("analytic:turn");
    let [w, h] = clip.size().map(|s| s as f32);
    let positions = [
        ("in the middle", [0.5 * w, 0.5 * h]),
        ("in a corner", [0.0, 0.0]),
        ("outside", [1.4 * w, -0.3 * h]),
        ("far outside", [-1e5, 0.0]),
        ("on the middle row", [0.9 * w, 0.5 * h]),
    ];
    for foveation in foveations() {
        for (what, px) in positions {
            let delivery = Delivery::looking(&clip, foveation, |_| px);
            is_not_accused(&format!("gaze {what}, {:?}", foveation.kind), &delivery);
        }
        // Lost: the description does not say where the frame is sharp.
        let mut lost = Delivery::looking(&clip, foveation, |_| [0.5 * w - 0.5, 0.5 * h - 0.5]);
        lost.frames.iter_mut().for_each(|frame| frame.view.gaze = Gaze::Lost);
        is_not_accused(&format!("gaze lost, {:?}", foveation.kind), &lost);
    }
}

/// Puts a value in 3 % of the pixels.
fn riddle<T: Copy>(image: &mut Image<T>, value: T, draws: &mut Draws) {
    image.pixels_mut().iter_mut().filter(|_| draws.uniform() < 0.03).for_each(|pixel| *pixel = value);
}

#[test]
fn frames_that_show_nothing_or_nonsense() {
    let clip = scene("analytic:lateral");
    let mut draws = Draws::new("nonsense");
    for foveation in foveations() {
        let right = Delivery::right(&clip, foveation);
        let check = |what: &str, change: &mut dyn FnMut(usize, &mut Delivered)| {
            let mut changed = right.clone();
            changed.frames.iter_mut().enumerate().for_each(|(i, frame)| change(i, frame));
            is_not_accused(&format!("{what}, {:?}", foveation.kind), &changed);
        };
        for (what, value) in [("gray", 0.18), ("black", 0.0), ("NaN", f32::NAN)] {
            check(what, &mut |_, f| f.color = Image::filled(clip.size(), [value; 3]));
        }
        check("riddled", &mut |_, frame| {
            riddle(&mut frame.color, [f32::NAN, f32::INFINITY, 0.5], &mut draws);
            riddle(frame.depth.as_mut().unwrap(), f32::NAN, &mut draws);
            riddle(frame.motion.as_mut().unwrap(), [f32::INFINITY, f32::NAN], &mut draws);
        });
        check("color alone", &mut |_, f| (f.depth, f.motion) = (None, None));
        check("jitter that the vectors lack", &mut |i, f| f.view.jitter_px = jitter(i));
        check("a camera of unknown motion", &mut |_, f| f.view.previous_from_current = None);
        let mut contained = right.clone();
        contained.desc.motion.jittered = true;
        contain_jitter(&mut contained);
        is_not_accused(&format!("jitter that the vectors contain as stated, {:?}", foveation.kind), &contained);
    }
    // Nothing but noise, described as full rate.
    let mut noise = Delivery::right(&clip, Foveation { kind: FoveationKind::Off, ..Foveation::default() });
    for frame in &mut noise.frames {
        frame.color = frame.color.map(|_| [0; 3].map(|_| draws.uniform()));
    }
    is_not_accused("noise", &noise);
}

#[test]
fn frames_of_any_size() {
    for size in [[1, 1], [7, 3], [16, 16], [33, 17], [150, 20]] {
        let clip = Clip::open("analytic:turn", Some(size), 1, 3);
        is_not_accused(&format!("{size:?}"), &Delivery::right(&clip, Foveation::default()));
    }
}
