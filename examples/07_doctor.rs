//! A doctor looks at frames whose motion vectors have the wrong sign, says so, and says what mends it.
//!
//! `cargo run --example 07_doctor` (any adapter; software Vulkan: mesa-vulkan-drivers)

mod headless;

use afterimage::gpu::{Doctor, Frame};
use afterimage::wgpu::{BufferUsages, TextureFormat, TextureUsages};
use afterimage::{ContextDesc, Filter, Gaze, ViewFrame, ViewGeometry};
use headless::Headless;

const SIZE: [u32; 2] = [256, 128];

/// Brightness of a wall with a pattern on it.
fn wall(x: f32, y: f32) -> f32 {
    0.5 + 0.2 * (0.31 * x + 0.13 * y).sin() + 0.15 * (0.17 * x - 0.23 * y).sin() + 0.1 * (0.07 * x * y * 0.05).cos()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Headless::new()?;
    let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    let [color, motion] = [(); 2].map(|()| gpu.texture(SIZE, 1, TextureFormat::Rgba32Float, read));

    // As for the post-process. This renderer does not foveate, and means its vectors to be previous minus current.
    let mut desc = ContextDesc::new(SIZE);
    desc.settings.foveation.filter = Filter::Off;
    let mut doctor = Doctor::new(&gpu.device, &desc, 0)?;
    let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC;
    let words = gpu.buffer(doctor.words_bytes(), usage);

    for index in 0..8 {
        // The wall moves to the right by 3 pixels a frame, and down by 1. It was to the left before: (-3, -1) is right.
        let moved = [3.0, 1.0].map(|px: f32| px * index as f32);
        gpu.write(&color, 0, |x, y| [wall(x as f32 - moved[0], y as f32 - moved[1]); 3]);
        gpu.write(&motion, 0, |_, _| [3.0, 1.0, 0.0]);
        let views = [ViewFrame::new(ViewGeometry::flat(SIZE, 70.0)?, Gaze::At { px: [60.0, 40.0] })];
        let frame = Frame { motion: Some((&motion).into()), ..Frame::new(&color, &views, index) };
        let mut encoder = gpu.encoder();
        doctor.record(&gpu.device, &mut encoder, &frame, &words)?;
        gpu.submit(encoder);
        // An engine would read the words a few frames later.
        doctor.read(&gpu.read_buffer(&words));
    }
    for finding in doctor.findings() {
        println!("{finding}");
    }
    Ok(())
}
