//! Each wrong convention of motion vectors is worse than Bevy's.

use crate::common::headless::Headless;
use crate::{clip, clip_psnr_db, courtyard, kind};
use bevy::prelude::*;
use bevy_afterimage::FoveationKind;
use bevy_afterimage::afterimage::{MotionConvention, MotionDirection, MotionUnit, YAxis};
use bevy_afterimage::testing::Planted;

const FRAMES: usize = 20;
const SKIPPED: usize = 8;

fn planted(planted: Planted) -> Headless {
    let mut headless = courtyard(kind(FoveationKind::Quads));
    headless.app.insert_resource(planted);
    headless
}

#[test]
fn motion_has_the_right_sign_axis_and_unit() {
    let bevy = MotionConvention::BEVY;
    let reference = clip(&mut courtyard(kind(FoveationKind::Off)), FRAMES, SKIPPED);
    let psnr = |motion| clip_psnr_db(&clip(&mut planted(Planted { motion, ..default() }), FRAMES, SKIPPED), &reference);
    let right = psnr(None);
    println!("{right:.2} dB");
    for (name, error) in [
        ("direction", MotionConvention { direction: MotionDirection::PreviousMinusCurrent, ..bevy }),
        ("vertical axis", MotionConvention { y_axis: YAxis::Up, ..bevy }),
        ("pixels", MotionConvention { unit: MotionUnit::Pixels, ..bevy }),
        ("half", MotionConvention { unit: MotionUnit::Ndc, ..bevy }),
    ] {
        let wrong = psnr(Some(error));
        println!("{name}: {wrong:.2} dB");
        assert!(wrong < right - 0.15, "{name}: {wrong:.2} dB, right {right:.2} dB");
    }
}
