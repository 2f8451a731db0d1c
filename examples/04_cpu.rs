//! How do I do the same without a GPU? Two frames in, one image out.
//!
//! `cargo run --features cpu --example 04_cpu`

use afterimage::cpu::{CpuAfterimage, CpuFrame, CpuView};
use afterimage::{ContextDesc, Gaze, Image, Settings, ViewFrame, ViewGeometry};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let size = [320, 180];
    let mut post = CpuAfterimage::new(ContextDesc::new(size), Settings::default())?;
    let mut output = [Image::filled(size, [0.0; 3])];

    // Frame 0: the eye looks left and sees sharp stripes there. Frame 1: it looks right, and the renderer saves work on the left.
    let sharp = Image::from_fn(size, |[x, _]| [(x % 2) as f32; 3]);
    let blurred = Image::filled(size, [0.5; 3]);
    for (index, (color, gaze_x)) in [(&sharp, 60.0), (&blurred, 260.0)].into_iter().enumerate() {
        let facts = ViewFrame {
            geometry: ViewGeometry::flat(size, 70.0)?,
            gaze: Gaze::At { px: [gaze_x, 90.0] },
            previous_from_current: None,
        };
        let views = [CpuView::new(facts, color)];
        let frame = CpuFrame::new(&views, index as u64);
        post.process(&frame, &mut output, None)?;
    }

    let stripes = |x: std::ops::Range<usize>| {
        let kept = x.clone().filter(|&x| output[0].at(x, 90) == sharp.at(x, 90)).count();
        100 * kept / x.len()
    };
    println!("stripes still seen on the left, where the eye was: {} %", stripes(40..80));
    println!("and in the middle, where it never was: {} %", stripes(140..180));
    Ok(())
}
