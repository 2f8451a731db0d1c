//! Why is the image soft or smeared? Six debug views of the decisions at each pixel, drawn on the GPU.
//!
//! `cargo run -p afterimage-lab --example 06_debug_views`; writes `out/06_debug_views.png`

use afterimage::gpu::{Afterimage, Frame};
use afterimage::internal::{ContextDesc, Foveation, Pyramid, ViewFrame};
use afterimage::wgpu::{TextureFormat, TextureUsages};
use afterimage::{DebugView, Gaze, Image};
use afterimage_lab::device::Headless;
use afterimage_lab::metric::encode;
use afterimage_lab::picture::{to_rgb8, write_png};
use afterimage_lab::source::{AnalyticSource, FrameSource};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Headless::find(true).ok_or("no adapter")?;
    println!("on {}", gpu.info.name);
    let size = [320, 180];
    let mut source = AnalyticSource::new("occluder", size, 70.0, 60.0)?;
    let foveation = Foveation { rate_mid: 4, rate_far: 8, ..Foveation::default() };

    let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    let write = TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC;
    let color = gpu.texture(size, 1, TextureFormat::Rgba32Float, read);
    let depth = gpu.texture(size, 1, TextureFormat::R32Float, read);
    let motion = gpu.texture(size, 1, TextureFormat::Rg32Float, read);
    let output = gpu.texture(size, 1, TextureFormat::Rgba32Float, write);
    let mut post = Afterimage::new(&gpu.device, &ContextDesc::new(size), output.format())?;

    let mut pictures = vec![];
    for index in 0..20 {
        let frame = source.frame(index)?;
        let px = if index < 12 { [80.0, 60.0] } else { [230.0, 120.0] };
        let lods = foveation.lod_map(source.view(), px);
        gpu.write_rgb(&color, 0, &foveation.render(&Pyramid::new(frame.color, foveation.max_level()), &lods));
        gpu.write(&depth, 0, &frame.depth.ok_or("no depth")?);
        gpu.write(&motion, 0, &frame.motion.ok_or("no motion")?);
        let views = [ViewFrame {
            previous_from_current: frame.previous_from_current,
            ..ViewFrame::new(*source.view(), Gaze::At { px })
        }];
        let frame =
            Frame { depth: Some((&depth).into()), motion: Some((&motion).into()), ..Frame::new(&color, &views, index) };
        if index == 19 {
            // Before the frame itself is recorded, because that advances the history.
            for view in DebugView::ALL {
                let mut encoder = gpu.device.create_command_encoder(&Default::default());
                post.record_view(&gpu.device, &mut encoder, &frame, &output, view)?;
                gpu.queue.submit([encoder.finish()]);
                pictures.push(gpu.read_rgb(&output, 0));
            }
        }
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        post.record(&gpu.device, &mut encoder, &frame, &output)?;
        gpu.queue.submit([encoder.finish()]);
    }

    // A contact sheet of three by two views.
    let [w, h] = size;
    let sheet = Image::from_fn([3 * w, 2 * h], |[x, y]| {
        pictures[(y / h * 3 + x / w) as usize].at((x % w) as usize, (y % h) as usize)
    });
    std::fs::create_dir_all("out")?;
    write_png("out/06_debug_views.png".as_ref(), &to_rgb8(&encode(&sheet, 0.0)))?;
    println!("row by row {:?}: out/06_debug_views.png", DebugView::ALL);
    println!("quality and age: black is none; survival: black is forgotten; gate: black is shut");
    println!("rejection: grey valid, red disoccluded, orange off screen; motion: grey none, red to the right");
    Ok(())
}
