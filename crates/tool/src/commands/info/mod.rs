//! `afterimage info`: describe an input, or list the adapters.

mod adapters;
mod camera;
mod gaze;
mod motion;
mod scene;

use crate::args::channels::ChannelArgs;
use crate::args::gaze_log::GazeLogArgs;
use crate::failure::{Failure, with_options};
use afterimage::internal::{ContextDesc, FoveationKind, Reset, ViewFrame};
use afterimage::{Gaze, ViewGeometry, cpu};
use afterimage_eval::exposure::Exposure;
use afterimage_lab::error::InputError;
use afterimage_lab::source;
use afterimage_lab::source::exr_file::MotionReading;
use afterimage_lab::source::{AlbedoLayer, ChannelNames, FrameSource, ReadLimits, SceneOptions, SequenceSource};
use clap::Args;
use motion::{Reader, motion_info, with_option};
use std::path::Path;

/// Describe an input, or list the adapters
#[derive(Args, Clone, Debug)]
#[command(
    after_help = "Examples:\n  afterimage info frames/\n  afterimage info scene.glb\n  afterimage info viewing.csv\n  \
                  afterimage info adapters --self-test"
)]
pub struct InfoArgs {
    /// An input of `run`, a scene (.gltf, .glb, builtin:NAME), a gaze log (a scanpath, or an eye tracker's export), a
    /// camera file (.json, images.txt), or the word adapters
    pub input: String,
    /// Limit on the size of input images, million pixels
    #[arg(long, default_value_t = 64, value_name = "N")]
    pub max_megapixels: u32,
    /// With adapters: test the arithmetic of each, and whether the passes give the same bits as on the CPU (seconds on
    /// software devices)
    #[arg(long)]
    pub self_test: bool,
    /// Animation of a scene to describe, by name or number from 0; default: the first
    #[arg(long, visible_alias = "clip", value_name = "NAME|N")]
    pub animation: Option<String>,
    #[command(flatten)]
    pub channels: ChannelArgs,
    #[command(flatten)]
    pub log: GazeLogArgs,
}

/// The subcommand.
pub fn info(args: &InfoArgs) -> Result<(), Failure> {
    if !has_channels(&args.input) {
        args.channels.refuse_for(&args.input)?;
    }
    if args.input == "adapters" {
        return adapters::adapters_info(args.self_test);
    }
    if args.self_test {
        return Err(Failure::Input(format!("--self-test: expected the word adapters, not {}", args.input)));
    }
    if args.animation.is_some() && !source::is_scene(&args.input) {
        let input = &args.input;
        return Err(Failure::Input(format!("--animation: {input} is not a scene (.gltf, .glb); leave the option out")));
    }
    if gaze::is_log(&args.input) && !camera::is_camera_file(&args.input) {
        return gaze::gaze_info(&args.input, &args.log);
    }
    args.log.refuse_for(&args.input)?;
    if source::is_scene(&args.input) {
        return Ok(scene::scene_info(&args.input, args.animation.as_deref())?);
    }
    if camera::is_camera_file(&args.input) {
        return Ok(camera::camera_info(&args.input)?);
    }
    let limits = ReadLimits::from_megapixels(args.max_megapixels);
    let names = ChannelNames { assume_own_convention: true, albedo: AlbedoLayer::Recognised, ..args.channels.names() };
    let path = Path::new(&args.input);
    if path.is_dir() {
        let mut source = SequenceSource::open_named(path, &limits, &names)?;
        let reading = source.motion_reading();
        return described(&mut source, args, reading);
    }
    let mut source = source::open_named(&args.input, &limits, &SceneOptions::default(), &names)?;
    described(source.as_mut(), args, None)
}

/// Whether an input may be EXR frames.
fn has_channels(input: &str) -> bool {
    let is_exr = || Path::new(input).extension().is_some_and(|ending| ending.eq_ignore_ascii_case("exr"));
    Path::new(input).is_dir() || is_exr()
}

