//! Reprojection: identity, shifts, conventions, garbage vectors.

use super::depth::run_law;
use super::*;
use crate::motion_hard::*;
use afterimage_testing::holds;

motion_laws!(Cpu, run_law);

#[test]
fn every_motion_convention_means_the_same_shift() {
    let before = noise(SIZE, "convention");
    for unit in [MotionUnit::Pixels, MotionUnit::Uv, MotionUnit::Ndc] {
        for direction in [MotionDirection::PreviousMinusCurrent, MotionDirection::CurrentMinusPrevious] {
            for y_axis in [YAxis::Down, YAxis::Up] {
                let convention = MotionConvention { unit, direction, y_axis, ..MotionConvention::default() };
                let scale = convention.to_internal(SIZE);
                let vector = [3.0 / scale[0], -2.0 / scale[1]];
                let desc = ContextDesc { motion: convention, ..ContextDesc::new(SIZE) };
                let mut post = CpuAfterimage::new(&ContextDesc { settings: ungated(), ..desc }).unwrap();
                one(&mut post, 0, &still(before.clone()));
                post.stick();
                let later = |motion| View { motion: Some(Image::filled(SIZE, motion)), ..still(noise(SIZE, "later")) };
                assert_eq!(post.step(1, &later(vector)).shown.at(10, 10), before.at(13, 8), "{convention:?}");
                // The planted error: the same vector read with the other sign.
                let flipped = post.step(2, &later([-vector[0], vector[1]])).shown;
                assert_ne!(flipped.at(10, 10), before.at(13 + 3, 8), "{convention:?}");
            }
        }
    }
}

/// CPU time of the calling thread.
#[cfg(unix)]
fn thread_ns() -> f64 {
    let t = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    t.tv_sec as f64 * 1e9 + t.tv_nsec as f64
}

#[cfg(unix)]
#[test]
fn h60_a_turn_costs_no_more_than_any_other_frame() {
    const LARGE: [u32; 2] = [256, 192];
    // On one thread, whose time is measured. Normal frames and turns alternate, so that both meet the same load.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let mut ratios = vec![];
    for method in METHODS {
        let depth = Some(Image::from_fn(LARGE, |[x, y]| 2.0 + (x + y) as f32 * 0.01));
        let frame = |name: &str, motion: f32| View {
            depth: depth.clone(),
            motion: Some(Image::filled(LARGE, [motion, 0.25])),
            ..still(noise(LARGE, name))
        };
        let (normal, turn) = (frame("cost", 0.25), frame("cost", 5000.0));
        let settings = Settings { method: method.into(), ..Settings::paper() };
        let mut start = CpuAfterimage::new(&ContextDesc { settings, ..ContextDesc::new(LARGE) }).unwrap();
        one(&mut start, 0, &frame("before", 0.0));
        let time = |input: &View| {
            let mut post = start.clone();
            pool.install(|| {
                let from = thread_ns();
                one(&mut post, 1, input);
                thread_ns() - from
            })
        };
        let times: Vec<_> = (0..15).map(|_| [time(&normal), time(&turn)]).collect();
        let [normal, turn] = [0, 1].map(|i| {
            let mut times: Vec<_> = times.iter().map(|pair| pair[i]).collect();
            times.sort_by(f64::total_cmp);
            times[times.len() / 2]
        });
        ratios.push(turn / normal);
    }
    assert!(ratios.iter().all(|&r| r < 1.1), "{ratios:?}");
    let [wrs, smr] = ratios[..] else { unreachable!() };
    holds!("H60", Cpu, "all is new, bit for bit; CPU time over a normal frame's: wrs {wrs:.2}, smr {smr:.2}");
}
