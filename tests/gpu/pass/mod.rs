//! The pass on the GPU against its twin on the CPU: whole sequences, decisions and stored state bit for bit.

mod albedo;
mod alpha;
mod antialiasing;
mod bare;
mod dump;
mod engines;
mod gaze;
mod lens;
mod levels;
mod lifecycle;
mod light;
mod limits;
mod mask_hard;
mod masks;
mod motion;
mod objects;
mod planned;
mod planned_hard;
mod prime;
mod properties;
mod quads;
mod reactive;
mod reservoirs;
#[allow(dead_code, reason = "the lab's tests on analytic scenes use all of it")]
pub mod rig;
mod sparse;
mod submission;
mod surfaces;
mod surfaces_hard;
mod targets;

use crate::settings::{ungated, ungated_of, wrs};
use afterimage::gpu::{Afterimage, DebugTarget, Frame, Prime, Region, Target, Textures};
use afterimage::internal::{
    Bias, ContextDesc, Foveation, FoveationKind, Method, MethodKind, Reset, Sampler, Settings, Smr, ViewFrame, Wrs,
};
use afterimage::internal::{Sources, method_pass};
use afterimage::kernel::{pack, stored_reservoir};
use afterimage::shader::SHADERS;
use afterimage::wgpu::{self, Device, Limits, Queue, Texture, TextureFormat, TextureUsages};
use afterimage::{
    CreateError, DebugView, DepthConvention, Exposure, FrameError, Gaze, Image, MotionConvention, ViewGeometry,
};
use afterimage_testing::gpu::read_texture;
use afterimage_testing::{Draws, agree, holds};
use bare::Bare;
use rig::{Made, Rig, View, make_texture, noise, noise_view};
use surfaces::run_law;
