//! Changing light on the device: hard cases H72 to H75. The CPU's tests check frames and laws; here the device agrees
//! in every bit, and the properties hold.

use super::rig::{Rig, View, noise};
use crate::settings::ungated;
use afterimage::{ContextDesc, Exposure, Image, Reset, Settings};
use afterimage_testing::holds;

const SIZE: [u32; 2] = [64, 48];

fn rig(gate: bool) -> Option<Rig> {
    Rig::new(ContextDesc::new(SIZE), if gate { Settings::paper() } else { ungated() })
}

fn plain(light: f32) -> View {
    View::still(Image::filled(SIZE, [light; 3]), [20.0, 20.0])
}

fn lit(shown: &[[u32; 3]], dark: f32) -> usize {
    shown.iter().filter(|&&c| c != [dark.to_bits(); 3]).count()
}

#[test]
fn h72_exposure_up_and_down_by_256() {
    for (gate, ratio) in [(true, 256.0), (false, 256.0), (true, 1.0 / 256.0), (false, 1.0 / 256.0)] {
        let Some(mut rig) = rig(gate) else { return };
        let view = |name: &str, ratio: f32| {
            let color = noise(SIZE, name).map(|c| c.map(|v| v * ratio));
            View::still(color, [20.0, 20.0])
        };
        for index in 0..10 {
            rig.both(index, Reset::None, &[view("still", 1.0)]);
        }
        // With the ratio: no history is rejected, nothing flashes.
        rig.exposure = Exposure::Changed { ratio };
        let (made, trace) = rig.both(10, Reset::None, &[view("still", ratio)]);
        let expected: Vec<[u32; 3]> = view("still", ratio).color.pixels().iter().map(|c| c.map(f32::to_bits)).collect();
        assert!(made.shown == expected && made.stats.rejected() == 0);
        assert!(trace[0].pixels().iter().filter(|t| !t.take).count() > 64 * 48 / 2);
        // Back, undeclared: after 3 frames the gate has rejected all history but a hundredth, which happens to look
        // alike.
        rig.exposure = Exposure::Same;
        for index in 11..31 {
            let (made, trace) = rig.both(index, Reset::None, &[view(&format!("h72 {index}"), 1.0)]);
            let stale = trace[0].pixels().iter().filter(|t| u64::from(t.age) > index - 11).count();
            let most = if index < 14 {
                64 * 48
            } else if index < 30 {
                30
            } else {
                0
            };
            assert!(!gate || stale <= most, "x{ratio}, frame {index}: {stale} stale pixels");
            assert_eq!(made.stats.rejected(), 0);
        }
    }
    holds!(
        "H72",
        Gpu,
        "wrs, x256 and /256 declared: the frame itself, 0 of 3072 rejected; undeclared: 1 % stale after 3 frames"
    );
}

#[test]
fn h73_h74_fireflies_and_strobes_leave_nothing_behind() {
    let dark = 0.031_25;
    for (gate, light, frames) in [(true, 65504.0, 1), (true, 1.0, 6), (false, 65504.0, 100)] {
        let Some(mut rig) = rig(gate) else { return };
        for index in 0..20 + frames + 3 {
            // One firefly, then a strobe.
            let on = index == 4 || (10..20).contains(&index) && index % 2 == 1;
            let (made, _) = rig.both(index, Reset::None, &[plain(if on { light } else { dark })]);
            let only_inputs = made.shown.iter().all(|&c| c == [dark.to_bits(); 3] || c == [light.to_bits(); 3]);
            assert!(only_inputs);
            let left = lit(&made.shown, dark);
            assert!(
                index < 20 + frames || left == 0,
                "{light}, gate {gate}: {left} pixels after {} frames",
                index - 20
            );
            assert!(light != 65504.0 || !gate || index != 5 || left == 0, "a firefly lives one frame");
        }
    }
    holds!(
        "H73",
        Gpu,
        "wrs: 65504 in 1/32 is gone with the next frame (gated), within 100 without a gate; no other color"
    );
    holds!("H74", Gpu, "wrs: after 10 frames of strobe dark again exactly within 6 frames (gated), 100 without a gate");
}

#[test]
fn h75_black_and_white_by_turns_are_one_or_the_other() {
    let mut means = vec![];
    for gate in [true, false] {
        let Some(mut rig) = rig(gate) else { return };
        let mut white = 0;
        for index in 0..160 {
            let (made, _) = rig.both(index, Reset::None, &[plain((index % 2) as f32)]);
            assert!(made.shown.iter().all(|&c| c == [0; 3] || c == [1.0_f32.to_bits(); 3]));
            white += if index >= 96 { lit(&made.shown, 0.0) } else { 0 };
        }
        let mean = white as f64 / (64.0 * 64.0 * 48.0);
        println!("gate {gate}: mean over time {mean:.4}");
        // Runs of a dozen frames: five of them in 64, in 3072 pixels, have a standard error of 0.004.
        assert!((mean - 0.5).abs() < 0.02, "{mean}");
        means.push(mean);
    }
    holds!("H75", Gpu, "wrs: black or white only; mean over time {:.4} (gated), {:.4}", means[0], means[1]);
}
