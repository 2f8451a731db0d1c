//! The smallest program without a GPU: two frames in, one image out.
//!
//! `cargo run --features cpu --example 04_cpu`

use afterimage::cpu::{CpuAfterimage, Frame};
use afterimage::levels::{ContextDesc, ViewFrame};
use afterimage::{Gaze, Image, ViewGeometry};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let size = [320, 180];
    let mut post = CpuAfterimage::new(&ContextDesc::new(size))?;
    let mut output = [Image::filled(size, [0.0; 3])];

    // Frame 0: the gaze is left, and the renderer shades sharp stripes. Frame 1: the gaze is right, and the stripes are
    // blurred.
    let sharp = Image::from_fn(size, |[x, _]| [(x % 2) as f32; 3]);
    let blurred = Image::filled(size, [0.5; 3]);
    for (index, color, gaze_x) in [(0, &sharp, 60.0), (1, &blurred, 260.0)] {
        let views = [ViewFrame::new(ViewGeometry::flat(size, 70.0)?, Gaze::At { px: [gaze_x, 90.0] })];
        post.process(&Frame::new(&[color], &views, index), &mut output)?;
    }

    let stripes = |x: std::ops::Range<usize>| {
        let kept = x.clone().filter(|&x| output[0].at(x, 90) == sharp.at(x, 90)).count();
        100 * kept / x.len()
    };
    println!("stripes still seen on the left, where the eye was: {} %", stripes(40..80));
    println!("and in the middle, where it never was: {} %", stripes(140..180));
    Ok(())
}
