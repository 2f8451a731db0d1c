//! Each wrong convention of motion vectors is worse than Bevy's.

use crate::{clip_psnr_db, clips, compared, courtyards};
use bevy::prelude::*;
use bevy_afterimage::afterimage::{MotionConvention, MotionDirection, MotionUnit, YAxis};
use bevy_afterimage::testing::Planted;

#[test]
fn motion_has_the_right_sign_axis_and_unit() {
    let bevy = MotionConvention::BEVY;
    let errors = [
        ("direction", MotionConvention { direction: MotionDirection::PreviousMinusCurrent, ..bevy }),
        ("vertical axis", MotionConvention { y_axis: YAxis::Up, ..bevy }),
        ("pixels", MotionConvention { unit: MotionUnit::Pixels, ..bevy }),
        ("half", MotionConvention { unit: MotionUnit::Ndc, ..bevy }),
    ];
    let [full, _, quads] = compared();
    let right = [(full, Planted::default()), (quads.clone(), Planted::default())];
    let wrong = errors.map(|(_, motion)| (quads.clone(), Planted { motion: Some(motion), ..default() }));
    let [a, b] = right;
    let [c, d, e, f] = wrong;
    let [reference, right, wrong @ ..] = clips(courtyards([a, b, c, d, e, f]), 20, 8);
    let right = clip_psnr_db(&right, &reference);
    println!("{right:.2} dB");
    for ((name, _), wrong) in errors.into_iter().zip(wrong) {
        let wrong = clip_psnr_db(&wrong, &reference);
        println!("{name}: {wrong:.2} dB");
        assert!(wrong < right - 0.15, "{name}: {wrong:.2} dB, right {right:.2} dB");
    }
}
