//! Albedo of planned frames: a texture that changes under light that does not needs no motion vectors.

use super::*;
use afterimage::internal::{Foveation, Smr};

const SIZE: [u32; 2] = [96, 64];
const FRAMES: u64 = 24;

/// Light of a wall: a slope, and a soft shadow.
fn light([x, y]: [u32; 2]) -> f32 {
    let shadow = 0.5 + 0.5 * (0.1 * (x as f32 - 48.0)).tanh();
    (0.3 + 0.004 * y as f32) * (0.4 + 0.6 * shadow)
}

/// Above, a texture that scrolls by 3 pixels a frame; below, a video with another picture in every frame.
fn texture([x, y]: [u32; 2], index: u64) -> [f32; 3] {
    let (column, picture) = if y < 32 { (u64::from(x) + 3 * index, 0) } else { (u64::from(x), index) };
    let hash = |channel: u64| {
        let mixed = (column / 2 * 7919 + u64::from(y / 2) * 104_729 + picture * 1_299_709 + channel * 15_485_863)
            .wrapping_mul(0x9e37_79b9_7f4a_7c15);
        0.35 + 0.3 * (mixed >> 40) as f32 / (1 << 24) as f32
    };
    [hash(0), hash(1), hash(2)]
}

/// Mean squared error of the upper and the lower half from the eighth frame on, of frames of which a tenth is shaded.
/// Surfaces stand still, and so say the vectors.
fn errors(has_albedo: bool) -> [f64; 2] {
    let method = Method::Smr(Smr { antialias: true, ..Smr::default() });
    let settings = Settings { method, foveation: Foveation::uniform(0.1), ..Settings::default() };
    let desc = ContextDesc { settings, has_albedo, keep_alpha: false, ..ContextDesc::new(SIZE) };
    let mut post = CpuAfterimage::new(&desc).unwrap();
    let mut errors = [0.0; 2];
    for index in 0..FRAMES {
        let albedo = Image::from_fn(SIZE, |px| texture(px, index));
        let color = Image::from_fn(SIZE, |px| pixel(&albedo, px).map(|a| a * light(px)));
        let mut view = View::still(color.clone(), [48.0, 32.0]);
        view.facts.jitter_px = Foveation::jitter_px(index);
        view.motion = Some(Image::filled(SIZE, [0.0; 2]));
        view.albedo = has_albedo.then_some(albedo);
        let (shown, ..) = one(&mut post, index, &view);
        for (i, (a, b)) in shown.pixels().iter().zip(color.pixels()).enumerate().filter(|_| index >= 8) {
            let half = usize::from(i >= shown.pixels().len() / 2);
            errors[half] += (0..3).map(|c| f64::from(a[c] - b[c]).powi(2)).sum::<f64>();
        }
    }
    errors
}

#[test]
fn a_scrolling_texture_and_a_video_need_no_vectors_with_albedo() {
    let (without, with) = (errors(false), errors(true));
    let gain = [0, 1].map(|half| 10.0 * (without[half] / with[half]).log10());
    println!("with albedo the scrolling texture gains {:.1} dB, the video {:.1} dB", gain[0], gain[1]);
    assert!(gain.iter().all(|&db| db > 10.0), "{gain:?}");
}
