//! Whole passes on the CPU: conventions, history rejection, determinism, lifecycle; hard cases H19, H22, H29, H46-H60,
//! H63, H66, H77-H79, H107, H108.

mod depth;
mod lifecycle;
mod light;
mod means;
mod nan;
mod noted;
mod properties;
mod quads;
mod reprojection;
mod reservoirs;
mod sparse;
mod sparse_hard;
pub mod sparse_noise;
mod sparse_planted;
mod trust;
mod upsampling;
mod views;
mod weighted;

pub use depth::run_law;

use crate::depth_hard::{METHODS, SIZE, still};
use crate::images::{Images, OneView, View, noise};
use crate::settings::{ungated, wrs};
use afterimage::cpu::{CpuAfterimage, Frame};
use afterimage::kernel::debug_view::PixelTrace;
use afterimage::{
    Bias, ContextDesc, DepthConvention, DepthTest, Exposure, FrameError, FrameStats, Gaze, Image, Method, MethodKind,
    MotionConvention, MotionDirection, MotionUnit, Reset, Sampler, Settings, Verdict, ViewFrame, ViewGeometry, Warning,
    Wrs, YAxis,
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

/// Weight of history with which it is always kept.
fn sticky(post: &mut CpuAfterimage) {
    crate::depth_hard::Steps::stick(post);
}

fn step(
    post: &mut CpuAfterimage,
    index: u64,
    reset: Reset,
    inputs: &[&View],
) -> (Vec<Color>, FrameStats, Vec<Image<PixelTrace>>) {
    let size = inputs[0].facts.geometry.size_px();
    let mut out = vec![Image::filled(size, [f32::NAN; 3]); inputs.len()];
    let mut trace = vec![Image::filled(size, PixelTrace::default()); inputs.len()];
    let views: Vec<_> = inputs.iter().map(|view| view.one()).collect();
    let images = Images::of(&views);
    let frame = Frame { reset, ..images.frame(index) };
    let stats = post.process_traced(&frame, &mut out, &mut trace).unwrap();
    (out, stats, trace)
}

fn one(post: &mut CpuAfterimage, index: u64, input: &View) -> (Color, FrameStats, Image<PixelTrace>) {
    let (mut out, stats, mut trace) = step(post, index, Reset::None, &[input]);
    (out.remove(0), stats, trace.remove(0))
}
