//! Pass motion vectors and depth in an engine's conventions, and signal camera cuts.
//!
//! `cargo run -p afterimage-lab --example 01_moving_camera`

use afterimage::cpu::{CpuAfterimage, Frame};
use afterimage::internal::{ContextDesc, Reset, ViewFrame};
use afterimage::{DepthConvention, Gaze, Image, MotionConvention, Verdict};
use afterimage_lab::source::{AnalyticSource, FrameSource};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let size = [320, 180];
    let mut source = AnalyticSource::new("lateral", size, 70.0, 60.0)?;

    // An engine with reversed infinite depth, and motion in normalised device coordinates: current minus previous, y
    // up.
    let near = 0.1;
    let desc = ContextDesc {
        motion: MotionConvention::UNREAL,
        depth: DepthConvention::Reversed { near, far: f32::INFINITY },
        ..ContextDesc::new(size)
    };
    let mut post = CpuAfterimage::new(&desc)?;
    let mut output = [Image::filled(size, [0.0; 3])];

    for index in 0..30 {
        let frame = source.frame(index)?;
        // Contents of that engine's G-buffer.
        let scale = desc.motion.to_internal(size);
        let motion = frame.motion.ok_or("no motion")?.map(|v| [v[0] / scale[0], v[1] / scale[1]]);
        let depth = frame.depth.ok_or("no depth")?.map(|z| near / z);
        let views = [ViewFrame {
            previous_from_current: frame.previous_from_current,
            ..ViewFrame::new(*source.view(), Gaze::At { px: [160.0, 90.0] })
        }];
        // A camera cut at frame 20: no history is valid.
        let reset = if index == 20 { Reset::All } else { Reset::None };
        // One image a view.
        let (color, depth, motion) = ([&frame.color], [&depth], [&motion]);
        let frame = Frame { depth: Some(&depth), motion: Some(&motion), reset, ..Frame::new(&color, &views, index) };
        let stats = post.process(&frame, &mut output)?;
        let share = |v: Verdict| 100.0 * stats.verdicts[v as usize] as f64 / stats.pixels as f64;
        println!(
            "frame {index:2}: history valid {:5.1} %, disoccluded {:4.1} %, from outside {:4.1} %, reset {:5.1} %",
            share(Verdict::Valid),
            share(Verdict::Disoccluded),
            share(Verdict::OffScreen),
            share(Verdict::Reset)
        );
    }
    Ok(())
}
