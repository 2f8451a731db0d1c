//! Stereo: two views in one context, with array textures, one gaze for each view, and one dispatch.
//!
//! `cargo run --example 03_stereo` (any adapter; software Vulkan: mesa-vulkan-drivers)

mod headless;

use afterimage::gpu::{Afterimage, Frame};
use afterimage::wgpu::{TextureFormat, TextureUsages};
use afterimage::{ContextDesc, Gaze, ViewFrame, ViewGeometry};
use headless::Headless;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Headless::new()?;
    let size = [256, 256];
    let desc = ContextDesc { view_count: 2, ..ContextDesc::new(size) };
    let mut post = Afterimage::new(&gpu.device, &desc, TextureFormat::Rgba32Float)?;

    // Two array layers: left eye, right eye.
    let read = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
    let write = TextureUsages::STORAGE_BINDING | TextureUsages::COPY_SRC;
    let color = gpu.texture(size, 2, TextureFormat::Rgba32Float, read);
    let output = gpu.texture(size, 2, TextureFormat::Rgba32Float, write);

    // Each eye of a headset has a wider field of view on its outer side (left, right, up, down). Both look at one
    // point, first on the left, then on the right.
    let eyes = [([-0.876, 0.733, 0.83, -0.83], -0.032), ([-0.733, 0.876, 0.83, -0.83], 0.032)];
    let stripes = |eye: u32, sharp: bool, x: u32| {
        let light = if sharp { (x % 2) as f32 } else { 0.5 };
        if eye == 0 { [light, 0.25, 0.25] } else { [0.25, 0.25, light] }
    };
    for index in 0..2 {
        let mut views = vec![];
        // The ray of an eye tracker that sits between the eyes, and how far along it they look.
        let ray = [if index == 0 { -0.2 } else { 0.3 }, 0.0, -0.6];
        for (eye, (angles_rad, x_m)) in (0..).zip(eyes) {
            let geometry = ViewGeometry::from_angles(size, angles_rad)?;
            let pose = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [x_m, 0.0, 0.0, 1.0]];
            views.push(ViewFrame::new(geometry, Gaze::on_ray([0.0; 3], ray, 0.65, pose)));
            gpu.write(&color, eye, |x, _| stripes(eye, index == 0, x));
        }
        let mut encoder = gpu.encoder();
        let recorded = post.record(&gpu.device, &mut encoder, &Frame::new(&color, &views, index), &output)?;
        gpu.submit(encoder);
        for warning in recorded.warnings() {
            println!("frame {index}: {warning}");
        }
        let column = |eye: usize| post.gaze_px(eye, &views[eye].geometry, views[eye].gaze)[0];
        println!("frame {index}: left eye looks at column {:.0}, right eye at {:.0}", column(0), column(1));
    }
    for (eye, name) in [(0, "left"), (1, "right")] {
        let shown = gpu.read(&output, eye);
        let sharp = |c: &&[f32; 4]| c[0].max(c[2]) == 1.0 || c[0].min(c[2]) == 0.0;
        let other = |c: &&[f32; 4]| if eye == 0 { c[2] != 0.25 } else { c[0] != 0.25 };
        println!(
            "{name} eye: {} of {} pixels still sharp, {} from the other eye",
            shown.iter().filter(sharp).count(),
            shown.len(),
            shown.iter().filter(other).count()
        );
    }
    println!("{} KiB of history for both", post.memory_bytes() / 1024);
    Ok(())
}
