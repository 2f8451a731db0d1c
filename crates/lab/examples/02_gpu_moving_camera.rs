//! Pass motion vectors, depth and camera of a moving view on a GPU, and verify the conventions.
//!
//! `cargo run -p afterimage-lab --example 02_gpu_moving_camera` (any adapter; software Vulkan: mesa-vulkan-drivers)

use afterimage::gpu::{Afterimage, Frame, Target};
use afterimage::internal::{ContextDesc, ViewFrame};
use afterimage::wgpu::{TextureFormat, TextureUsages};
use afterimage::{DepthConvention, Gaze, MotionConvention, MotionDirection, Verdict};
use afterimage_lab::device::Headless;
use afterimage_lab::source::{AnalyticSource, FrameSource};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Headless::find(true).ok_or("no adapter")?;
    println!("on {}", gpu.info.name);
    let size = [320, 180];
    let near = 0.1;
    // Reversed infinite depth, and motion as Unreal has it.
    let right = ContextDesc {
        motion: MotionConvention::UNREAL,
        depth: DepthConvention::Reversed { near, far: f32::INFINITY },
        ..ContextDesc::new(size)
    };
    // The most common mistake: motion vectors of the opposite sign.
    let wrong = MotionConvention { direction: MotionDirection::PreviousMinusCurrent, ..right.motion };
    let wrong = ContextDesc { motion: wrong, ..right };

    let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    let color = gpu.texture(size, 1, TextureFormat::Rgba32Float, read);
    let depth = gpu.texture(size, 1, TextureFormat::R32Float, read);
    let motion = gpu.texture(size, 1, TextureFormat::Rg32Float, read);
    let output = gpu.texture(size, 1, TextureFormat::Rgba32Float, TextureUsages::STORAGE_BINDING);
    let counters = gpu.counters();
    for (name, desc) in [("as it is", right), ("with the wrong sign", wrong)] {
        let mut source = AnalyticSource::new("occluder", size, 70.0, 60.0)?;
        let mut post = Afterimage::new(&gpu.device, &desc, output.format())?;
        println!("motion {name}");
        for index in 0..20 {
            let frame = source.frame(index)?;
            // Contents of that engine's G-buffer.
            let scale = right.motion.to_internal(size);
            gpu.write_rgb(&color, 0, &frame.color);
            gpu.write(&depth, 0, &frame.depth.ok_or("no depth")?.map(|z| near / z));
            gpu.write(&motion, 0, &frame.motion.ok_or("no motion")?.map(|v| [v[0] / scale[0], v[1] / scale[1]]));
            let views = [ViewFrame {
                previous_from_current: frame.previous_from_current,
                ..ViewFrame::new(*source.view(), Gaze::At { px: [160.0, 90.0] })
            }];
            let frame = Frame {
                depth: Some((&depth).into()),
                motion: Some((&motion).into()),
                ..Frame::new(&color, &views, index)
            };
            let target = Target { counters: Some(&counters), ..Target::new(&output) };
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            post.record(&gpu.device, &mut encoder, &frame, target)?;
            gpu.queue.submit([encoder.finish()]);
            if index % 6 == 1 {
                let stats = gpu.read_counters(&counters);
                let share = |v: Verdict| 100.0 * stats.verdicts[v as usize] as f64 / stats.pixels as f64;
                println!(
                    "  frame {index:2}: history valid {:5.1} %, disoccluded {:4.1} %, from outside {:4.1} %",
                    share(Verdict::Valid),
                    share(Verdict::Disoccluded),
                    share(Verdict::OffScreen)
                );
            }
        }
    }
    Ok(())
}
