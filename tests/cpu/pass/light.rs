//! Light that changes: exposure, fireflies, strobes, flicker; hard cases H72 to H75.

use super::depth::run_law;
use super::*;
use crate::depth_hard::{Steps, still};
use crate::light_hard::*;

light_laws!(Cpu, run_law);

#[test]
fn h72_an_exposed_color_stays_within_halves() {
    for ratio in [f32::MAX, f32::MIN_POSITIVE, 1e-45] {
        let mut post = context(ungated());
        post.step(0, &still(frame(0, 1.0)));
        post.stick();
        let out = post.exposed(1, &still(frame(1, 1.0)), Exposure::Changed { ratio }).shown;
        let limit = if ratio > 1.0 { 65504.0 } else { 1e-12 };
        assert!(out.pixels().iter().flatten().all(|&v| v == 0.0 || if ratio > 1.0 { v == limit } else { v < limit }));
    }
}
