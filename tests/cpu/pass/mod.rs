//! Whole passes on the CPU: conventions, history rejection, determinism, lifecycle; hard cases H19, H22, H29, H46-H60,
//! H63, H66, H77-H79, H107, H108.

mod albedo;
mod alpha;
mod depth;
mod filled;
mod lifecycle;
mod light;
mod mask_hard;
pub mod mask_noise;
mod mask_planted;
mod masks;
mod means;
mod nan;
mod noted;
mod planned_hard;
mod properties;
mod quads;
mod reprojection;
mod reservoirs;
mod trust;
mod upsampling;
mod views;
mod weighted;

pub use depth::run_law;

use crate::depth_hard::{METHODS, SIZE, Steps, still};
use crate::images::{Images, View, noise, pixel, pixels};
use crate::settings::{ungated, wrs};
use afterimage::cpu::{CpuAfterimage, Frame};
use afterimage::internal::{Bias, ContextDesc, DepthTest, Method, MethodKind, Reset, Sampler, Settings, Wrs};
use afterimage::kernel::debug_view::PixelTrace;
use afterimage::{
    DepthConvention, Exposure, FrameError, FrameStats, Image, MotionConvention, MotionDirection, MotionUnit, Verdict,
    ViewGeometry, Warning, YAxis,
};
use afterimage_testing::Draws;
use proptest::prelude::*;

type Color = Image<[f32; 3]>;

fn geometry(size: [u32; 2]) -> ViewGeometry {
    ViewGeometry::flat(size, 70.0).unwrap()
}

fn context(settings: Settings) -> CpuAfterimage {
    CpuAfterimage::new(&ContextDesc { settings, ..ContextDesc::new(SIZE) }).unwrap()
}

fn one(post: &mut CpuAfterimage, index: u64, input: &View) -> (Color, FrameStats, Image<PixelTrace>) {
    let made = post.step(index, input);
    (made.shown, made.stats, made.trace)
}
