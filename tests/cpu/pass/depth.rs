//! Disocclusion, sky, camera motion.

use super::*;
use crate::depth_hard::*;
use afterimage_testing::holds;

/// What a law measured.
pub fn run_law(law: fn(Make<'_>) -> Option<String>) -> Option<String> {
    Some(law(&|desc| Some(Box::new(CpuAfterimage::new(&desc).unwrap()))).expect("the CPU is always there"))
}

depth_laws!(Cpu, run_law);

fn two_walls(split: u32, near: f32, far: f32) -> Image<f32> {
    Image::from_fn(SIZE, |[x, _]| if x < split { near } else { far })
}

#[test]
fn a_disoccluded_wall_is_rejected_and_only_it() {
    let mut post = context(ungated());
    let first = View { depth: Some(two_walls(32, 1.0, 5.0)), ..still(noise(SIZE, "x")) };
    one(&mut post, 0, &first);
    // The near wall steps back by 8 px: columns 24..32 now show the far wall.
    let motion = Image::from_fn(SIZE, |[x, _]| if x < 24 { [8.0, 0.0] } else { [0.0, 0.0] });
    let second = View { depth: Some(two_walls(24, 1.0, 5.0)), motion: Some(motion), ..still(noise(SIZE, "y")) };
    let (_, stats, trace) = one(&mut post.clone(), 1, &second);
    assert_eq!(stats.verdicts[Verdict::Disoccluded as usize], 8 * 48);
    assert!((24..32).all(|x| trace.at(x, 3).verdict == Verdict::Disoccluded && trace.at(x, 3).is_replaced));
    // Without the test they keep the wrong wall's samples.
    post.set_settings(Settings { depth_test: None, ..post.desc().settings }).unwrap();
    let (_, stats, _) = one(&mut post, 1, &second);
    assert_eq!(stats.rejected(), 0);
}

#[test]
fn h48_history_outlives_a_change_of_planes() {
    // Near and far planes belong to a context. History does not depend on them: it is valid under other planes.
    let planes = |near: f32, far: f32| DepthConvention::Reversed { near, far };
    let stored = |d: f32, near: f32, far: f32| (d - 1.0 / far) / (1.0 / near - 1.0 / far);
    let frame = |near: f32, far: f32| {
        let depth = Image::from_fn(SIZE, |[x, _]| stored(1.0 / (1.0 + x as f32), near, far));
        View { depth: Some(depth), ..still(noise(SIZE, "planes")) }
    };
    let make = |near, far| {
        let desc = ContextDesc { depth: planes(near, far), ..ContextDesc::new(SIZE) };
        CpuAfterimage::new(&ContextDesc { settings: ungated(), ..desc }).unwrap()
    };
    let mut before = make(0.1, 1000.0);
    one(&mut before, 0, &frame(0.1, 1000.0));
    let mut after = make(0.3, 5000.0);
    after.restore_history(before.history().words());
    let (_, stats, _) = one(&mut after.clone(), 1, &frame(0.3, 5000.0));
    assert_eq!(stats.rejected(), 0);
    // Planted error: depth of the old planes read with the new planes.
    let (_, wrong, _) = one(&mut after, 1, &frame(0.1, 1000.0));
    assert!(wrong.rejected() > 3000);
    holds!(
        "H48",
        Cpu,
        "1 to 64 m, near 0.1 to 0.3 m, far 1 to 5 km: none rejected ({} with the old planes)",
        wrong.rejected()
    );
}