fn described(source: &mut dyn FrameSource, args: &InfoArgs, reading: Option<MotionReading>) -> Result<(), Failure> {
    let reader = Reader { input: &args.input, channels: &args.channels, reading };
    let found = frames_info(source, &reader)?;
    inputs_look(source, &reader, found)
}

/// Prints what the first frames have. Returns the convention of motion vectors that fits, if it is another.
fn frames_info(source: &mut dyn FrameSource, reader: &Reader) -> Result<Option<MotionReading>, InputError> {
    let info = source.info().clone();
    let known = |v: Option<f32>| v.map_or("not stated".to_owned(), |v| v.to_string());
    say!("{}", info.name);
    say!("size: {}x{} px", info.size[0], info.size[1]);
    match info.frames {
        Some(n) => say!("frames: {n}"),
        None => say!("frames: endless"),
    }
    say!("still: {}", if info.still { "yes" } else { "no" });
    source.contents().iter().for_each(|line| say!("{line}"));
    source.warnings().iter().for_each(|line| say!("warning: {}", with_options(line)));
    say!("frames per second: {}", known(info.fps));
    say!("horizontal field of view, degrees: {}", known(info.hfov_deg));
    let first = source.frame(0)?;
    say!("non-finite pixels in frame 0: {}", first.nonfinite);
    let brightest = first.color.pixels().iter().flatten().fold(0.0_f32, |a, &b| a.max(b));
    say!("brightest channel in frame 0, linear: {brightest}");
    if let Some(hint) = Exposure::Stops(0.0).choose(&first.color, 1.0).hint {
        say!("warning: {hint}");
    }
    match &first.depth {
        None => say!("depth: none"),
        Some(depth) => {
            let finite = depth.pixels().iter().filter(|z| z.is_finite() && **z < 1e9);
            let (near, far) = finite.fold((f32::INFINITY, 0.0_f32), |(a, b), &z| (a.min(z), b.max(z)));
            say!("depth in frame 0: {near} to {far}");
        }
    }
    if info.still || info.frames == Some(1) {
        say!("motion: none, it is a still");
        return Ok(None);
    }
    let second = source.frame(1)?;
    let Some(motion) = &second.motion else {
        say!("motion: none");
        return Ok(None);
    };
    let largest = motion.pixels().iter().map(|m| m[0].hypot(m[1])).fold(0.0_f32, f32::max);
    say!("motion in frame 1: up to {largest:.2} px");
    motion_info(reader, [&first.color, &second.color], motion)
}

/// Frames that the doctor looks at.
const EXAMINED: u64 = 8;

/// Prints what the doctor says of the first frames, which are at full rate.
fn inputs_look(source: &mut dyn FrameSource, reader: &Reader, found: Option<MotionReading>) -> Result<(), Failure> {
    let info = source.info().clone();
    if info.still || info.frames == Some(1) {
        return Ok(());
    }
    let mut desc = ContextDesc::new(info.size);
    desc.settings.foveation.kind = FoveationKind::Off;
    let geometry = ViewGeometry::flat(info.size, info.hfov_deg.unwrap_or(70.0))?;
    let mut doctor = cpu::Doctor::new(&desc, 0)?;
    for index in 0..EXAMINED.min(info.frames.unwrap_or(EXAMINED)) {
        let frame = source.frame(index)?;
        let previous_from_current = frame.previous_from_current;
        let views = [ViewFrame { previous_from_current, ..ViewFrame::new(geometry, Gaze::Lost) }];
        let (color, depth, motion) = ([&frame.color], frame.depth.as_ref(), frame.motion.as_ref());
        let (depth, motion) = (depth.map(|d| [d]), motion.map(|m| [m]));
        let looked_at = cpu::Frame {
            depth: depth.as_ref().map(|d| &d[..]),
            motion: motion.as_ref().map(|m| &m[..]),
            reset: if frame.cut { Reset::All } else { Reset::None },
            ..cpu::Frame::new(&color, &views, index)
        };
        doctor.observe(&looked_at)?;
    }
    say!("inputs look:");
    for finding in doctor.findings() {
        say!("  {}", with_option(&finding, reader, found));
    }
    Ok(())
}
