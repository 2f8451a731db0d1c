//! Frames that the renderer foveates itself: two frames in, one image out, without a window.
//!
//! `cargo run --example 07_levels` (any adapter; software Vulkan: mesa-vulkan-drivers)

mod headless;

use afterimage::levels::{Afterimage, Desc, Frame, ViewFrame};
use afterimage::wgpu::{TextureFormat, TextureUsages};
use afterimage::{Gaze, ViewGeometry};
use headless::Headless;

const SIZE: [u32; 2] = [256, 64];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // From your renderer: a device, the texture of the foveated frame, and the texture of the output.
    let gpu = Headless::new()?;
    let (read, write) = (TextureUsages::TEXTURE_BINDING, TextureUsages::STORAGE_BINDING);
    let color = gpu.texture(SIZE, 1, TextureFormat::Rgba32Float, read | TextureUsages::COPY_DST);
    let output = gpu.texture(SIZE, 1, TextureFormat::Rgba32Float, write | TextureUsages::COPY_SRC);

    let mut post = Afterimage::new(&gpu.device, &Desc::new(SIZE, output.format()))?;
    // Frame 0: the gaze is left, and the renderer shades sharp stripes. Frame 1: the gaze is right, and the stripes are
    // blurred.
    for (index, gaze_x, sharp) in [(0, 50.0, true), (1, 200.0, false)] {
        gpu.write(&color, 0, |x, _| [if sharp { (x % 2) as f32 } else { 0.5 }; 3]);
        let views = [ViewFrame::new(ViewGeometry::flat(SIZE, 70.0)?, Gaze::At { px: [gaze_x, 32.0] })];
        let mut encoder = gpu.encoder();
        post.record(&mut encoder, &Frame::new(&color, &views, index), &output)?;
        gpu.submit(encoder);
    }

    let shown = gpu.read(&output, 0);
    let row = &shown[32 * SIZE[0] as usize..][..SIZE[0] as usize];
    let kept = |range: std::ops::Range<usize>| {
        let stripes = range.clone().filter(|&x| (row[x][0] - (x % 2) as f32).abs() < 0.05);
        100 * stripes.count() / range.len()
    };
    println!("stripes still seen on the left, where the eye was: {} %", kept(40..60));
    println!("and further out, where it never looked: {} %", kept(110..130));
    Ok(())
}
