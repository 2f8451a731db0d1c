//! Stereo without a GPU: two views in one context, with one image and one gaze each. Views do not affect each other.
//!
//! `cargo run --features cpu --example 05_cpu_stereo`

use afterimage::cpu::{CpuAfterimage, Frame};
use afterimage::levels::{ContextDesc, ViewFrame};
use afterimage::{Gaze, Image, ViewGeometry};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let size = [256, 256];
    let mut post = CpuAfterimage::new(&ContextDesc { view_count: 2, ..ContextDesc::new(size) })?;
    let mut output = [Image::filled(size, [0.0; 3]), Image::filled(size, [0.0; 3])];

    // Each eye of a headset has a wider field of view on its outer side. The eyes are 64 mm apart and look at one point
    // 0.6 m ahead.
    let eyes = [([-1.2, 0.9], 0.032), ([-0.9, 1.2], -0.032)];
    let (left, right) = (Image::filled(size, [0.8, 0.3, 0.3]), Image::filled(size, [0.3, 0.3, 0.8]));
    for index in 0..10 {
        let mut views = vec![];
        for (tan_x, offset_m) in eyes {
            let geometry = ViewGeometry::off_axis(size, tan_x, [-1.1, 1.1])?;
            let gaze = geometry.project([offset_m, 0.0, 0.6]).map_or(Gaze::Lost, |px| Gaze::At { px });
            views.push(ViewFrame::new(geometry, gaze));
        }
        post.process(&Frame::new(&[&left, &right], &views, index), &mut output)?;
    }
    println!("left eye shows {:?}, right eye {:?}", output[0].at(128, 128), output[1].at(128, 128));
    println!("{} KiB of history for both", post.memory_bytes() / 1024);
    Ok(())
}
