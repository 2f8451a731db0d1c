//! Each wrong convention of motion vectors is worse than Bevy's.

use crate::common::headless::Headless;
use crate::{clip, clip_psnr_db, courtyard, kind};
use bevy::prelude::*;
use bevy_afterimage::FoveationKind;
use bevy_afterimage::afterimage::{MotionConvention, MotionDirection, MotionUnit, YAxis};
use bevy_afterimage::testing::Planted;

const FRAMES: usize = 20;
const SKIPPED: usize = 8;

fn planted(foveation: FoveationKind, planted: Planted) -> Headless {
    let mut headless = courtyard(kind(foveation));
    headless.app.insert_resource(planted);
    headless
}

/// PSNR with Bevy's convention, and with errors planted, by name.
fn compare(foveation: FoveationKind, errors: &[(&str, Planted)]) {
    let reference = clip(&mut courtyard(kind(FoveationKind::Off)), FRAMES, SKIPPED);
    let psnr = |errors| clip_psnr_db(&clip(&mut planted(foveation, errors), FRAMES, SKIPPED), &reference);
    let right = psnr(Planted::default());
    println!("{foveation:?}: {right:.2} dB");
    for (name, error) in errors {
        let wrong = psnr(*error);
        println!("{foveation:?}, {name}: {wrong:.2} dB");
        assert!(wrong < right - 0.15, "{foveation:?}, {name}: {wrong:.2} dB, right {right:.2} dB");
    }
}

fn motion(convention: MotionConvention) -> Planted {
    Planted { motion: Some(convention), ..default() }
}

#[test]
fn motion_of_samples_has_the_right_sign_axis_and_unit() {
    let bevy = MotionConvention::BEVY;
    compare(
        FoveationKind::Sparse,
        &[
            ("direction", motion(MotionConvention { direction: MotionDirection::PreviousMinusCurrent, ..bevy })),
            ("vertical axis", motion(MotionConvention { y_axis: YAxis::Up, ..bevy })),
            ("pixels", motion(MotionConvention { unit: MotionUnit::Pixels, ..bevy })),
            ("half", motion(MotionConvention { unit: MotionUnit::Ndc, ..bevy })),
        ],
    );
}

#[test]
fn motion_of_whole_frames_has_the_right_sign() {
    let bevy = MotionConvention::BEVY;
    let backwards = MotionConvention { direction: MotionDirection::PreviousMinusCurrent, ..bevy };
    compare(FoveationKind::Simulated, &[("direction", motion(backwards))]);
}
